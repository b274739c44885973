// The unit in which the weighted light of all ends sums to kChannelSum in the brightest channel.
#include "records/eye_paths.h"
#include "eye-paths/sums.glsl"

layout(std430) buffer PathsEndsBlock { EyePathEnd list[]; } pathsEnds;
layout(std430) buffer CountersBlock { uint rays, ends; } counters;

void main() {
  uint count = uint(pathsEnds.list.length());
  vec4 own = vec4(0.0);
  for (uint path = gl_LocalInvocationID.x; path < count; path += kGroup) {
    EyePathEnd end = pathsEnds.list[path];
    own += vec4(end.radiance * end.weight, float(end.kind > 0.0));
  }
  vec4 sum = groupSum(own);
  float unit = max(sum.r, max(sum.g, sum.b)) / kChannelSum;
  for (uint path = gl_LocalInvocationID.x; path < count; path += kGroup) pathsEnds.list[path].unit = unit;
  if (gl_LocalInvocationID.x == 0u) counters.ends = uint(sum.a);
}
