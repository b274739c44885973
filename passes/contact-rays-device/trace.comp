// Irradiance / pi from VPLs of one subset, chosen by the light they would send if nothing hid them and by the chance that
// nothing does. Over the frames, subsets and places in the sum follow one low-discrepancy sequence (Roberts 2018). Define:
// RAY_PASSAGE 0/1 (common/rays/trace.glsl).
#include "common/random.glsl"
#include "common/records/contact.h"
#include "common/rays/visibility.glsl"
#include "contact_sources.glsl"
#include "contact_surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer SourcesBlock { ContactSource list[]; } sources;
layout(std430) buffer CountsBlock { uvec2 list[]; } counts;  // rays to each VPL, and those that reached it
layout(rgba32f) uniform writeonly image2D unfiltered;
layout(std430) buffer CountersBlock { uint pixels, rays; } counters;

layout(push_constant) uniform Constants {
  uint rays;
  uint frameIndex;
};

// cos_s cos_l / (d^2 + A / pi) / d^2, in the form in which pass deferred has it, times the weight.
float unhidden(ContactSource light, ContactSurface s) {
  vec3 d = s.position - light.position;
  float d2 = max(dot(d, d), 1e-12);
  return light.weight * max(-dot(s.normal, d), 0.0) * max(dot(light.normal, d), 0.0) / (d2 * (d2 + light.area));
}

vec3 lightAt(ivec2 p) {
  ContactSurface s = contactSurface(p);
  vec3 away = normalize(s.position - view.eye), origin = s.position + (s.normal - away) * rayEpsilon();
  uint stream = randomStream(frame.seed, uint(p.x), kContactStream, uint(p.y));
  vec2 u = streamSequence(stream, frameIndex);
  uint subset = min(uint(u.y * float(kContactSubsets)), kContactSubsets - 1u), end = uint(sources.list.length());
  float sum = 0.0;
  for (uint i = subset; i < end; i += kContactSubsets) sum += unhidden(sources.list[i], s);
  if (!(sum > 0.0)) return vec3(0.0);
  // The places of the rays in the sum grow, so that one way through the list passes all of them.
  vec3 light = vec3(0.0);
  uint chosen = subset;
  float before = 0.0, own = unhidden(sources.list[subset], s);
  for (uint k = 0u; k < rays; ++k) {
    float place = (float(k) + u.x) / float(rays) * sum;
    for (uint i = chosen + kContactSubsets; i < end && before + own <= place; i += kContactSubsets) {
      float next = unhidden(sources.list[i], s);
      if (!(next > 0.0)) continue;
      before += own;
      own = next;
      chosen = i;
    }
    vec3 to = sources.list[chosen].position - origin, share = visibility(Ray(origin, to, 0.0, kContactRayEnd));
    atomicAdd(counts.list[chosen].x, 1u);
    if (share == vec3(0.0)) continue;
    atomicAdd(counts.list[chosen].y, 1u);
    light += share * sources.list[chosen].color;
  }
  return light * (sum * float(kContactSubsets) / (float(rays) * kPi));
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(unfiltered))) || !inContact(p)) return;
  atomicAdd(counters.pixels, 1u);
  atomicAdd(counters.rays, rays);
  imageStore(unfiltered, p, vec4(min(lightAt(p), 65504.0), 0.0));
}
