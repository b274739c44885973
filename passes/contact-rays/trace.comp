// Irradiance / pi from VPLs of one subset, chosen by the light they would send if nothing hid them and by the chance
// that nothing does. Over the frames, subsets and places in the sum follow one low-discrepancy sequence (Roberts 2018).
// Where there is no history it is the mean of several such estimates, which take the places of the frames before, each
// in the next subset. Defines: RAY_PASSAGE 0/1 (rays/trace.glsl); HISTORY 0/1, 1 if `origin` says where there is
// none.
#include "sampling/random.glsl"
#include "screen/history.glsl"
#include "records/contact.h"
#include "records/vpl.h"
#include "rays/visibility.glsl"
#include "contact_sources.glsl"
#include "contact_surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

LIST(readonly, ContactSources, sources);
LIST(readonly, Vpl, vpls);
LIST(restrict, uvec2, counts);  // rays to each VPL, and those that reached it, as kTallySums partial sums
#if HISTORY
IMAGE(r32ui, readonly, uimage2D, origin);
#endif
IMAGE(rgba32f, writeonly, image2D, unfiltered);
COUNTERS { uint pixels, rays; } counters;

layout(push_constant) uniform Constants {
  ivec4 fovea;  // square around it: its first pixel, and the one behind its last
  uint rays;
  uint firstSamples;
  uint frameIndex;
} constants;

CONSTANT uint kBlocks = 64u;

// cos_s cos_l / (d^2 + A / pi) / d^2, in the form in which pass deferred has it, times the weight.
vec4 unhidden(ContactSources light, ContactSurface s) {
  vec4 x = vec4(s.position.x) - light.x, y = vec4(s.position.y) - light.y, z = vec4(s.position.z) - light.z;
  vec4 d2 = max(x * x + y * y + z * z, vec4(1e-12));
  vec4 facing = max(-(s.normal.x * x + s.normal.y * y + s.normal.z * z), vec4(0.0));
  vec4 along = max(light.normalX * x + light.normalY * y + light.normalZ * z, vec4(0.0));
  return light.weight * facing * along / (d2 * (d2 + light.area));
}

// Where the partial sums of this work group start. Neighbouring groups, which run at the same time, have different
// ones.
uint ownTallies() {
  uvec2 group = uvec2(gl_GlobalInvocationID) / 8u;
  return (group.x + 5u * group.y) % kTallySums * (uint(counts.list.length()) / kTallySums);
}

// From all VPLs by those of one subset. offset: of the rays' places in the sum, from 0 to 1.
vec3 lightOf(uint subset, ContactSurface s, float offset) {
  vec3 away = normalize(s.position - view.eye), start = s.position + (s.normal - away) * rayEpsilon();
  // The sum before each block of sources, with which rays skip the blocks that are not theirs.
  uint fours = uint(sources.list.length()) / kContactSubsets, first = subset * fours;
  uint width = (fours + kBlocks - 1u) / kBlocks;
  float starts[kBlocks];
  float sum = 0.0;
  for (uint b = 0u; b < kBlocks; ++b) {
    starts[b] = sum;
    vec4 light = vec4(0.0);
    for (uint i = b * width; i < min((b + 1u) * width, fours); ++i) light += unhidden(sources.list[first + i], s);
    sum += dot(light, vec4(1.0));
  }
  if (!(sum > 0.0)) return vec3(0.0);
  // The places of the rays in the sum grow, so that one way through the list passes all of them.
  vec3 light = vec3(0.0);
  vec4 four = vec4(0.0);
  uint chosen = 0u, block = 0u, next = 0u;  // numbers in the subset; next: of fours
  float before = 0.0, own = 0.0, weight = 1.0;
  for (uint k = 0u; k < constants.rays; ++k) {
    float place = (float(k) + offset) / float(constants.rays) * sum;
    for (; block + 1u < kBlocks && starts[block + 1u] <= place && starts[block + 1u] < sum; ++block) {
      next = (block + 1u) * width;
      before = starts[block + 1u];
      own = 0.0;
    }
    for (; next < fours && before + own <= place; ++next) {
      before += own;
      four = unhidden(sources.list[first + next], s);
      own = dot(four, vec4(1.0));
    }
    float rest = place - before;
    for (uint lane = 0u; lane < 4u; ++lane) {
      if (!(four[lane] > 0.0)) continue;
      chosen = 4u * (next - 1u) + lane;
      weight = sources.list[first + next - 1u].weight[lane];
      if (rest < four[lane]) break;
      rest -= four[lane];
    }
    uint slot = slotOf(subset, chosen), tally = ownTallies() + slot;
    vec3 to = vpls.list[slot].position - start, share = visibility(Ray(start, to, 0.0, kContactRayEnd));
    atomicAdd(counts.list[tally].x, 1u);
    if (share == vec3(0.0)) continue;
    atomicAdd(counts.list[tally].y, 1u);
    light += share * vpls.list[slot].intensity / weight;
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
  ivec2 p = ivec2(constants.fovea) + ivec2(gl_GlobalInvocationID);
  if (any(greaterThanEqual(p, ivec2(constants.fovea.z, constants.fovea.w))) || !inContact(p)) return;
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
