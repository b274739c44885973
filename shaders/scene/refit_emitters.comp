// The nodes of the tree of emitters from this frame's vertices, one node per work group, whose invocations share its
// emitters. Their order in the tree stays.
#include "records/emitters.h"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Positions { vec4 positions[]; };
layout(std430) readonly buffer Triangles { uvec4 triangles[]; };  // `sceneTriangles` of scene/scene.glsl
layout(std430) buffer Emitters { uvec4 texels[]; };               // `rayEmitters` of rays/emitters.glsl

layout(push_constant) uniform Constants { uint nodes; };

const float kFarthest = 3.4e38;

struct Emitter {
  vec3 low, high;
  vec3 normal;  // unit
  float power;
  bool bothSides;
};

Emitter emitterAt(uint place) {
  uvec4 record = texels[1u + place];
  uint index = record.x & ~kEmitterBothSides;
  uvec4 triangle = triangles[index];
  vec3 a = positions[triangle.x].xyz, b = positions[triangle.y].xyz, c = positions[triangle.z].xyz;
  vec3 across = cross(b - a, c - a);
  float twice = length(across);
  return Emitter(min(a, min(b, c)), max(a, max(b, c)), twice > 0.0 ? across / twice : vec3(0.0),
                 uintBitsToFloat(record.y) * 0.5 * twice, record.x != index);
}

// The emitters of a node: one turn for each bit of its number but the first. Empty if there is no such node.
uvec2 rangeOf(uint node) {
  uvec2 range = uvec2(0u, texels[0].x);
  for (int bit = findMSB(node) - 1; bit >= 0; --bit) {
    if (range.y - range.x <= kEmittersInLeaf) return uvec2(0u);
    uint middle = range.x + (range.y - range.x) / 2u;
    range = (node >> bit & 1u) == 0u ? uvec2(range.x, middle) : uvec2(middle, range.y);
  }
  return range;
}

const uint kGroup = 64u;

shared vec4 parts[kGroup];

// What `merge` makes of the values of all invocations of a group, in a fixed order.
#define COMBINE(own, merge)                                     \
  parts[gl_LocalInvocationID.x] = own;                          \
  barrier();                                                    \
  for (uint half_ = kGroup / 2u; half_ > 0u; half_ /= 2u) {     \
    if (gl_LocalInvocationID.x < half_)                         \
      parts[gl_LocalInvocationID.x] =                           \
          merge(parts[gl_LocalInvocationID.x], parts[gl_LocalInvocationID.x + half_]); \
    barrier();                                                  \
  }                                                             \
  own = parts[0];                                               \
  barrier();

vec4 plus(vec4 a, vec4 b) { return a + b; }

void main() {
  uint node = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uvec2 range = node > 0u && node < nodes ? rangeOf(node) : uvec2(0u);
  if (range.x == range.y) return;  // all invocations of the group do
  // Axis and power; corners, and whether all emitters emit to one side only.
  vec4 sum = vec4(0.0), low = vec4(vec3(kFarthest), 1.0), high = vec4(-kFarthest);
  for (uint i = range.x + gl_LocalInvocationID.x; i < range.y; i += kGroup) {
    Emitter e = emitterAt(i);
    low = min(low, vec4(e.low, e.bothSides ? 0.0 : 1.0));
    high.xyz = max(high.xyz, e.high);
    sum += vec4(e.power * e.normal, e.power);
  }
  COMBINE(sum, plus)
  COMBINE(low, min)
  COMBINE(high, max)
  float size = length(sum.xyz);
  vec3 axis = size > 0.0 ? sum.xyz / size : vec3(0.0);
  vec4 least = vec4(1.0);
  for (uint i = range.x + gl_LocalInvocationID.x; i < range.y; i += kGroup)
    least = min(least, vec4(dot(axis, emitterAt(i).normal)));
  COMBINE(least, min)
  if (gl_LocalInvocationID.x != 0u) return;
  float spread = size > 0.0 && low.w > 0.0 ? max(least.x - kConeRounding, -1.0) : -1.0;
  vec3 box = high.xyz - low.xyz;
  uint first = texels[0].y + 3u * node;
  texels[first] = floatBitsToUint(vec4(0.5 * (low.xyz + high.xyz), 0.25 * dot(box, box)));
  texels[first + 1u] = floatBitsToUint(vec4(axis, spread));
  texels[first + 2u].x = floatBitsToUint(sum.w);
}
