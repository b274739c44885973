// Vertices of a subdivision surface from this frame's points of its cage: limit position and normal by stencils, by the
// same operations in the same order as Stencils::evaluate() in framework/scene/subdivision/subdivision.h.
#include "scene/octahedral.glsl"

layout(local_size_x = 64) in;

uniform utextureBuffer ranges;   // first entry and count of each vertex
uniform utextureBuffer entries;  // bits of the weights: position, tangent a, tangent b; point
uniform textureBuffer points;    // xyz
layout(std430) writeonly buffer Positions { vec4 positions[]; };
layout(std430) buffer Attributes { vec4 attributes[]; };  // xy: octahedral normal, zw: uv, which is left unchanged

layout(push_constant) uniform Constants {
  uint firstRange;
  uint count;
  uint firstPoint;
  uint firstVertex;
  float side;  // -1 if the points are mirrored, so that a x b points inwards
};

void main() {
  uint vertex = gl_GlobalInvocationID.x;
  if (vertex >= count) return;
  uvec2 range = texelFetch(ranges, int(firstRange + vertex)).xy;
  vec3 position = vec3(0.0), a = vec3(0.0), b = vec3(0.0);
  for (uint i = range.x; i < range.x + range.y; ++i) {
    uvec4 entry = texelFetch(entries, int(i));
    vec3 weights = uintBitsToFloat(entry.xyz);
    vec3 point = texelFetch(points, int(firstPoint + entry.w)).xyz;
    position += weights.x * point;
    a += weights.y * point;
    b += weights.z * point;
  }
  vec3 normal = side * cross(a, b);
  float size = length(normal);
  // Also covers infinity and NaN.
  normal = size > 0.0 && size < 1e38 ? normal / size : vec3(0.0, 1.0, 0.0);
  positions[firstVertex + vertex] = vec4(position, 1.0);
  attributes[firstVertex + vertex].xy = octEncode(normal);
}
