#extension GL_EXT_control_flow_attributes : require
// Triangles of few columns, one per invocation. Counts the chunks of the others.
#include "voxelize/visit.glsl"

layout(local_size_x = 64) in;

#if !ACCUMULATE
layout(std430) writeonly buffer ChunksBlock { uint list[]; } chunks;
#endif

void main() {
  uint i = groupIndex() * 64u + gl_LocalInvocationIndex;
  if (i >= constants.triangleCount) return;
  uvec4 indices = sceneTriangle(constants.firstTriangle + i);
  CellTriangle t = loadCellTriangle(voxelGrid(constants.resolution), indices);
  uint columns = columnCount(t);
  bool large = columns > kSmallColumns;
#if !ACCUMULATE
  chunks.list[i] = large ? (columns + kChunkColumns - 1u) / kChunkColumns : 0u;
#endif
  if (large) return;
  Material material = loadMaterial(materialOf(indices));
  for (uint column = 0u; column < columns; ++column)
    visitColumn(t, constants.firstTriangle + i, indices, material, column);
}
