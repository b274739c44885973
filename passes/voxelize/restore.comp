// Removes last frame's voxels of dynamic objects: the voxels they hid reappear, and their cells lose their marks.
#include "scene/scene.glsl"
#include "voxels/voxel.glsl"
#include "voxelize/state.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer StateBlock { State value; } state;
layout(std430) readonly buffer CellsBlock { uvec2 list[]; } cells;
layout(std430) writeonly buffer MarksBlock { uint words[]; } marks;
layout(std430) writeonly buffer VoxelsSurfaceBlock { VoxelSide sides[]; } voxelsSurface;
layout(r32ui) uniform writeonly uimage3D voxelsIndex;
layout(r32ui) uniform uimage3D voxelsOccupied;

layout(push_constant) uniform Constants { uint resolution; };

void main() {
  uint side = groupIndex() * 64u + gl_LocalInvocationIndex;
  if (side >= 2u * state.value.phases[1].voxels) return;
  uint voxel = state.value.phases[1].first + side / 2u;
  voxelsSurface.sides[2u * voxel + side % 2u] = kNoSurface;
  if (side % 2u != 0u) return;
  uvec2 entry = cells.list[voxel];
  marks.words[entry.x / 32u] = 0u;
  ivec3 cell = ivec3(entry.x % resolution, entry.x / resolution % resolution, entry.x / (resolution * resolution));
  imageStore(voxelsIndex, cell, uvec4(entry.y));
  if (entry.y == 0u) imageAtomicAnd(voxelsOccupied, occupiedBrick(cell), ~occupiedBit(cell));
}
