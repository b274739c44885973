#include "tests/references/voxel_trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "framework/base/random.h"

namespace fovea::scene {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

struct Stream {  // numbers in [0, 1)
  uint32_t key, draw = 0;
  float next() { return uniformFloat(hashCombine(key, draw++)); }
  glm::vec3 point() {
    const float x = next(), y = next();
    return {x, y, next()};
  }
  glm::vec3 direction() {
    for (;;) {
      const glm::vec3 v = 2.0f * point() - 1.0f;
      if (glm::length(v) > 0.1f && glm::length(v) < 1) return glm::normalize(v);
    }
  }
};

struct Volume {
  VoxelGrid grid;
  std::vector<uint32_t> index;
  std::vector<VoxelSide> surface;
  Voxels voxels() const { return {grid, index, surface}; }

  explicit Volume(int resolution, VoxelGrid g = {{-1.3f, 0.4f, 2.1f}, 0.35f, 1}) : grid(g) {
    grid.resolution = resolution;
    index.resize(size_t(resolution) * size_t(resolution) * size_t(resolution));
  }
  void add(glm::ivec3 cell, const VoxelSide& side0, const VoxelSide& side1) {
    surface.push_back(side0);
    surface.push_back(side1);
    const size_t r = size_t(grid.resolution);
    index[size_t(cell.x) + r * (size_t(cell.y) + r * size_t(cell.z))] = uint32_t(surface.size() / 2);
  }
};

VoxelSide makeSide(glm::vec3 position, glm::vec3 normal) {
  VoxelSide s;
  s.position = position;
  s.normal = normal;
  s.area = 1;
  return s;
}

// Cells filled at random, with positions anywhere in their cell and some sides empty.
Volume randomVolume(int resolution, float filled, Stream& random) {
  Volume v(resolution);
  for (int i = 0; i < resolution * resolution * resolution; ++i) {
    if (random.next() >= filled) continue;
    const glm::ivec3 cell(i % resolution, i / resolution % resolution, i / resolution / resolution);
    VoxelSide sides[2];
    for (uint32_t k = 0; k < 2; ++k) {
      glm::vec3 n = random.direction();
      if (voxelSideOf(n) != k) n = -n;
      sides[k] = makeSide(v.grid.voxelToWorld(glm::vec3(cell) + random.point()), n);
      sides[k].area = random.next() < 0.3f ? 0.0f : v.grid.cell * v.grid.cell * random.next();
    }
    v.add(cell, sides[0], sides[1]);
  }
  return v;
}

// Tests every cell against the ray, in double precision.
struct BruteForce {
  uint32_t side = kNoSide;
  double cellIn = 0, cellOut = 0;      // where the ray is in its cell, m
  std::vector<uint32_t> alsoPossible;  // in cells that the ray only just touches
  bool unclear = false;                // rounding may decide whether a side is met
};

// The side of a voxel that a ray meets or passes, and where.
struct Crossing {
  uint32_t side = kNoSide;
  bool met = false;
  double in = 0, out = 0, plane = 0;  // distances at which the ray is in the cell and crosses the plane, m
  glm::ivec3 cell{0};
};

Crossing crossingOf(const Volume& v, uint32_t voxel, glm::dvec3 origin, glm::dvec3 direction,
                    glm::dvec3 normal, double out, bool& unclear) {
  const double cell = double(v.grid.cell);
  Crossing best;
  double facing = 0;
  for (uint32_t s = 2 * voxel - 2; s < 2 * voxel; ++s) {
    const VoxelSide& side = v.surface[s];
    if (side.area == 0) continue;
    const glm::dvec3 n(side.normal), position(side.position);
    const double cosine = glm::dot(n, direction), front = glm::dot(position - origin, normal) - 0.25 * cell;
    unclear |= std::abs(cosine) < 1e-5 || std::abs(front) < 1e-5;
    if (cosine >= 0 || front <= 0) continue;
    const glm::dvec3 leaves = origin + out * direction;
    const double behind = 0.1 * cell - glm::dot(leaves - position, n);
    const double plane = glm::dot(position - origin, n) / cosine;
    const glm::dvec3 at = origin + std::min(plane, out) * direction;
    const double radius = 1.5 * std::sqrt(double(side.area) / 3.14159265358979);
    const double beside = radius - glm::distance(at, position);
    unclear |= std::abs(behind) < 1e-5 || std::abs(beside) < 1e-4;
    const bool met = behind > 0 && beside > 0;
    if (best.side != kNoSide && (best.met != met ? best.met : cosine >= facing)) continue;
    facing = cosine;
    best.side = s, best.met = met, best.plane = plane;
  }
  return best;
}

// The sides in all cells on the ray's way, in their order.
std::vector<Crossing> crossings(const Volume& v, glm::dvec3 origin, glm::dvec3 direction, glm::dvec3 normal,
                                BruteForce& best) {
  std::vector<Crossing> list;
  const int r = v.grid.resolution;
  for (int i = 0; i < r * r * r; ++i) {
    const uint32_t voxel = v.index[size_t(i)];
    if (voxel == 0) continue;
    const glm::ivec3 cell(i % r, i / r % r, i / r / r);
    const glm::dvec3 low = glm::dvec3(v.grid.origin) + double(v.grid.cell) * glm::dvec3(cell);
    double in = 0, out = 1e30;
    for (int k = 0; k < 3; ++k) {
      double a = (low[k] - origin[k]) / direction[k],
             b = (low[k] + double(v.grid.cell) - origin[k]) / direction[k];
      if (direction[k] == 0) {
        const bool inside = origin[k] >= low[k] && origin[k] < low[k] + double(v.grid.cell);
        a = inside ? -1e30 : 1e30;
        b = 1e30;
      }
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    if (out < in - 1e-4) continue;
    Crossing c = crossingOf(v, voxel, origin, direction, normal, out, best.unclear);
    if (c.side == kNoSide) continue;
    c.in = in, c.out = out, c.cell = cell;
    if (out - in < 1e-4) {
      best.alsoPossible.push_back(c.side);
    } else {
      list.push_back(c);
    }
  }
  std::ranges::sort(list, {}, &Crossing::in);
  return list;
}

// Whether a ray that passed a side slipped through a slit beside it. before: the crossing before this one.
bool slips(const Volume& v, const Crossing& c, const Crossing* before, glm::dvec3 origin,
           glm::dvec3 direction, bool& unclear) {
  unclear |= std::abs(c.plane - c.out) < 1e-4 || std::abs(c.plane - c.in) < 1e-4;
  if (c.plane < c.in) return before && before->plane > before->out && std::abs(before->out - c.in) < 1e-4;
  const VoxelSide& side = v.surface[c.side];
  glm::dvec3 off = origin + c.plane * direction - glm::dvec3(side.position);
  if (c.plane > c.out) {
    const double reach = 1.5 * std::sqrt(double(side.area) / 3.14159265358979);
    unclear |= std::abs(glm::length(off) - reach) < 1e-4;
    return glm::length(off) < reach;
  }
  off -= glm::dot(off, glm::dvec3(side.normal)) * glm::dvec3(side.normal);
  const double most = std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)});
  bool found = false;
  for (int k = 0; k < 3; ++k) {
    unclear |= std::abs(std::abs(off[k]) - 0.5 * most) < 1e-4;
    glm::ivec3 next = c.cell;
    next[k] += off[k] > 0 ? 1 : -1;
    found |= std::abs(off[k]) > 0.5 * most && v.voxels().at(next) != 0;
  }
  return found;
}

// The first side that is met or, if there is none, the last through which the ray slipped.
BruteForce bruteForce(const Volume& v, glm::dvec3 origin, glm::dvec3 direction, glm::dvec3 normal) {
  BruteForce best;
  const std::vector<Crossing> list = crossings(v, origin, direction, normal, best);
  for (size_t i = 0; i < list.size(); ++i) {
    const Crossing& c = list[i];
    if (!c.met && !slips(v, c, i > 0 ? &list[i - 1] : nullptr, origin, direction, best.unclear)) continue;
    best.side = c.side, best.cellIn = c.in, best.cellOut = c.out;
    if (c.met) break;
  }
  return best;
}

struct Counts {
  int hits = 0, misses = 0, touched = 0, unclear = 0;
};

void expectRay(const Volume& v, glm::vec3 origin, glm::vec3 direction, glm::vec3 normal, Counts& counts) {
  const VoxelHit hit = traceVoxels(v.voxels(), origin, direction, normal);
  const BruteForce want = bruteForce(v, origin, direction, normal);
  if (want.unclear) {
    ++counts.unclear;
    return;
  }
  if (hit.side != want.side) {
    ++counts.touched;
    EXPECT_NE(std::find(want.alsoPossible.begin(), want.alsoPossible.end(), hit.side),
              want.alsoPossible.end())
        << "side " << hit.side << " instead of " << want.side;
    return;
  }
  ++(hit.side == kNoSide ? counts.misses : counts.hits);
  if (hit.side == kNoSide) return;
  const VoxelSide& side = v.surface[hit.side];
  const double plane = glm::dot(glm::dvec3(side.position) - glm::dvec3(origin), glm::dvec3(side.normal)) /
                       glm::dot(glm::dvec3(side.normal), glm::dvec3(direction));
  EXPECT_NEAR(hit.distance, std::clamp(plane, want.cellIn, want.cellOut), 2e-4 + 1e-4 * std::abs(plane));
}

TEST(VoxelTrace, EqualsTheSearchThroughAllCells) {
  Counts counts;
  for (uint32_t volume = 0; volume < 12; ++volume) {
    Stream random{randomStream(3, 0, 0, volume)};
    const Volume v = randomVolume(1 + int(volume), volume % 3 == 0 ? 0.5f : 0.04f, random);
    const float edge = v.grid.cell * float(v.grid.resolution);
    for (int ray = 0; ray < 3600; ++ray) {
      // Half of them start inside, the others around the grid.
      const glm::vec3 origin =
          v.grid.origin + edge * (ray % 2 ? random.point() : 3.0f * random.point() - 1.0f);
      const glm::vec3 direction =
          ray % 4 < 2 ? random.direction() : glm::normalize(v.grid.origin + edge * random.point() - origin);
      expectRay(v, origin, direction, ray % 3 ? direction : random.direction(), counts);
    }
  }
  EXPECT_GT(counts.hits, 4000);
  EXPECT_GT(counts.misses, 4000);
  EXPECT_LT(counts.touched, 5);
  EXPECT_LT(counts.unclear, 36);
}

TEST(VoxelTrace, DirectionsWithZeroComponents) {
  Counts counts;
  Stream random{5};
  const Volume v = randomVolume(9, 0.15f, random);
  const float edge = v.grid.cell * 9;
  for (int ray = 0; ray < 12000; ++ray) {
    glm::vec3 direction = random.direction();
    direction[ray % 3] = ray % 5 == 0 ? -0.0f : 0.0f;
    if (ray % 2) direction[(ray + 1) % 3] = 0;
    if (glm::length(direction) < 0.05f) continue;
    direction = glm::normalize(direction);
    expectRay(v, v.grid.origin + edge * (2.0f * random.point() - 0.5f), direction, direction, counts);
  }
  EXPECT_GT(counts.hits, 300);
  EXPECT_LT(counts.touched, 10);
}

// From origins on the walls between cells, on the edges and in the corners, the walk ends and hits what
// lies straight ahead.
TEST(VoxelTrace, OriginsOnWalls) {
  Volume v(8, {glm::vec3(-4), 1, 8});
  for (int y = 0; y < 8; ++y)
    for (int z = 0; z < 8; ++z) v.add({6, y, z}, {}, makeSide({2.5f, y - 3.5f, z - 3.5f}, {-1, 0, 0}));
  for (int x = -4; x < 2; ++x)
    for (int y = -3; y < 4; ++y)
      for (int z = -3; z < 4; ++z) {
        const VoxelHit hit = traceVoxels(v.voxels(), glm::vec3(x, y, z), {1, 0, 0}, {1, 0, 0});
        ASSERT_NE(hit.side, kNoSide);
        EXPECT_EQ(v.surface[hit.side].position, glm::vec3(2.5f, y + 0.5f, z + 0.5f));
        EXPECT_FLOAT_EQ(hit.distance, 2.5f - float(x));
        EXPECT_EQ(traceVoxels(v.voxels(), glm::vec3(x, y, z), {-1, 0, 0}, {-1, 0, 0}).side, kNoSide);
        const glm::vec3 diagonal = glm::normalize(glm::vec3(1, y > 0 ? -0.5f : 0.5f, z > 0 ? -0.5f : 0.5f));
        EXPECT_NE(traceVoxels(v.voxels(), glm::vec3(x, y, z), diagonal, diagonal).side, kNoSide);
      }
}

TEST(VoxelTrace, SkipsTheOwnSurfaceAndBacks) {
  Volume v(8, {glm::vec3(0), 1, 8});
  const glm::vec3 up(0, 1, 0), down(0, -1, 0);
  for (int x = 0; x < 8; ++x)
    for (int z = 0; z < 8; ++z) {
      v.add({x, 2, z}, makeSide({x + 0.5f, 2.5f, z + 0.5f}, up),
            makeSide({x + 0.5f, 2.3f, z + 0.5f}, down));  // thin
      v.add({x, 6, z}, makeSide({x + 0.5f, 6.5f, z + 0.5f}, up), {});
    }
  const glm::vec3 origin(1.2f, 2.5f, 3.3f), flat = glm::normalize(glm::vec3(1, 0.02f, 0.3f));
  EXPECT_EQ(traceVoxels(v.voxels(), origin, flat, up).side, kNoSide) << "along the floor it starts on";
  EXPECT_EQ(traceVoxels(v.voxels(), origin, up, up).side, kNoSide) << "the ceiling shows its back";
  const VoxelHit hit = traceVoxels(v.voxels(), {1.2f, 5, 3.3f}, down, down);
  ASSERT_NE(hit.side, kNoSide);
  EXPECT_EQ(v.surface[hit.side].normal, up);
  EXPECT_FLOAT_EQ(hit.distance, 2.5f);
  const VoxelHit below = traceVoxels(v.voxels(), {1.2f, 0.5f, 3.3f}, up, up);
  ASSERT_NE(below.side, kNoSide);
  EXPECT_EQ(v.surface[below.side].normal, down);
  EXPECT_FLOAT_EQ(below.distance, 1.8f);
}

// Of a voxel with both sides towards the ray (a sharp edge), the side that faces it more is hit; if they are
// equal, side 0.
TEST(VoxelTrace, TheSideThatFacesMoreIsHit) {
  Volume v(4, {glm::vec3(0), 1, 4});
  const glm::vec3 n0 = glm::normalize(glm::vec3(-1, 2, 0)), n1 = glm::normalize(glm::vec3(-2, 1, 0));
  v.add({2, 2, 2}, makeSide({2.5f, 2.5f, 2.5f}, n0), makeSide({2.5f, 2.5f, 2.5f}, n1));
  const glm::vec3 along(1, 0, 0), down(0, -1, 0), both = glm::normalize(glm::vec3(1, -1, 0));
  EXPECT_EQ(traceVoxels(v.voxels(), {0.5f, 2.5f, 2.5f}, along, along).side, 1u);
  EXPECT_EQ(traceVoxels(v.voxels(), {2.5f, 3.5f, 2.5f}, down, down).side, 0u);
  v.surface[1].normal = n0;
  EXPECT_EQ(traceVoxels(v.voxels(), {1.5f, 3.5f, 2.5f}, both, both).side, 0u);
}

// Along a floor just under its voxels' tops, the plane is hit where it is, not where the first voxel is entered.
TEST(VoxelTrace, GrazingRaysReachThePlane) {
  Volume v(16, {glm::vec3(0), 1, 16});
  for (int x = 0; x < 16; ++x)
    for (int z = 0; z < 16; ++z) v.add({x, 2, z}, makeSide({x + 0.5f, 2.1f, z + 0.5f}, {0, 1, 0}), {});
  const glm::vec3 origin(0.5f, 3.5f, 8.5f), direction = glm::normalize(glm::vec3(1, -0.1f, 0));
  const VoxelHit hit = traceVoxels(v.voxels(), origin, direction, direction);
  ASSERT_NE(hit.side, kNoSide);
  EXPECT_FLOAT_EQ(v.surface[hit.side].position.x, 13.5f)
      << "at x = 13.5 it is 0.1 cells above the plane or less";
}

// A piece of surface that hangs in the air is hit where it is, and not beside that.
TEST(VoxelTrace, SmallSidesArePassed) {
  Volume v(8, {glm::vec3(0), 1, 8});
  const glm::vec3 back(-1, 0, 0), along(1, 0, 0), origin(0.5f, 3.9f, 3.9f);
  VoxelSide small = makeSide({2.9f, 3.1f, 3.1f}, back);
  small.area = 0.05f;
  v.add({2, 3, 3}, {}, small);
  EXPECT_EQ(traceVoxels(v.voxels(), origin, along, along).side, kNoSide);
  EXPECT_EQ(traceVoxels(v.voxels(), {0.5f, 3.2f, 3.0f}, along, along).side, 1u);
  v.add({6, 3, 3}, {}, makeSide({6.5f, 3.5f, 3.5f}, back));
  EXPECT_EQ(traceVoxels(v.voxels(), origin, along, along).side, 3u);
  EXPECT_EQ(traceVoxels(v.voxels(), {0.5f, 3.2f, 3.0f}, along, along).side, 1u);
}

// Slits between the sides of a wall let no ray through: where the surface goes on beside a side that is too small, where
// a ray leaves the last cell in front of the plane that it reaches just beyond, and between neighbours at other depths.
TEST(VoxelTrace, WallsHaveNoSlits) {
  const glm::vec3 back(-1, 0, 0), along(1, 0, 0), up = glm::normalize(glm::vec3(0.5f, 1, 0));
  Volume v(8, {glm::vec3(0), 1, 8});
  for (int y = 0; y < 6; ++y) {
    VoxelSide small = makeSide({2.9f, y + 0.2f, 3.5f}, back);
    small.area = y < 5 ? 0.05f : 1;
    v.add({2, y, 3}, {}, small);
  }
  const VoxelHit beside = traceVoxels(v.voxels(), {0.5f, 3.8f, 3.5f}, along, along);
  EXPECT_EQ(beside.side, 7u);
  EXPECT_FLOAT_EQ(beside.distance, 2.4f);
  EXPECT_EQ(traceVoxels(v.voxels(), {0.5f, 3.2f, 3.9f}, along, along).side, kNoSide) << "beyond its edge";
  EXPECT_EQ(traceVoxels(v.voxels(), {2.4f, 5.1f, 3.5f}, up, up).side, 11u) << "0.7 above, at y = 6.1";
  EXPECT_EQ(traceVoxels(v.voxels(), {2.2f, 5.1f, 3.5f}, up, up).side, kNoSide) << "1.1 above";

  Volume stepped(8, {glm::vec3(0), 1, 8});
  const glm::vec3 steep = glm::normalize(glm::vec3(0.1f, 1, 0));
  stepped.add({2, 3, 3}, {}, makeSide({2.9f, 3.5f, 3.5f}, back));
  stepped.add({2, 4, 3}, {}, makeSide({2.1f, 4.5f, 3.5f}, back));
  EXPECT_EQ(traceVoxels(stepped.voxels(), {2.1f, 1.5f, 3.5f}, steep, steep).side, 3u);
}

// From everywhere in a closed room, rays end on a wall. Where walls meet they share a side whose normal lies between
// theirs, and a ray that grazes it may leave the room in front of it.
TEST(VoxelTrace, ClosedRoomsAreClosed) {
  Stream random{9};
  Volume v(10, {glm::vec3(0), 1, 10});
  for (int i = 0; i < 1000; ++i) {
    const glm::ivec3 cell(i % 10, i / 10 % 10, i / 100);
    glm::vec3 normals[2] = {glm::vec3(0), glm::vec3(0)}, places[2] = {glm::vec3(0), glm::vec3(0)};
    float areas[2] = {0, 0};
    for (int axis = 0; axis < 3; ++axis) {
      if (cell[axis] != 0 && cell[axis] != 9) continue;
      const int side = cell[axis] == 0 ? 0 : 1;
      glm::vec3 middle = glm::vec3(cell) + 0.5f;
      middle[axis] = side == 0 ? 0.02f : 9.98f;
      normals[side][axis] += side == 0 ? 1.0f : -1.0f;
      places[side] += middle;
      areas[side] += 1;
    }
    if (areas[0] + areas[1] == 0) continue;
    VoxelSide sides[2];
    for (int k = 0; k < 2; ++k) {
      if (areas[k] == 0) continue;
      sides[k] = makeSide(places[k] / areas[k], glm::normalize(normals[k]));
      sides[k].area = areas[k];
    }
    v.add(cell, sides[0], sides[1]);
  }
  int lost = 0;
  for (int ray = 0; ray < 20000; ++ray) {
    const glm::vec3 origin = 1.0f + 8.0f * random.point(), direction = random.direction();
    lost += traceVoxels(v.voxels(), origin, direction, direction).side == kNoSide;
  }
  EXPECT_LE(lost, 6);
}

TEST(VoxelTrace, CellsBeyondFarAreNotLookedAt) {
  Volume v(8, {glm::vec3(0), 1, 8});
  v.add({6, 3, 3}, {}, makeSide({6.5f, 3.5f, 3.5f}, {-1, 0, 0}));
  const glm::vec3 along(1, 0, 0), origin(0.5f, 3.5f, 3.5f);
  EXPECT_EQ(traceVoxels(v.voxels(), origin, along, along, 5.4f).side, kNoSide);
  EXPECT_EQ(traceVoxels(v.voxels(), origin, along, along, 5.6f).side, 1u);
}

TEST(VoxelTrace, NothingForWhatIsNoNumber) {
  Stream random{6};
  const Volume v = randomVolume(6, 0.9f, random);
  const glm::vec3 inside = v.grid.voxelToWorld(glm::vec3(3.3f)), x(1, 0, 0);
  for (int k = 0; k < 3; ++k)
    for (const float bad : {kNan, kInf, -kInf, 1e30f}) {
      glm::vec3 origin = inside, direction = x;
      origin[k] = bad;
      direction[k] = bad;
      EXPECT_EQ(traceVoxels(v.voxels(), origin, x, x).side, kNoSide);
      EXPECT_EQ(traceVoxels(v.voxels(), inside, direction, x).side, kNoSide);
    }
  EXPECT_EQ(traceVoxels(v.voxels(), inside, x, glm::vec3(kNan)).side, kNoSide);
  EXPECT_EQ(traceVoxels(v.voxels(), inside, glm::vec3(0), x).side, kNoSide);
}

TEST(VoxelTrace, EmptyGrid) {
  const Volume v(5);
  EXPECT_EQ(traceVoxels(v.voxels(), v.grid.voxelToWorld(glm::vec3(2.5f)), {0, 0, 1}, {0, 0, 1}).side,
            kNoSide);
}

}  // namespace
}  // namespace fovea::scene
