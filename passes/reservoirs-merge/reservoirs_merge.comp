// Merges the reservoir of each pixel with those of its sources: of all their samples it keeps one. Their shares follow
// the pairwise balance heuristic (Bitterli, "Correlations and Reuse for Fast and Accurate Physically Based Light
// Transport", 2022, Ch. 9): the pixel is paired with each source, and in a pair a sample counts by the densities with
// which either would have chosen it. This takes two terms a source instead of one for each two sources.
// Defines: VISIBILITY 0/1, whether who does not see a sample counts as one that could not have chosen it; MOVED 0/1, 1
// if the sources belong to the previous frame.
#include "screen/history.glsl"
#include "sampling/reservoir.glsl"
#include "screen/gbuffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
#if MOVED
layout(rgba32f) uniform readonly image2D movedPosition;
layout(rgba16f) uniform readonly image2D movedNormal;
#endif
layout(r32ui) uniform readonly uimage2D sources;
#if VISIBILITY
layout(r32ui) uniform readonly uimage2D visibility;  // of source k bits 2 k and 2 k + 1
#endif
LARGE_TEXELS(vec4, own);
LARGE_TEXELS(vec4, others);
layout(std430) writeonly buffer ReservoirBlock { Reservoir list[]; } reservoirs;

layout(push_constant) uniform Constants {
  uint frameIndex;
  uint seed;
  uint iteration;
  float most;
  float growthLimit;
};

const uint kMergeStream = 0x72656d67u;
const uint kItsSample = 1u, kOurSample = 2u;  // bits of `visibility`

Reservoir chosen = kNoReservoir;
float sum = 0.0;  // of the weights offered so far

void offer(Reservoir r, float weight, uint random) {
  sum += weight;
  if (uniformFloat(random) * sum < weight) chosen = r;
}

VisiblePoint visiblePoint(vec4 position, vec4 normal) { return VisiblePoint(position.xyz, normalize(normal.xyz)); }
VisiblePoint pointAt(ivec2 pixel) { return visiblePoint(surfaceAt(pixel), imageLoad(gbufferNormal, pixel)); }
#if MOVED
VisiblePoint sourceAt(ivec2 pixel) {
  return visiblePoint(imageLoad(movedPosition, pixel), imageLoad(movedNormal, pixel));
}
#else
VisiblePoint sourceAt(ivec2 pixel) { return pointAt(pixel); }
#endif

float lightAt(VisiblePoint v, Reservoir r) { return dot(r.radiance, kLuminance) * cosineTowards(v, r); }

// Number of samples for which a source counts.
float countAt(int i) { return min(loadCount(others, i), most); }

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(gbufferDistance);
  if (any(greaterThanEqual(p, size))) return;
  int i = p.y * size.x + p.x, perPixel = imageSize(sources).x / size.x;
  uint stream = randomStream(seed, frameIndex, hashCombine(kMergeStream, iteration), uint(i));
#if VISIBILITY
  uint visible = imageLoad(visibility, p).r;
#else
  uint visible = 0xffffffffu;
#endif
  VisiblePoint here = pointAt(p);
  Reservoir ours = loadReservoir(own, i);
  float ourCosine = cosineTowards(here, ours), otherCount = 0.0;
  for (int k = 0; k < perPixel; ++k) {
    uint source = imageLoad(sources, ivec2(p.x * perPixel + k, p.y)).r;
    if (source != kNone) otherCount += countAt(int(source >> 16) * size.x + int(source & 0xffffu));
  }
  float ourShare = otherCount > 0.0 ? 0.0 : 1.0;
  for (int k = 0; k < (otherCount > 0.0 ? perPixel : 0); ++k, visible >>= 2) {
    uint source = imageLoad(sources, ivec2(p.x * perPixel + k, p.y)).r;
    if (source == kNone) continue;
    ivec2 q = ivec2(source & 0xffffu, source >> 16);
    int j = q.y * size.x + q.x;
    Reservoir its = loadReservoir(others, j);
    float count = countAt(j);
    VisiblePoint there = sourceAt(q);
    // Densities are those of solid angles of this pixel, less the luminance of the sample, which both have in common.
    float grown = (visible & kItsSample) != 0u && its.weight > 0.0 ? growth(there, here, its, growthLimit) : 0.0;
    if (grown > 0.0) {
      float density = otherCount * cosineTowards(there, its) / grown,
            ourDensity = ours.count * cosineTowards(here, its);
      float share = count / otherCount * density / max(density + ourDensity, 1e-30);
      offer(its, share * lightAt(here, its) * its.weight * grown, hashCombine(stream, uint(k)));
    }
    float back = (visible & kOurSample) != 0u && ours.weight > 0.0 ? growth(there, here, ours, growthLimit) : 0.0;
    float density = back > 0.0 ? otherCount * cosineTowards(there, ours) / back : 0.0;
    ourShare += count / otherCount * ours.count * ourCosine / max(density + ours.count * ourCosine, 1e-30);
  }
  if (ours.weight > 0.0)
    offer(ours, ourShare * lightAt(here, ours) * ours.weight, hashCombine(stream, uint(perPixel)));
  chosen.weight = sum > 0.0 ? sum / lightAt(here, chosen) : 0.0;
  chosen.count = ours.count + otherCount;
  reservoirs.list[i] = chosen;
}
