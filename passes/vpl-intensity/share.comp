// Strategy `importance-area`: every eye path goes to the VPL nearest to its end, by d^2 + lambda (1 - n.n'), and to a
// lit one if the end is lit.
//
// The light that the region receives by way of a piece of surface C is the integral of B p over C: the light found by
// the eye paths that end there, divided by the number M of paths. A VPL with the flux F sends it F p_l. So F = (sum
// of B over its n paths) / (M p_l) preserves that light however the VPLs were chosen; only p_l has to be estimated.
// It has to be what the region receives from the VPL as it is shaded: with the VPL's own shadow map (seen.comp), with
// its own disc (discs.comp) or, if requested, with the clamp, whose lost light is then returned to the region's mean.
//
// A VPL that the region hardly sees (one in a crack, or inside the surfaces that its voxel averages) would have to be
// arbitrarily bright to deliver the light of its paths. If p_l is below the least density, it keeps only the part p_l
// / least of every path, and likewise if its p_l is the average of only a few points (partKept()). The rest goes to
// the nearest VPL that is seen well, so that no light is lost; in rooms full of small things this is a third of it.
//
// TRACED 1: the paths are those of pass eye-paths, whose ends hold all the light that leaves there, in colour, and a
// VPL emits that in place of its own. A path can then go to any VPL, and goes to the nearest of those that its start
// sees. Given to another, its light would reach whatever that VPL does see; after a jump of the gaze, when there is
// no VPL yet where the new paths end, that would be a flash on a far wall.
//
// PATHS: paths per invocation.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

uniform samplerBuffer sites;
#if TRACED
LARGE_TEXELS(vec4, tracedEnds);
#else
uniform samplerBuffer ends;
#endif
uniform samplerBuffer densities;
uniform samplerBuffer seenFrom;
LARGE_TEXELS(uint, seen);
layout(std430) buffer TotalsBlock { Totals value; } totals;
layout(std430) buffer SumsBlock { PathSum list[]; } sums;
layout(std430) readonly buffer KeptBlock { Kept value; } kept;

#if NEAR
uniform samplerBuffer screen;  // EyePathStart
uniform samplerBuffer spread;  // x: area, m^2
#endif

layout(push_constant) uniform Constants {
  uint vplCount;
  uint tried;  // paths
  uint points;
  float normalShare;
  float areaCap;
};

// Of all VPLs, those of the highest rank come first, and of these the nearest.
const uint kShines = 4u;    // emissive, as the end is; light this bright would make spots elsewhere
const uint kSeen = 2u;      // seen by the start of the path; for traced paths only, as dark VPLs cannot emit the light
                            // of others
const uint kSameKind = 1u;  // lit, or not lit, as the end is

const uint kPaths = uint(PATHS);

#if TRACED
EyePathEnd endOf(uint path) { return loadEyePathEnd(tracedEnds, path); }
#else
PathEnd endOf(uint path) { return loadPathEnd(ends, path); }
#endif

// part: the part of the path that the VPL gets.
void give(uint vpl, uint path, float part) {
  if (vpl == kNoSide || !(part > 0.0)) return;
#if TRACED
  EyePathEnd end = endOf(path);
  part *= end.weight;
  atomicAdd(sums.list[vpl].paths, max(uint(part * kPathUnits + 0.5), 1u));
  if (!(end.unit > 0.0)) return;
#if NEAR
  // The part of it that pass near-field supplies comes from no VPL.
  vec3 away = end.position - loadStart(screen, path % points).position;
  float d2 = dot(away, away);
  end.radiance *= kPi * d2 / (kPi * d2 + texelFetch(spread, 0).x);
#endif
  uvec3 light = uvec3(end.radiance / end.unit * part + 0.5);
  atomicAdd(sums.list[vpl].lightX, light.x);
  atomicAdd(sums.list[vpl].lightY, light.y);
  atomicAdd(sums.list[vpl].lightZ, light.z);
#else
  uint units = uint(part * kPathUnits + 0.5);
  atomicAdd(sums.list[vpl].paths, units);
  atomicAdd(sums.list[vpl].lightX, lightUnits(endOf(path).luminance, abs(loadSite(sites, vpl).light), units));
#endif
}

struct Path {
  vec3 position, normal;
  float kind;               // kind of its end, 0 if it hits nothing
  float best, bestWhole;
  uint owner, whole;        // nearest of all VPLs, and of those that are seen well
  uint rank, rankWhole;
};

Path pathAt(uint path) {
  bool inside = path < tried;
  uint within = inside ? path : 0u;
  vec3 position = endOf(within).position, normal = endOf(within).normal;
  float kind = endOf(within).kind;
#if TRACED
  if (kind == kGlowing) kind = kUnlit;  // voxels know no light of emissive surfaces
#endif
  return Path(position, normal, inside && kind > 0.0 ? kind : 0.0, 1e38, 1e38, kNoSide, kNoSide, 0u, 0u);
}

// ranked: kSeen if the start of the path sees the VPL, else 0.
void offer(inout Path p, uint vpl, VplSite site, float lambda, uint ranked) {
  vec3 d = site.position - p.position;
  bool thin = site.handicap <= kThinSite;
  float handicap = thin ? kThinSite - site.handicap : site.handicap;
  precise float cost = dot(d, d) + lambda * (1.0 - dot(p.normal, site.normal)) + handicap;
  float kind = site.light < 0.0 ? kShining : siteKind(site.light, 0.0);
  uint its = ranked + (kind != p.kind ? 0u : kind == kShining ? kShines + kSameKind : kSameKind);
  bool takes = handicap >= 0.0;
  bool nearer = takes && (its > p.rank || (its == p.rank && cost < p.best));
  bool nearerWhole = takes && !thin && (its > p.rankWhole || (its == p.rankWhole && cost < p.bestWhole));
  p.owner = nearer ? vpl : p.owner;
  p.best = nearer ? cost : p.best;
  p.rank = nearer ? its : p.rank;
  p.whole = nearerWhole ? vpl : p.whole;
  p.bestWhole = nearerWhole ? cost : p.bestWhole;
  p.rankWhole = nearerWhole ? its : p.rankWhole;
}

void finish(Path p, uint path) {
  if (p.kind == 0.0) return;
  atomicAdd(totals.value.found, 1u);
  if (p.owner == kNoSide) return;
  float from = texelFetch(seenFrom, int(p.owner)).r;
  float part = partKept(texelFetch(densities, int(p.owner)).r, kept.value.median / areaCap, from);
  // In whole units, so that the parts add up.
  part = p.owner == p.whole || p.whole == kNoSide ? 1.0 : floor(part * kPathUnits + 0.5) / kPathUnits;
  give(p.owner, path, part);
  give(p.whole, path, 1.0 - part);
}

// An invocation compares several paths with each VPL, because on a CPU device most of the time goes into loading VPLs.
// These paths start from the same point, so that one look-up tells for all of them whether the point sees the VPL.
void main() {
  float lambda = normalWeight(voxelsGrid(), normalShare, totals.value.areaLow, totals.value.areaHigh);
  uint point = gl_GlobalInvocationID.x % points, turn = point >> 6u, bit = 1u << (turn & 31u);
  uint first = gl_GlobalInvocationID.x / points * points * kPaths + point;
  int words = 64 * int(laneWords(points)), word = int((point & 63u) * laneWords(points) + (turn >> 5u));
  Path paths[kPaths];
  for (uint k = 0u; k < kPaths; ++k) paths[k] = pathAt(first + k * points);
  for (uint i = 0u; i < vplCount; ++i) {
    VplSite site = loadSite(sites, i);
    uint ranked = 0u;
#if TRACED
    if ((texelOf(seen, int(i) * words + word).r & bit) != 0u) ranked = kSeen;
#endif
    for (uint k = 0u; k < kPaths; ++k) offer(paths[k], i, site, lambda, ranked);
  }
  for (uint k = 0u; k < kPaths; ++k) finish(paths[k], first + k * points);
}
