#extension GL_EXT_control_flow_attributes : require
// Triangles of many columns, one work group per chunk of columns. The load is balanced, and no
// invocation loops for long.
#include "voxelize/visit.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer ChunksBlock { uint list[]; } chunks;  // exclusive prefix sums
#if !ACCUMULATE
layout(std430) readonly buffer StateBlock { State value; } state;
#endif

shared uint owner;

void main() {
  uint chunk = groupIndex();
  if (chunk >= state.value.chunks) return;
  if (gl_LocalInvocationIndex == 0u) {  // the last triangle that starts at or before the chunk
    uint low = 0u, high = constants.triangleCount;
    while (high - low > 1u) {
      uint middle = (low + high) / 2u;
      if (chunks.list[middle] <= chunk) low = middle;
      else high = middle;
    }
    owner = low;
  }
  barrier();
  uvec4 indices = sceneTriangle(constants.firstTriangle + owner);
  CellTriangle t = loadCellTriangle(voxelGrid(constants.resolution), indices);
  Material material = loadMaterial(materialOf(indices));
  uint first = (chunk - chunks.list[owner]) * kChunkColumns, end = min(first + kChunkColumns, columnCount(t));
  for (uint column = first + gl_LocalInvocationIndex; column < end; column += 64u)
    visitColumn(t, constants.firstTriangle + owner, indices, material, column);
}
