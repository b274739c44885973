#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
// Irradiance from one page of VPLs, each pixel from one of INTERLEAVE^2 subsets of them (Eq. 2 of
// the paper without rho):
//   E = sum over l of I_l cos_s cos_l Vis / d^2,   I_l = rho_l Phi_l / pi
// Defines: INTERLEAVE; PAGE_VPLS, at most 1024; SHADOWED 0/1; TILED 0/1; KERNEL_DISC 0/1; ACCUMULATE 0/1, 1 for all
// pages but the first; NEAR_FIELD 0/1, 1 to add the light of pass near-field; MASKED 0/1, 1 to shade only the listed
// blocks of BLOCK x BLOCK pixels; SCALE 1/2, see samples.glsl; GLOSS 0/1, 1 to find also the light that the surfaces of
// full materials reflect, see vpls/vpl_gloss.glsl; NEAR_GLOSS 0/1, 1 if pass near-field has found its part of that.
#if GLOSS
#include "vpls/vpl_gloss.glsl"
#endif
#include "scene/scene.glsl"
#include "screen/gbuffer.glsl"
#include "vpls/vpl.glsl"
#include "vpls/paraboloid.glsl"
#include "vpls/vpl_shadow.glsl"
#include "deferred/records.h"
#include "deferred/samples.glsl"

// An invocation shades kPixels vertically adjacent pixels: it receives a VPL once for all of them, and neighbours
// read the same cache lines of a map.
#if MASKED
#include "deferred/blocks.glsl"
const int kPixels = int(kListedPixels);
layout(local_size_x = kTileWidth, local_size_y = kTileHeight / kPixels) in;
#else
const int kPixels = 8;
layout(local_size_x = kTileWidth, local_size_y = kTileHeight / kPixels) in;
#endif

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(std140) uniform Vpls { Vpl list[PAGE_VPLS]; } vpls;
#if SHADOWED
layout(rg16_snorm) uniform readonly image2D gbufferFace;
layout(r32ui) uniform readonly uimage2DArray atlas;
#endif

#if NEAR_FIELD
layout(rgba16f) uniform readonly image2D nearField;
#if NEAR_GLOSS
layout(rgba16f) uniform readonly image2D nearGloss;
#endif
#endif

#if GLOSS
layout(rgba16f) uniform readonly image2D gbufferSpecular;
#endif

layout(push_constant) uniform Constants {
#if !MASKED
  ivec4 area;  // corners of the part of the grid to shade
  ivec4 hole;  // corners of the part in it to leave out
#endif
  float clampDistance;  // m
#if SHADOWED
  uint firstSlot;       // of this page
  float shadowBias;
#endif
};

const uint kSubsets = INTERLEAVE * INTERLEAVE;

struct Receiver {
  vec3 position, normal, face, sum;
#if GLOSS
  Lobe lobe;
  vec3 gloss;  // sum of the light under the lobe
#endif
};

#if GLOSS
// The sum of the squared differences between the normal of a receiver and those beside and above or below it, which are
// the next of the same subset; 0 for those of other surfaces.
float turnOf(Receiver receivers[kPixels], bool valid[kPixels], int k) {
  vec3 normal = receivers[k].normal, beside = subgroupShuffleXor(normal, 1u) - normal;
  bool there = subgroupShuffleXor(valid[k], 1u);
  int other = k ^ 1;
  vec3 below = receivers[other].normal - normal;
  float x = dot(beside, beside), y = dot(below, below);
  return (there && x < kSharpEdge ? x : 0.0) + (valid[other] && y < kSharpEdge ? y : 0.0);
}
#endif

// Bounds of the receivers of a subgroup. Without pixels, low > high.
struct Block {
  vec3 centre, reach;        // box around their positions
  vec3 normal, normalReach;  // box around their normals
  float plane;               // least distance of a receiver's plane from the centre along its normal, m
};

Block blockOf(Receiver receivers[kPixels], bool valid[kPixels]) {
  vec3 low = vec3(1e30), high = vec3(-1e30), normalLow = vec3(1e30), normalHigh = vec3(-1e30);
  for (int k = 0; k < kPixels; ++k) {
    low = valid[k] ? min(low, receivers[k].position) : low;
    high = valid[k] ? max(high, receivers[k].position) : high;
    normalLow = valid[k] ? min(normalLow, receivers[k].normal) : normalLow;
    normalHigh = valid[k] ? max(normalHigh, receivers[k].normal) : normalHigh;
  }
  low = subgroupMin(low);
  high = subgroupMax(high);
  normalLow = subgroupMin(normalLow);
  normalHigh = subgroupMax(normalHigh);
  Block b = Block(0.5 * (low + high), 0.5 * (high - low), 0.5 * (normalLow + normalHigh),
                  0.5 * (normalHigh - normalLow), 1e30);
  for (int k = 0; k < kPixels; ++k)
    b.plane = valid[k] ? min(b.plane, dot(receivers[k].normal, receivers[k].position - b.centre)) : b.plane;
  b.plane = subgroupMin(b.plane);
  return b;
}

// Whether a VPL may light any of them, by bounds of both cosines' numerators. Coplanar ones pass because of rounding.
bool mayLight(Vpl vpl, Block b) {
  vec3 away = b.centre - vpl.position;
  float along = dot(vpl.normal, away) + dot(abs(vpl.normal), b.reach);
  float facing = dot(b.normalReach, abs(away)) - dot(b.normal, away) - b.plane;
  float rounding = 1e-6 * (dot(abs(away), vec3(1.0)) + dot(b.reach, vec3(1.0)));
  return min(along, facing) > rounding && b.reach.x >= 0.0 && vpl.intensity != vec3(0.0);
}

// A VPL in the form in which all receivers of a subgroup use it.
struct Emitter {
  vec3 position, intensity;
  mat3 axes;   // its frame, see vpls/paraboloid.glsl
  float area;  // m^2
};

Emitter emitterOf(Vpl vpl) {
  mat3 axes = mat3(0.0);
#if SHADOWED
  axes = orthonormalFrame(vpl.normal);
#endif
  axes[2] = vpl.normal;
  return Emitter(vpl.position, vpl.intensity, axes, vpl.area);
}

// The emitter of another lane.
Emitter handOver(Emitter e, uint lane) {
  e.position = subgroupShuffle(e.position, lane);
  e.intensity = subgroupShuffle(e.intensity, lane);
#if SHADOWED
  e.axes[0] = subgroupShuffle(e.axes[0], lane);
  e.axes[1] = subgroupShuffle(e.axes[1], lane);
#endif
  e.axes[2] = subgroupShuffle(e.axes[2], lane);
#if KERNEL_DISC || GLOSS
  e.area = subgroupShuffle(e.area, lane);
#endif
  return e;
}

// All invocations of a work group share a subset, so that they read the same VPLs at the same time.
#if MASKED
uvec2 subsetOfGroup() { return placeInBlock() % INTERLEAVE; }
ivec2 sampleAt(int k, ivec2 size) { return listedPixel(k, size); }
#else
// A work group covers every INTERLEAVE-th pixel of a block. The subset is the slowest of the three dimensions, so
// everything that is shaded at a time reads the same few maps.
uvec2 subsetOfGroup() { return uvec2(gl_WorkGroupID.z % INTERLEAVE, gl_WorkGroupID.z / INTERLEAVE); }
ivec2 sampleAt(int k, ivec2 size) {
  uvec2 block = gl_WorkGroupID.xy * (gl_WorkGroupSize.xy * uvec2(1, kPixels));
  uvec2 place = block + gl_LocalInvocationID.xy * uvec2(1, kPixels) + uvec2(0, k);
  ivec2 at = area.xy + ivec2(place * INTERLEAVE + subsetOfGroup());
  bool inside = all(lessThan(at, area.zw)) && (any(lessThan(at, hole.xy)) || any(greaterThanEqual(at, hole.zw)));
  return inside ? at : size;
}
#endif

// cos_s cos_l Vis / d^2, with one division. slot: slot of the VPL in the atlas.
float transfer(Receiver r, Emitter e, uint slot
#if SHADOWED
               , AtlasLayout maps, float bias
#endif
) {
  vec3 toSurface = r.position - e.position;
  float d2 = max(dot(toSurface, toSurface), 1e-12), d = sqrt(d2);
  float alongNormal = dot(e.axes[2], toSurface);
#if KERNEL_DISC
  float denominator = d2 * (d2 + e.area * (1.0 / kPi));
#else
  float nearest = max(d, clampDistance);  // in the denominator only
  float denominator = d2 * (nearest * nearest);
#endif
  float cosines = max(-dot(r.normal, toSurface), 0.0) * max(alongNormal, 0.0);
  // Uses |z| for z; the two differ only for receivers that get no light.
  float ahead = d + abs(alongNormal), inverse = 1.0 / (ahead * denominator), result = cosines * (ahead * inverse);
#if SHADOWED
  vec2 local = vec2(dot(e.axes[0], toSurface), dot(e.axes[1], toSurface));
  // |p| <= 1. Receivers without light all read the same texel, which stays in the cache.
  float half_ = 0.5 * float(maps.size);
  vec2 p = local * (denominator * inverse);
  ivec2 texel = cosines > 0.0 ? min(ivec2(p * half_ + half_), maps.size - 1) : ivec2(0);
#if TILED
  ivec3 at = atlasTexel(slot, texel, maps);
#else
  ivec3 at = atlasTexel(slot, texel);
#endif
  float stored = uintBitsToFloat(imageLoad(atlas, at).x);
  bool lit = vplSees(stored, dot(r.face, toSurface), d, ahead, toLocal(e.axes, r.face), texel, maps.size, bias);
  return lit ? result : 0.0;
#else
  return result;
#endif
}

// Adds the light of the subset's VPLs to the receivers, and if `glossy`, which is a constant, that under their lobes.
void gather(inout Receiver receivers[kPixels], Block block, uint subset, bool glossy) {
#if SHADOWED
  AtlasLayout maps = atlasLayout(imageSize(atlas));
#endif
  // Each lane takes a VPL of its own, and those that may light something are passed to all lanes, one after another.
  // On a CPU, where every lane's load from a uniform buffer has its own cost, loading them in every lane costs as
  // much as everything else.
  uint lanes = subgroupBallotBitCount(subgroupBallot(true));
  for (uint first = 0u; first * kSubsets + subset < PAGE_VPLS; first += lanes) {
    uint mine = (first + gl_SubgroupInvocationID) * kSubsets + subset;
    Vpl vpl = vpls.list[min(mine, PAGE_VPLS - 1u)];
    Emitter own = emitterOf(vpl);
    uvec4 left = subgroupBallot(mine < PAGE_VPLS && mayLight(vpl, block));
    while ((left.x | left.y) != 0u) {
      uint lane = subgroupBallotFindLSB(left);
      left.xy &= ~(lane < 32u ? uvec2(1u << lane, 0u) : uvec2(0u, 1u << (lane - 32u)));
      Emitter e = handOver(own, lane);
      for (int k = 0; k < kPixels; ++k) {
#if SHADOWED
        float t = transfer(receivers[k], e, firstSlot + (first + lane) * kSubsets + subset, maps, shadowBias);
#else
        float t = transfer(receivers[k], e, 0u);
#endif
#if GLOSS
        if (glossy) {
          vec3 toLight = e.position - receivers[k].position;
          Response response = responseTo(receivers[k].lobe, receivers[k].normal, toLight, e.area);
          receivers[k].gloss += (t * response.lobe) * e.intensity;
          t *= response.layer;
        }
#endif
        receivers[k].sum += t * e.intensity;
      }
    }
  }
}

void main() {
  uvec2 subset2 = subsetOfGroup();
  ivec2 size = imageSize(partial), pixels = imageSize(gbufferDistance);
  Receiver receivers[kPixels];
  bool valid[kPixels];
  for (int k = 0; k < kPixels; ++k) {
    ivec2 at = sampleAt(k, size), p = samplePixel(at, pixels);
    vec4 position = surfaceAt(p);
    valid[k] = position.w > 0.0 && all(lessThan(at, size));
    receivers[k].position = position.xyz;
    vec4 normal = imageLoad(gbufferNormal, p);
    receivers[k].normal = normal.xyz;
#if SHADOWED
    receivers[k].face = octDecode(imageLoad(gbufferFace, p).xy);
#endif
    receivers[k].sum = vec3(0.0);
#if GLOSS
    receivers[k].lobe = lobeOf(normal, view.eye - position.xyz, imageLoad(gbufferSpecular, p));
    receivers[k].gloss = vec3(0.0);
#endif
  }
#if GLOSS
  bool glossy = false;
  for (int k = 0; k < kPixels; ++k) glossy = glossy || (valid[k] && receivers[k].lobe.share > 0.0);
  glossy = subgroupAny(glossy);
#endif
  Block block = blockOf(receivers, valid);
  uint subset = subset2.y * INTERLEAVE + subset2.x;
#if GLOSS
  // Most groups show nothing glossy.
  if (!glossy) gather(receivers, block, subset, false);
  if (glossy) {
    for (int k = 0; k < kPixels; ++k) complete(receivers[k].lobe, turnOf(receivers, valid, k));
    gather(receivers, block, subset, true);
  }
#else
  gather(receivers, block, subset, false);
#endif
  for (int k = 0; k < kPixels; ++k) {
    ivec2 at = sampleAt(k, size);
    if (any(greaterThanEqual(at, size))) continue;
    // In units of `irradiance`, E / pi; one subset stands for all of them.
    vec3 sum = receivers[k].sum * (float(INTERLEAVE * INTERLEAVE) / kPi), gloss = sum;
#if GLOSS
    vec3 underLobe = receivers[k].gloss * (float(INTERLEAVE * INTERLEAVE) / receivers[k].lobe.albedo);
    gloss = mix(sum, underLobe, receivers[k].lobe.share);
#endif
#if NEAR_FIELD && !ACCUMULATE
    vec3 near = imageLoad(nearField, samplePixel(at, pixels)).rgb;
    sum += near;
#if NEAR_GLOSS
    near = imageLoad(nearGloss, samplePixel(at, pixels)).rgb;
#endif
    gloss += near;
#endif
#if ACCUMULATE
    sum += imageLoad(partial, at).rgb;
#endif
    imageStore(partial, at, vec4(min(sum, 65504.0), 0.0));
#if GLOSS
#if ACCUMULATE
    gloss += imageLoad(partialGloss, at).rgb;
#endif
    imageStore(partialGloss, at, vec4(min(gloss, 65504.0), 0.0));
#endif
  }
}
