// Single rays, where they meet what is black or nothing at all.
#include "framework/scene/rays/surface_tracer.h"

#include <gtest/gtest.h>

#include <memory>

#include "framework/scene/environment/environment_map.h"
#include "framework/scene/scene.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

// What reaches a floor of one metre from a white sky, as a share of it, with a roof that faces away from the floor.
float lightBelow(bool roof) {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f));
  addQuad(s, grey, {-0.5f, 0, -0.5f}, {0, 0, 1}, {1, 0, 0});
  if (roof) addQuad(s, grey, {-100, 0.1f, -100}, {0, 0, 200}, {200, 0, 0});
  s.environmentMap = std::make_shared<scene::EnvironmentMap>(4, 2, std::vector<glm::vec3>(8, glm::vec3(1)));
  scene::Camera camera;
  camera.position = {0, 0.05f, 0};
  camera.orientation = glm::angleAxis(-1.57f, glm::vec3(1, 0, 0));
  s.cameras.push_back(camera);
  const scene::Geometry g = scene::flatten(s);
  const scene::Frame frame = scene::makeFrame(s, g, {8, 8}, 0, 1);
  const auto rays = scene::RayScene::cached(s, g);
  const scene::SurfaceTracer tracer(frame, frame.views[0], *rays);
  uint64_t count = 0;
  const scene::TracedSurface floor = tracer.look({4, 4}, count);
  EXPECT_TRUE(floor.there);
  return tracer.gather(floor, 2, 256, 1, count).g;
}

TEST(SurfaceTracer, TheSkyDoesNotShineThroughBlackBacks) {
  EXPECT_NEAR(lightBelow(false), 1, 0.05);
  EXPECT_LT(lightBelow(true), 0.01);
}

// What a sun beside the mirror direction lets one see of a floor of metal that is treated as at least so rough.
float gleamOf(float roughness, float leastRoughness) {
  scene::Scene s;
  const uint32_t metal = addMaterial(s, glm::vec3(0.8f));
  s.materials[metal].metallic = 1;
  s.materials[metal].roughness = roughness;
  addQuad(s, metal, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  scene::Light sun;
  sun.direction = glm::normalize(glm::vec3(-0.3f, -1, 0));
  sun.intensity = 1;
  s.lights.push_back(sun);
  s.cameras.emplace_back().position = {0, 1, 0};
  s.cameras[0].orientation = glm::angleAxis(-1.57f, glm::vec3(1, 0, 0));
  const scene::Geometry g = scene::flatten(s);
  const scene::Frame frame = scene::makeFrame(s, g, {8, 8}, 0, 1);
  const auto rays = scene::RayScene::cached(s, g);
  const scene::SurfaceTracer tracer(frame, frame.views[0], *rays, true);
  uint64_t count = 0;
  return tracer.seen(tracer.look({4, 4}, count), {0, 1, 0}, count, leastRoughness).g;
}

TEST(SurfaceTracer, SmoothSurfacesMayBeTreatedAsRougher) {
  const float smooth = gleamOf(0.2f, 0), rough = gleamOf(0.5f, 0);
  EXPECT_GT(rough, 2 * smooth);  // its highlight reaches further
  EXPECT_FLOAT_EQ(gleamOf(0.2f, 0.5f), rough);
  EXPECT_FLOAT_EQ(gleamOf(0.5f, 0.2f), rough);
}

}  // namespace
}  // namespace fovea::test
