// One work group per slot: draws the disc of its VPL into the pixels' keys, where the nearest one stays.
#include "scene/scene.glsl"
#include "vpls/vpl.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer state;  // VplState
#if DEPTH_TEST
layout(r32f) uniform readonly image2D gbufferDistance;
#endif
layout(std430) buffer KeysBlock { uint pixel[]; } keys;

layout(push_constant) uniform Constants {
  ivec2 size;
  float radius;  // px
};

void main() {
  uint slot = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (slot >= vplStates(state)) return;
  VplState vpl = loadVplState(state, slot);
  vec4 clip = view.worldToClip * vec4(vpl.position, 1.0);
  if (!(vpl.life > 0.0 && clip.w > 0.0)) return;
  vec2 centre = (0.5 * clip.xy / clip.w + 0.5) * vec2(size);
  if (!(all(greaterThanEqual(centre, vec2(0.0))) && all(lessThan(centre, vec2(size))))) return;
  float distance = length(vpl.position - view.eye);
#if DEPTH_TEST
  // Draws the VPL if it is in front of the surface seen at its centre, or on it; the tolerance allows
  // for a voxel's size.
  float seen = imageLoad(gbufferDistance, ivec2(centre)).r;
  if (seen > 0.0 && distance > 1.03 * seen) return;
#endif
  // The upper bits of a positive float order as the float does. Of VPLs with the same upper bits, the lower
  // slot is on top.
  uint key = (floatBitsToUint(distance) >> 15) << 16 | slot;
  ivec2 lo = max(ivec2(centre - radius), ivec2(0)), hi = min(ivec2(centre + radius), size - 1);
  int width = hi.x - lo.x + 1, pixels = width * (hi.y - lo.y + 1);
  for (int i = int(gl_LocalInvocationIndex); i < pixels; i += 64) {
    ivec2 p = lo + ivec2(i % width, i / width);
    vec2 d = vec2(p) + 0.5 - centre;
    // The pixel under the centre always counts, so that no visible VPL is missed.
    if (dot(d, d) <= radius * radius || p == ivec2(centre)) atomicMin(keys.pixel[p.y * size.x + p.x], key);
  }
}
