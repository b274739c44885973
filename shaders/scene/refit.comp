// Computes boxes of a bounding volume hierarchy from this frame's vertices: in each invocation those of one part of the
// tree (RefitOrder of framework/scene/rays/bvh.h), from its leaves up.
#include "records/rays.h"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Positions { vec4 positions[]; };
layout(std430) readonly buffer Triangles { uvec4 triangles[]; };  // `rayTriangles` of rays/trace.glsl
layout(std430) buffer Nodes { BvhNode nodes[]; };
layout(std430) readonly buffer Order { uint order[]; };
layout(std430) readonly buffer Parts { uint parts[]; };

layout(push_constant) uniform Constants {
  uint place;  // where the second node of the tree is, less 1
  uint begin, end;  // parts of this round
};

const float kFarthest = 3.4e38;

void refit(uint node) {
  uint at = node == 0u ? kBvhMoving : place + node, first = nodes[at].first, count = nodes[at].count;
  vec3 low = vec3(kFarthest), high = vec3(-kFarthest);
  for (uint t = first; t < first + count; ++t) {
    uvec4 triangle = triangles[t];
    for (int k = 0; k < 3; ++k) {
      vec3 p = positions[triangle[k]].xyz;
      low = min(low, p);
      high = max(high, p);
    }
  }
  if (count == 0u) {
    low = min(nodes[first].low, nodes[first + 1u].low);
    high = max(nodes[first].high, nodes[first + 1u].high);
  }
  nodes[at].low = low;
  nodes[at].high = high;
}

void main() {
  uint rowSize = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  uint part = begin + gl_GlobalInvocationID.y * rowSize + gl_GlobalInvocationID.x;
  if (part >= end) return;
  for (uint i = parts[part]; i < parts[part + 1u]; ++i) refit(order[i]);
}
