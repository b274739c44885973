// Single rays that hit black surfaces or nothing.
#include "framework/scene/rays/surface_tracer.h"

#include <gtest/gtest.h>

#include <memory>

#include "framework/base/random.h"
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

// A floor of full materials that a camera one metre above looks down on.
struct Floor {
  scene::Scene scene;
  scene::Geometry geometry;
  scene::Frame frame;
  std::shared_ptr<const scene::RayScene> rays;
  std::unique_ptr<scene::SurfaceTracer> tracer;
  scene::TracedSurface seen;
  uint64_t count = 0;

  // s: what else there is.
  Floor(const scene::Material& material, scene::Scene s) : scene(std::move(s)) {
    scene.materials.push_back(material);
    addQuad(scene, uint32_t(scene.materials.size() - 1), {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    scene.cameras.emplace_back().position = {0, 1, 0};
    scene.cameras[0].orientation = glm::angleAxis(-1.57f, glm::vec3(1, 0, 0));
    geometry = scene::flatten(scene);
    frame = scene::makeFrame(scene, geometry, {8, 8}, 0, 1);
    rays = scene::RayScene::cached(scene, geometry);
    tracer = std::make_unique<scene::SurfaceTracer>(frame, frame.views[0], *rays, true);
    seen = tracer->look({4, 4}, count);
  }

  // The radiance that it sends in the direction `out` of the light that reaches it, a mean over many random numbers.
  double passedOn(glm::vec3 out, float leastRoughness, uint32_t bounces) {
    constexpr uint32_t kGathers = 20000;
    const scene::Reflection reflection =
        tracer->reflection(seen, out, tracer->reflectance(seen), leastRoughness);
    double sum = 0;
    for (uint32_t i = 0; i < kGathers; ++i)
      sum += double(tracer->passedOn(seen, reflection, bounces, 2, randomStream(5, i, 0, 0), count).g);
    return sum / kGathers;
  }
};

scene::Material materialOf(float metallic, float roughness) {
  scene::Material m;
  m.baseColor = glm::vec4(1);
  m.metallic = metallic;
  m.roughness = roughness;
  return m;
}

// What a sun beside the mirror direction lets one see of a floor of metal that is treated as at least so rough.
float gleamOf(float roughness, float leastRoughness) {
  scene::Scene s;
  scene::Light sun;
  sun.direction = glm::normalize(glm::vec3(-0.3f, -1, 0));
  sun.intensity = 1;
  s.lights.push_back(sun);
  Floor floor(materialOf(1, roughness), std::move(s));
  return floor.tracer->seen(floor.seen, {0, 1, 0}, floor.count, leastRoughness).g;
}

TEST(SurfaceTracer, SmoothSurfacesMayBeTreatedAsRougher) {
  const float smooth = gleamOf(0.2f, 0), rough = gleamOf(0.5f, 0);
  EXPECT_GT(rough, 2 * smooth);  // its highlight reaches further
  EXPECT_FLOAT_EQ(gleamOf(0.2f, 0.5f), rough);
  EXPECT_FLOAT_EQ(gleamOf(0.5f, 0.2f), rough);
}

// A white surface under a white sky looks like it from everywhere. Without rays of its own it sees single points of the
// sky, which a narrow lobe seldom meets.
TEST(SurfaceTracer, NothingIsLostOfTheLightThatIsPassedOn) {
  const struct {
    float roughness;
    uint32_t bounces;
  } cases[] = {{0.1f, 1}, {0.4f, 1}, {0.8f, 0}};
  for (const auto& [roughness, bounces] : cases)
    for (const float metallic : {0.0f, 1.0f})
      for (const glm::vec3 out : {glm::vec3(0, 1, 0), glm::normalize(glm::vec3(2, 1, 0))}) {
        scene::Scene s;
        s.environmentMap =
            std::make_shared<scene::EnvironmentMap>(4, 2, std::vector<glm::vec3>(8, glm::vec3(1)));
        Floor floor(materialOf(metallic, roughness), std::move(s));
        EXPECT_NEAR(floor.passedOn(out, 0, bounces), 1, 0.02)
            << metallic << ", " << roughness << ", " << out.x;
      }
}

// A metal floor sends the light of a panel to where a mirror would, and hardly anywhere else. The panel is as bright in
// it as the part of the lobe that it fills.
TEST(SurfaceTracer, MetalPassesLightOnInItsLobe) {
  const auto shown = [](glm::vec3 out, float roughness, float leastRoughness) {
    scene::Scene s;
    const uint32_t panel = addMaterial(s, glm::vec3(0));
    s.materials[panel].emission = glm::vec3(3);
    s.materials[panel].doubleSided = true;
    addQuad(s, panel, {-2, 0.2f, -1.5f}, {0, 1.8f, 0}, {0, 0, 3});
    return Floor(materialOf(1, roughness), std::move(s)).passedOn(glm::normalize(out), leastRoughness, 1);
  };
  EXPECT_NEAR(shown({1, 0.5f, 0}, 0.1f, 0), 3, 0.1);  // mirrored
  EXPECT_LT(shown({-1, 0.5f, 0}, 0.1f, 0), 0.01);     // back to where it came from
  EXPECT_NEAR(shown({-1, 2, 0}, 0.1f, 0.5f), shown({-1, 2, 0}, 0.5f, 0), 1e-6);
  EXPECT_GT(shown({-1, 2, 0}, 0.5f, 0), 0.01);
}

}  // namespace
}  // namespace fovea::test
