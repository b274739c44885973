// The built-in scenes must be as large as the paper's, sound, the same every time, and complete as scene files.
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

namespace fovea::scene {
namespace {

struct Expected {
  const char* name;
  size_t triangles;    // of the paper's scene
  bool closed = true;  // around the viewer
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

TEST_P(BuiltinScenes, HasAsManyTrianglesAsThePapers) {
  const Geometry g = flatten(scene());
  EXPECT_GE(double(g.triangles.size()), 0.9 * double(GetParam().triangles));
  EXPECT_LE(double(g.triangles.size()), 1.1 * double(GetParam().triangles));
}

TEST_P(BuiltinScenes, IsTheSameEveryTimeAndQuicklyMade) {
  const std::clock_t begin = std::clock();  // time of the process, so that other load does not count
  const Scene again = builtin(GetParam().name);
  EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 4.0);
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

TEST_P(BuiltinScenes, HasOneMainLightAViewAPathAndAGaze) {
  const Scene& s = scene();
  EXPECT_EQ(s.lights.size(), 1u);
  EXPECT_FALSE(s.cameras.empty());
  EXPECT_GE(s.cameraPath.size(), 3u);
  EXPECT_GE(s.gaze.size(), 15u);
  EXPECT_FALSE(s.movers.empty());
  EXPECT_FALSE(s.lightMotions.empty());
  size_t cages = 0;
  for (const Mesh& m : s.meshes) cages += m.cage && !m.cage->targets.empty();
  EXPECT_GE(cages, 1u) << "nothing deforms";
  EXPECT_FALSE(s.animations.empty());
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

INSTANTIATE_TEST_SUITE_P(All, BuiltinScenes,
                         testing::Values(Expected{"cornellbox_moving", 5800, false},
                                         Expected{"atrium", 279000}, Expected{"balcony", 192000},
                                         Expected{"room", 476000}, Expected{"yard", 516000}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace fovea::scene
