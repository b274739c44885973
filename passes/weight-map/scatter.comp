#extension GL_KHR_shader_subgroup_arithmetic : require
// Every pixel gives its foveated weight to the voxel side in which its surface point lies; a side keeps the largest
// weight (passes/vpls.md, weight-map), so the result does not depend on the order. Defines: WHOLE_IMAGE 0/1;
// FROM_CENTRE 0/1, whether weights fall off from the gaze on and not from the edge of the fovea; BLOCK, pixels per
// invocation along an axis; GROUP, invocations per work group along an axis.
#include "scene/scene.glsl"
#include "sampling/fovea.glsl"
#include "voxels/voxel_trace.glsl"
#include "screen/gbuffer.glsl"

// An invocation processes a block of pixels row by row, alternating in direction. Neighbours mostly show the same
// side, so a run of them costs one look-up of the side and one atomic. A run is a loop of its own, as a CPU device
// executes everything in a loop in every turn. The loops end at their heads: SwiftShader gives an invocation that has
// left a loop at its foot the values of those that go on.
const int kBlock = BLOCK;

layout(local_size_x = GROUP, local_size_y = GROUP) in;

SURFACES(gbuffer, surfaceAt)
layout(rg16_snorm) uniform readonly image2D gbufferFace;
layout(std430) buffer Weights { uint weights[]; };    // bits of non-negative floats, which are ordered as the floats
layout(std430) buffer Counters { uint counters[]; };  // visible, unassigned

layout(push_constant) uniform Constants {
  int spacing;        // one pixel in each square of this width is looked at
#if !WHOLE_IMAGE
  float foveaRadius;  // image widths
#endif
};

// The side in which a surface point lies; if that is empty (rounding decides on the border of a cell), the voxel's
// other side, provided that it faces the eye.
uint seenSide(VoxelGrid grid, ivec3 cell, uint exact) {
  uint voxel = voxelAt(grid, cell);
  if (voxel == 0u) return kNoSide;
  uint side = 2u * (voxel - 1u) + exact;
  if (loadSide(side).area > 0.0) return side;
  side ^= 1u;
  VoxelSide s = loadSide(side);
  return s.area > 0.0 && dot(s.normal, view.eye - s.position) > 0.0 ? side : kNoSide;
}

// Returns 1 for the first weight that a side gets.
uint give(uint side, float weight) {
  if (side == kNoSide) return 0u;
  return atomicMax(weights[side], floatBitsToUint(weight)) == 0u ? 1u : 0u;
}

struct Seen {
  ivec2 pixel;
  bool surface;  // neither background nor outside the image
  ivec3 cell;
  uint facing;
};

Seen seenAt(VoxelGrid grid, ivec2 first, int i, ivec2 size) {
  Seen seen;
  int row = i / kBlock, column = i % kBlock;
  seen.pixel = spacing * (first + ivec2((row & 1) == 0 ? column : kBlock - 1 - column, row));
  vec4 position = surfaceAt(min(seen.pixel, size - 1));
  seen.surface = i < kBlock * kBlock && all(lessThan(seen.pixel, size)) && position.w > 0.0;
  seen.cell = ivec3(floor(worldToVoxel(grid, position.xyz)));
  seen.facing = voxelSideOf(octDecode(imageLoad(gbufferFace, min(seen.pixel, size - 1)).xy));
  return seen;
}

void main() {
  ivec2 size = imageSize(gbufferDistance);
  ivec2 first = ivec2(gl_GlobalInvocationID.xy) * kBlock;
  VoxelGrid grid = voxelsGrid();
#if !WHOLE_IMAGE
  Fovea fovea = makeFovea(view.gaze, vec2(size), foveaRadius);
  if (FROM_CENTRE != 0) fovea.radius = 1.0;
#endif
  uint visible = 0u, unassigned = 0u;
  Seen next = seenAt(grid, first, 0, size);
  int i = 0;
  while (i < kBlock * kBlock) {
    Seen run = next;
    float weight = 0.0;
    uint pixels = 0u;
    while (i < kBlock * kBlock && next.surface == run.surface && next.cell == run.cell && next.facing == run.facing) {
#if WHOLE_IMAGE
      weight = 1.0;
#else
      weight = max(weight, foveaWeight(fovea, vec2(next.pixel) + 0.5));
#endif
      ++pixels;
      next = seenAt(grid, first, ++i, size);
    }
    uint side = run.surface ? seenSide(grid, run.cell, run.facing) : kNoSide;
    visible += give(side, weight);
    unassigned += run.surface && side == kNoSide ? pixels : 0u;
  }
  visible = subgroupAdd(visible);
  unassigned = subgroupAdd(unassigned);
  if (subgroupElect()) {
    if (visible > 0u) atomicAdd(counters[0], visible);
    if (unassigned > 0u) atomicAdd(counters[1], unassigned);
  }
}
