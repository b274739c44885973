// How much of the light has changed: the output `change` (passes/README.md, eye-paths).
#include "records/eye_paths.h"
#include "eye-paths/sums.glsl"

layout(std430) readonly buffer DifferencesBlock { EyePathDifference list[]; } differences;
layout(std430) buffer MemoryBlock { EyePathMemory value; } memory;
layout(std430) writeonly buffer ChangeBlock { vec4 list[]; } change;

layout(push_constant) uniform Constants { uint points; };

void main() {
  vec4 own = vec4(0.0);  // changed, gained, larger, and the squares of what the points have gained
  for (uint point = gl_LocalInvocationID.x; point < points; point += kGroup) {
    float gained = 0.0;
    for (uint path = point; path < uint(differences.list.length()); path += points) {
      EyePathDifference d = differences.list[path];
      own.xz += vec2(d.changed, d.larger);
      gained += d.gained;
    }
    own.yw += vec2(gained, gained * gained);
  }
  vec4 sum = groupSum(own);
  if (gl_LocalInvocationID.x != 0u) return;
  // Also 0 where there is no light, or none that is a number.
  float share = sum.x / sum.z, changed = share > 0.0 ? min(share, 1.0) : 0.0;
  float oneWay = sqrt(max(sum.y * sum.y - sum.w, 0.0)) / sum.z, drift = oneWay > 0.0 ? min(oneWay, 1.0) : 0.0;
  // Running means are made for what moves all the time, so only what is sudden or goes one way ages them.
  EyePathMemory kept = memory.value;
  float sudden = changed - kept.usualChange, unfollowed = max(sudden, drift);
  float ageing = kBiasWeight * unfollowed * unfollowed;
  memory.value.outOfTurn = kOutOfTurn * sudden;
  memory.value.usualChange = max(changed, kUsualKept * kept.usualChange);
  memory.value.lost = max(ageing / (1.0 + ageing), kept.lost - kRegained);
  change.list[0] = vec4(changed, ageing, memory.value.lost, drift);
}
