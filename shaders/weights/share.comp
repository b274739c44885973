// Strategy `importance-area`: every eye path goes to the VPL nearest to its end, by d^2 + lambda (1 - n.n'), a lit one if the
// end is lit.
//
// The light that the region gets by way of a piece of surface C is the integral of B p over C: what the eye paths that end
// there find, summed and divided by their number M. A VPL with the flux F sends it F p_l. So F = (sum of B over its n
// paths) / (M p_l) keeps that light, whatever picked the VPLs; p_l is the only thing that has to be estimated. It has to be
// what the region gets from the VPL as that is shaded: with the VPL's own shadow map (seen.comp), with its own disc
// (discs.comp) or, where that is asked for, with the clamp, whose light comes back to the region's mean.
#include "common/scene.glsl"
#include "weights/weights.glsl"

layout(local_size_x = 64) in;

layout(set = 0) uniform samplerBuffer sites;
layout(set = 0) uniform samplerBuffer ends;
layout(set = 0, std430) readonly buffer TotalsBlock { Totals value; } totals;
layout(set = 0, std430) buffer SumsBlock { uvec2 list[]; } sums;  // paths; their light

layout(push_constant) uniform Constants {
  uint vplCount;
  uint paths;
  float normalShare;
};

const float kOtherKind = 1e20;  // m^2: only if there is no VPL of the kind

void main() {
  uint path = gl_GlobalInvocationID.x;
  if (path >= paths) return;
  vec4 end = texelFetch(ends, int(2u * path)), normal = texelFetch(ends, int(2u * path + 1u));
  if (!(end.w > 0.0)) return;
  float lambda = normalWeight(voxelsGrid(), normalShare, totals.value.areaLow, totals.value.areaHigh);
  float best = 1e38;
  uint owner = kNoSide;
  for (uint i = 0u; i < vplCount; ++i) {
    vec4 site = texelFetch(sites, int(2u * i)), siteNormal = texelFetch(sites, int(2u * i + 1u));
    vec3 d = site.xyz - end.xyz;
    precise float cost = dot(d, d) + lambda * (1.0 - dot(normal.xyz, siteNormal.xyz)) + site.w;
    cost = site.w >= 0.0 ? cost + (siteKind(siteNormal.w) == end.w ? 0.0 : kOtherKind) : 2e38;
    bool nearer = cost < best;
    owner = nearer ? i : owner;
    best = nearer ? cost : best;
  }
  if (owner == kNoSide) return;
  atomicAdd(sums.list[owner].x, 1u);
  atomicAdd(sums.list[owner].y, lightUnits(normal.w, texelFetch(sites, int(2u * owner + 1u)).w));
}
