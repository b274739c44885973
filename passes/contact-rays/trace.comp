// Irradiance / pi from VPLs of one subset, chosen by the light they would send if nothing hid them and by the chance
// that nothing does. Over the frames, subsets and places in the sum follow one low-discrepancy sequence (Roberts 2018).
// Where there is no history it is the mean of several such estimates, which take the places of the frames before, each
// in the next subset. Defines: RAY_PASSAGE 0/1 (rays/trace.glsl); HISTORY 0/1, 1 if `origin` says where there is
// none.
#include "sampling/random.glsl"
#include "scene/history.glsl"
#include "records/contact.h"
#include "rays/visibility.glsl"
#include "contact_sources.glsl"
#include "contact_surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

LIST(readonly, ContactSource, sources);
LIST(restrict, uvec2, counts);  // rays to each VPL, and those that reached it
#if HISTORY
IMAGE(r32ui, readonly, uimage2D, origin);
#endif
IMAGE(rgba32f, writeonly, image2D, unfiltered);
COUNTERS { uint pixels, rays; } counters;

layout(push_constant) uniform Constants {
  uint rays;
  uint firstSamples;
  uint frameIndex;
} constants;

CONSTANT uint kBlocks = 16u;

// cos_s cos_l / (d^2 + A / pi) / d^2, in the form in which pass deferred has it, times the weight.
float unhidden(ContactSource light, ContactSurface s) {
  vec3 d = s.position - light.position;
  float d2 = max(dot(d, d), 1e-12);
  return light.weight * max(-dot(s.normal, d), 0.0) * max(dot(light.normal, d), 0.0) / (d2 * (d2 + light.area));
}

// From all VPLs by those of one subset. offset: of the rays' places in the sum, from 0 to 1.
vec3 lightOf(uint subset, ContactSurface s, float offset) {
  vec3 away = normalize(s.position - view.eye), start = s.position + (s.normal - away) * rayEpsilon();
  // The sum before each block of sources, with which rays skip the blocks that are not theirs.
  const uint all = kContactSubsets * kBlocks;
  uint end = uint(sources.list.length()), width = (end + all - 1u) / all * kContactSubsets;
  float starts[kBlocks];
  float sum = 0.0;
  for (uint b = 0u; b < kBlocks; ++b) {
    starts[b] = sum;
    uint first = subset + b * width, last = min(first + width, end);
    for (uint i = first; i < last; i += kContactSubsets) sum += unhidden(sources.list[i], s);
  }
  if (!(sum > 0.0)) return vec3(0.0);
  // The places of the rays in the sum grow, so that one way through the list passes all of them.
  vec3 light = vec3(0.0);
  uint chosen = subset, block = 0u, next = subset;
  float before = 0.0, own = 0.0;
  for (uint k = 0u; k < constants.rays; ++k) {
    float place = (float(k) + offset) / float(constants.rays) * sum;
    for (; block + 1u < kBlocks && starts[block + 1u] <= place && starts[block + 1u] < sum; ++block) {
      next = subset + (block + 1u) * width;
      before = starts[block + 1u];
      own = 0.0;
    }
    for (; next < end && before + own <= place; next += kContactSubsets) {
      float light_ = unhidden(sources.list[next], s);
      if (!(light_ > 0.0)) continue;
      before += own;
      own = light_;
      chosen = next;
    }
    vec3 to = sources.list[chosen].position - start, share = visibility(Ray(start, to, 0.0, kContactRayEnd));
    atomicAdd(counts.list[chosen].x, 1u);
    if (share == vec3(0.0)) continue;
    atomicAdd(counts.list[chosen].y, 1u);
    light += share * sources.list[chosen].color;
  }
  return light * (sum * float(kContactSubsets) / (float(constants.rays) * kPi));
}

uint samplesAt(ivec2 p) {
#if HISTORY
  if (imageLoad(origin, p).r == kNone) return constants.firstSamples;
#endif
  return 1u;
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID);
  if (any(greaterThanEqual(p, imageSize(unfiltered))) || !inContact(p)) return;
  uint samples = samplesAt(p);
  atomicAdd(counters.pixels, 1u);
  atomicAdd(counters.rays, samples * constants.rays);
  ContactSurface surface = contactSurface(p);
  uint stream = randomStream(frame.seed, uint(p.x), kContactStream, uint(p.y));
  uint first = min(uint(streamSequence(stream, constants.frameIndex).y * float(kContactSubsets)), kContactSubsets - 1u);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < samples; ++i)
    sum += lightOf((first + i) % kContactSubsets, surface, streamSequence(stream, constants.frameIndex - i).x);
  imageStore(unfiltered, p, vec4(min(sum / float(samples), 65504.0), 0.0));
}
