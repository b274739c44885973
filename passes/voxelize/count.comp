// The sizes of the list, as counters, also in frames that voxelise nothing.
#include "scene/scene.glsl"
#include "voxels/voxel.glsl"

layout(local_size_x = 1) in;

layout(std430) readonly buffer VoxelsInfoBlock { VoxelInfo value; } voxelsInfo;
layout(std430) writeonly buffer CountersBlock { uint voxels, staticVoxels, overflow; } counters;

void main() {
  counters.voxels = voxelsInfo.value.voxels;
  counters.staticVoxels = voxelsInfo.value.staticVoxels;
  counters.overflow = voxelsInfo.value.overflow;
}
