// Turns sums into averages; one invocation per side.
#include "scene/scene.glsl"
#include "voxels/voxel.glsl"
#include "voxelize/state.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer StateBlock { State value; } state;
layout(std430) readonly buffer SumsBlock { uint words[]; } sums;
layout(std430) readonly buffer CellsBlock { uvec2 list[]; } cells;
layout(std430) writeonly buffer VoxelsSurfaceBlock { VoxelSide sides[]; } voxelsSurface;

layout(push_constant) uniform Constants {
  uint resolution;
  uint phase;
  uint base;   // first voxel of the batch, within the phase
  uint batch;  // voxels
};

float sumAt(uint word) { return float(sums.words[word + 1u]) * 4294967296.0 + float(sums.words[word]); }
// The difference of two sums, exact although they may be nearly equal.
float differenceAt(uint word, uint less) {
  uint borrow, low = usubBorrow(sums.words[word], sums.words[less], borrow);
  return float(sums.words[word + 1u] - sums.words[less + 1u] - borrow) * 4294967296.0 + float(low);
}
vec3 sums3At(uint word) { return vec3(sumAt(word), sumAt(word + 2u), sumAt(word + 4u)); }

// The area of a side that rays can hit (voxels/voxel_trace.glsl): the piece of its plane within the cell, but at most a
// disc of kSideRadii times the radius of its surface. Position, area and result are in cells.
float reachOf(vec3 position, vec3 normal, float area) {
  const float kSlices = 8.0, kRounding = 0.01;
  vec3 size = abs(normal);
  bool alongX = size.x >= size.y && size.x >= size.z, alongY = !alongX && size.y >= size.z;
  vec3 n = alongX ? normal.yzx : alongY ? normal.zxy : normal;
  vec3 p = alongX ? position.yzx : alongY ? position.zxy : position;
  vec2 slope = -n.xy / n.z;
  if (abs(slope.x) > abs(slope.y)) slope = slope.yx, p.xy = p.yx;
  slope.y = slope.y < 0.0 ? min(slope.y, -0.01) : max(slope.y, 0.01);  // flatter planes would magnify rounding
  float within = 0.0;  // share of the face over which the plane lies in the cell
  for (float slice = 0.5; slice < kSlices; slice += 1.0) {
    float height = p.z + slope.x * (slice / kSlices - p.x) - slope.y * p.y;
    vec2 ends = clamp((vec2(-kRounding, 1.0 + kRounding) - height) / slope.y, 0.0, 1.0);
    within += abs(ends.y - ends.x) / kSlices;
  }
  return min(within / abs(n.z), kSideRadii * kSideRadii * area);
}

void main() {
  uint entry = groupIndex() * 64u + gl_LocalInvocationIndex, word = entry * kSumWords;
  if (entry >= 2u * min(batch, state.value.phases[phase].voxels - min(base, state.value.phases[phase].voxels))) return;
  uint voxel = state.value.phases[phase].first + base + entry / 2u, side = entry % 2u;
  uint linear = cells.list[voxel].x;
  float area = sumAt(word);
  if (area == 0.0) {
    voxelsSurface.sides[2u * voxel + side] = kNoSurface;
    return;
  }
  VoxelGrid grid = voxelGrid(resolution);
  float inverse = 1.0 / area, inverseWeight = 1.0 / sumAt(word + 14u);
  uvec3 cell = uvec3(linear % resolution, linear / resolution % resolution, linear / (resolution * resolution));
  vec3 position = voxelToWorld(grid, vec3(cell) + sums3At(word + 16u) * inverseWeight);
  vec3 normal = sums3At(word + 22u) * inverseWeight - 1.0;
  // The normals of one side can cancel if three or more meet; any direction on that side will do.
  float len = length(normal);
  normal = len > 1e-3 ? normal / len : vec3(side == 0u ? 0.57735027 : -0.57735027);
  vec3 emission = vec3(0.0);
  float emissionArea = 0.0;  // in units of area
  float emissive = differenceAt(word + 14u, word) / (kEmissiveWeight - 1.0);
  if (emissive > 0.0) {
    float reach = 4294967296.0 * reachOf(sums3At(word + 16u) * inverseWeight, normal, area / 4294967296.0);
    emissionArea = max(emissive, reach);
    emission = sums3At(word + 8u) / emissionArea;
  }
  float object = float(0xffffu - (sums.words[word + 28u] & 0xffffu));
  uint piece = sums.words[word + 29u], mask = (1u << kTriangleBits) - 1u;
  float triangle = piece == 0u ? 0.0 : float(mask - (piece & mask));  // below 2^24: exact
  float unit = grid.cell * grid.cell / 4294967296.0;
  voxelsSurface.sides[2u * voxel + side] = VoxelSide(position, area * unit, normal, object, sums3At(word + 2u) * inverse,
                                                     triangle, emission, emissionArea * unit);
}
