// The built-in Cornell box must match the paper's description, closed except for its front, and lit so that indirect
// light matters.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "fovea/scene.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"

namespace fovea::scene {
namespace {

const Geometry& box() {
  static const Geometry g = flatten(builtin("cornellbox"));
  return g;
}

TEST(CornellBox, IsAboutFivePointEightThousandTriangles) {
  EXPECT_GE(box().triangles.size(), 5500u);
  EXPECT_LE(box().triangles.size(), 6100u);
  // The room itself has few triangles; the rest belongs to the objects.
  const Scene s = builtin("cornellbox");
  EXPECT_EQ(s.meshes[0].name, "room");
}

TEST(CornellBox, InsideIsFivePointFiveMetresASide) {
  const Scene s = builtin("cornellbox");
  glm::vec3 low(1e9f), high(-1e9f);
  for (const Primitive& p : s.meshes[0].primitives) {
    if (s.materials[p.material].name == "light grey") continue;  // the outside
    for (const glm::vec3& v : p.positions) {
      low = glm::min(low, v);
      high = glm::max(high, v);
    }
  }
  for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(high[i] - low[i], 5.5f);
}

TEST(CornellBox, ReflectancesArePlausible) {
  for (const Material& m : builtin("cornellbox").materials)
    for (int i = 0; i < 3; ++i) {
      EXPECT_LE(m.baseColor[i], 0.8f) << m.name;
      EXPECT_GT(m.baseColor[i], 0.0f) << m.name;
    }
}

// Every solid is watertight: each directed edge between positions meets its opposite exactly once. This holds
// for the room too, since its walls have an outside and a rim: no seam lets light through.
TEST(CornellBox, EverySolidIsClosed) {
  const Scene s = builtin("cornellbox");
  for (const Mesh& mesh : s.meshes) {
    using Point = std::array<float, 3>;
    std::map<std::pair<Point, Point>, int> edges;
    const auto key = [](const glm::vec3& v) { return Point{v.x + 0.0f, v.y + 0.0f, v.z + 0.0f}; };
    for (const Primitive& p : mesh.primitives)
      for (size_t i = 0; i < p.indices.size(); i += 3)
        for (size_t k = 0; k < 3; ++k)
          ++edges[{key(p.positions[p.indices[i + k]]), key(p.positions[p.indices[i + (k + 1) % 3]])}];
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1) << mesh.name;
      const auto opposite = edges.find({edge.second, edge.first});
      ASSERT_NE(opposite, edges.end()) << mesh.name << ": an open edge at " << edge.first[0] << ' '
                                       << edge.first[1] << ' ' << edge.first[2];
    }
  }
}

TEST(CornellBox, NormalsAgreeWithTheWinding) {
  const Geometry& g = box();
  for (const Triangle& t : g.triangles) {
    const glm::vec3 n =
        glm::cross(g.positions[t.v[1]] - g.positions[t.v[0]], g.positions[t.v[2]] - g.positions[t.v[0]]);
    ASSERT_GT(glm::length(n), 0.0f);
    for (uint32_t v : t.v) EXPECT_GT(glm::dot(glm::normalize(n), g.normals[v]), 0.2f);
  }
}

TEST(CornellBox, YellowCubeStandsCloseToTheWhiteWallWithoutTouchingIt) {
  const Scene s = builtin("cornellbox");
  const Geometry& g = box();
  const auto yellow = std::find_if(s.materials.begin(), s.materials.end(),
                                   [](const Material& m) { return m.name == "yellow"; });
  ASSERT_NE(yellow, s.materials.end());
  float back = 1e9f, bottom = 1e9f;
  for (const Triangle& t : g.triangles)
    if (t.material() == uint32_t(yellow - s.materials.begin()))
      for (uint32_t v : t.v) {
        back = std::min(back, g.positions[v].z);
        bottom = std::min(bottom, g.positions[v].y);
      }
  EXPECT_GT(back, -2.75f);
  EXPECT_LT(back, -2.75f + 0.3f);
  EXPECT_NEAR(bottom, 0, 1e-6f);
}

TEST(CornellBox, OneLightInsideOneCameraOutsideLookingIn) {
  const Scene s = builtin("cornellbox");
  ASSERT_EQ(s.lights.size(), 1u);
  EXPECT_GT(s.lights[0].position.y, 5.0f);
  EXPECT_LT(s.lights[0].position.y, 5.5f);
  ASSERT_EQ(s.cameras.size(), 1u);
  EXPECT_GT(s.cameras[0].position.z, 2.75f);
  EXPECT_FALSE(s.gaze.empty());
  EXPECT_EQ(s.hash, builtin("cornellbox").hash);
  EXPECT_NE(s.hash, 0u);
}

TEST(CornellBox, UnknownBuiltinsSuggestTheNearest) {
  try {
    builtin("cornelbox");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean `cornellbox`"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace fovea::scene
