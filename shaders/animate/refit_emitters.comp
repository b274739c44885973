// The nodes of the tree of emitters from this frame's vertices, one per invocation. Each goes through all of its
// emitters, which are few; their order in the tree stays.
#include "common/records/emitters.h"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Positions { vec4 positions[]; };
layout(std430) readonly buffer Triangles { uvec4 triangles[]; };  // `sceneTriangles` of common/scene.glsl
layout(std430) buffer Emitters { uvec4 texels[]; };               // `rayEmitters` of common/rays/emitters.glsl

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

void main() {
  uint node = gl_GlobalInvocationID.x;
  uvec2 range = node > 0u ? rangeOf(node) : uvec2(0u);
  if (range.x == range.y) return;
  vec3 low = vec3(kFarthest), high = vec3(-kFarthest), axis = vec3(0.0);
  float power = 0.0;
  bool allDirections = false;
  for (uint i = range.x; i < range.y; ++i) {
    Emitter e = emitterAt(i);
    low = min(low, e.low);
    high = max(high, e.high);
    power += e.power;
    axis += e.power * e.normal;
    allDirections = allDirections || e.bothSides;
  }
  float spread = -1.0, size = length(axis);
  if (size > 0.0 && !allDirections) {
    axis /= size;
    spread = 1.0;
    for (uint i = range.x; i < range.y; ++i) spread = min(spread, dot(axis, emitterAt(i).normal));
    spread = max(spread - kConeRounding, -1.0);
  }
  vec3 box = high - low;
  uint first = texels[0].y + 3u * node;
  texels[first] = floatBitsToUint(vec4(0.5 * (low + high), 0.25 * dot(box, box)));
  texels[first + 1u] = floatBitsToUint(vec4(axis, spread));
  texels[first + 2u].x = floatBitsToUint(power);
}
