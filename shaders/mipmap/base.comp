#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Level 0 of the mips: the 2x2x2 voxels of each cell, seen from six sides or from all at once.
#include "common/scene.glsl"
#include "common/voxel_trace.glsl"
#include "mipmap/combine.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;

layout(set = 0, rgba16f) uniform image3D mipsColor;
layout(set = 0, r16f) uniform writeonly image3D mipsWeight;
layout(set = 0) uniform samplerBuffer radiance;
#if WEIGHTED
layout(set = 0) uniform samplerBuffer weights;
#endif

// What a voxel shows towards a face: coverage is the side's projected area by that of the voxel's face.
Cell voxelTowards(uint voxel, int face, float faceArea) {
  Cell sum = kEmpty;
  if (voxel == 0u) return sum;
  for (uint i = 0u; i < 2u; ++i) {
    int side = int(2u * (voxel - 1u) + i);
    float coverage = texelFetch(voxelsSurface, kVoxelSideTexels * side).w / faceArea;
#if DIRECTIONAL
    vec3 normal = texelFetch(voxelsSurface, kVoxelSideTexels * side + 1).xyz;
    float along = face < 2 ? normal.x : face < 4 ? normal.y : normal.z;
    coverage *= max((face & 1) == 0 ? along : -along, 0.0);
#endif
    if (coverage <= 0.0) continue;
    sum.color += coverage * vec4(texelFetch(radiance, side).rgb, 1.0);
#if WEIGHTED
    sum.weight += coverage * texelFetch(weights, side).r;
#endif
  }
  return sum;
}

void main() {
  VoxelGrid grid = voxelsGrid();
  int size = (grid.resolution + 1) / 2;
  ivec3 cell = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(cell, ivec3(size)))) return;
  uint voxels[8];
  uint any_ = 0u;
  for (int i = 0; i < 8; ++i) {
    ivec3 at = 2 * cell + ivec3(i & 1, i >> 1 & 1, i >> 2);
    voxels[i] = ODD != 0 ? voxelAt(grid, at) : texelFetch(voxelsIndex, at, 0).r;
    any_ |= voxels[i];
  }
  float faceArea = grid.cell * grid.cell;
  for (int face = 0; face < kFaces; ++face) {
    Cell sum = kEmpty;
    for (int column = 0; column < 4 && any_ != 0u; ++column)
      sum = add(sum, behind(voxelTowards(voxels[nearChild(face, column)], face, faceArea),
                            voxelTowards(voxels[farChild(face, column)], face, faceArea)));
    ivec3 texel = cell + ivec3(face * size, 0, 0);
    // Most cells are empty and have been so. Storing is what costs (on lavapipe 10 times a look).
    if (sum.color.a <= 0.0 && imageLoad(mipsColor, texel).a <= 0.0) continue;
    imageStore(mipsColor, texel, stored(0.25 * sum.color));
    imageStore(mipsWeight, texel, stored(vec4(0.25 * sum.weight)));
  }
}
