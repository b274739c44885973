// Tests candidates elsewhere than at the averages of voxel sides: at the ends of eye paths, at VPLs of light paths, and
// where rays meet a side.
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

// A cube of 2 m whose floor is seen.
struct Room {
  scene::Scene scene;
  VoxelArrays voxels;
  SeenImage image{{8, 8}, raysOnto({0, 0, 0}, {0, -1, 0}, glm::vec3(0), glm::vec3(0))};

  Room() {
    const uint32_t m = addMaterial(scene, glm::vec3(0.5f)), walls[6] = {m, m, m, m, m, m};
    addRoom(scene, walls, 1);
    scene.cameras.emplace_back();
    voxels = voxelizeReference(scene, scene::flatten(scene), 12);
    for (SeenPixel& p : image.pixels) {
      p.position = {0, -1, 0};
      p.distance = 1;
      p.normal = p.face = {0, 1, 0};
    }
  }
  void wire(PassTest& test, int count) {
    test.scene(scene).viewSize(8, 8).param("count", count).param("region", "image");
    image.wire(test);
    setVoxels(test, voxels);
  }
};

TEST(CandidatesTraced, LieWhereEyePathsEnd) {
  Room room;
  const VoxelArrays& voxels = room.voxels;
  const auto ends = endsOnTheCeiling(64);
  const auto candidates = [&](bool traced) {
    PassTest test("candidates");
    room.wire(test, 800);
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

TEST(CandidatesTraced, LieWhereRaysMeetTheirSide) {
  Room room;
  PassTest test("candidates");
  room.wire(test, 500);
  test.param("position", "intersection").seed(3);
  test.run();
  const CandidateReference reference{.image = room.image,
                                     .voxels = room.voxels,
                                     .fovea = scene::makeFovea({0.5f, 0.5f}, room.image.size, 0.25f),
                                     .region = scene::kRegionImage,
                                     .seed = 3};
  const auto list = test.values<Candidate>("candidates");
  int away = 0;
  for (uint32_t i = 0; i < list.size(); ++i) {
    const auto attempt = reference.attempt(i);
    if (list[i].side != attempt.side || list[i].side == scene::kNoSide) continue;
    const glm::vec3 met = attempt.origin + attempt.distance * attempt.direction;
    ASSERT_LT(glm::distance(list[i].position, met), 1e-4f) << i;
    const scene::VoxelSide& side = room.voxels.surface[list[i].side];
    away += glm::distance(met, side.position) > 0.1f * room.voxels.grid.cell;
  }
  EXPECT_GT(away, 300);
}

// Of the light paths' VPLs every third slot is empty and one lies where there is no voxel.
TEST(CandidatesTraced, LieWhereLightPathsLand) {
  Room room;
  constexpr uint32_t kVpls = 60;
  std::vector<scene::Vpl> emitted(kVpls);
  for (uint32_t i = 0; i < kVpls; ++i) {
    const auto number = [i](uint32_t what) { return uniformFloat(randomStream(8, 0, what, i)); };
    emitted[i].position = {1.9f * number(0) - 0.95f, i == 4 ? 0.3f : 1, 1.9f * number(1) - 0.95f};
    emitted[i].normal = {0, -1, 0};
    if (i % 3 != 0) emitted[i].intensity = glm::vec3(1);
  }
  for (const bool intersection : {false, true}) {
    PassTest test("candidates");
    room.wire(test, kVpls + 5);
    if (intersection) test.param("position", "intersection");
    test.buffer("emitted", emitted, "Vpl");
    test.run();
    const auto list = test.values<Candidate>("candidates");
    for (uint32_t i = 0; i < list.size(); ++i) {
      const Candidate& c = list[i];
      const bool there = i < kVpls && i % 3 != 0 && i != 4;
      ASSERT_EQ(c.side != scene::kNoSide, there) << i;
      if (!there) continue;
      const scene::VoxelSide& side = room.voxels.surface[c.side];
      EXPECT_EQ(c.position, intersection ? emitted[i].position : side.position);
      EXPECT_LT(glm::distance(c.position, emitted[i].position), 2 * room.voxels.grid.cell);
      EXPECT_LT(c.normal.y, -0.5f);
    }
    EXPECT_EQ(test.counter("candidates"), 39);
    EXPECT_EQ(test.counter("rays"), 0);
  }
}

}  // namespace
}  // namespace fovea::test
