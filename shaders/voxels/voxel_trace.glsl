// Rays through the voxels, up to the first surface that they meet.
//
// Needs scene/scene.glsl and the port `voxels` with the members `index` and, for traceVoxels(), `occupied`
// (Usage::StorageRead), and `surface` (Usage::TexelRead).
#ifndef FOVEA_VOXEL_TRACE_GLSL
#define FOVEA_VOXEL_TRACE_GLSL

#include "device/texels.glsl"
#include "voxels/voxel.glsl"
#include "vpls/vpl.glsl"

// An image rather than a texture, because on lavapipe a load from a texture costs several times as much.
layout(r32ui) uniform readonly uimage3D voxelsIndex;
layout(r32ui) uniform readonly uimage3D voxelsOccupied;
LARGE_TEXELS(vec4, voxelsSurface);

// The grid of the connected bundle.
VoxelGrid voxelsGrid() { return voxelGrid(uint(imageSize(voxelsIndex).x)); }

// Number of the voxel in a cell plus 1; 0 if the cell is empty or outside the grid.
uint voxelAt(VoxelGrid grid, ivec3 cell) { return insideGrid(grid, cell) ? imageLoad(voxelsIndex, cell).r : 0u; }

// A side by its number.
VoxelSide loadSide(uint side) {
  int first = 4 * int(side);
  vec4 a = texelOf(voxelsSurface, first), b = texelOf(voxelsSurface, first + 1),
       c = texelOf(voxelsSurface, first + 2), d = texelOf(voxelsSurface, first + 3);
  return VoxelSide(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w, d.xyz, d.w);
}

// The area, m^2, from which a side sends light with the radiance that it has.
float sendingArea(VoxelSide side) { return max(side.area, side.emissionArea); }

// What meetsSide() returns.
const uint kNotMet = 0u, kPassed = 1u, kMet = 2u;

// Whether the ray hits this side before it leaves the cell at distance `exit`, or only passes beside it. Only the
// front of a side counts, and only if it is not the surface on which the ray starts. origin, direction, normal: as in
// traceVoxels(); exit, distance: m, the latter to the side's plane; facing: cosine, negative towards the ray.
uint meetsSide(VoxelGrid grid, uint side, vec3 origin, vec3 direction, vec3 normal, float exit, out float facing,
               out float distance) {
  VoxelSide s = loadSide(side);
  vec3 to = s.position - origin;
  float height = dot(to, s.normal);
  facing = dot(s.normal, direction);
  distance = facing < 0.0 ? height / facing : 0.0;
  if (!(s.area > 0.0 && facing < 0.0 && dot(to, normal) > kOwnSurface * grid.cell)) return kNotMet;
  vec3 off = min(distance, exit) * direction - to;
  return exit * facing - height < kBehindPlane * grid.cell &&
                 kPi * dot(off, off) < kSideRadii * kSideRadii * s.area
             ? kMet
             : kPassed;
}

// Whether a ray that only passed a side in `cell` slipped through the surface that the side represents: if it crosses
// the plane beyond the cell, within the reach of the side; if it does so within the cell, where the surface goes on in
// a next cell that way. place: where the ray crosses the plane, in the cell or beyond.
bool slipsThrough(VoxelGrid grid, ivec3 cell, uint side, vec3 place, bool beyond) {
  VoxelSide s = loadSide(side);
  vec3 off = place - s.position;
  if (beyond) return kPi * dot(off, off) < kSideRadii * kSideRadii * s.area;
  off -= dot(off, s.normal) * s.normal;
  vec3 size = abs(off);
  bvec3 towards = greaterThan(size, vec3(0.5 * max(max(size.x, size.y), size.z)));
  ivec3 next = ivec3(sign(off));
  return (towards.x && voxelAt(grid, cell + ivec3(next.x, 0, 0)) != 0u) ||
         (towards.y && voxelAt(grid, cell + ivec3(0, next.y, 0)) != 0u) ||
         (towards.z && voxelAt(grid, cell + ivec3(0, 0, next.z)) != 0u);
}

// Cell of a walk along one axis after it has passed all walls before the distance t (also those at t, with `also`),
// corrected for rounding: `at` is that cell or a neighbour, next and before are the distances of the walls ahead of
// it and behind it.
int settle(int at, int from, int stride, float next, float before, float t, bool also) {
  bool more = also ? next <= t : next < t, less = at != from && (also ? before > t : before >= t);
  return at + (more ? stride : less ? -stride : 0);
}

// First side along a ray. origin: world space, m; direction: unit; normal: of the surface on which the ray starts,
// unit, on the side to which the ray goes (for a ray that starts on no surface, the direction itself). A side is hit if
// it faces the ray, is met within its cell and lies in front of the start's tangent plane; the last condition skips the
// ray's own surface and the back of a thin wall. If both sides of a voxel qualify, the one that faces the ray more is
// hit; a voxel without such a side is passed. A slit between sides is no hole in a wall: a ray that leaves the grid
// hits the last side through which it slipped, if any. What it passes beyond an edge, for example a lamp in the air, it
// does not hit.
//
// The walk goes from cell to cell through the nearest wall (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for
// Ray Tracing", Eurographics 1987). The distances to the walls follow from the cell's integer coordinates, so no
// error accumulates, and a zero direction component never reaches a wall. An empty brick is crossed in one step, to
// the same cell that single steps would reach; the brick bits are 1/32 of the index volume, which does not fit into a
// CPU's nearer caches. The walk takes at most 3R + 3 turns. A ray with a NaN hits nothing. far: cells that the ray
// enters beyond this distance (m) are ignored.
VoxelHit traceVoxels(VoxelGrid grid, vec3 origin, vec3 direction, vec3 normal, float far) {
  VoxelHit miss = VoxelHit(kNoSide, 0.0), slipped = miss;
  vec3 p = (origin - grid.origin) / grid.cell;  // in cells, as are all distances below
  float size = float(grid.resolution);
  // Rejects NaN, for which every comparison is false, and positions too far away for a float to resolve a cell.
  if (!(dot(abs(p), vec3(1.0)) < 1e6 && dot(direction, direction) > 0.5 &&
        dot(direction, direction) < 2.0))
    return miss;

  bvec3 moves = greaterThan(abs(direction), vec3(1e-7));  // a smaller component crosses no cell of any grid
  vec3 inverse = mix(vec3(0.0), 1.0 / direction, moves);
  vec3 never = mix(vec3(1e30), vec3(0.0), moves);
  // Interval in which the ray is inside the grid.
  bvec3 outside = bvec3(uvec3(lessThan(p, vec3(0.0))) | uvec3(greaterThan(p, vec3(size))));
  if (any(outside) && any(bvec3(uvec3(outside) & uvec3(not(moves))))) return miss;
  vec3 wallA = -p * inverse, wallB = (size - p) * inverse;
  vec3 enter = min(wallA, wallB) - never, leave = max(wallA, wallB) + never;
  float t = max(max(enter.x, enter.y), max(enter.z, 0.0));
  if (t > min(min(leave.x, leave.y), leave.z)) return miss;

  ivec3 cell = clamp(ivec3(floor(p + t * direction)), ivec3(0), ivec3(grid.resolution - 1));
  ivec3 stride = ivec3(sign(direction)) * ivec3(moves);
  vec3 ahead = vec3(greaterThan(direction, vec3(0.0)));  // the wall ahead: corner 0 or 1 of the cell
  uint brick = imageLoad(voxelsOccupied, occupiedBrick(cell)).r;
  bool inside = true, full = (brick & occupiedBit(cell)) != 0u;
  float front = -1.0;  // where the ray last left a cell in front of its side; behind that of the next it has slipped
  for (int turn = 0; inside;) {
    // Empty space is crossed in a loop of its own: a CPU device executes everything in a loop for all rays of a group
    // in every turn, and most cells are empty.
    for (; !full && inside; ++turn) {
      ivec3 low = brick == 0u ? cell & ~(kBrickCells - 1) : cell;
      ivec3 wide = min(brick == 0u ? kBrickCells : ivec3(1), grid.resolution - low);
      vec3 wall = vec3(low) + ahead * vec3(wide);  // where the ray leaves the empty space
      vec3 walls = (wall - p) * inverse + never;
      t = min(min(walls.x, walls.y), walls.z);
      bool throughX = walls.x == t, throughY = !throughX && walls.y == t;
      // Along the other axes, passes the walls that lie before this one; of equal ones first those of x, then of y.
      ivec3 last = mix(cell, low + max(stride, 0) * (wide - 1), moves);
      ivec3 at = clamp(ivec3(floor(p + t * direction)), min(cell, last), max(cell, last));
      vec3 next = (vec3(at) + ahead - p) * inverse + never, before = (vec3(at - stride) + ahead - p) * inverse + never;
      ivec3 on = ivec3(settle(at.x, cell.x, stride.x, next.x, before.x, t, !throughX),
                       settle(at.y, cell.y, stride.y, next.y, before.y, t, !throughX && !throughY),
                       settle(at.z, cell.z, stride.z, next.z, before.z, t, false));
      ivec3 out_ = low + mix(ivec3(-1), wide, greaterThan(stride, ivec3(0)));
      cell = ivec3(throughX ? out_.x : on.x, throughY ? out_.y : on.y, throughX || throughY ? on.z : out_.z);
      inside = turn < 3 * grid.resolution + 3 && t * grid.cell <= far &&
               all(lessThan(uvec3(cell), uvec3(grid.resolution)));
      brick = imageLoad(voxelsOccupied, inside ? occupiedBrick(cell) : ivec3(0)).r;
      full = (brick & occupiedBit(cell)) != 0u;
    }
    if (!inside) break;
    vec3 walls = (vec3(cell) + ahead - p) * inverse + never;
    float next = min(min(walls.x, walls.y), walls.z);
    uint side = 2u * (imageLoad(voxelsIndex, cell).r - 1u);
    float facing0, facing1, distance0, distance1;
    uint met0 = meetsSide(grid, side, origin, direction, normal, next * grid.cell, facing0, distance0);
    uint met1 = meetsSide(grid, side + 1u, origin, direction, normal, next * grid.cell, facing1, distance1);
    uint met = max(met0, met1);
    if (met != kNotMet) {
      bool second = met1 > met0 || (met1 == met0 && facing1 < facing0);
      float plane = second ? distance1 : distance0;
      VoxelHit hit = VoxelHit(second ? side + 1u : side, clamp(plane, t * grid.cell, max(t, next) * grid.cell));
      if (met == kMet) return hit;
      bool beyond = plane > next * grid.cell;
      if (plane < t * grid.cell ? front == t
                                : slipsThrough(grid, cell, hit.side, origin + plane * direction, beyond))
        slipped = hit;
      if (beyond) front = next;
    }
    full = false;  // on to the next cell
  }
  if (t * grid.cell > far) return miss;
  return slipped;
}

// The same without an end.
VoxelHit traceVoxels(VoxelGrid grid, vec3 origin, vec3 direction, vec3 normal) {
  return traceVoxels(grid, origin, direction, normal, 1e30);
}

#endif
