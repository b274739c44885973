#include "tests/support/voxels.h"
#include "framework/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "fovea/pass.h"

namespace fovea::test {
namespace {

using glm::ivec3;
using glm::vec2;
using glm::vec3;

// Sums are integers in units of 2^-32.
uint64_t fixedPoint(float x) { return uint64_t(std::floor(x * 4294967296.0f + 0.5f)); }

struct Sums {
  uint64_t area = 0, weight = 0;
  std::array<uint64_t, 3> position{}, normal{}, reflectance{}, emission{};
  uint32_t object = 0;  // key: area of the largest piece and 0xffff - its object
};
using Cells = std::map<uint32_t, std::array<Sums, 2>>;  // by linear cell index

// A triangle in units of cells, with the axes permuted so that z is the axis of the largest component of n.
struct Triangle {
  vec3 a{0}, b{0}, c{0}, n{0};
  vec3 normal{0};       // unit, axes not turned
  vec2 slope{0};        // slopes of z over x and y
  float areaScale = 0;  // area per doubled area seen along z
  int axis = 0;         // index of the original axis of z
  ivec3 lo{0}, hi{-1};  // cells of its box
};

vec3 turn(vec3 v, int axis) { return axis == 0 ? vec3(v.y, v.z, v.x) : axis == 1 ? vec3(v.z, v.x, v.y) : v; }
vec3 turnBack(vec3 v, int axis) {
  return axis == 0 ? vec3(v.z, v.x, v.y) : axis == 1 ? vec3(v.y, v.z, v.x) : v;
}

Triangle makeTriangle(const scene::VoxelGrid& grid, vec3 a, vec3 b, vec3 c) {
  Triangle t;
  const float inverse = 1.0f / grid.cell;
  // Edges come from the positions as given: differences of coordinates that were rounded to the grid's would ruin the
  // areas of small triangles.
  const vec3 e1 = (b - a) * inverse, e2 = (c - a) * inverse;
  t.a = (a - grid.origin) * inverse;
  t.b = t.a + e1;
  t.c = t.a + e2;
  t.n = {e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x};
  const vec3 m = glm::abs(t.n);
  t.axis = m.x >= m.y && m.x >= m.z ? 0 : m.y >= m.z ? 1 : 2;
  if (!(m[t.axis] > 1e-12f)) return t;
  const float length = std::sqrt((t.n.x * t.n.x + t.n.y * t.n.y) + t.n.z * t.n.z);
  t.normal = t.n * (1.0f / length);
  t.areaScale = 0.5f * length * (1.0f / m[t.axis]);
  const vec3 least = glm::floor(glm::min(glm::min(t.a, t.b), t.c)), most = glm::max(glm::max(t.a, t.b), t.c);
  const vec3 last =
      glm::max(least, glm::ceil(most) - 1.0f);  // half-open: what lies on a border belongs to the upper cell
  const float r = float(grid.resolution);
  t.lo = ivec3(turn(glm::min(glm::max(least, vec3(0.0f)), vec3(r)), t.axis));
  t.hi = ivec3(turn(glm::max(glm::min(last, vec3(r - 1.0f)), vec3(-1.0f)), t.axis));
  t.a = turn(t.a, t.axis);
  t.b = turn(t.b, t.axis);
  t.c = turn(t.c, t.axis);
  t.n = turn(t.n, t.axis);
  t.slope = vec2(t.n) * (-1.0f / t.n.z);
  return t;
}

constexpr float kSlack = 1e-3f;  // cells

// Whether a corner of the cell lies on the inner side of the edge p -> q, in the projection along w.
bool edgeMeetsCell(vec3 p, vec3 q, int u, int v, float sign) {
  const float nu = -(q[v] - p[v]) * sign, nv = (q[u] - p[u]) * sign;
  const float reach = std::max(nu, 0.0f) + std::max(nv, 0.0f);
  return reach + kSlack * (std::abs(nu) + std::abs(nv)) >= nu * p[u] + nv * p[v];
}

// Separating axes: the triangle's plane and the nine cross products of edges and axes (Akenine-Moeller 2001, as 2D
// edge tests as in Schwarz and Seidel 2010); the loop covers the axes of the box itself. The tests have slack,
// because what they let through is clipped.
bool overlapsCell(const Triangle& t, vec3 a, vec3 b, vec3 c) {
  const vec3 n = t.n;
  const float d = (n.x * a.x + n.y * a.y) + n.z * a.z;
  const float least = (std::min(n.x, 0.0f) + std::min(n.y, 0.0f)) + std::min(n.z, 0.0f);
  const float most = (std::max(n.x, 0.0f) + std::max(n.y, 0.0f)) + std::max(n.z, 0.0f);
  const float slack = kSlack * (most - least);
  if (d < least - slack || d > most + slack) return false;
  for (int w = 0; w < 3; ++w) {
    const int u = (w + 1) % 3, v = (w + 2) % 3;
    const float sign = n[w] < 0.0f ? -1.0f : 1.0f;
    if (!edgeMeetsCell(a, b, u, v, sign) || !edgeMeetsCell(b, c, u, v, sign) ||
        !edgeMeetsCell(c, a, u, v, sign))
      return false;
  }
  return true;
}

using Polygon = std::vector<vec3>;

// Sutherland-Hodgman clipping: keeps what lies at or above 0 along an axis (upper: at or below 1).
Polygon clip(const Polygon& in, int axis, bool upper) {
  Polygon out;
  for (size_t i = 0; i < in.size(); ++i) {
    const vec3 p = in[i], q = in[(i + 1) % in.size()];
    const float dp = upper ? 1.0f - p[axis] : p[axis], dq = upper ? 1.0f - q[axis] : q[axis];
    if (dp >= 0.0f) out.push_back(p);
    if ((dp >= 0.0f) != (dq >= 0.0f)) {
      const float s = dp * (1.0f / (dp - dq));
      vec3 x = p + (q - p) * s;
      x[axis] = upper ? 1.0f : 0.0f;
      out.push_back(x);
    }
  }
  return out;
}

struct Piece {
  float area = 0;  // in cell faces
  vec3 centroid{0};
};

Piece clipToCell(const Triangle& t, vec3 a, vec3 b, vec3 c) {
  Polygon polygon{a, b, c};
  for (int axis = 0; axis < 3; ++axis) polygon = clip(clip(polygon, axis, false), axis, true);
  if (polygon.size() < 3) return {};
  // The weights of the fan's triangles are those seen along z; none is negative, so the centroid stays inside.
  const vec3 first = polygon[0];
  float sum = 0;
  vec3 moment{0};
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    const vec3 p = polygon[i] - first, q = polygon[i + 1] - first;
    const float w = std::abs(p.x * q.y - p.y * q.x);
    sum += w;
    moment += w * (p + q);
  }
  if (!(sum > 0.0f)) return {};
  return {sum * t.areaScale, first + moment * (1.0f / (3.0f * sum))};
}

// Whether the whole cell, seen along z, lies inside the edge p -> q.
bool edgeHoldsCell(vec3 p, vec3 q, float side) {
  const float nu = -(q.y - p.y) * side, nv = (q.x - p.x) * side;
  return std::min(nu, 0.0f) + std::min(nv, 0.0f) >= nu * p.x + nv * p.y;
}

// The fast path of the shader, for a triangle that passes through all four of the cell's edges along z.
bool crossesCell(const Triangle& t, vec3 a, vec3 b, vec3 c, Piece& piece) {
  const float side = t.n.z < 0.0f ? -1.0f : 1.0f;
  const float z = (a.z - t.slope.x * a.x) - t.slope.y * a.y;  // at the corner
  const float least = (z + std::min(t.slope.x, 0.0f)) + std::min(t.slope.y, 0.0f);
  const float most = (z + std::max(t.slope.x, 0.0f)) + std::max(t.slope.y, 0.0f);
  piece = {2.0f * t.areaScale, vec3(0.5f, 0.5f, z + 0.5f * (t.slope.x + t.slope.y))};
  return least >= 0.0f && most < 1.0f && edgeHoldsCell(a, b, side) && edgeHoldsCell(b, c, side) &&
         edgeHoldsCell(c, a, side);
}

vec2 uvAt(const scene::Geometry& g, const scene::Triangle& indices, const Triangle& t, vec3 a, vec3 p) {
  const vec3 e1 = t.b - t.a, e2 = t.c - t.a, d = p - a;
  const float inverse = 1.0f / t.n.z;
  const float s = (d.x * e2.y - d.y * e2.x) * inverse, r = (e1.x * d.y - e1.y * d.x) * inverse;
  return g.uvs[indices.v[0]] * (1.0f - s - r) + g.uvs[indices.v[1]] * s + g.uvs[indices.v[2]] * r;
}

void add(Sums& sums, const Piece& piece, vec3 normal, vec3 reflectance, vec3 emission, uint32_t object) {
  const float weight = piece.area * (emission != vec3(0) ? 256.0f : 1.0f);
  sums.area += fixedPoint(piece.area);
  sums.weight += fixedPoint(weight);
  for (int k = 0; k < 3; ++k) {
    sums.position[size_t(k)] += fixedPoint(weight * piece.centroid[k]);
    sums.normal[size_t(k)] += fixedPoint(weight * (normal[k] + 1.0f));
    sums.reflectance[size_t(k)] += fixedPoint(piece.area * reflectance[k]);
    sums.emission[size_t(k)] += fixedPoint(piece.area * std::min(emission[k], 65504.0f));
  }
  const uint32_t size = uint32_t(std::min(piece.area * 32768.0f, 65535.0f));
  sums.object = std::max(sums.object, size << 16 | (0xffffu - object));
}

void addTriangle(const scene::Scene& scene, const scene::Geometry& g, const scene::VoxelGrid& grid,
                 const scene::Triangle& indices, Cells& cells) {
  const Triangle t =
      makeTriangle(grid, g.positions[indices.v[0]], g.positions[indices.v[1]], g.positions[indices.v[2]]);
  const scene::Material& material = scene.materials[indices.material()];
  const uint32_t side = scene::voxelSideOf(t.normal);
  for (int z = t.lo.z; z <= t.hi.z; ++z)
    for (int y = t.lo.y; y <= t.hi.y; ++y)
      for (int x = t.lo.x; x <= t.hi.x; ++x) {
        const vec3 cell(x, y, z), a = t.a - cell, b = t.b - cell, c = t.c - cell;
        if (!overlapsCell(t, a, b, c)) continue;
        Piece piece;
        if (!crossesCell(t, a, b, c, piece)) piece = clipToCell(t, a, b, c);
        if (fixedPoint(piece.area) == 0) continue;
        const vec2 uv = uvAt(g, indices, t, a, piece.centroid);
        piece.centroid = turnBack(piece.centroid, t.axis);
        const glm::vec4 color = scene::reflectance(scene, material, uv);
        if (material.masked && color.a < material.alphaCutoff) continue;
        const vec3 emission = scene::emission(scene, material, uv);
        const glm::uvec3 place(turnBack(cell, t.axis));
        auto& sides =
            cells[place.x + uint32_t(grid.resolution) * (place.y + uint32_t(grid.resolution) * place.z)];
        add(sides[side], piece, t.normal, vec3(color), emission, indices.object());
        if (material.doubleSided)
          add(sides[1 - side], piece, -t.normal, vec3(color), emission, indices.object());
      }
}

vec3 average(const std::array<uint64_t, 3>& sum, uint64_t weight) {
  return vec3(glm::dvec3(double(sum[0]), double(sum[1]), double(sum[2])) / double(weight));
}

// The area of a plane within the unit cube, by slices, but at most that of a disc of 1.5 radii.
double reachOf(glm::dvec3 position, glm::dvec3 normal, double area) {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (std::abs(normal[u]) > std::abs(normal[v])) std::swap(u, v);
  const double slopeU = -normal[u] / normal[axis];
  double slopeV = -normal[v] / normal[axis], within = 0;
  if (std::abs(slopeV) < 0.01) slopeV = slopeV < 0 ? -0.01 : 0.01;
  for (int slice = 0; slice < 8; ++slice) {
    const double height = position[axis] + slopeU * ((slice + 0.5) / 8 - position[u]) - slopeV * position[v];
    const double low = std::clamp((-0.01 - height) / slopeV, 0.0, 1.0),
                 high = std::clamp((1.01 - height) / slopeV, 0.0, 1.0);
    within += std::abs(high - low) / 8;
  }
  return std::min(within / std::abs(normal[axis]), 2.25 * area);
}

scene::VoxelSide resolveSide(const scene::VoxelGrid& grid, uint32_t linear, uint32_t side, const Sums& sums) {
  scene::VoxelSide result;
  if (sums.area == 0) return result;
  const uint32_t r = uint32_t(grid.resolution);
  const vec3 cell(float(linear % r), float(linear / r % r), float(linear / (r * r)));
  result.position = grid.voxelToWorld(cell + average(sums.position, sums.weight));
  result.area = float(double(sums.area) / 4294967296.0) * grid.cell * grid.cell;
  const vec3 normal = average(sums.normal, sums.weight) - 1.0f;
  // The normals of one side can cancel if three or more meet; any direction to that side will do.
  const float length = glm::length(normal);
  result.normal = length > 1e-3f ? normal / length : vec3(side == 0 ? 0.57735027f : -0.57735027f);
  result.object = float(0xffffu - (sums.object & 0xffffu));
  result.reflectance = average(sums.reflectance, sums.area);
  if (sums.weight > sums.area) {
    const double emissive = double(sums.weight - sums.area) / 255 / 0x1p32;
    const double reach =
        reachOf(average(sums.position, sums.weight), result.normal, double(sums.area) / 0x1p32);
    result.emission = average(sums.emission, uint64_t(0x1p32 * std::max(emissive, reach)));
    result.emissionArea = float(std::max(emissive, reach)) * grid.cell * grid.cell;
  }
  return result;
}

void append(const Cells& cells, VoxelArrays& out) {
  for (const auto& [linear, sides] : cells) {
    for (uint32_t side = 0; side < 2; ++side)
      out.surface.push_back(resolveSide(out.grid, linear, side, sides[side]));
    out.index[linear] = ++out.info.voxels;
  }
}

}  // namespace

VoxelArrays voxelizeReference(const scene::Scene& scene, const scene::Geometry& geometry, int resolution) {
  VoxelArrays out;
  const bool empty = geometry.empty();
  out.grid = scene::voxelGrid(empty ? vec3(0.0f) : geometry.boundsMin,
                              empty ? vec3(0.0f) : geometry.boundsMax, resolution);
  out.resolution = resolution;
  out.info.resolution = uint32_t(resolution);
  out.index.resize(size_t(resolution) * size_t(resolution) * size_t(resolution));
  Cells fixed, moving;
  for (uint32_t i = 0; i < geometry.triangles.size(); ++i)
    addTriangle(scene, geometry, out.grid, geometry.triangles[i],
                i < geometry.staticTriangles ? fixed : moving);
  append(fixed, out);
  out.info.staticVoxels = out.info.voxels;
  append(moving, out);
  return out;
}

std::vector<uint32_t> occupiedBricks(const VoxelArrays& voxels) {
  const int r = voxels.resolution, wide = (r + 3) / 4;
  std::vector<uint32_t> bricks(size_t(wide) * size_t(wide) * size_t((r + 1) / 2));
  for (int z = 0; z < r; ++z)
    for (int y = 0; y < r; ++y)
      for (int x = 0; x < r; ++x)
        if (voxels.voxelAt({x, y, z}) != 0)
          bricks[size_t(x / 4 + wide * (y / 4 + wide * (z / 2)))] |= 1u
                                                                     << (x % 4 + 4 * (y % 4) + 16 * (z % 2));
  return bricks;
}

void setVoxels(PassTest& test, const VoxelArrays& voxels) {
  const graph::PortSpec* port = test.declaration().findPort("voxels");
  if (!port) return;
  const uint32_t r = uint32_t(voxels.resolution);
  std::vector<scene::VoxelSide> surface = voxels.surface;
  if (surface.empty()) surface.resize(2);  // an empty buffer does not exist
  for (const graph::MemberSpec& m : port->members) {
    if (m.name == "index") test.volume("voxels.index", VK_FORMAT_R32_UINT, r, r, r, voxels.index);
    if (m.name == "occupied")
      test.volume("voxels.occupied", VK_FORMAT_R32_UINT, (r + 3) / 4, (r + 3) / 4, (r + 1) / 2,
                  occupiedBricks(voxels));
    if (m.name == "surface") test.buffer("voxels.surface", surface, "VoxelSide");
    if (m.name == "info") test.buffer("voxels.info", std::vector<scene::VoxelInfo>{voxels.info}, "VoxelInfo");
  }
}

}  // namespace fovea::test
