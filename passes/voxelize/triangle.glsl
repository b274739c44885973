// A triangle against the cells of the grid: which ones it overlaps, and the piece of it in each. Needs
// scene/scene.glsl and voxels/voxel.glsl. tests/support/voxels.cpp has the same operations in the
// same order, hence `precise` and quotient().
#ifndef FOVEA_VOXELIZE_TRIANGLE_GLSL
#define FOVEA_VOXELIZE_TRIANGLE_GLSL

#include "device/exact.glsl"

// In units of cells, with the axes permuted so that z is that of the largest component of the normal. A column of
// cells along z then meets the triangle in at most four cells.
struct CellTriangle {
  vec3 a, b, c, n;
  vec3 normal;      // unit, axes not permuted
  float areaScale;  // area per doubled area as seen along z
  int axis;         // the axis that z stands for
  ivec3 lo, hi;     // cells of its box; empty if a hi is below its lo
  vec2 slope;       // of z over x and y
};

vec3 turnAxes(vec3 v, int axis) { return axis == 0 ? v.yzx : axis == 1 ? v.zxy : v; }
vec3 turnBack(vec3 v, int axis) { return axis == 0 ? v.zxy : axis == 1 ? v.yzx : v; }

CellTriangle loadCellTriangle(VoxelGrid grid, uvec4 indices) {
  vec3 A = scenePosition(indices.x), B = scenePosition(indices.y), C = scenePosition(indices.z);
  float inverse = quotient(1.0, grid.cell);
  // Edges come from the original positions: differences of coordinates rounded to the grid's precision would ruin the
  // areas of small triangles.
  precise vec3 e1 = (B - A) * inverse;
  precise vec3 e2 = (C - A) * inverse;
  precise vec3 a = (A - grid.origin) * inverse;
  precise vec3 b = a + e1;
  precise vec3 c = a + e2;
  precise vec3 n = vec3(e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x);
  vec3 m = abs(n);
  CellTriangle t;
  t.axis = m.x >= m.y && m.x >= m.z ? 0 : m.y >= m.z ? 1 : 2;
  t.n = turnAxes(n, t.axis);
  bool degenerate = !(abs(t.n.z) > 1e-12);
  if (degenerate) t.n.z = 1.0;
  precise float square = (n.x * n.x + n.y * n.y) + n.z * n.z;
  float len = root(square), inverseLength = quotient(1.0, len);
  precise vec3 normal = n * inverseLength;
  float inverseZ = quotient(1.0, abs(t.n.z));
  precise float areaScale = 0.5 * len * inverseZ;
  t.normal = normal;
  t.areaScale = areaScale;
  float perZ = quotient(-1.0, t.n.z);
  precise vec2 slope = t.n.xy * perZ;
  t.slope = slope;
  vec3 least = floor(min(min(a, b), c)), most = max(max(a, b), c);
  vec3 last = max(least, ceil(most) - 1.0);  // half-open: a point on a border belongs to the upper cell
  float r = float(grid.resolution);
  t.lo = ivec3(turnAxes(min(max(least, vec3(0.0)), vec3(r)), t.axis));
  t.hi = ivec3(turnAxes(max(min(last, vec3(r - 1.0)), vec3(-1.0)), t.axis));
  if (degenerate) t.hi = ivec3(-1);
  t.a = turnAxes(a, t.axis);
  t.b = turnAxes(b, t.axis);
  t.c = turnAxes(c, t.axis);
  return t;
}

// Columns of cells along z that the box covers.
uint columnCount(CellTriangle t) {
  ivec3 size = t.hi - t.lo + 1;
  return any(lessThanEqual(size, ivec3(0))) ? 0u : uint(size.x * size.y);
}
ivec2 columnAt(CellTriangle t, uint i) {
  uint width = uint(t.hi.x - t.lo.x + 1);
  return t.lo.xy + ivec2(i % width, i / width);
}

// Range of cells in which the plane passes through a column, slightly widened; x: first cell, y: last one.
ivec2 columnRange(CellTriangle t, ivec2 column) {
  float z = t.a.z + dot(t.slope, vec2(column) - t.a.xy);
  float least = z + min(t.slope.x, 0.0) + min(t.slope.y, 0.0), most = z + max(t.slope.x, 0.0) + max(t.slope.y, 0.0);
  vec2 range = clamp(floor(vec2(least - 0.05, most + 0.05)), vec2(-1.0), vec2(1e6));
  return ivec2(max(int(range.x), t.lo.z), min(int(range.y), t.hi.z));
}

const float kSlack = 1e-3;  // cells

// Whether a corner of the cell lies on the inner side of the edge p -> q of a projection.
bool edgeMeetsCell(vec2 p, vec2 q, float side) {
  precise float nu = -(q.y - p.y) * side;
  precise float nv = (q.x - p.x) * side;
  precise float reach = max(nu, 0.0) + max(nv, 0.0) + kSlack * (abs(nu) + abs(nv));
  precise float edge = nu * p.x + nv * p.y;
  return reach >= edge;
}
bool projectionMeetsCell(vec2 a, vec2 b, vec2 c, float n) {
  float side = n < 0.0 ? -1.0 : 1.0;
  return edgeMeetsCell(a, b, side) && edgeMeetsCell(b, c, side) && edgeMeetsCell(c, a, side);
}

// Separating axes: the triangle's plane and the nine cross products of edges and axes (Akenine-Moeller 2001, as 2D
// edge tests as in Schwarz and Seidel 2010); the box's own axes are handled by the loop. The test has slack, since
// the triangle is clipped afterwards.
bool overlapsCell(CellTriangle t, vec3 a, vec3 b, vec3 c) {
  vec3 n = t.n;
  precise float d = (n.x * a.x + n.y * a.y) + n.z * a.z;
  precise float least = (min(n.x, 0.0) + min(n.y, 0.0)) + min(n.z, 0.0);
  precise float most = (max(n.x, 0.0) + max(n.y, 0.0)) + max(n.z, 0.0);
  precise float slack = kSlack * (most - least);
  return d >= least - slack && d <= most + slack && projectionMeetsCell(a.yz, b.yz, c.yz, n.x) &&
         projectionMeetsCell(a.zx, b.zx, c.zx, n.y) && projectionMeetsCell(a.xy, b.xy, c.xy, n.z);
}

// Whether the whole cell, seen along z, lies inside the edge p -> q.
bool edgeHoldsCell(vec2 p, vec2 q, float side) {
  precise float nu = -(q.y - p.y) * side;
  precise float nv = (q.x - p.x) * side;
  precise float least = min(nu, 0.0) + min(nv, 0.0);
  precise float edge = nu * p.x + nv * p.y;
  return least >= edge;
}

struct Piece {
  float area;     // in cell faces
  vec3 centre;    // its centroid in the cell, axes permuted
};

// Sutherland-Hodgman clipping. The loops must not be unrolled: a CPU device would take half a minute to
// compile their indirect accesses.
vec3 polygons[18];  // two of up to nine corners

// Clips the polygon at `from` to the part at or above 0 (or, with `upper`, at or below 1) along x, and writes it to
// `to`; after `upper` the axes are rotated by one.
int clipPolygon(int from, int to, int size, bool upper) {
  int kept = 0;
  precise vec3 p = polygons[from];
  precise float dp = upper ? 1.0 - p.x : p.x;
  [[dont_unroll]] for (int i = 1; i <= size; ++i) {
    precise vec3 q = polygons[from + (i < size ? i : 0)];
    precise float dq = upper ? 1.0 - q.x : q.x;
    if (dp >= 0.0) {
      polygons[to + min(kept, 8)] = upper ? p.yzx : p;
      ++kept;
    }
    if ((dp >= 0.0) != (dq >= 0.0)) {
      precise float change = dp - dq;
      float inverse = quotient(1.0, change);
      precise float s = dp * inverse;
      precise vec3 x = p + (q - p) * s;
      x.x = upper ? 1.0 : 0.0;
      polygons[to + min(kept, 8)] = upper ? x.yzx : x;
      ++kept;
    }
    p = q;
    dp = dq;
  }
  return min(kept, 9);
}

Piece clipToCell(CellTriangle t, vec3 a, vec3 b, vec3 c) {
  polygons[0] = a;
  polygons[1] = b;
  polygons[2] = c;
  int size = 3, from = 0;
  vec3 least = min(min(a, b), c), most = max(max(a, b), c);
  // If the triangle is inside the cell, clipping changes nothing.
  bool inside = all(greaterThanEqual(least, vec3(0.0))) && all(lessThanEqual(most, vec3(1.0)));
  [[dont_unroll]] for (int plane = inside ? 6 : 0; plane < 6; ++plane) {
    size = clipPolygon(from, 9 - from, size, plane % 2 != 0);
    from = 9 - from;
  }
  // The weights of the fan's triangles are areas as seen along z; none is negative, so the centroid stays inside.
  vec3 first = polygons[0];
  precise float sum = 0.0;
  precise vec3 moment = vec3(0.0);
  [[dont_unroll]] for (int i = 1; i + 1 < size; ++i) {
    precise vec3 p = polygons[i] - first;
    precise vec3 q = polygons[i + 1] - first;
    precise float w = abs(p.x * q.y - p.y * q.x);
    sum = sum + w;
    moment = moment + w * (p + q);
  }
  if (size < 3 || !(sum > 0.0)) return Piece(0.0, vec3(0.0));
  precise float area = sum * t.areaScale;
  precise float thrice = 3.0 * sum;
  float third = quotient(1.0, thrice);
  precise vec3 centre = first + moment * third;
  return Piece(area, centre);
}

// The piece of a triangle that crosses all four of the cell's edges along z, as most pieces of a large triangle do.
// Returns false if it does not.
bool crossesCell(CellTriangle t, vec3 a, vec3 b, vec3 c, out Piece piece) {
  float side = t.n.z < 0.0 ? -1.0 : 1.0;
  precise float z = (a.z - t.slope.x * a.x) - t.slope.y * a.y;  // at the corner
  precise float least = (z + min(t.slope.x, 0.0)) + min(t.slope.y, 0.0);
  precise float most = (z + max(t.slope.x, 0.0)) + max(t.slope.y, 0.0);
  precise float middle = z + 0.5 * (t.slope.x + t.slope.y);
  precise float area = 2.0 * t.areaScale;
  piece = Piece(area, vec3(0.5, 0.5, middle));
  return least >= 0.0 && most < 1.0 && edgeHoldsCell(a.xy, b.xy, side) && edgeHoldsCell(b.xy, c.xy, side) &&
         edgeHoldsCell(c.xy, a.xy, side);
}

// Weights of the second and third vertex at point p of the cell in which the first vertex has the coordinates a; both
// with permuted axes.
vec2 cellWeights(CellTriangle t, vec3 a, vec3 p) {
  precise vec3 e1 = t.b - t.a;
  precise vec3 e2 = t.c - t.a;
  precise vec3 d = p - a;
  float inverse = quotient(1.0, t.n.z);
  precise float s = (d.x * e2.y - d.y * e2.x) * inverse;
  precise float r = (e1.x * d.y - e1.y * d.x) * inverse;
  return vec2(s, r);
}

#endif
