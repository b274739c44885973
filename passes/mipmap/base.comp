// Level 0 of the mips: the 2x2x2 voxels of each cell, seen from six sides or from all directions at once.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "voxels/voxel_trace.glsl"
#include "mipmap/combine.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;

layout(rgba16f) uniform image3D mipsColor;
LARGE_TEXELS(vec4, radiance);
#if WEIGHTED
layout(r16f) uniform writeonly image3D mipsWeight;
LARGE_TEXELS(float, weights);
#endif
#if KEEPS
LARGE_TEXELS(uint, changed);
#include "scene/movers.glsl"
#include "mipmap/dirty.glsl"

layout(push_constant) uniform Constants {
  vec4 movers[2u * kMoverBoxes];
  uint all_;  // 1: nothing is kept from the last frame
};
#endif

// What a voxel shows towards a face; coverage is the side's projected area relative to the voxel's face.
Cell voxelTowards(uint voxel, int face, float faceArea) {
  Cell sum = kEmpty;
  if (voxel == 0u) return sum;
  for (uint i = 0u; i < 2u; ++i) {
    int side = int(2u * (voxel - 1u) + i);
    VoxelSide surface = loadSide(uint(side));
    float coverage = sendingArea(surface) / faceArea;
#if DIRECTIONAL
    float along = face < 2 ? surface.normal.x : face < 4 ? surface.normal.y : surface.normal.z;
    coverage *= max((face & 1) == 0 ? along : -along, 0.0);
#endif
    if (coverage <= 0.0) continue;
    sum.color += coverage * vec4(texelOf(radiance, side).rgb, 1.0);
#if WEIGHTED
    sum.weight += coverage * texelOf(weights, side).r;
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
    voxels[i] = ODD != 0 ? voxelAt(grid, at) : imageLoad(voxelsIndex, at).r;
    any_ |= voxels[i];
  }
  float faceArea = grid.cell * grid.cell;
  bool anew = true;
#if KEEPS
  // Voxels appear and vanish where something moves; the margin is needed because a voxel may lie slightly outside
  // of what it contains.
  vec3 low = voxelToWorld(grid, 2.0 * vec3(cell) - 1.0), high = voxelToWorld(grid, 2.0 * vec3(cell) + 3.0);
  anew = all_ != 0u;
  for (uint i = 0u; i < kMoverBoxes; ++i)
    anew = anew || (all(lessThanEqual(low, movers[2u * i + 1u].xyz)) &&
                     all(greaterThanEqual(high, movers[2u * i].xyz)));
  for (int i = 0; i < (any_ != 0u ? 8 : 0); ++i) {
    int side = 2 * int(max(voxels[i], 1u) - 1u);
    uint new_ = texelOf(changed, side).x | texelOf(changed, side + 1).x;
    anew = anew || (voxels[i] != 0u && new_ != 0u);
  }
  if (anew) markDirty(0u, size / 2, cell / 2);
#endif
  for (int face = 0; face < (anew ? kFaces : 0); ++face) {
    Cell sum = kEmpty;
    for (int column = 0; column < 4 && any_ != 0u; ++column)
      sum = add(sum, behind(voxelTowards(voxels[nearChild(face, column)], face, faceArea),
                            voxelTowards(voxels[farChild(face, column)], face, faceArea)));
    ivec3 texel = cell + ivec3(face * size, 0, 0);
    // Most cells are empty and stay so. Storing is the costly part (on lavapipe 10 times a load).
    if (sum.color.a <= 0.0 && imageLoad(mipsColor, texel).a <= 0.0) continue;
    imageStore(mipsColor, texel, stored(0.25 * sum.color));
#if WEIGHTED
    imageStore(mipsWeight, texel, stored(vec4(0.25 * sum.weight)));
#endif
  }
}
