// The boxes of one level of a bounding volume hierarchy from this frame's vertices, one node per invocation. The boxes
// of the level below are already those of this frame.
#include "records/rays.h"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Positions { vec4 positions[]; };
layout(std430) readonly buffer Triangles { uvec4 triangles[]; };  // `rayTriangles` of rays/trace.glsl
layout(std430) buffer Nodes { BvhNode nodes[]; };

layout(push_constant) uniform Constants {
  uint first;
  uint count;
};

const float kFarthest = 3.4e38;

void main() {
  uint i = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  if (i >= count) return;
  BvhNode node = nodes[first + i];
  vec3 low = vec3(kFarthest), high = vec3(-kFarthest);
  for (uint t = node.first; t < node.first + node.count; ++t) {
    uvec4 triangle = triangles[t];
    for (int k = 0; k < 3; ++k) {
      vec3 p = positions[triangle[k]].xyz;
      low = min(low, p);
      high = max(high, p);
    }
  }
  if (node.count == 0u) {
    low = min(nodes[node.first].low, nodes[node.first + 1u].low);
    high = max(nodes[node.first].high, nodes[node.first + 1u].high);
  }
  nodes[first + i].low = low;
  nodes[first + i].high = high;
}
