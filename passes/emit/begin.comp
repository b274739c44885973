// The power of the sources, and the first round of paths. `shares` gets the sums by which paths choose a light. Define:
// RAY_PASSAGE 0 (rays/trace.glsl).
#include "emit/sources.glsl"
#include "emit/rounds.glsl"

layout(local_size_x = 1) in;

VALUE(writeonly, LightPaths, progress);
LIST(writeonly, float, shares);

layout(push_constant) uniform Constants {
  uint count;
  uint bounces;
  uint emissive;
} constants;

CONSTANT float kMostPower = 3e38;

void main() {
  float lightPower = 0.0;
  for (uint i = 0u; i < frame.lightCount; ++i) {
    float own = meanChannel(powerOf(lights[i]));
    if (own > 0.0 && own < kMostPower) lightPower += own;
    shares.list[i] = lightPower;
  }
  float power = lightPower + (constants.emissive != 0u ? emissivePower() : 0.0);
  // The longest path must fit into an empty list.
  bool hasSurfaces = power > lightPower;
  uint bounces = min(constants.bounces, constants.count - uint(hasSurfaces));
  bool any = frame.triangleCount > 0u && power > 0.0 && (bounces > 0u || hasSurfaces);
  uint paths = any ? constants.count : 0u;
  uvec2 groups = groupsOf(paths);
  progress.value = LightPaths(groups.x, groups.y, 1u, 0u, paths, 0u, 0u, 0u, bounces, lightPower, power, 0u);
}
