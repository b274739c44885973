// The built-in scenes must be as large as the paper's, sound, the same every time, and complete as scene files. The
// validation and stress scenes must be sound, too, and lit in view.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <map>

#include "fovea/scene.h"
#include "framework/scene/load.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/scene.h"
#include "framework/scene/subdivision/subdivision.h"
#include "passes/path-trace/lights.h"

namespace fovea::scene {
namespace {

// Of a scene, in seconds of the process; sanitizers make it several times as slow.
constexpr double kMostSeconds = FOVEA_SANITIZED ? 20 : 4;

struct Expected {
  const char* name;
  size_t triangles;    // of the paper's scene, or those that a validation or stress scene has
  bool closed = true;  // around the viewer
  bool validation = false;
  size_t lights = 1;
  double lit = 0;  // s: when light comes in, if not from the beginning
};

class BuiltinScenes : public testing::TestWithParam<Expected> {
 protected:
  static const Scene& scene() {
    static std::map<std::string, Scene> scenes;
    const std::string name = GetParam().name;
    if (scenes.count(name) == 0) {
      Diagnostics warnings;
      scenes.emplace(name, load(name, warnings));
    }
    return scenes.at(name);
  }
};

TEST_P(BuiltinScenes, HasAsManyTrianglesAsItShould) {
  const Geometry g = flatten(scene());
  EXPECT_GE(double(g.triangles.size()), 0.9 * double(GetParam().triangles));
  EXPECT_LE(double(g.triangles.size()), 1.1 * double(GetParam().triangles));
}

TEST_P(BuiltinScenes, IsTheSameEveryTimeAndQuicklyMade) {
  const std::clock_t begin = std::clock();  // time of the process, so that other load does not count
  const Scene again = builtin(GetParam().name);
  EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, kMostSeconds);
  EXPECT_EQ(again.hash, builtin(GetParam().name).hash);
}

TEST_P(BuiltinScenes, EveryTriangleIsSound) {
  for (const Mesh& m : scene().meshes)
    for (const Primitive& p : m.primitives) {
      ASSERT_EQ(p.normals.size(), p.positions.size()) << m.name;
      ASSERT_EQ(p.uvs.size(), p.positions.size()) << m.name;
      ASSERT_LT(p.material, scene().materials.size()) << m.name;
      for (size_t v = 0; v < p.positions.size(); ++v) {
        ASSERT_TRUE(std::isfinite(glm::dot(p.positions[v], glm::vec3(1)))) << m.name;
        ASSERT_TRUE(std::isfinite(p.uvs[v].x + p.uvs[v].y)) << m.name;
        ASSERT_NEAR(glm::length(p.normals[v]), 1, 1e-3) << m.name;
      }
      size_t thin = 0, against = 0;
      for (size_t i = 0; i < p.indices.size(); i += 3) {
        const glm::vec3 a = p.positions[p.indices[i]], b = p.positions[p.indices[i + 1]],
                        c = p.positions[p.indices[i + 2]];
        const glm::vec3 n = glm::cross(b - a, c - a);
        if (!(glm::length(n) > 1e-10f)) ++thin;
        const glm::vec3 mean =
            p.normals[p.indices[i]] + p.normals[p.indices[i + 1]] + p.normals[p.indices[i + 2]];
        if (glm::dot(n, mean) < 0) ++against;
      }
      EXPECT_EQ(thin, 0u) << m.name << ", " << scene().materials[p.material].name;
      EXPECT_EQ(against, 0u) << m.name << ", " << scene().materials[p.material].name;
    }
}

TEST_P(BuiltinScenes, ReflectancesArePlausible) {
  for (const Material& m : scene().materials)
    for (int i = 0; i < 3; ++i) {
      EXPECT_GT(m.baseColor[i], 0) << m.name;
      EXPECT_LE(m.baseColor[i], m.baseColorTexture ? 1.0f : 0.9f) << m.name;
    }
}

TEST_P(BuiltinScenes, HasLightsAViewAPathAndAGaze) {
  const Scene& s = scene();
  EXPECT_EQ(s.lights.size(), GetParam().lights);
  EXPECT_FALSE(s.cameras.empty());
  EXPECT_GE(s.cameraPath.size(), 3u);
  EXPECT_GE(s.gaze.size(), GetParam().validation ? 10u : 15u);
  EXPECT_FALSE(s.movers.empty());
  if (!GetParam().validation) {
    EXPECT_FALSE(s.lightMotions.empty());
    size_t cages = 0;
    for (const Mesh& m : s.meshes) cages += m.cage && !m.cage->targets.empty();
    EXPECT_GE(cages, 1u) << "nothing deforms";
    EXPECT_FALSE(s.animations.empty());
  }
  // The path starts at the generator's view of the still scene.
  const Scene still = builtin(GetParam().name);
  ASSERT_FALSE(still.cameras.empty());
  EXPECT_LT(glm::length(still.cameras[0].position - s.cameraPath[0].camera.position), 1e-3f);
  EXPECT_GT(std::abs(glm::dot(still.cameras[0].orientation, s.cameraPath[0].camera.orientation)), 0.99999f);
  EXPECT_NEAR(still.cameras[0].verticalFov, s.cameraPath[0].camera.verticalFov, 1e-4f);
}

// Along the camera's path no object is seen from its inside, and below the horizon there is always something: walls
// have a thickness and no gaps.
TEST_P(BuiltinScenes, IsClosedAroundTheViewer) {
  if (!GetParam().closed) GTEST_SKIP() << "seen from outside";
  const Scene& s = scene();
  const Geometry g = flatten(s);
  const RayScene rays(s, g);
  for (const CameraKey& key : s.cameraPath) {
    int inside = 0, escaped = 0;
    constexpr int kRays = 8000;
    for (int i = 0; i < kRays; ++i) {
      const float y = -1 + 1.9f * (float(i) + 0.5f) / kRays, r = std::sqrt(1 - y * y),
                  a = 2.39996f * float(i);
      const glm::vec3 d(r * std::cos(a), y, r * std::sin(a));
      const RayHit hit = rays.intersect({key.camera.position, d});
      if (!hit) {
        escaped += y < 0;
        continue;
      }
      const Triangle& t = g.triangles[hit.triangle];
      const glm::vec3 n =
          glm::cross(g.positions[t.v[1]] - g.positions[t.v[0]], g.positions[t.v[2]] - g.positions[t.v[0]]);
      inside += glm::dot(n, d) > 0 && !s.materials[t.material()].doubleSided;
    }
    EXPECT_EQ(escaped, 0) << "at " << key.time << " s";
    EXPECT_LE(inside, kRays / 1000) << "at " << key.time << " s";
  }
}

glm::vec3 normalOf(const Geometry& g, uint32_t triangle) {
  const Triangle& t = g.triangles[triangle];
  return glm::cross(g.positions[t.v[1]] - g.positions[t.v[0]], g.positions[t.v[2]] - g.positions[t.v[0]]);
}

class ValidationScenes : public BuiltinScenes {};

// Calls f(direction) for rays through a square picture of side x side pixels.
template <class F>
void forPixels(const Camera& camera, int side, F f) {
  const float half = std::tan(0.5f * camera.verticalFov);
  for (int i = 0; i < side * side; ++i) {
    const glm::vec2 p = 2.0f * (glm::vec2(i % side, i / side) + 0.5f) / float(side) - 1.0f;
    f(glm::normalize(camera.orientation * glm::vec3(half * p.x, -half * p.y, -1)));
  }
}

// Two front faces of different materials at the same place would be drawn as a pattern that changes with the view.
TEST_P(ValidationScenes, NoTwoSurfacesOfDifferentMaterialsCoincideInView) {
  const Scene& s = scene();
  const Geometry g = flatten(s);
  const RayScene rays(s, g);
  for (const CameraKey& key : s.cameraPath) {
    constexpr int kSide = 200;
    int both = 0;
    forPixels(key.camera, kSide, [&](glm::vec3 d) {
      const RayHit first = rays.intersect({key.camera.position, d});
      if (!first) return;
      const float gap = 2e-5f * first.distance;
      const RayHit second = rays.intersect(
          {key.camera.position, d, first.distance + 1e-7f * first.distance, first.distance + gap});
      if (!second) return;
      both += g.triangles[first.triangle].material() != g.triangles[second.triangle].material() &&
              glm::dot(normalOf(g, first.triangle), d) < 0 && glm::dot(normalOf(g, second.triangle), d) < 0;
    });
    EXPECT_LE(both, kSide * kSide / 2000) << "at " << key.time << " s";
  }
}

// The scene with its movers where they are at the last key up to this time.
Scene posed(Scene s, double time) {
  for (Mover& mover : s.movers) {
    MotionKey last = mover.keys[0];
    for (const MotionKey& key : mover.keys)
      if (key.time <= time) last = key;
    mover.keys = {last};
  }
  return s;
}

// Part of what the eye sees is lit without a bounce, by a light or by a surface that emits.
TEST_P(ValidationScenes, LightReachesTheView) {
  const Scene s = posed(scene(), GetParam().lit);
  const Geometry g = flatten(s);
  const RayScene rays(s, g);
  std::vector<uint32_t> emitters;
  for (uint32_t t = 0; t < g.triangles.size(); ++t)
    if (glm::length(s.materials[g.triangles[t].material()].emission) > 0) emitters.push_back(t);
  for (const CameraKey& key : s.cameraPath) {
    int seen = 0, lit = 0;
    uint32_t next = 0;
    forPixels(key.camera, 48, [&](glm::vec3 d) {
      const RayHit hit = rays.intersect({key.camera.position, d});
      if (!hit) return;
      ++seen;
      const glm::vec3 n = glm::normalize(normalOf(g, hit.triangle));
      const glm::vec3 normal = glm::dot(n, d) < 0 ? n : -n;
      const glm::vec3 p = key.camera.position + hit.distance * d + 4 * rays.epsilon() * normal;
      const auto sees = [&](glm::vec3 direction, float distance) {
        return glm::dot(direction, normal) > 0 && !rays.occluded({p, direction, 0, 0.999f * distance});
      };
      bool reached = false;
      for (const Light& light : s.lights) {
        const path_trace::IncidentLight sample = path_trace::incidentLight(light, p);
        reached |= glm::dot(sample.irradiance, glm::vec3(1)) > 0 && sees(sample.direction, sample.distance);
      }
      for (int i = 0; i < 12 && !reached && !emitters.empty(); ++i) {
        const uint32_t triangle = emitters[(next += 7919) % emitters.size()];
        const Triangle& t = g.triangles[triangle];
        const glm::vec3 to = (g.positions[t.v[0]] + g.positions[t.v[1]] + g.positions[t.v[2]]) / 3.0f - p;
        if (glm::dot(to, normalOf(g, triangle)) < 0) reached = sees(glm::normalize(to), glm::length(to));
      }
      lit += reached;
    });
    EXPECT_GT(lit, seen / 10) << "at " << key.time << " s";
  }
}

INSTANTIATE_TEST_SUITE_P(All, BuiltinScenes,
                         testing::Values(Expected{"cornellbox_moving", 5800, false},
                                         Expected{"atrium", 279000}, Expected{"balcony", 192000},
                                         Expected{"room", 476000}, Expected{"yard", 516000}),
                         [](const auto& info) { return std::string(info.param.name); });

const Expected kValidation[] = {{"alley", 82500, true, true, 0},
                                {"chapel", 18600, true, true, 1},
                                {"dollhouse", 132300, false, true, 2},
                                {"gallery", 58000, true, true, 0},
                                {"greenhouse", 112600, true, true, 1},
                                {"hangar", 35300, true, true, 1},
                                {"kitchen", 21300, true, true, 3},
                                {"laundry", 71200, true, true, 0},
                                {"lounge", 86000, true, true, 4},
                                // No validation scenes, but checked as such.
                                {"garage", 61200, true, true, 0},
                                {"workshop", 35600, true, true, 1}};
const Expected kStress[] = {{"ballroom", 33200, true, true, 100},
                            {"doorway", 55700, true, true, 1, 2.0},
                            {"night_window", 76400, true, true, 1},
                            {"terraces", 2121400, false, true, 1}};
const auto nameOf = [](const auto& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Validation, BuiltinScenes, testing::ValuesIn(kValidation), nameOf);
INSTANTIATE_TEST_SUITE_P(Validation, ValidationScenes, testing::ValuesIn(kValidation), nameOf);
INSTANTIATE_TEST_SUITE_P(Stress, BuiltinScenes, testing::ValuesIn(kStress), nameOf);
INSTANTIATE_TEST_SUITE_P(Stress, ValidationScenes, testing::ValuesIn(kStress), nameOf);

}  // namespace
}  // namespace fovea::scene
