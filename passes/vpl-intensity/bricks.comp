// Strategy `area`, first step: which VPLs can be nearest to a side in a brick: those whose smallest possible distance
// is no more than the least of the largest possible ones. One bit per VPL; one invocation per brick.
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;

uniform samplerBuffer sites;
layout(std430) readonly buffer TotalsBlock { Totals value; } totals;
layout(std430) readonly buffer BricksBlock { uint list[]; } bricks;
layout(std430) writeonly buffer MasksBlock { uint list[]; } masks;

layout(push_constant) uniform Constants {
  uint vplCount;
  float normalShare;
};

void main() {
  VoxelGrid grid = voxelsGrid();
  ivec3 brick = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(brick, brickGrid(grid)))) return;
  uint index = brickIndex(grid, brick), words = (vplCount + 31u) / 32u;
  if (bricks.list[index] == 0u) return;
  // Slightly wider, as average positions may lie outside their cell because of rounding.
  vec3 low = voxelToWorld(grid, vec3(brick * kBrick) - 0.01),
       high = voxelToWorld(grid, vec3((brick + 1) * kBrick) + 0.01);
  float nearest = 1e38;
  for (uint i = 0u; i < vplCount; ++i) {
    VplSite site = loadSite(sites, i);
    vec3 far = max(abs(site.position - low), abs(site.position - high));
    nearest = min(nearest, site.handicap > 0.0 ? dot(far, far) : 1e38);
  }
  // Normals add at most twice their weight.
  float limit = nearest + 2.001 * normalWeight(grid, normalShare, totals.value.areaLow, totals.value.areaHigh);
  for (uint word = 0u; word < words; ++word) {
    uint bits = 0u;
    for (uint i = 32u * word; i < min(32u * word + 32u, vplCount); ++i) {
      VplSite site = loadSite(sites, i);
      vec3 gap = max(max(low - site.position, site.position - high), vec3(0.0));
      if (site.handicap > 0.0 && dot(gap, gap) <= limit) bits |= 1u << (i & 31u);
    }
    masks.list[index * words + word] = bits;
  }
}
