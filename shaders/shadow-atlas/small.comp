#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Second of two: pairs of a VPL and a triangle that covers few texels, one an invocation.
#include "common/paraboloid.glsl"
#include "shadow-atlas/project.glsl"
#include "shadow-atlas/step.glsl"
#include "shadow-atlas/triangles.glsl"

layout(local_size_x = 64) in;  // kSmallPerGroup

layout(set = 0, std140) uniform BatchBlock { VplView views[BATCH]; } batch;
layout(set = 0, std430) readonly buffer StepsBlock { Step list[]; } steps;
layout(set = 0, std430) readonly buffer PairsBlock { uint list[]; } pairs;
layout(set = 0, std430) buffer CountersBlock { uint maps, small, large, masked; } counters;
layout(set = 0, r32ui) uniform uimage2DArray atlas;

layout(push_constant) uniform Constants {
  uint step_;
  uint size;
  float planeEpsilon;
};

void main() {
  uint entry = (gl_WorkGroupID.y * kGroupsPerRow + gl_WorkGroupID.x) * kSmallPerGroup + gl_LocalInvocationIndex;
  if (entry == 0u) atomicAdd(counters.small, steps.list[step_].smallCount);
  if (entry >= steps.list[step_].smallCount) return;
  uint pair = pairs.list[entry];
  VplView view = batch.views[pair >> kTriangleBits];
  Triangle triangle = loadTriangle(pair & kTriangleMask);
  vec3 a = seenFrom(view, triangle.a), b = seenFrom(view, triangle.b), c = seenFrom(view, triangle.c);
  bool tight;
  TexelBox box = projectedBox(a, b, c, float(size), tight);
  RayTest test = rayTest(view, triangle, planeEpsilon);
  ivec3 origin = atlasTexel(uint(view.positionSlot.w), ivec2(0), atlasLayout(imageSize(atlas)));

  vec2 texel = box.lo;
  float toMap = 2.0 / float(size);
  do {
    vec3 weights;
    float distance_ = hitDistance(test, (texel + 0.5) * toMap - 1.0, weights);
    if (distance_ > 0.0) imageAtomicMin(atlas, origin + ivec3(texel, 0), floatBitsToUint(distance_));
    texel.x += 1.0;
    bool next = texel.x > box.hi.x;
    texel = next ? vec2(box.lo.x, texel.y + 1.0) : texel;
  } while (texel.y <= box.hi.y);
}
