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

}  // namespace
}  // namespace fovea::test
