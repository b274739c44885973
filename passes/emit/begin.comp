// The power of the sources, and the first round of paths. The light of a path is chosen by the sums in `shares`.
#define RAY_PASSAGE 0
#include "emit/sources.glsl"
#include "emit/rounds.glsl"

layout(local_size_x = 128) in;  // kMaxLights

VALUE(writeonly, LightPaths, progress);
LIST(writeonly, float, shares);

layout(push_constant) uniform Constants {
  uint count;
  uint bounces;
  uint emissive;
} constants;

shared float powers[kMaxLights];

void main() {
  uint i = gl_LocalInvocationID.x;
  float own = i < frame.lightCount ? meanChannel(powerOf(lights[i])) : 0.0;
  powers[i] = own > 0.0 && !isinf(own) ? own : 0.0;
  barrier();
  if (i > 0u) return;
  float power = 0.0;
  for (uint light = 0u; light < frame.lightCount; ++light) {
    power += powers[light];
    shares.list[light] = power;
  }
  LightPaths start;
  start.lightPower = power;
  start.power = power + (constants.emissive != 0u ? emissivePower() : 0.0);
  // The longest path must fit into an empty list.
  bool hasSurfaces = start.power > power;
  start.bounces = min(constants.bounces, constants.count - uint(hasSurfaces));
  bool any = frame.triangleCount > 0u && start.power > 0.0 && (start.bounces > 0u || hasSurfaces);
  start.first = 0u;
  start.count = any ? constants.count : 0u;
  uvec2 groups = groupsOf(start.count);
  start.groupsX = groups.x;
  start.groupsY = groups.y;
  start.groupsZ = 1u;
  start.paths = 0u;
  start.stored = 0u;
  start.full = 0u;
  start.unused = 0u;
  progress.value = start;
}
