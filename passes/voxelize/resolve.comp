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
vec3 sums3At(uint word) { return vec3(sumAt(word), sumAt(word + 2u), sumAt(word + 4u)); }

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
  // As seen along the axis of its side, the surface covers no more than a face of the cell, and what lies behind its
  // emissive part does not dim it.
  float face = 4294967296.0 / max(max(abs(normal.x), abs(normal.y)), abs(normal.z));
  float emissive = (sumAt(word + 14u) - area) / (kEmissiveWeight - 1.0);
  vec3 emission = sums3At(word + 8u) / max(emissive, min(area, face));
  float object = float(0xffffu - (sums.words[word + 28u] & 0xffffu));
  uint piece = sums.words[word + 29u], mask = (1u << kTriangleBits) - 1u;
  float triangle = piece == 0u ? 0.0 : float(mask - (piece & mask));  // below 2^24: exact
  voxelsSurface.sides[2u * voxel + side] =
      VoxelSide(position, area * (1.0 / 4294967296.0) * grid.cell * grid.cell, normal, object,
                sums3At(word + 2u) * inverse, triangle, emission, 0.0);
}
