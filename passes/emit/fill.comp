// The slots that are still free in a full list, which are fewer than the VPLs of a path, are filled by splitting the
// brightest VPL in two, which changes no sum. Then the place of each VPL along a space-filling curve.
#include "device/language.glsl"
#include "records/light_paths.h"
#include "records/vpl.h"

const uint kGroup = 256u;
layout(local_size_x = 256) in;

VALUE(restrict, LightPaths, progress);
LIST(restrict, Vpl, found);
LIST(writeonly, uint, keys);
COUNTERS { uint paths, rays, vpls, escaped; } counters;

layout(push_constant) uniform Constants { uint count; } constants;

const float kFarthest = 3.4e38;

shared vec2 brightest[kGroup];  // brightness, and index as bits
shared vec3 lows[kGroup], highs[kGroup];

// The brighter one of two VPLs, or the first if they are equal.
vec2 brighter(vec2 a, vec2 b) {
  return b.x > a.x || (b.x == a.x && floatBitsToUint(b.y) < floatBitsToUint(a.y)) ? b : a;
}

void splitBrightest(uint stored) {
  uint i = gl_LocalInvocationID.x;
  vec2 own = vec2(-1.0, uintBitsToFloat(0u));
  for (uint vpl = i; vpl < stored; vpl += kGroup)
    own = brighter(own, vec2(dot(found.list[vpl].intensity, vec3(1.0)), uintBitsToFloat(vpl)));
  brightest[i] = own;
  barrier();
  for (uint half_ = kGroup / 2u; half_ > 0u; half_ /= 2u) {
    if (i < half_) brightest[i] = brighter(brightest[i], brightest[i + half_]);
    barrier();
  }
  if (i == 0u) {
    uint chosen = floatBitsToUint(brightest[0].y);
    found.list[chosen].intensity *= 0.5;
    found.list[stored] = found.list[chosen];
  }
  memoryBarrierBuffer();
  barrier();
}

uint spreadBits(uint x) {  // spreads 10 bits to every third bit
  x = (x | (x << 16u)) & 0x030000ffu;
  x = (x | (x << 8u)) & 0x0300f00fu;
  x = (x | (x << 4u)) & 0x030c30c3u;
  return (x | (x << 2u)) & 0x09249249u;
}

void main() {
  uint i = gl_LocalInvocationID.x, stored = progress.value.stored;
  bool full = progress.value.full != 0u && stored > 0u;
  for (; full && stored < constants.count; ++stored) splitBrightest(stored);
  vec3 low = vec3(kFarthest), high = vec3(-kFarthest);
  for (uint vpl = i; vpl < stored; vpl += kGroup) {
    low = min(low, found.list[vpl].position);
    high = max(high, found.list[vpl].position);
  }
  lows[i] = low;
  highs[i] = high;
  barrier();
  for (uint half_ = kGroup / 2u; half_ > 0u; half_ /= 2u) {
    if (i < half_) {
      lows[i] = min(lows[i], lows[i + half_]);
      highs[i] = max(highs[i], highs[i + half_]);
    }
    barrier();
  }
  low = lows[0];
  vec3 size = highs[0] - low;
  float scale = 1023.0 / max(max(size.x, size.y), max(size.z, 1e-6));
  for (uint vpl = i; vpl < stored; vpl += kGroup) {
    uvec3 cell = uvec3((found.list[vpl].position - low) * scale);
    keys.list[vpl] = spreadBits(cell.x) | spreadBits(cell.y) << 1u | spreadBits(cell.z) << 2u;
  }
  if (i > 0u) return;
  progress.value.stored = stored;
  counters.vpls = stored;
}
