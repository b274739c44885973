// Computes the boxes of some levels of a bounding volume hierarchy from this frame's vertices, beginning with the deepest
// of these levels. The boxes below it are already those of this frame. A dispatch for several levels has a single group.
#include "records/rays.h"

layout(local_size_x = 256) in;

layout(std430) readonly buffer Positions { vec4 positions[]; };
layout(std430) readonly buffer Triangles { uvec4 triangles[]; };  // `rayTriangles` of rays/trace.glsl
layout(std430) coherent buffer Nodes { BvhNode nodes[]; };
layout(std430) readonly buffer Levels { uint levels[]; };  // first node of each, then the number of nodes

layout(push_constant) uniform Constants {
  uint place;  // where the second node of the tree is, less 1
  uint highest, deepest;
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
  uint rowSize = gl_NumWorkGroups.x * gl_WorkGroupSize.x, size = gl_NumWorkGroups.y * rowSize;
  uint index = gl_GlobalInvocationID.y * rowSize + gl_GlobalInvocationID.x;
  for (uint level = deepest + 1u; level-- > highest;) {
    for (uint node = levels[level] + index; node < levels[level + 1u]; node += size) refit(node);
    memoryBarrierBuffer();
    barrier();
  }
}
