// Tests candidates at the ends of eye paths.
#include <gtest/gtest.h>

#include <cstring>

#include "shaders/records/eye_paths.h"
#include "tests/passes/candidates_reference.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

using passes::EyePathEnd;
using passes::EyePathStart;
using scene::Candidate;

// Every other path ends on the ceiling, the others hit nothing.
std::vector<EyePathEnd> endsOnTheCeiling(uint32_t count) {
  std::vector<EyePathEnd> ends(count);
  for (uint32_t i = 0; i < count; ++i) {
    const auto number = [i](uint32_t what) { return uniformFloat(randomStream(5, 0, what, i)); };
    ends[i].position = {1.9f * number(0) - 0.95f, 1, 1.9f * number(1) - 0.95f};
    ends[i].normal = {0, -1, 0};
    if (i % 2 == 0) ends[i].kind = float(1 + i / 2 % 4);
    ends[i].weight = 0.5f;
    ends[i].radiance = glm::vec3(10);
  }
  return ends;
}

TEST(CandidatesTraced, LieWhereEyePathsEnd) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f)), walls[6] = {m, m, m, m, m, m};
  addRoom(s, walls, 1);
  s.cameras.emplace_back();
  const scene::Geometry g = scene::flatten(s);
  const VoxelArrays voxels = voxelizeReference(s, g, 12);
  SeenImage image({8, 8}, raysOnto({0, 0, 0}, {0, -1, 0}, glm::vec3(0), glm::vec3(0)));
  for (SeenPixel& p : image.pixels) {
    p.position = {0, -1, 0};
    p.distance = 1;
    p.normal = p.face = {0, 1, 0};
  }
  const auto ends = endsOnTheCeiling(64);
  const auto candidates = [&](bool traced) {
    PassTest test("candidates");
    test.scene(s).viewSize(8, 8).param("count", 800).param("region", "image");
    image.wire(test);
    setVoxels(test, voxels);
    if (traced)
      test.buffer("traced.starts", std::vector<EyePathStart>(16), "ScreenPoint")
          .buffer("traced.ends", ends, "EyePathEnd");
    test.run();
    EXPECT_GT(test.counter("candidates"), 780);  // a few bounces pass between voxels
    return test.values<Candidate>("candidates");
  };
  const auto plain = candidates(false), traced = candidates(true);
  int moved = 0, dark = 0;
  for (size_t i = 0; i < plain.size(); ++i) {
    const Candidate& c = traced[i];
    if (std::memcmp(&c, &plain[i], sizeof c) == 0) continue;
    ++moved;
    ASSERT_EQ(i % 4, 3u) << i;
    const auto at = std::ranges::find(ends, c.position, &EyePathEnd::position);
    ASSERT_NE(at, ends.end()) << i;
    EXPECT_GE(at->kind, 1);
    dark += at->kind == 1;
    EXPECT_FLOAT_EQ(c.luminance, 5);
    EXPECT_EQ(c.localPosition, c.position);
    ASSERT_NE(c.side, scene::kNoSide);
    EXPECT_EQ(c.normal, voxels.surface[c.side].normal);
    EXPECT_LT(c.normal.y, -0.5f);
    EXPECT_LT(glm::distance(c.position, voxels.surface[c.side].position), 2 * voxels.grid.cell);
  }
  EXPECT_NEAR(moved, 100, 35);  // half of a quarter
  EXPECT_NEAR(dark, 25, 20);
}

}  // namespace
}  // namespace fovea::test
