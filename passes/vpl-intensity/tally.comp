// Computes the totals on which the areas depend, VPLs alive and surface of the voxels; marks the bricks that contain
// sides (for `area`: sides to assign); and for `area` lists the VPLs that compete for them. Defines: AREA 0/1: the
// strategy is `area`; LIT_ONLY 0/1: only lit sides count.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer vpls;
layout(std140) uniform VoxelsInfoBlock { VoxelInfo value; } voxelsInfo;
layout(std430) buffer BricksBlock { uint list[]; } bricks;
layout(std430) buffer TotalsBlock { Totals value; } totals;
#if AREA
LARGE_TEXELS(vec4, radiance);
layout(std430) writeonly buffer SitesBlock { VplSite list[]; } sites;
#endif

layout(push_constant) uniform Constants {
  uint vplCount;
  uint sideCapacity;
};

#if AREA
bool litSide(uint side) { return side < sideCapacity && texelOf(radiance, int(side)).w > 0.0; }
#endif

void tallyVpls(uint first, uint stride) {
  uint alive = 0u;
  for (uint i = first; i < vplCount; i += stride) {
    VplState vpl = loadVplState(vpls, i);
    bool there = vpl.life > 0.0;
    alive += uint(there);
#if AREA
    bool competes = there && (LIT_ONLY == 0 || litSide(vpl.side));
    sites.list[i] = VplSite(vpl.position, competes ? 1.0 : 0.0, vpl.normal, 0.0);
#endif
  }
  if (alive > 0u) atomicAdd(totals.value.alive, alive);
}

void tallySides(uint first, uint stride) {
  VoxelGrid grid = voxelsGrid();
  uint low = 0u, high = 0u, sides = min(2u * voxelsInfo.value.voxels, sideCapacity);
  for (uint i = first; i < sides; i += stride) {
    VoxelSide side = loadSide(i);
    if (!(side.area > 0.0)) continue;
    uint units = areaUnits(grid, side.area);
    low += units;
    high += uint(low < units);
#if AREA && LIT_ONLY
    if (!litSide(i)) continue;
#endif
    atomicOr(bricks.list[brickIndex(grid, brickOf(grid, side.position))], 1u);
  }
  ADD_WIDE(totals.value.areaLow, totals.value.areaHigh, low);
  if (high > 0u) atomicAdd(totals.value.areaHigh, high);
}

void main() {
  uint first = gl_GlobalInvocationID.x, stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  tallyVpls(first, stride);
  tallySides(first, stride);
}
