// Tests cages that must be refused, random cages, and cages of a scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "fovea/error.h"
#include "framework/scene/subdivision/subdivision.h"
#include "tests/support/cages.h"

namespace fovea::scene {
namespace {

using namespace test;
using Scheme = SubdivisionCage::Scheme;
using testing::HasSubstr;

void expectRefused(const SubdivisionCage& cage, const std::string& place, const std::string& message) {
  const std::vector<CageProblem> problems = checkCage(cage);
  ASSERT_FALSE(problems.empty()) << place;
  EXPECT_EQ(problems.front().place, place);
  EXPECT_THAT(problems.front().message, HasSubstr(message));
  EXPECT_THROW(refine(cage), Error);
  EXPECT_THROW(Stencils{cage}, Error);
}

TEST(Subdivision, BadCagesAreRefused) {
  const auto changed = [](const std::function<void(SubdivisionCage&)>& change) {
    SubdivisionCage cage = cubeCage(2);
    change(cage);
    return cage;
  };
  using Cage = SubdivisionCage;
  expectRefused(Cage{}, "faceSizes", "no faces");
  expectRefused(changed([](Cage& c) { c.level = 0; }), "level", "not in 1 to 8");
  expectRefused(changed([](Cage& c) { c.level = 9; }), "level", "not in 1 to 8");
  expectRefused(changed([](Cage& c) { c.lightLevel = 3; }), "lightLevel",
                "finer than that of the picture, 2");
  expectRefused(changed([](Cage& c) { c.positions[3].y = NAN; }), "positions[3]", "not finite");
  expectRefused(changed([](Cage& c) { c.faceVertices[5] = 8; }), "faceVertices[5]", "only 8");
  expectRefused(changed([](Cage& c) { c.faceSizes[2] = 2; }), "faceSizes[2]", "a face of 2 vertices");
  expectRefused(changed([](Cage& c) { c.faceSizes[2] = 5; }), "faceVertices", "add up to 25");
  expectRefused(changed([](Cage& c) { c.faceVertices[1] = 0; }), "faces[0]", "names vertex 0 twice");
  expectRefused(changed([](Cage& c) { std::swap(c.faceVertices[1], c.faceVertices[3]); }), "faces[4]",
                "in the same direction");
  expectRefused(changed([](Cage& c) { addFace(c, {0, 1, 7}); }), "faces[6]", "in the same direction");
  expectRefused(changed([](Cage& c) { c.positions.emplace_back(0, 0, 0); }), "positions[8]",
                "belongs to no face");
  expectRefused(changed([](Cage& c) {
                  c.positions.emplace_back(3, 3, 3);
                  c.positions.emplace_back(3, 3, 4);
                  addFace(c, {7, 8, 9});
                }),
                "positions[7]", "meet only in this vertex");
  expectRefused(changed([](Cage& c) { c.creases.push_back({0, 7, 1}); }), "creases[0]", "no edge between");
  expectRefused(changed([](Cage& c) { c.creases.push_back({0, 900, 1}); }), "creases[0]", "no edge between");
  expectRefused(changed([](Cage& c) { c.creases.push_back({0, 1, -1}); }), "creases[0]", "sharpness");
  expectRefused(changed([](Cage& c) { c.corners.push_back({12, 1}); }), "corners[0]", "no vertex 12");
  expectRefused(changed([](Cage& c) { c.uvs = {{0, 0}}; }), "faceUvs", "missing");
  expectRefused(changed([](Cage& c) { c.faceUvs = c.faceVertices; }), "faceUvs[0]", "only 0");
  expectRefused(changed([](Cage& c) { c.faceMaterials = {0, 1}; }), "faceMaterials", "for 6 faces");
  expectRefused(changed([](Cage& c) { c.scheme = Scheme::Loop; }), "faceSizes[0]", "triangles only");
  expectRefused(changed([](Cage& c) { c.targets.resize(1), c.targets[0].positions.resize(3); }), "targets[0]",
                "for 8 points");
  Cage large = gridCage(200, 200, 8, [](uint32_t, uint32_t) { return 0.0f; });
  expectRefused(large, "level", "at most 4194304");
}

// Holes, random creases, corners, seams and wrong indices: the cage is refined, with stencils that give the
// same, or refused.
TEST(Subdivision, RandomCagesAreRefinedOrRefused) {
  uint32_t draw = 0;
  const auto below = [&](uint32_t n) { return hashCombine(17, draw++) % n; };
  int refinedCages = 0, refusedCages = 0;
  for (uint32_t i = 0; i < 300; ++i) {
    const uint32_t kind = below(3), size = 3 + below(3);
    const SubdivisionCage whole = kind == 0 ? cubeCage(1)
                                  : kind == 1
                                      ? icosahedronCage(1)
                                      : gridCage(size, size, 1, [](uint32_t, uint32_t) { return 0.0f; });
    SubdivisionCage cage = jittered(whole, 0.3f, i);
    cage.level = 1 + below(3);
    cage.faceSizes.clear(), cage.faceVertices.clear(), cage.faceUvs.clear();
    std::vector<uint32_t> to(whole.positions.size(), kNoIndex);
    std::vector<glm::vec3> used;
    size_t first = 0;
    for (size_t f = 0; f < whole.faceSizes.size(); first += whole.faceSizes[f++]) {
      if (below(6) == 0) continue;
      cage.faceSizes.push_back(whole.faceSizes[f]);
      for (size_t k = first; k < first + whole.faceSizes[f]; ++k) {
        uint32_t& point = to[whole.faceVertices[k]];
        if (point == kNoIndex)
          point = uint32_t(used.size()), used.push_back(cage.positions[whole.faceVertices[k]]);
        cage.faceVertices.push_back(below(4000) == 0 ? below(30) : point);
        if (k > first && below(4) == 0)
          cage.creases.push_back({cage.faceVertices[cage.faceVertices.size() - 2], point, float(below(12))});
        if (!whole.faceUvs.empty())
          cage.faceUvs.push_back(below(8) ? whole.faceUvs[k] : below(uint32_t(whole.uvs.size())));
        if (below(20) == 0) cage.corners.push_back({point, float(below(12))});
      }
    }
    cage.positions = used;
    const bool good = checkCage(cage).empty();
    ++(good ? refinedCages : refusedCages);
    if (!good) {
      EXPECT_THROW(refine(cage), Error);
      continue;
    }
    const Stencils stencils(cage);
    std::vector<glm::vec3> positions(stencils.vertexCount()), normals(stencils.vertexCount());
    stencils.evaluate(cage.positions, positions, normals);
    size_t v = 0;
    uint64_t triangles = 0;
    for (const Primitive& p : refine(cage)) {
      triangles += p.indices.size() / 3;
      for (size_t k = 0; k < p.positions.size(); ++k, ++v) {
        ASSERT_LT(v, positions.size());
        ASSERT_LT(glm::distance(p.positions[k], positions[v]), 1e-5f);
        ASSERT_NEAR(glm::length(p.normals[k]), 1, 1e-4);
      }
    }
    EXPECT_EQ(v, positions.size());
    EXPECT_EQ(triangles, refinedTriangles(cage));
  }
  EXPECT_GT(refinedCages, 50);
  EXPECT_GT(refusedCages, 20);
}

TEST(Subdivision, CagesOfASceneAreRefinedOnce) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes.resize(2);
  scene.meshes[0].name = "ball";
  auto cage = std::make_shared<SubdivisionCage>(cubeCage(2));
  scene.meshes[0].cage = cage;
  refineCages(scene);
  ASSERT_EQ(scene.meshes[0].primitives.size(), 1u);
  EXPECT_EQ(scene.meshes[0].primitives[0].indices.size(), 6u * 4 * 4 * 2 * 3);
  EXPECT_TRUE(scene.meshes[1].primitives.empty());
  scene.meshes[0].primitives[0].material = 0;
  refineCages(scene);
  EXPECT_EQ(scene.meshes[0].primitives.size(), 1u);
  cage->faceMaterials.assign(6, 3);
  scene.meshes[0].primitives.clear();
  try {
    refineCages(scene);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("mesh `ball`"));
    EXPECT_THAT(e.what(), HasSubstr("only 1"));
  }
}

}  // namespace
}  // namespace fovea::scene
