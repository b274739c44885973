// Tests limit points and normals against closed forms, and topology, seams and stencils.
#include "framework/scene/subdivision/subdivision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "tests/support/cages.h"

namespace fovea::scene {
namespace {

using namespace test;
using Scheme = SubdivisionCage::Scheme;

Primitive refineOne(const SubdivisionCage& cage) {
  std::vector<Primitive> primitives = refine(cage);
  EXPECT_EQ(primitives.size(), 1u);
  return primitives.empty() ? Primitive{} : primitives.front();
}

// Normals of the vertices at `position`.
std::vector<glm::vec3> normalsAt(const Primitive& p, glm::vec3 position, float tolerance = 1e-5f) {
  std::vector<glm::vec3> normals;
  for (size_t i = 0; i < p.positions.size(); ++i)
    if (glm::distance(p.positions[i], position) < tolerance) normals.push_back(p.normals[i]);
  return normals;
}

void expectSmoothAt(const Primitive& p, glm::vec3 position, glm::vec3 normal) {
  const std::vector<glm::vec3> normals = normalsAt(p, position);
  ASSERT_EQ(normals.size(), 1u) << position.x << " " << position.y << " " << position.z;
  EXPECT_LT(glm::distance(normals[0], glm::normalize(normal)), 1e-5f);
}

// Vertices - edges + faces, with vertices at the same position counted as one.
int eulerCharacteristic(const std::vector<Primitive>& primitives) {
  std::map<std::tuple<long, long, long>, int> known;
  std::set<std::pair<int, int>> edges;
  int faces = 0;
  for (const Primitive& p : primitives) {
    std::vector<int> place;
    for (const glm::vec3& v : p.positions)
      place.push_back(
          known
              .emplace(std::tuple(std::lround(v.x * 1e4), std::lround(v.y * 1e4), std::lround(v.z * 1e4)),
                       int(known.size()))
              .first->second);
    for (size_t i = 0; i < p.indices.size(); i += 3, ++faces)
      for (size_t k = 0; k < 3; ++k) {
        const int a = place[p.indices[i + k]], b = place[p.indices[i + (k + 1) % 3]];
        edges.emplace(std::min(a, b), std::max(a, b));
      }
  }
  return int(known.size()) - int(edges.size()) + faces;
}

uint64_t triangleCount(const std::vector<Primitive>& primitives) {
  uint64_t count = 0;
  for (const Primitive& p : primitives) count += p.indices.size() / 3;
  return count;
}

// Normals and triangles face the same way.
void expectFacing(const std::vector<Primitive>& primitives, float least) {
  for (const Primitive& p : primitives)
    for (size_t i = 0; i < p.indices.size(); i += 3) {
      const uint32_t* t = &p.indices[i];
      const glm::vec3 n = glm::normalize(
          glm::cross(p.positions[t[1]] - p.positions[t[0]], p.positions[t[2]] - p.positions[t[0]]));
      for (int k = 0; k < 3; ++k)
        ASSERT_GT(glm::dot(n, p.normals[t[k]]), least)
            << "triangle " << i / 3 << " at " << p.positions[t[k]].x << ", " << p.positions[t[k]].y << ", "
            << p.positions[t[k]].z;
    }
}

// ---- closed forms -----------------------------------------------------------------------------------------

// A vertex of n quads with neighbours e and diagonals d tends to (n^2 v + 4 sum e + sum d) / (n (n + 5)) (Halstead,
// Kass, DeRose 1993, section 3). The cube's corner: n = 3, (9 + 4 - 1) / 24 = 1/2. One refinement by hand gives the
// centre of a face (0, 0, 1), of an edge (3/4, 0, 3/4) and the corner 5/9; their limits by the same mask with n = 4
// are (16 + 4 * 3 + 4 * 5/9) / 36 = 68/81 and (16 * 3/4 + 4 (1 + 10/9) + 3/2) / 36 = 395/648.
TEST(Subdivision, LimitPointsOfACube) {
  for (uint32_t level = 1; level <= 4; ++level) {
    const Primitive p = refineOne(cubeCage(level));
    expectSmoothAt(p, glm::vec3(0.5f), {1, 1, 1});
    expectSmoothAt(p, glm::vec3(-0.5f, 0.5f, -0.5f), {-1, 1, -1});
    expectSmoothAt(p, {0, 0, 68.0f / 81.0f}, {0, 0, 1});
    expectSmoothAt(p, {0, -68.0f / 81.0f, 0}, {0, -1, 0});
    expectSmoothAt(p, {395.0f / 648.0f, 0, 395.0f / 648.0f}, {1, 0, 1});
  }
}

// A sharp loop around the top: it is a uniform cubic B-spline of the top's corners, (1 + 4 - 1) / 6 = 2/3,
// and the top stays in its plane. Each side of the crease has its own normal.
TEST(Subdivision, CreaseOfACubeIsASplineWithANormalASide) {
  SubdivisionCage cage = cubeCage(3);
  cage.creases = {{4, 5, 10}, {5, 7, 10}, {7, 6, 10}, {6, 4, 10}};
  const Primitive p = refineOne(cage);
  std::vector<glm::vec3> normals = normalsAt(p, {2.0f / 3, 2.0f / 3, 1});
  ASSERT_EQ(normals.size(), 2u);
  std::sort(normals.begin(), normals.end(), [](auto a, auto b) { return a.z < b.z; });
  EXPECT_LT(glm::distance(normals[1], glm::vec3(0, 0, 1)), 1e-5f);
  EXPECT_NEAR(normals[0].x, normals[0].y, 1e-5f);
  EXPECT_GT(normals[0].x, 0.5f);
  EXPECT_LT(normals[0].z, 0.7f);
  for (size_t i = 0; i < p.positions.size(); ++i) EXPECT_LE(p.positions[i].z, 1 + 1e-5f);
  // Far from the crease nothing is split: 4 * 2^3 points of the loop are there twice.
  EXPECT_EQ(p.positions.size(), size_t(6 * 64 + 2 + 32));
  EXPECT_EQ(eulerCharacteristic({p}), 2);
}

// With all edges sharp, the result is the cube itself with the normals of its faces.
TEST(Subdivision, SharpCubeStaysACube) {
  SubdivisionCage cage = cubeCage(3);
  for (uint32_t a = 0; a < 8; ++a)
    for (uint32_t bit : {1u, 2u, 4u})
      if (!(a & bit)) cage.creases.push_back({a, a | bit, 12});
  const Primitive p = refineOne(cage);
  EXPECT_EQ(p.positions.size(), size_t(6 * 9 * 9));
  EXPECT_EQ(normalsAt(p, {1, 1, 1}).size(), 3u);
  for (size_t i = 0; i < p.positions.size(); ++i) {
    const glm::vec3 n = p.normals[i];
    EXPECT_NEAR(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1, 1e-4);
    EXPECT_NEAR(glm::dot(p.positions[i], n), 1, 1e-4);
  }
}

TEST(Subdivision, SemiSharpCreasesRoundOff) {
  SubdivisionCage cage = cubeCage(3);
  cage.creases = {{4, 5, 2}, {5, 7, 2}, {7, 6, 2}, {6, 4, 2}};
  const Primitive fine = refineOne(cage);
  EXPECT_EQ(fine.positions.size(), size_t(6 * 64 + 2)) << "no crease is left at level 3";
  const float top = std::max_element(fine.positions.begin(), fine.positions.end(), [](auto a, auto b) {
                      return a.z < b.z;
                    })->z;
  EXPECT_GT(top, 68.0f / 81.0f + 0.05f);
  EXPECT_LE(top, 1 + 1e-6f);
  cage.level = 1;
  EXPECT_EQ(refineOne(cage).positions.size(), size_t(26 + 8)) << "still sharp at level 1: two sides";
}

// Basis of the uniform cubic B-spline over control points -1 .. n, and its derivative.
double spline(const std::function<double(int)>& control, double t, int last, bool derivative) {
  const int i = std::clamp(int(std::floor(t)), 0, last - 1);
  const double x = t - i;
  const double w[4] = {(1 - x) * (1 - x) * (1 - x) / 6, (3 * x * x * x - 6 * x * x + 4) / 6,
                       (-3 * x * x * x + 3 * x * x + 3 * x + 1) / 6, x * x * x / 6};
  const double d[4] = {-(1 - x) * (1 - x) / 2, (3 * x * x - 4 * x) / 2, (-3 * x * x + 2 * x + 1) / 2,
                       x * x / 2};
  double sum = 0;
  for (int k = 0; k < 4; ++k) sum += (derivative ? d[k] : w[k]) * control(i - 1 + k);
  return sum;
}

// A grid is a bicubic B-spline surface; at a boundary as if the net went on with p(-1) = 2 p(0) - p(1) in
// both directions (so it ends in its corner points). Texture coordinates are the parameters.
TEST(Subdivision, BoundaryPatchIsABSplineSurface) {
  constexpr int kLast = 4;
  SubdivisionCage cage = gridCage(kLast + 1, kLast + 1, 3, [](uint32_t, uint32_t) { return 0.0f; });
  cage = jittered(cage, 0.3f, 11);
  for (size_t i = 0; i < cage.uvs.size(); ++i) cage.uvs[i] = glm::vec2(i % (kLast + 1), i / (kLast + 1));
  const auto net = [&](int x, int y, int axis) {
    return double(cage.positions[size_t(y * (kLast + 1) + x)][axis]);
  };
  const auto extended = [](const std::function<double(int)>& row, int i) {
    return i < 0 ? 2 * row(0) - row(1) : i > kLast ? 2 * row(kLast) - row(kLast - 1) : row(i);
  };
  const auto evaluate = [&](glm::vec2 uv, int axis, bool du, bool dv) {
    const auto row = [&](int y) {
      return spline([&](int x) { return extended([&](int k) { return net(k, y, axis); }, x); }, double(uv.x),
                    kLast, du);
    };
    return spline([&](int y) { return extended(row, y); }, double(uv.y), kLast, dv);
  };
  const Primitive p = refineOne(cage);
  ASSERT_EQ(p.positions.size(), size_t(33 * 33));
  for (size_t i = 0; i < p.positions.size(); ++i) {
    const glm::vec2 uv = p.uvs[i];
    EXPECT_NEAR(uv.x * 8, std::round(uv.x * 8), 1e-4);
    glm::dvec3 position, du, dv;
    for (int k = 0; k < 3; ++k) {
      position[k] = evaluate(uv, k, false, false);
      du[k] = evaluate(uv, k, true, false);
      dv[k] = evaluate(uv, k, false, true);
    }
    EXPECT_LT(glm::distance(glm::dvec3(p.positions[i]), position), 2e-6) << uv.x << ", " << uv.y;
    EXPECT_LT(glm::distance(glm::dvec3(p.normals[i]), glm::normalize(glm::cross(du, dv))), 2e-4)
        << uv.x << ", " << uv.y;
  }
}

// Loop: a vertex of valence n tends to (1 - n w) v + w sum e with w = 1 / (n + 3 / (8 b)),
// n b = 5/8 - (3/8 + cos(2 pi / n) / 4)^2 (Loop 1987): 1/5 for n = 3.
TEST(Subdivision, LoopLimitPoints) {
  for (uint32_t level : {1u, 3u}) {
    const Primitive p = refineOne(tetrahedronCage(level));
    for (const glm::vec3& v : tetrahedronCage(1).positions) expectSmoothAt(p, 0.2f * v, v);
    const double cosine = std::cos(2 * std::numbers::pi / 5), r = 0.375 + cosine / 4;
    const double w = 1 / (5 + 3 / (8 * (0.625 - r * r) / 5));
    // The five neighbours of an icosahedron's vertex add up to sqrt(5) of it.
    const float shrink = float(1 - 5 * w + w * std::sqrt(5.0));
    EXPECT_NEAR(shrink, 0.70781, 1e-5);
    const Primitive q = refineOne(icosahedronCage(level));
    for (const glm::vec3& v : icosahedronCage(1).positions) expectSmoothAt(q, shrink * v, v);
  }
}

// Whatever the valence, flat cages stay flat and face up: each mask of creases and corners annihilates
// constants and keeps the orientation. The vertex in the middle of the fan lies on the boundary or inside.
TEST(Subdivision, FlatFansFaceUp) {
  for (const Scheme scheme : {Scheme::CatmullClark, Scheme::Loop})
    for (uint32_t count = 1; count <= 7; ++count)
      for (const float angle : {1.2f, 2.6f, 3.1415927f, 4.2f}) {
        if (angle / float(count) > 2.7f) continue;
        for (const bool corner : {false, true}) {
          SubdivisionCage cage = fanCage(scheme, count, angle, 2);
          if (corner) cage.corners.push_back({0, 10});
          if (count > 2) cage.creases.push_back({0, scheme == Scheme::Loop ? 2u : 3u, 10});
          const Primitive p = refineOne(cage);
          for (size_t i = 0; i < p.normals.size(); ++i) {
            EXPECT_NEAR(p.positions[i].z, 0, 1e-6);
            EXPECT_GT(p.normals[i].z, 0.9999f) << int(scheme) << " " << count << " " << angle << " " << corner
                                               << " at " << p.positions[i].x << ", " << p.positions[i].y;
          }
        }
      }
}

// A cone's tip stays where it is and its normal points along the axis.
TEST(Subdivision, SharpVertexIsKept) {
  for (const Scheme scheme : {Scheme::CatmullClark, Scheme::Loop}) {
    SubdivisionCage cage = scheme == Scheme::Loop ? tetrahedronCage(3) : cubeCage(3);
    const uint32_t vertex = scheme == Scheme::Loop ? 0 : 7;
    cage.corners.push_back({vertex, 10});
    expectSmoothAt(refineOne(cage), {1, 1, 1}, {1, 1, 1});
  }
}

// ---- topology ---------------------------------------------------------------------------------------------

TEST(Subdivision, TriangleCountsAndEulerCharacteristic) {
  for (uint32_t level = 1; level <= 4; ++level) {
    const uint64_t growth = uint64_t(1) << (2 * (level - 1));
    const auto expect = [&](const SubdivisionCage& cage, uint64_t triangles, int characteristic) {
      const std::vector<Primitive> primitives = refine(cage);
      EXPECT_EQ(triangleCount(primitives), triangles);
      EXPECT_EQ(refinedTriangles(cage), triangles);
      EXPECT_EQ(eulerCharacteristic(primitives), characteristic);
    };
    expect(cubeCage(level), 48 * growth, 2);
    expect(torusCage(7, 5, level), 35 * 8 * growth, 0);
    expect(gridCage(4, 3, level, [](uint32_t x, uint32_t) { return float(x); }), 6 * 8 * growth, 1);
    expect(tetrahedronCage(level), 16 * growth, 2);
    expect(icosahedronCage(level), 80 * growth, 2);
    expect(fanCage(Scheme::Loop, 5, 3, level), 20 * growth, 1);
  }
}

TEST(Subdivision, PolygonsBecomeQuads) {
  SubdivisionCage cage;  // a prism over a pentagon, with caps of five vertices
  for (int i = 0; i < 10; ++i) {
    const float a = 2 * std::numbers::pi_v<float> * float(i / 2) / 5;
    cage.positions.emplace_back(std::cos(a), std::sin(a), i % 2);
  }
  addFace(cage, {8, 6, 4, 2, 0});
  addFace(cage, {1, 3, 5, 7, 9});
  for (uint32_t i = 0; i < 5; ++i) addFace(cage, {2 * i, 2 * (i + 1) % 10, 2 * (i + 1) % 10 + 1, 2 * i + 1});
  const std::vector<Primitive> primitives = refine(cage);
  EXPECT_EQ(triangleCount(primitives), 30u * 8);
  EXPECT_EQ(eulerCharacteristic(primitives), 2);
  expectFacing(primitives, 0.5f);
}

TEST(Subdivision, NormalsAndTrianglesFaceTheSameWay) {
  expectFacing(refine(cubeCage(4)), 0.9f);
  expectFacing(refine(torusCage(8, 6, 3)), 0.9f);
  expectFacing(refine(icosahedronCage(3)), 0.9f);
  // A sharp vertex inside smooth faces is a spike, whose sides may fold; creases are not.
  SubdivisionCage cage = everythingCage(3);
  cage.corners.clear();
  expectFacing(refine(cage), 0.6f);
}

TEST(Subdivision, MaterialsGoDownWithTheFaces) {
  SubdivisionCage cage = cubeCage(2);
  cage.faceMaterials = {4, 4, 4, 1, 4, 1};
  const std::vector<Primitive> primitives = refine(cage);
  ASSERT_EQ(primitives.size(), 2u);
  EXPECT_EQ(primitives[0].material, 1u);
  EXPECT_EQ(primitives[0].indices.size(), 2u * 4 * 4 * 2 * 3);
  EXPECT_EQ(primitives[1].material, 4u);
  EXPECT_EQ(primitives[1].indices.size(), 4u * 4 * 4 * 2 * 3);
  // The surface is smooth across the seam.
  for (const glm::vec3& v : primitives[0].positions)
    for (const glm::vec3& other : normalsAt(primitives[1], v))
      EXPECT_LT(glm::distance(other, normalsAt(primitives[0], v)[0]), 1e-5f);
}

// One texture island per face: seams split vertices, not the surface, and island corners keep their coordinates.
TEST(Subdivision, SeamsOfTextureCoordinates) {
  SubdivisionCage cage = cubeCage(2);
  for (uint32_t f = 0; f < 6; ++f)
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
      cage.faceUvs.push_back(uint32_t(cage.uvs.size()));
      cage.uvs.push_back(corner + glm::vec2(2 * float(f), 0));
    }
  const Primitive p = refineOne(cage);
  EXPECT_EQ(p.positions.size(), 6u * 25);
  EXPECT_EQ(eulerCharacteristic({p}), 2);
  std::set<std::pair<float, float>> corners;
  for (size_t i = 0; i < p.positions.size(); ++i) {
    EXPECT_LT(glm::distance(p.normals[i], normalsAt(p, p.positions[i])[0]), 1e-6f);
    if (glm::distance(p.positions[i], glm::sign(p.positions[i]) * 0.5f) < 1e-5f)
      corners.emplace(p.uvs[i].x, p.uvs[i].y);
  }
  EXPECT_EQ(corners.size(), 24u);
  for (const auto& [u, v] : corners) {
    EXPECT_EQ(u, std::round(u));
    EXPECT_EQ(v, std::round(v));
  }
}

// ---- stencils ---------------------------------------------------------------------------------------------

void expectStencilsRefine(const SubdivisionCage& cage, const SubdivisionCage& deformed) {
  const Stencils stencils(cage);
  ASSERT_EQ(stencils.pointCount(), cage.positions.size());
  std::vector<glm::vec3> positions(stencils.vertexCount()), normals(stencils.vertexCount());
  stencils.evaluate(deformed.positions, positions, normals);
  size_t v = 0;
  for (const Primitive& p : refine(deformed))
    for (size_t i = 0; i < p.positions.size(); ++i, ++v) {
      ASSERT_LT(v, positions.size());
      EXPECT_LT(glm::distance(positions[v], p.positions[i]), 5e-6f);
      EXPECT_LT(glm::distance(normals[v], p.normals[i]), 2e-5f);
    }
  EXPECT_EQ(v, stencils.vertexCount());
}

TEST(Subdivision, StencilsEqualRefinement) {
  for (uint32_t level = 1; level <= 3; ++level) {
    const SubdivisionCage all = everythingCage(level), ball = icosahedronCage(level),
                          cloth = gridCage(5, 4, level,
                                           [](uint32_t x, uint32_t y) { return 0.3f * float(x * y % 3); });
    expectStencilsRefine(all, all);
    expectStencilsRefine(all, jittered(all, 0.1f, 3));
    expectStencilsRefine(ball, jittered(ball, 0.2f, 4));
    expectStencilsRefine(cloth, jittered(cloth, 0.2f, 5));
  }
}

TEST(Subdivision, StencilsAreAffine) {
  const Stencils stencils(everythingCage(2));
  for (const Stencils::Range& r : stencils.ranges()) {
    glm::dvec3 sum(0);
    for (uint32_t i = r.first; i < r.first + r.count; ++i) {
      const Stencils::Entry& e = stencils.entries()[i];
      sum += glm::dvec3(e.position, e.tangentA, e.tangentB);
      EXPECT_LT(e.point, stencils.pointCount());
    }
    EXPECT_LT(glm::distance(sum, glm::dvec3(1, 0, 0)), 1e-5);
  }
}

// ---- the coarser level for voxels and VPL maps ------------------------------------------------------------

// Its triangles are those of the cage refined to that level, on vertices of the finer one.
void expectCoarse(SubdivisionCage cage, uint32_t light) {
  const std::vector<Primitive> picture = refine(cage);
  cage.lightLevel = light;
  const std::vector<Primitive> both = refine(cage);
  cage.lightLevel.reset();
  cage.level = light;
  const std::vector<Primitive> coarse = refine(cage);
  ASSERT_EQ(both.size(), coarse.size());
  for (size_t n = 0; n < both.size(); ++n) {
    EXPECT_EQ(both[n].positions, picture[n].positions) << "the picture's mesh stays as it is";
    EXPECT_EQ(both[n].indices, picture[n].indices);
    EXPECT_EQ(both[n].material, coarse[n].material);
    ASSERT_EQ(both[n].lightIndices.size(), coarse[n].indices.size());
    for (size_t i = 0; i < coarse[n].indices.size(); ++i) {
      const uint32_t a = both[n].lightIndices[i], b = coarse[n].indices[i];
      ASSERT_LT(glm::distance(both[n].positions[a], coarse[n].positions[b]), 2e-6f) << n << " " << i;
      ASSERT_LT(glm::distance(both[n].uvs[a], coarse[n].uvs[b]), 2e-6f) << n << " " << i;
    }
  }
}

TEST(Subdivision, CoarserTrianglesForLightAreThoseOfTheirLevel) {
  for (uint32_t level = 2; level <= 4; ++level)
    for (uint32_t light = 1; light < level; ++light) {
      SCOPED_TRACE(std::to_string(level) + " " + std::to_string(light));
      // Creases that end inside the surface are left out, because OpenSubdiv's limit point there depends a little
      // on the level.
      SubdivisionCage everything = everythingCage(level);
      everything.creases.resize(6);
      expectCoarse(everything, light);
      expectCoarse(torusCage(5, 4, level), light);
      expectCoarse(icosahedronCage(level), light);
      expectCoarse(gridCage(4, 3, level, [](uint32_t x, uint32_t y) { return float(x * y); }), light);
      SubdivisionCage cube = cubeCage(level);
      cube.faceMaterials = {4, 4, 4, 1, 4, 1};
      expectCoarse(cube, light);
    }
}

// Level 0 consists of the cage's own faces, as fans between the limit points of its vertices.
TEST(Subdivision, CoarsestTrianglesForLightAreTheFacesOfTheCage) {
  for (uint32_t level = 1; level <= 3; ++level) {
    SubdivisionCage cage = cubeCage(level);
    cage.lightLevel = 0;
    const Primitive p = refineOne(cage);
    ASSERT_EQ(p.lightIndices.size(), 12u * 3);
    size_t i = 0;
    for (size_t face = 0; face < 6; ++face)
      for (uint32_t k = 2; k < 4; ++k)
        for (uint32_t corner : {0u, k - 1, k}) {
          const glm::vec3 limit = 0.5f * cage.positions[cage.faceVertices[4 * face + corner]];
          EXPECT_LT(glm::distance(p.positions[p.lightIndices[i++]], limit), 1e-6f);
        }
  }
  SubdivisionCage ball = icosahedronCage(2);
  ball.lightLevel = 0;
  EXPECT_EQ(refineOne(ball).lightIndices.size(), 20u * 3);
}

TEST(Subdivision, TheSameLevelForLightNeedsNoTrianglesOfItsOwn) {
  SubdivisionCage cage = cubeCage(2);
  cage.lightLevel = 2;
  EXPECT_TRUE(refineOne(cage).lightIndices.empty());
}

TEST(Subdivision, RefiningIsDeterministic) {
  const std::vector<Primitive> a = refine(everythingCage(3)), b = refine(everythingCage(3));
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].positions, b[i].positions);
    EXPECT_EQ(a[i].normals, b[i].normals);
    EXPECT_EQ(a[i].indices, b[i].indices);
  }
}

}  // namespace
}  // namespace fovea::scene
