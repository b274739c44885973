#include "framework/scene/device/draw_runs.h"

#include <gtest/gtest.h>

namespace fovea::scene {
namespace {

Scene threeMaterials() {
  Scene s;
  s.materials.resize(3);
  s.materials[1].doubleSided = true;
  s.materials[2].masked = true;
  return s;
}

Geometry triangles(const std::vector<uint32_t>& materials) {
  Geometry g;
  for (const uint32_t m : materials) g.triangles.push_back({{0, 0, 0}, m | 7u << 16});
  return g;
}

void expectRun(const DrawRun& run, DrawKind kind, uint32_t first, uint32_t count) {
  EXPECT_EQ(run.kind, kind);
  EXPECT_EQ(run.firstTriangle, first);
  EXPECT_EQ(run.triangleCount, count);
}

TEST(DrawRuns, NeighboursOfOneKindShareADraw) {
  const auto runs = drawRuns(threeMaterials(), triangles({0, 0, 1, 2, 2, 2, 0}));
  ASSERT_EQ(runs.size(), 4u);
  expectRun(runs[0], DrawKind::SingleSided, 0, 2);
  expectRun(runs[1], DrawKind::DoubleSided, 2, 1);
  expectRun(runs[2], DrawKind::Masked, 3, 3);
  expectRun(runs[3], DrawKind::SingleSided, 6, 1);
}

TEST(DrawRuns, GlassIsTransparentWithFullMaterialsOnly) {
  Scene s = threeMaterials();
  s.materials[0].transmission = 0.5f;
  const Geometry g = triangles({0, 1});
  expectRun(drawRuns(s, g)[0], DrawKind::SingleSided, 0, 1);
  expectRun(drawRuns(s, g, true)[0], DrawKind::Transparent, 0, 1);
  expectRun(drawRuns(s, g, true)[1], DrawKind::DoubleSided, 1, 1);
}

TEST(DrawRuns, BlendedSurfacesHaveHolesInsteadWithDiffuseMaterials) {
  Scene s = threeMaterials();
  s.materials[2].blended = true;
  expectRun(drawRuns(s, triangles({2}))[0], DrawKind::Masked, 0, 1);
  expectRun(drawRuns(s, triangles({2}), true)[0], DrawKind::Transparent, 0, 1);
}

TEST(DrawRuns, NothingToDraw) { EXPECT_TRUE(drawRuns(threeMaterials(), {}).empty()); }

TEST(DrawRuns, AMixtureIsTestedAsAWhole) {
  std::vector<uint32_t> materials;
  for (uint32_t i = 0; i < kMaxDrawRuns; ++i) materials.push_back(i % 2);
  EXPECT_EQ(drawRuns(threeMaterials(), triangles(materials)).size(), kMaxDrawRuns);
  materials.push_back(kMaxDrawRuns % 2);
  const auto runs = drawRuns(threeMaterials(), triangles(materials));
  ASSERT_EQ(runs.size(), 1u);
  expectRun(runs[0], DrawKind::Masked, 0, uint32_t(materials.size()));
}

}  // namespace
}  // namespace fovea::scene
