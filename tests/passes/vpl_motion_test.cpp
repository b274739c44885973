// Compares VPLs brought to the current frame with the CPU, with one case for each way in which a VPL ends or continues.
#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "fovea/test.h"
#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "shaders/records/vpl.h"
#include "tests/support/shapes.h"
#include "tests/support/voxels.h"

namespace fovea::test {
namespace {

using scene::VoxelSide;
using scene::VplState;

bool isEmpty(const VplState& v) {
  VplState empty;
  return std::memcmp(&v, &empty, sizeof(v)) == 0;
}

float random(uint32_t what, uint32_t i) { return uniformFloat(randomStream(31, 0, what, i)); }
glm::vec3 randomVector(uint32_t what, uint32_t i) {
  return 2.0f * glm::vec3(random(3 * what, i), random(3 * what + 1, i), random(3 * what + 2, i)) - 1.0f;
}

VplState makeVpl(glm::vec3 position, glm::vec3 normal, float object = 0) {
  VplState v;
  v.position = v.localPosition = position;
  v.normal = v.localNormal = normal;
  v.importance = 0.25f;
  v.previousImportance = 0.125f;
  v.life = 3;
  v.reflectance = {0.5f, 0.5f, 0.5f};
  v.side = 12345;
  v.object = object;
  return v;
}

// A floor of 4 m x 4 m around the origin, seen from both sides; the voxels are 0.5 m wide.
struct Floor {
  scene::Scene scene;
  VoxelArrays voxels;

  Floor() {
    scene.materials.clear();
    scene.cameras.emplace_back();
    addQuad(scene, addMaterial(scene, {0.2f, 0.4f, 0.6f}), {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
    voxels = voxelizeReference(scene, scene::flatten(scene), 8);
  }
  // Index of the voxel at a position.
  uint32_t voxel(glm::vec3 p) const { return voxels.voxelAt(glm::ivec3(voxels.grid.worldToVoxel(p))) - 1; }
  void clear(glm::vec3 p) {
    const glm::ivec3 c(voxels.grid.worldToVoxel(p));
    voxels.index[size_t(c.x + 8 * (c.y + 8 * c.z))] = 0;
  }
  VoxelSide& side(glm::vec3 p, uint32_t k) { return voxels.surface[2 * voxel(p) + k]; }
  VoxelSide& top(glm::vec3 p) { return side(p, 0); }
};

std::vector<VplState> update(const Floor& floor, const std::vector<VplState>& previous, double maxTurn = 30) {
  PassTest test("vpl-motion");
  test.scene(floor.scene).param("max_turn", maxTurn);
  test.buffer("previous", previous, "VplState");
  setVoxels(test, floor.voxels);
  test.run();
  const auto result = test.values<VplState>("vpls");
  double alive = 0, deleted = 0;
  for (size_t i = 0; i < result.size(); ++i) {
    alive += result[i].life > 0;
    deleted += previous[i].life > 0 && result[i].life == 0;
    EXPECT_TRUE(result[i].life > 0 || isEmpty(result[i])) << "slot " << i;
  }
  EXPECT_EQ(test.counter("alive"), alive);
  EXPECT_EQ(test.counter("deleted"), deleted);
  return result;
}

glm::vec3 tilted(float degrees) {
  return glm::vec3(std::sin(glm::radians(degrees)), std::cos(glm::radians(degrees)), 0);
}

const glm::vec3 kUp(0, 1, 0), kPlace(0.6f, 0, -0.8f);

TEST(Update, TakesTheSurfaceFromTheVoxel) {
  Floor floor;
  floor.top(kPlace).normal = tilted(10);
  const VplState old = makeVpl(kPlace, kUp);
  const VplState now = update(floor, {old}).at(0);
  EXPECT_EQ(now.position, kPlace);
  EXPECT_EQ(now.normal, tilted(10));
  EXPECT_EQ(now.reflectance, floor.top(kPlace).reflectance);
  EXPECT_EQ(now.side, 2 * floor.voxel(kPlace));
  EXPECT_EQ(now.life, 4);
  EXPECT_EQ(now.importance, 0.25f);
  EXPECT_EQ(now.previousImportance, 0.25f);
  EXPECT_EQ(now.localPosition, old.localPosition);
  EXPECT_EQ(now.localNormal, kUp) << "turns add up: they are measured against what was found";
  EXPECT_EQ(now.object, 0);
}

TEST(Update, DropsWhatTurnedTooFar) {
  for (const float limit : {0.5f, 30.0f, 80.0f, 120.0f}) {
    for (const float off : {-0.2f, 0.2f}) {
      Floor floor;
      floor.top(kPlace).normal = tilted(limit + off);
      EXPECT_EQ(isEmpty(update(floor, {makeVpl(kPlace, kUp)}, double(limit)).at(0)), off > 0)
          << limit + off << " degrees";
    }
  }
  EXPECT_FALSE(isEmpty(update(Floor(), {makeVpl(kPlace, kUp)}, 0).at(0)));
}

TEST(Update, DropsWhatHasNoSurfaceAnyMore) {
  Floor floor;
  floor.clear(kPlace);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<VplState> previous = {makeVpl(kPlace, kUp),          makeVpl(kPlace + 100.0f, kUp),
                                          makeVpl(kPlace - 100.0f, kUp), makeVpl({nan, 0, 0}, kUp),
                                          makeVpl({1e30f, 0, 0}, kUp),   makeVpl({1, 0, 1}, glm::vec3(nan)),
                                          makeVpl({0.1f, 0, 0}, -kUp),   makeVpl({1, 0, 1}, kUp)};
  const auto now = update(floor, previous);
  for (size_t i = 0; i + 1 < previous.size(); ++i) EXPECT_TRUE(isEmpty(now[i])) << "slot " << i;
  EXPECT_FALSE(isEmpty(now.back())) << "in its own slot";
}

TEST(Update, TakesTheSideThatMatchesBetter) {
  for (const uint32_t better : {0u, 1u}) {
    Floor floor;
    VoxelSide &near = floor.side(kPlace, better), &far = floor.side(kPlace, 1 - better);
    near = far = floor.top(kPlace);
    near.normal = tilted(-12);
    far.normal = tilted(25);
    EXPECT_EQ(update(floor, {makeVpl(kPlace, kUp)}).at(0).side, 2 * floor.voxel(kPlace) + better);
    near.area = 0;  // no such side: the other one, as long as it is within the limit
    EXPECT_EQ(update(floor, {makeVpl(kPlace, kUp)}).at(0).side, 2 * floor.voxel(kPlace) + 1 - better);
    EXPECT_TRUE(isEmpty(update(floor, {makeVpl(kPlace, kUp)}, 20).at(0)));
  }
}

TEST(Update, DropsWhatAnotherObjectHides) {
  Floor floor;
  floor.top(kPlace).object = 2;
  const auto now =
      update(floor, {makeVpl(kPlace, kUp, 0), makeVpl(kPlace, kUp, 1), makeVpl({1, 0, 1}, kUp, 0)});
  EXPECT_TRUE(isEmpty(now[0]));
  EXPECT_TRUE(isEmpty(now[1]));
  EXPECT_FALSE(isEmpty(now[2]));
  // The other side may still be the VPL's own.
  floor.side(kPlace, 1) = floor.top(kPlace);
  floor.side(kPlace, 1).object = 0;
  EXPECT_EQ(update(floor, {makeVpl(kPlace, kUp, 0)}).at(0).side, 2 * floor.voxel(kPlace) + 1);
}

TEST(Update, EmptyListAndEmptyScene) {
  for (const VplState& v : update(Floor(), std::vector<VplState>(100))) EXPECT_TRUE(isEmpty(v));
  Floor nothing;
  nothing.scene.nodes.clear();
  nothing.voxels = voxelizeReference(nothing.scene, scene::flatten(nothing.scene), 8);
  for (const VplState& v : update(nothing, {VplState{}, makeVpl(glm::vec3(0), kUp)})) EXPECT_TRUE(isEmpty(v));
  EXPECT_TRUE(isEmpty(update(Floor(), {VplState{}}).at(0)));
}

// Compares random VPLs over the voxels of a sphere with a plain loop.
TEST(Update, RandomVplsEqualTheCpus) {
  Floor f;
  f.scene.nodes.clear();
  addHollowSphere(f.scene, 0, {0.3f, 1, 0}, 1.5f, 24, 16);
  const scene::Geometry geometry = scene::flatten(f.scene);
  f.voxels = voxelizeReference(f.scene, geometry, 16);
  for (uint32_t i = 0; i < f.voxels.surface.size(); ++i)
    if (random(90, i) < 0.2f) f.voxels.surface[i].object = 3;
  std::vector<VplState> previous;
  for (uint32_t i = 0; i < 3000; ++i) {
    if (random(91, i) < 0.1f) {
      previous.emplace_back();
      continue;
    }
    const VoxelSide& side = f.voxels.surface[size_t(random(92, i) * float(f.voxels.surface.size()))];
    previous.push_back(makeVpl(side.position + 0.1f * randomVector(10, i), side.normal));
    previous.back().localNormal = glm::normalize(side.normal + 0.6f * randomVector(11, i));
    previous.back().importance = random(93, i);
  }
  const auto now = update(f, previous);
  int alive = 0, dropped = 0, close = 0;
  for (size_t i = 0; i < previous.size(); ++i) {
    const VplState& old = previous[i];
    VplState want;
    double best = std::cos(glm::radians(30.0));
    bool unclear = false;  // at a border between cells, or turned by just the limit
    const glm::vec3 cell = f.voxels.grid.worldToVoxel(old.localPosition);
    for (int k = 0; k < 3; ++k) unclear |= old.life > 0 && std::abs(cell[k] - std::round(cell[k])) < 1e-4f;
    const bool inside =
        glm::all(glm::greaterThanEqual(cell, glm::vec3(0))) && glm::all(glm::lessThan(cell, glm::vec3(16)));
    const uint32_t voxel = old.life > 0 && inside ? f.voxels.voxelAt(glm::ivec3(cell)) : 0;
    for (uint32_t s = 2 * voxel - 2; voxel && s < 2 * voxel; ++s) {
      const VoxelSide& side = f.voxels.surface[s];
      const double cosine = glm::dot(glm::dvec3(side.normal), glm::dvec3(old.localNormal));
      if (side.area == 0 || side.object != old.object) continue;
      unclear |= std::abs(cosine - best) < 2e-5;
      if (cosine < best) continue;
      best = cosine;
      want = old;
      want.life += 1;
      want.normal = side.normal;
      want.position = old.localPosition;
      want.reflectance = side.reflectance;
      want.side = s;
      want.previousImportance = old.importance;
    }
    close += unclear;
    if (unclear) continue;
    alive += want.life > 0;
    dropped += want.life == 0 && old.life > 0;
    ASSERT_EQ(std::memcmp(&now[i], &want, sizeof(want)), 0) << "slot " << i;
  }
  EXPECT_GT(alive, 500);
  EXPECT_GT(dropped, 500);
  EXPECT_LT(close, 20);
}

// ---- Objects that move ------------------------------------------------------------------------------------

// A floor and a cube of edge 2 in its own space, object 1.
scene::Scene makeMoving() {
  scene::Scene s;
  s.materials.clear();
  s.cameras.emplace_back();
  addQuad(s, addMaterial(s, {0.5f, 0.5f, 0.5f}), {-2, -1, -2}, {0, 0, 4}, {4, 0, 0});
  addQuad(s, 0, {-2, 2, -2}, {4, 0, 0}, {0, 0, 4});
  addQuad(s, 0, {-2, -2, -2}, {0, 0, 4}, {4, 0, 0});
  scene::Primitive cube;
  cube.material = addMaterial(s, {0.9f, 0.3f, 0.1f});
  for (int face = 0; face < 6; ++face) {
    glm::vec3 n(0), u(0), v(0);
    n[face / 2] = face % 2 ? 1.0f : -1.0f;
    u[(face / 2 + 1) % 3] = 1;
    v = glm::cross(n, u);
    const uint32_t first = uint32_t(cube.positions.size());
    for (const glm::vec3 corner : {n - u - v, n + u - v, n + u + v, n - u + v}) {
      cube.positions.push_back(corner);
      cube.normals.push_back(n);
      cube.uvs.push_back(glm::vec2(0));
    }
    for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) cube.indices.push_back(first + k);
  }
  addPrimitive(s, cube);
  s.nodes.back().dynamic = true;
  return s;
}

glm::mat4 pose(float degrees, glm::vec3 translation) {
  const glm::mat4 turned =
      glm::rotate(glm::translate(glm::mat4(1), translation), glm::radians(degrees), glm::vec3(0.2f, 1, 0.1f));
  return glm::scale(turned, glm::vec3(0.5f, 0.8f, 0.4f));
}

scene::ObjectTransform placed(const glm::mat4& toWorld) {
  scene::ObjectTransform t;
  t.toWorld = t.previousToWorld = toWorld;
  t.toObject = glm::inverse(toWorld);
  return t;
}

struct Moment {  // the scene with its cube somewhere
  scene::Scene scene = makeMoving();
  scene::Geometry geometry = scene::flatten(scene);
  scene::ObjectTransform cube;
  VoxelArrays voxels;

  explicit Moment(const glm::mat4& toWorld) : cube(placed(toWorld)) {
    scene::Frame frame = scene::makeFrame(scene, geometry, {8, 8}, 0, 1);
    frame.objects.at(1) = cube;
    scene::moveObjects(frame, geometry);
    voxels = voxelizeReference(scene, geometry, 32);
  }
  // One VPL on every side, in the order in which the sides are found.
  std::vector<VplState> vpls() const {
    std::vector<VplState> list;
    for (const VoxelSide& side : voxels.surface) {
      if (side.area == 0) continue;
      VplState v = makeVpl(side.position, side.normal, side.object);
      if (side.object == 1) {
        v.localPosition = cube.intoObject(v.position);
        v.localNormal = cube.normalIntoObject(v.normal);
      }
      list.push_back(v);
    }
    return list;
  }
  std::vector<VplState> update(const std::vector<VplState>& previous) const {
    PassTest test("vpl-motion");
    test.scene(scene).buffer("previous", previous, "VplState");
    setVoxels(test, voxels);
    test.beforeFrame([&](PassTest&, scene::Frame& frame) { frame.objects.at(1) = cube; });
    test.run();
    return test.values<VplState>("vpls");
  }
};

TEST(Update, FollowsAnObjectThatMovesAndTurns) {
  const Moment before(pose(0, {-0.6f, 0.5f, 0.1f})), after(pose(75, {0.7f, -0.45f, -0.4f}));
  const auto previous = before.vpls(), now = after.update(previous);
  int moving = 0, followed = 0, covered = 0;
  for (size_t i = 0; i < previous.size(); ++i) {
    const VplState &old = previous[i], &vpl = now[i];
    if (old.object == 0) {
      const uint32_t voxel = after.voxels.voxelAt(glm::ivec3(after.voxels.grid.worldToVoxel(old.position)));
      const bool hidden =
          voxel == 0 ||
          after.voxels.surface[2 * voxel - 2].object + after.voxels.surface[2 * voxel - 1].object > 0;
      covered += hidden;
      EXPECT_EQ(isEmpty(vpl), hidden) << "slot " << i;
      continue;
    }
    ++moving;
    if (isEmpty(vpl)) continue;
    ++followed;
    const glm::vec3 normal = after.cube.normalFromObject(old.localNormal);
    EXPECT_LT(glm::distance(vpl.position, after.cube.fromObject(old.localPosition)), 1e-5f);
    EXPECT_GE(glm::dot(vpl.normal, normal), std::cos(glm::radians(30.1f)));
    EXPECT_EQ(vpl.normal, after.voxels.surface[vpl.side].normal);
    EXPECT_EQ(after.voxels.surface[vpl.side].object, 1);
    EXPECT_EQ(vpl.localPosition, old.localPosition);
    EXPECT_EQ(vpl.localNormal, old.localNormal);
  }
  EXPECT_GT(moving, 400);
  // On faces all VPLs follow; on edges the average of a voxel may have left the surface or have another normal.
  EXPECT_GT(followed, 0.8 * moving);
  EXPECT_GT(covered, 20);
}

// The same voxels without the information that the cube has moved: its VPLs are where it no longer is.
TEST(Update, DropsWhatAnObjectLeftBehind) {
  const Moment before(pose(0, {-0.9f, 0.5f, 0.1f}));
  Moment after(pose(0, {0.9f, 0.5f, 0.1f}));
  const auto previous = before.vpls();
  after.cube = before.cube;
  const auto now = after.update(previous);
  for (size_t i = 0; i < previous.size(); ++i)
    EXPECT_TRUE(previous[i].object == 0 || isEmpty(now[i])) << "slot " << i;
}

}  // namespace
}  // namespace fovea::test
