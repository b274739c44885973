#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Second of two: pairs of a VPL and a triangle that covers many texels, or (MASKED) whose material has holes. Eight
// invocations a pair.
#include "common/paraboloid.glsl"
#include "shadow-atlas/project.glsl"
#include "shadow-atlas/step.glsl"
#include "shadow-atlas/triangles.glsl"

layout(local_size_x = 64) in;  // 8 * kLargePerGroup

layout(set = 0, std140) uniform BatchBlock { VplView views[BATCH]; } batch;
layout(set = 0, std430) readonly buffer StepsBlock { Step list[]; } steps;
layout(set = 0, std430) readonly buffer PairsBlock { uint list[]; } pairs;
layout(set = 0, std430) buffer CountersBlock { uint maps, small, large, masked; } counters;
layout(set = 0, r32ui) uniform uimage2DArray atlas;

layout(push_constant) uniform Constants {
  uint step_;
  uint capacity;
  uint size;
  uint slice, slices;  // of every pair's texels: a loop ends after 65,535 turns on some devices
  float planeEpsilon;
};

void main() {
  uint group = gl_WorkGroupID.y * kGroupsPerRow + gl_WorkGroupID.x;
  uint entry = group * kLargePerGroup + gl_LocalInvocationIndex / 8u;
  bool counts = slice == 0u && entry == 0u && gl_LocalInvocationIndex == 0u;
#ifdef MASKED
  if (counts) atomicAdd(counters.masked, steps.list[step_].maskedCount);
  if (entry >= steps.list[step_].maskedCount) return;
  uint pair = pairs.list[capacity + entry];
#else
  if (counts) atomicAdd(counters.large, steps.list[step_].largeCount);
  if (entry >= steps.list[step_].largeCount) return;
  uint pair = pairs.list[capacity - 1u - entry];
#endif
  VplView view = batch.views[pair >> kTriangleBits];
  Triangle triangle = loadTriangle(pair & kTriangleMask);
  vec3 a = seenFrom(view, triangle.a), b = seenFrom(view, triangle.b), c = seenFrom(view, triangle.c);
  bool tight;
  TexelBox box = projectedBox(a, b, c, float(size), tight);
  TexelBox cut = clippedBox(a, b, c, float(size));
  if (!tight) box = cut;
  if (isEmpty(box)) return;
  RayTest test = rayTest(view, triangle, planeEpsilon);
  ivec3 origin = atlasTexel(uint(view.positionSlot.w), ivec2(0), atlasLayout(imageSize(atlas)));
#ifdef MASKED
  vec2 uvA = texelFetch(sceneAttributes, int(triangle.vertices.x)).zw;
  vec2 uvB = texelFetch(sceneAttributes, int(triangle.vertices.y)).zw;
  vec2 uvC = texelFetch(sceneAttributes, int(triangle.vertices.z)).zw;
#endif

  int width = int(box.hi.x - box.lo.x) + 1;
  int texels = int(texelCount(box));
  float perRow = 1.0 / float(width);
  float toMap = 2.0 / float(size);
  int i = int(slice * 8u + gl_LocalInvocationIndex % 8u);
  do {
    float row = floor((float(i) + 0.5) * perRow);
    vec2 texel = box.lo + vec2(float(i - int(row) * width), row);
    vec3 weights;
    float distance_ = hitDistance(test, (texel + 0.5) * toMap - 1.0, weights);
    bool hit = distance_ > 0.0 && i < texels;
#ifdef MASKED
    weights /= weights.x + weights.y + weights.z;
    hit = hit && alphaTest(triangle.material, weights.x * uvC + weights.y * uvA + weights.z * uvB);
#endif
    if (hit) imageAtomicMin(atlas, origin + ivec3(texel, 0), floatBitsToUint(distance_));
    i += int(slices * 8u);
  } while (i < texels);
}
