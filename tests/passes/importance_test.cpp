// Tests the importance of VPLs: rays against the CPU, and scenes whose importance is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "fovea/error.h"
#include "fovea/scene.h"
#include "fovea/test.h"
#include "framework/base/random.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "shaders/records/vpl.h"
#include "tests/passes/importance_reference.h"
#include "tests/support/pixel_rays.h"
#include "tests/support/shapes.h"
#include "tests/support/voxels.h"

namespace fovea::test {
namespace {

using scene::Candidate;
using scene::VplState;

float random(uint32_t what, uint32_t i) { return uniformFloat(randomStream(31, 0, what, i)); }
glm::vec3 randomVec3(uint32_t what, uint32_t i) {
  return glm::vec3(random(what, i), random(what + 1, i), random(what + 2, i)) * 2.0f - 1.0f;
}

scene::Scene closedRoom() {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f));
  const uint32_t materials[6] = {grey, grey, grey, grey, grey, grey};
  addRoom(s, materials, 1);
  return s;
}

// A room of 2 m with tilted panels.
scene::Scene clutteredRoom() {
  scene::Scene s = closedRoom();
  for (uint32_t i = 0; i < 8; ++i) {
    const glm::vec3 corner = 0.6f * randomVec3(0, i), u = 0.5f * randomVec3(3, i),
                    v = 0.5f * randomVec3(6, i);
    addQuad(s, 0, corner, u, v);
    addQuad(s, 0, corner, v, u);
  }
  return s;
}

Candidate makeCandidate(glm::vec3 position, glm::vec3 normal, uint32_t side = 0) {
  Candidate c;
  c.position = position;
  c.normal = glm::normalize(normal);
  c.side = side;
  return c;
}

VplState makeVpl(const Candidate& c, float life = 3) {
  VplState v;
  v.position = c.position;
  v.normal = c.normal;
  v.side = c.side;
  v.life = life;
  return v;
}

std::vector<VplState> makeVpls(const std::vector<Candidate>& candidates) {
  std::vector<VplState> vpls;
  for (const Candidate& c : candidates) vpls.push_back(c.side == scene::kNoSide ? VplState{} : makeVpl(c));
  return vpls;
}

void wire(PassTest& test, const VoxelArrays& voxels, std::vector<float> weights,
          const std::vector<Candidate>& candidates, const std::vector<VplState>& vpls) {
  setVoxels(test, voxels);
  if (weights.empty()) weights.resize(2);  // an empty buffer does not exist
  test.buffer("weights", weights, "VoxelWeight");
  test.buffer("candidates", candidates, "Candidate");
  test.buffer("vpls", vpls, "VplState");
}

// VPLs on surfaces, some lifted off them or turned, some failed attempts.
std::vector<Candidate> randomCandidates(uint32_t count, const VoxelArrays& voxels) {
  std::vector<uint32_t> sides;
  for (uint32_t i = 0; i < voxels.surface.size(); ++i)
    if (voxels.surface[i].area > 0) sides.push_back(i);
  std::vector<Candidate> list;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t side = sides[size_t(random(10, i) * float(sides.size()))];
    const scene::VoxelSide& s = voxels.surface[side];
    Candidate c = makeCandidate(s.position, s.normal, side);
    if (i % 3 == 1) c.position += 0.3f * voxels.grid.cell * randomVec3(11, i);
    if (i % 5 == 2) c.normal = glm::normalize(c.normal + 0.8f * randomVec3(14, i));
    if (i % 11 == 7) c.side = scene::kNoSide;
    list.push_back(c);
  }
  return list;
}

std::vector<float> randomWeights(size_t count) {
  std::vector<float> weights(count);
  for (uint32_t i = 0; i < count; ++i) weights[i] = std::max(0.0f, 2 * random(20, i) - 1);
  return weights;
}

// ---- Against the CPU --------------------------------------------------------------------------------------

class AgainstTheCpu : public testing::TestWithParam<bool> {};

TEST_P(AgainstTheCpu, EveryVplIsEqual) {
  const bool luminance = GetParam();
  const scene::Scene s = clutteredRoom();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), 32);
  const std::vector<float> weights = randomWeights(voxels.surface.size());
  std::vector<glm::vec4> radiance;
  for (uint32_t i = 0; i < voxels.surface.size(); ++i) radiance.emplace_back(0, 0, 0, 3 * random(50, i));
  const auto candidates = randomCandidates(1003, voxels);
  std::vector<VplState> vpls = makeVpls(randomCandidates(777, voxels));
  std::reverse(vpls.begin(), vpls.end());

  PassTest test("importance");
  test.scene(s).param("luminance", luminance).param("luminance_floor", 0.2);
  wire(test, voxels, weights, candidates, vpls);
  test.buffer("radiance", radiance, "VoxelRadiance");
  test.beforeFrame([](PassTest&, scene::Frame& frame) { frame.exposure = 0.6f; });
  test.run();

  ImportanceReference reference{{voxels.grid, voxels.index, voxels.surface}, weights};
  size_t live = 0;
  const auto compare = [&](const std::vector<float>& got, const auto& list, auto isLive) {
    ASSERT_EQ(got.size(), list.size());
    for (size_t i = 0; i < got.size(); ++i) {
      if (!isLive(list[i])) {
        EXPECT_EQ(got[i], 0);
        continue;
      }
      ++live;
      const double bright = std::min(1.0, double(0.6f) * double(radiance[list[i].side].w));
      const double light = luminance ? 0.2 + 0.8 * bright : 1.0;
      const ImportanceReference::Range expected = reference.importance(list[i].position, list[i].normal);
      EXPECT_GE(got[i], light * expected.low - 1e-5) << i;
      EXPECT_LE(got[i], light * expected.high + 1e-5) << i;
    }
  };
  compare(test.values<float>("candidate_importance"), candidates,
          [](const Candidate& c) { return c.side != scene::kNoSide; });
  compare(test.values<float>("vpl_importance"), vpls, [](const VplState& v) { return v.life > 0; });
  EXPECT_EQ(test.counter("rays"), double(6 * live));
  // In the edges of the room rays run exactly along walls, so rounding decides whether the walls face them.
  std::printf("[ MEASURED ] %zu of %zu rays graze the border of a voxel\n", reference.grazing,
              reference.rays);
  EXPECT_LT(double(reference.grazing), 0.02 * double(reference.rays));
}

INSTANTIATE_TEST_SUITE_P(Variants, AgainstTheCpu, testing::Values(false, true));

// ---- Scenes whose importance is known ---------------------------------------------------------------------

// An output that nobody reads costs nothing, and the VPLs are the same without it.
TEST(Importance, CandidatesNeedNotBeRated) {
  const scene::Scene s = clutteredRoom();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), 32);
  const auto candidates = randomCandidates(100, voxels);
  std::vector<float> vpls[2];
  double rays[2];
  for (const bool rated : {false, true}) {
    PassTest test("importance");
    test.scene(s).param("rate_candidates", rated);
    wire(test, voxels, randomWeights(voxels.surface.size()), candidates, makeVpls(candidates));
    test.run();
    vpls[rated] = test.values<float>("vpl_importance");
    double sum = 0;
    for (const float importance : test.values<float>("candidate_importance")) sum += importance;
    EXPECT_EQ(sum > 0, rated);
    rays[rated] = test.counter("rays");
  }
  EXPECT_EQ(vpls[0], vpls[1]);
  EXPECT_GT(rays[0], 0);
  EXPECT_EQ(rays[1], 2 * rays[0]);  // the VPLs are the candidates
}

// Above the middle of a floor, every ray sees a ceiling of weight 1 except those that a lid of weight 0 catches.
TEST(Importance, OccludersBlock) {
  for (const bool lid : {false, true}) {
    scene::Scene s;
    const uint32_t grey = addMaterial(s, glm::vec3(0.5f));
    addQuad(s, grey, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});  // floor, faces up
    addQuad(s, grey, {-4, 1, -4}, {8, 0, 0}, {0, 0, 8});  // ceiling, faces down
    if (lid) addQuad(s, grey, {-0.3f, 0.6f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f});
    const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), 64);
    std::vector<float> weights;
    for (const scene::VoxelSide& side : voxels.surface)
      weights.push_back(side.area > 0 && side.position.y > 0.9f ? 1.0f : 0.0f);
    PassTest test("importance");
    const std::vector<Candidate> candidates = {makeCandidate({0.02f, 0, 0.03f}, {0, 1, 0})};
    wire(test.scene(s), voxels, weights, candidates, makeVpls(candidates));
    test.run();
    // The ray along the normal is 1 of 3.5 cosines; the others pass 0.6 m at 1.04 m from the axis.
    EXPECT_NEAR(test.values<float>("candidate_importance")[0], lid ? 2.5 / 3.5 : 1, 1e-6);
    EXPECT_NEAR(test.values<float>("vpl_importance")[0], lid ? 2.5 / 3.5 : 1, 1e-6);
  }
}

// Where every ray hits something of weight 1, the importance is 1. (In an edge of the room two walls share a
// side, whose normal lies between theirs and whose position is so near to both that it may count as the own
// surface of its neighbours.)
TEST(Importance, IsOneWhereEverythingCounts) {
  const scene::Scene s = closedRoom();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), 32);
  const auto candidates = randomCandidates(300, voxels);
  PassTest test("importance");
  wire(test.scene(s), voxels, std::vector<float>(voxels.surface.size(), 1.0f), candidates,
       makeVpls(candidates));
  test.run();
  const auto importance = test.values<float>("candidate_importance");
  int compared = 0;
  for (size_t i = 0; i < candidates.size(); ++i) {
    const glm::vec3 fromWall = 16.0f - glm::abs(voxels.grid.worldToVoxel(candidates[i].position) - 16.0f);
    const int walls = int(fromWall.x < 2) + int(fromWall.y < 2) + int(fromWall.z < 2);
    if (candidates[i].side == scene::kNoSide || walls > 1 || i % 5 == 2)
      continue;  // a turned one sees its own wall
    EXPECT_NEAR(importance[i], 1, 1e-6) << i;
    ++compared;
  }
  EXPECT_GT(compared, 130);
}

// The bits depend neither on the frame nor on the slot.
TEST(Importance, IsSteady) {
  const scene::Scene s = clutteredRoom();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), 32);
  const auto candidates = randomCandidates(200, voxels);
  std::vector<VplState> vpls = makeVpls(candidates);
  std::rotate(vpls.begin(), vpls.begin() + 77, vpls.end());
  PassTest test("importance");
  wire(test.scene(s), voxels, randomWeights(voxels.surface.size()), candidates, vpls);
  test.run();
  const auto first = test.values<float>("candidate_importance");
  auto rotated = first;
  std::rotate(rotated.begin(), rotated.begin() + 77, rotated.end());
  EXPECT_EQ(test.values<float>("vpl_importance"), rotated);
  test.seed(9);
  test.run(3);
  EXPECT_EQ(test.values<float>("candidate_importance"), first);
  EXPECT_GT(std::accumulate(first.begin(), first.end(), 0.0), 10);
}

TEST(Importance, EmptyListsAndScenes) {
  scene::Scene empty;
  for (const scene::Scene& s : {empty, closedRoom()}) {
    const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), 8);
    for (const uint32_t count : {1u, 17u}) {
      Candidate failed;
      PassTest test("importance");
      wire(test.scene(s), voxels, std::vector<float>(voxels.surface.size(), 1.0f),
           std::vector<Candidate>(count, failed), std::vector<VplState>(count + 3));
      test.run();
      EXPECT_EQ(test.values<float>("candidate_importance"), std::vector<float>(count, 0.0f));
      EXPECT_EQ(test.values<float>("vpl_importance"), std::vector<float>(count + 3, 0.0f));
      EXPECT_EQ(test.counter("rays"), 0);
    }
  }
  // A VPL of a scene that is no longer loaded.
  const VoxelArrays nothing = voxelizeReference(empty, scene::flatten(empty), 8);
  const std::vector<Candidate> one = {makeCandidate({0, 0, 0}, {0, 1, 0})};
  PassTest test("importance");
  wire(test.scene(empty), nothing, std::vector<float>(nothing.surface.size(), 1.0f), one, makeVpls(one));
  test.run();
  EXPECT_EQ(test.values<float>("candidate_importance")[0], 0);
}

// ---- Cones ------------------------------------------------------------------------------------------------

// The bundle "voxel-mips" of these weights, made by pass mipmap.
void wireMips(PassTest& test, const scene::Scene& s, const VoxelArrays& voxels,
              const std::vector<float>& weights) {
  PassTest mipmap("mipmap");
  setVoxels(mipmap.scene(s), voxels);
  mipmap.buffer("weights", weights, "VoxelWeight");
  mipmap.buffer("radiance", std::vector<glm::vec4>(weights.size(), glm::vec4(0.0f)), "VoxelRadiance");
  mipmap.run();
  for (const char* port : {"mips.color", "mips.weight"}) {
    const graph::ResourceDesc& d = mipmap.desc(port);
    test.volume(port, d.format, d.width, d.height, d.depth, mipmap.bytes(port), d.mips);
  }
}

TEST(Importance, ConesInAClosedRoomMeetItsWalls) {
  const scene::Scene s = closedRoom();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), 32);
  const std::vector<float> weights(voxels.surface.size(), 1.0f);
  std::vector<Candidate> candidates = {makeCandidate({0, 0, 0}, {0.3f, -0.2f, 0.5f})};
  for (uint32_t i = 0; i < 100; ++i) {
    const glm::vec3 p = 0.8f * randomVec3(60, i);
    candidates.push_back(makeCandidate({p.x, -1, p.z}, {0, 1, 0}));
    candidates.push_back(makeCandidate({1, p.y, p.z}, {-1, 0, 0}));
  }
  PassTest test("importance");
  wire(test.scene(s).param("method", "cones"), voxels, weights, candidates, makeVpls(candidates));
  wireMips(test, s, voxels, weights);
  test.run();
  for (const float i : test.values<float>("candidate_importance")) EXPECT_NEAR(i, 1, 0.05);
  EXPECT_EQ(test.values<float>("vpl_importance"), test.values<float>("candidate_importance"));
  EXPECT_EQ(test.counter("rays"), 2 * 6 * 201);  // both lists
}

// What the eye sees of a scene, weighted.
std::vector<float> seenWeights(const scene::Scene& s, const VoxelArrays& voxels, glm::vec2 gaze) {
  const auto look = [gaze](PassTest&, scene::Frame& frame) { frame.views[0].gaze = gaze; };
  PassTest gbuffer("gbuffer"), weightMap("weight-map");
  gbuffer.scene(s).viewSize(128, 128).run();
  setVoxels(weightMap.scene(s).viewSize(128, 128).beforeFrame(look), voxels);
  for (const char* port : {"gbuffer.distance", "gbuffer.face"})
    weightMap.image(port, gbuffer.desc(port).format, 128, 128, 1, gbuffer.bytes(port));
  weightMap.buffer("gbuffer.camera", gbuffer.values<scene::PixelRays>("gbuffer.camera"), "PixelRays");
  weightMap.run();
  EXPECT_LT(weightMap.counter("unassigned"), 128 * 128 / 200);
  return weightMap.values<float>("weights");
}

TEST(Importance, ConesAgreeWithRaysInTheCornellBox) {
  const scene::Scene s = scene::builtin("cornellbox");
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), 64);
  const std::vector<float> weights = seenWeights(s, voxels, {0.3f, 0.5f});
  std::vector<Candidate> candidates;
  std::vector<uint32_t> sides;
  for (uint32_t i = 0; i < voxels.surface.size(); ++i)
    if (voxels.surface[i].area > 0.3f * voxels.grid.cell * voxels.grid.cell) sides.push_back(i);
  for (uint32_t i = 0; i < 600; ++i) {
    const scene::VoxelSide& side = voxels.surface[sides[size_t(random(70, i) * float(sides.size()))]];
    candidates.push_back(makeCandidate(side.position, side.normal));
  }
  std::vector<float> importance[2];
  for (const char* method : {"rays", "cones"}) {
    PassTest test("importance");
    wire(test.scene(s).param("method", method), voxels, weights, candidates, makeVpls(candidates));
    wireMips(test, s, voxels, weights);
    test.run();
    importance[method[0] == 'c'] = test.values<float>("candidate_importance");
  }
  double mean[2] = {}, square[2] = {}, product = 0;
  const double n = double(candidates.size());
  for (size_t i = 0; i < candidates.size(); ++i) {
    for (int m = 0; m < 2; ++m) {
      mean[m] += double(importance[m][i]) / n;
      square[m] += double(importance[m][i]) * double(importance[m][i]) / n;
    }
    product += double(importance[0][i]) * double(importance[1][i]) / n;
  }
  const double correlation = (product - mean[0] * mean[1]) /
                             std::sqrt((square[0] - mean[0] * mean[0]) * (square[1] - mean[1] * mean[1]));
  EXPECT_GT(correlation, 0.85);
  EXPECT_NEAR(mean[1], mean[0], 0.2 * mean[0]);
  EXPECT_GT(mean[0], 0.1);
}

TEST(Importance, SaysWhichInputIsMissing) {
  const scene::Scene s = closedRoom();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), 8);
  const std::vector<Candidate> one(1);
  const auto message = [&](auto configure) -> std::string {
    PassTest test("importance");
    configure(test.scene(s));
    wire(test, voxels, std::vector<float>(voxels.surface.size()), one, makeVpls(one));
    try {
      test.run();
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(message([](PassTest& t) { t.param("luminance", true); }),
              testing::HasSubstr("needs the input `radiance`"));
  EXPECT_THAT(message([](PassTest& t) { t.param("method", "cones"); }),
              testing::HasSubstr("needs the input `mips`"));
}

}  // namespace
}  // namespace fovea::test
