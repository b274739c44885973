// Strategy `area`, second step: every side gives its area to the nearest VPL, by d^2 + lambda (1 - n.n')
// (passes/README.md, vpl-intensity); the lowest slot wins a tie. One invocation per side.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

LARGE_TEXELS(vec4, radiance);
uniform samplerBuffer sites;
LARGE_TEXELS(uint, masks);
layout(std140) uniform VoxelsInfoBlock { VoxelInfo value; } voxelsInfo;
layout(std430) readonly buffer TotalsBlock { Totals value; } totals;
layout(std430) buffer SumsBlock { uvec2 list[]; } sums;
layout(std430) buffer CountersBlock { uint alive, givenSides; } counters;

layout(push_constant) uniform Constants {
  uint vplCount;
  uint sideCapacity;
  float normalShare;
};

void main() {
  uint number = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (number >= min(2u * voxelsInfo.value.voxels, sideCapacity)) return;
  VoxelSide side = loadSide(number);
  if (!(side.area > 0.0)) return;
#if LIT_ONLY
  if (!(texelOf(radiance, int(number)).w > 0.0)) return;
#endif
  VoxelGrid grid = voxelsGrid();
  float lambda = normalWeight(grid, normalShare, totals.value.areaLow, totals.value.areaHigh);
  uint words = (vplCount + 31u) / 32u, first = brickIndex(grid, brickOf(grid, side.position)) * words;
  float best = 1e38;
  uint owner = kNoSide;
  for (uint word = 0u; word < words; ++word)
    for (uint bits = texelOf(masks, int(first + word)).r; bits != 0u; bits &= bits - 1u) {
      uint i = 32u * word + uint(findLSB(bits));
      VplSite site = loadSite(sites, i);
      vec3 d = site.position - side.position;
      precise float cost = dot(d, d) + lambda * (1.0 - dot(side.normal, site.normal));
      if (cost < best) {
        best = cost;
        owner = i;
      }
    }
  if (owner == kNoSide) return;  // no VPL competes
  uint units = areaUnits(grid, sendingArea(side));
  ADD_WIDE(sums.list[owner].x, sums.list[owner].y, units);
  atomicAdd(counters.givenSides, 1u);
}
