// Strategy `area`, last step: turns the sums of sides into areas.
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer SumsBlock { uvec2 list[]; } sums;
layout(std430) writeonly buffer AreasBlock { float list[]; } areas;

layout(push_constant) uniform Constants { uint vplCount; };

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot < vplCount) areas.list[slot] = unitsToArea(voxelsGrid(), sums.list[slot].x, sums.list[slot].y);
}
