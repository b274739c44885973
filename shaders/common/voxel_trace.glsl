// Rays through the voxels: the first surface that one meets. The same formulas as framework/scene/voxel_trace.h.
// Needs common/scene.glsl and an input port `voxels` (index as Usage::Sampled, surface as Usage::TexelRead); its bindings
// number themselves.
#ifndef FOVEA_VOXEL_TRACE_GLSL
#define FOVEA_VOXEL_TRACE_GLSL

#include "common/voxel.glsl"
#include "common/vpl.glsl"

layout(set = 0) uniform utexture3D voxelsIndex;
layout(set = 0) uniform samplerBuffer voxelsSurface;

// The grid of the bundle that is wired.
VoxelGrid voxelsGrid() { return voxelGrid(uint(textureSize(voxelsIndex, 0).x)); }

// Number of the voxel in a cell plus 1; 0: empty, or outside the grid.
uint voxelAt(VoxelGrid grid, ivec3 cell) { return insideGrid(grid, cell) ? texelFetch(voxelsIndex, cell, 0).r : 0u; }

VoxelSide loadSide(uint side) {
  int first = int(side) * kVoxelSideTexels;
  vec4 positionArea = texelFetch(voxelsSurface, first), normalObject = texelFetch(voxelsSurface, first + 1);
  return VoxelSide(positionArea.xyz, positionArea.w, normalObject.xyz, normalObject.w,
                   texelFetch(voxelsSurface, first + 2).rgb, texelFetch(voxelsSurface, first + 3).rgb);
}

struct VoxelHit {
  uint side;       // kNoSide: the ray leaves the grid
  float distance;  // along the ray, m: where it meets the side's plane, kept within the voxel
};

// Smallest distance of a hit from the plane the ray starts on, in cells. Voxels of the own surface reach out of its plane
// by rounding only (the average position of a plane lies on it), curved ones by a little.
const float kOwnSurface = 0.25;

// Can the ray hit this side? Only its front, and only where it is not what the ray starts from.
bool facesRay(VoxelGrid grid, uint side, vec3 origin, vec3 direction, vec3 normal, out float facing, out float distance) {
  int first = int(side) * kVoxelSideTexels;
  vec4 positionArea = texelFetch(voxelsSurface, first);
  vec3 sideNormal = texelFetch(voxelsSurface, first + 1).xyz;
  vec3 to = positionArea.xyz - origin;
  facing = dot(sideNormal, direction);
  distance = facing < 0.0 ? dot(to, sideNormal) / facing : 0.0;
  return positionArea.w > 0.0 && facing < 0.0 && dot(to, normal) > kOwnSurface * grid.cell;
}

// First side along a ray. direction: unit; normal: of the surface the ray starts on, unit, pointing to where the ray goes
// (a ray that starts on no surface: the direction itself). A side is hit that faces the ray and lies in front of the
// start's tangent plane: that skips the own surface and the back of an own thin wall. If both sides of a voxel qualify, it
// is the one that faces the ray more; a voxel without such a side is passed.
//
// The walk goes from cell to cell through the nearest wall (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray
// Tracing", Eurographics 1987); the distances to the walls follow from the cell's whole numbers, so no error adds up, and
// a direction component of 0 never comes to a wall. At most 3R + 3 turns; anything that is not a number hits nothing.
// far: cells that the ray enters beyond this distance (m) are not looked at.
VoxelHit traceVoxels(VoxelGrid grid, vec3 origin, vec3 direction, vec3 normal, float far) {
  VoxelHit miss = VoxelHit(kNoSide, 0.0);
  vec3 p = (origin - grid.origin) / grid.cell;  // in cells, as are all distances below
  float size = float(grid.resolution);
  // Not a number, and too far away for a float to know a cell: false in every comparison.
  if (!(dot(abs(p), vec3(1.0)) < 1e6 && dot(direction, direction) > 0.5 && dot(direction, direction) < 2.0)) return miss;

  bvec3 moves = greaterThan(abs(direction), vec3(1e-7));  // slower crosses no cell of any grid
  vec3 inverse = mix(vec3(0.0), 1.0 / direction, moves);
  vec3 never = mix(vec3(1e30), vec3(0.0), moves);
  // Where the ray is inside the grid.
  bvec3 outside = bvec3(uvec3(lessThan(p, vec3(0.0))) | uvec3(greaterThan(p, vec3(size))));
  if (any(outside) && any(bvec3(uvec3(outside) & uvec3(not(moves))))) return miss;
  vec3 wallA = -p * inverse, wallB = (size - p) * inverse;
  vec3 enter = min(wallA, wallB) - never, leave = max(wallA, wallB) + never;
  float t = max(max(enter.x, enter.y), max(enter.z, 0.0));
  if (t > min(min(leave.x, leave.y), leave.z)) return miss;

  ivec3 cell = clamp(ivec3(floor(p + t * direction)), ivec3(0), ivec3(grid.resolution - 1));
  ivec3 stride = ivec3(sign(direction)) * ivec3(moves);
  vec3 ahead = vec3(greaterThan(direction, vec3(0.0)));  // the wall ahead: corner 0 or 1 of the cell
  for (int turn = 0; turn < 3 * grid.resolution + 3; ++turn) {
    uint voxel = texelFetch(voxelsIndex, cell, 0).r;
    vec3 walls = (vec3(cell) + ahead - p) * inverse + never;
    float next = min(min(walls.x, walls.y), walls.z);
    if (voxel != 0u) {
      uint side = 2u * (voxel - 1u);
      float facing0, facing1, distance0, distance1;
      bool hit0 = facesRay(grid, side, origin, direction, normal, facing0, distance0);
      bool hit1 = facesRay(grid, side + 1u, origin, direction, normal, facing1, distance1);
      if (hit0 || hit1) {
        bool second = hit1 && !(hit0 && facing0 <= facing1);
        return VoxelHit(second ? side + 1u : side,
                        clamp(second ? distance1 : distance0, t * grid.cell, max(t, next) * grid.cell));
      }
    }
    bool throughX = walls.x == next, throughY = !throughX && walls.y == next;
    cell.x += throughX ? stride.x : 0;
    cell.y += throughY ? stride.y : 0;
    cell.z += throughX || throughY ? 0 : stride.z;
    t = next;
    if (any(greaterThanEqual(uvec3(cell), uvec3(grid.resolution))) || t * grid.cell > far) break;
  }
  return miss;
}

VoxelHit traceVoxels(VoxelGrid grid, vec3 origin, vec3 direction, vec3 normal) {
  return traceVoxels(grid, origin, direction, normal, 1e30);
}

#endif
