// Strategy `importance-area`, first step: p_l, the light that the region receives from a VPL per area and radiosity,
// and with it which VPLs are seen at all. One work group per VPL.
//
// p_l is the mean over the region's points s of   cos_s cos_l V / (pi d^2 + cell^2);   discs.comp later replaces the
// disc of a cell by that of the VPL's own area. V is the visibility that pass deferred uses, a look-up in the VPL's
// own shadow map: with any other visibility (such as rays through voxels), VPLs would be compensated for light that
// they do not lose, or not for light that they do. Points that show the background count as dark.
// Define: CHANGE 0/1: whether changes of the light are known.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "vpls/paraboloid.glsl"
#include "vpls/vpl_shadow.glsl"
#include "vpl-intensity/vpl_intensity.glsl"
#include "vpl-intensity/landing.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer vpls;
uniform samplerBuffer placed;
layout(r32ui) uniform readonly uimage2DArray atlas;
#if CHANGE
uniform samplerBuffer change;  // z: share of what was known of the light that is lost
#endif
layout(std430) writeonly buffer DensitiesBlock { float list[]; } densities;

LARGE_TEXELS(vec4, radiance);
layout(std430) writeonly buffer SitesBlock { VplSite list[]; } sites;
layout(std430) writeonly buffer SeenBlock { uint words[]; } seen;   // see landing.glsl
layout(std430) writeonly buffer SeenFromBlock { float list[]; } seenFrom;

layout(push_constant) uniform Constants {
  uint vplCount;
  uint points;
  float nearest;  // m; if above 0, smaller distances count as this one, as for the kernel `clamp`
  uint fadeFrames;
};

shared vec3 sums[64];

struct Map {
  uint slot;
  vec3 position;
  mat3 frame;  // the VPL's
  AtlasLayout layout_;
};

// The same test as in pass deferred.
bool sees(Map map, vec3 point, vec3 face) {
  vec3 local = toLocal(map.frame, point - map.position), tilt = toLocal(map.frame, face);
  float len = length(local);
  ivec2 texel = paraboloidTexel(paraboloidProject(local, len), map.layout_.size);
  float stored = uintBitsToFloat(imageLoad(atlas, atlasTexel(map.slot, texel, map.layout_)).x);
  return vplSees(stored, dot(tilt, local), len, len + local.z, tilt, texel, map.layout_.size, 1.0);
}

// Sum of the terms of p_l, of their squares, and of the terms without the clamp.
vec3 seenSum(float area, uint slot, uint lane) {
  Vpl vpl = loadVpl(placed, slot);
  Map map = Map(slot, vpl.position, orthonormalFrame(vpl.normal), atlasLayout(imageSize(atlas)));
  vec3 sum = vec3(0.0);
  uint bits = 0u, turn = 0u;
  for (uint i = lane; i < points; i += 64u, ++turn) {
    float p = landing(i, vpl.position, vpl.normal, area, nearest);
    EyePathStart from = loadStart(screen, i);
    bool seen_ = p > 0.0 && sees(map, from.position, from.face);
    float free_ = nearest > 0.0 ? landing(i, vpl.position, vpl.normal, area, 0.0) : p;
    sum += seen_ ? vec3(p, p * p, free_) : vec3(0.0);
    bits |= seen_ ? 1u << (turn & 31u) : 0u;
    if ((turn & 31u) == 31u || i + 64u >= points) {
      seen.words[(slot * 64u + lane) * laneWords(points) + turn / 32u] = bits;
      bits = 0u;
    }
  }
  return sum;
}

void main() {
  uint slot = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x, lane = gl_LocalInvocationIndex;
  bool inside = slot < vplCount;
  uint within = min(slot, vplCount - 1u);
  VplState vpl = loadVplState(vpls, within);
  // Also excludes VPLs that pass vpl-origins has emptied because of a value that is not finite.
  bool wanted = inside && vpl.life > 0.0 && loadVpl(placed, within).area > 0.0;
  VoxelGrid grid = voxelsGrid();
  sums[lane] = wanted ? seenSum(grid.cell * grid.cell, slot, lane) : vec3(0.0);
  barrier();
  for (uint half_ = 32u; half_ > 0u; half_ /= 2u) {  // a tree, so that the order is always the same
    if (lane < half_) sums[lane] += sums[lane + half_];
    barrier();
  }
  if (lane != 0u || !inside) return;
  seenFrom.list[slot] = sums[0].y > 0.0 ? sums[0].x * sums[0].x / sums[0].y : 0.0;
  float sum = max(sums[0].x, sums[0].z / kMostGain);
  densities.list[slot] = sum / float(points);
  int side = int(vpl.side);
  float light = side >= 0 && side < texelsIn(radiance) ? texelOf(radiance, side).w : 0.0;
  if (light > 0.0 && siteKind(light, luminanceOf(loadSide(uint(side)).emission)) == kShining) light = -light;
  // A new VPL is put at a disadvantage of up to 1 / (N p_l), the area it would have, so that it grows from nothing.
  float young = fadeFrames > 0u ? max(1.0 - vpl.life / float(fadeFrames + 1u), 0.0) : 0.0;
#if CHANGE
  young *= 1.0 - texelFetch(change, 0).z;
#endif
  float handicap = sum > 0.0 ? min(young * float(points) / (sum * float(vplCount)), 1e10) : -1.0;
  sites.list[slot] = VplSite(vpl.position, handicap, vpl.normal, light);
}
