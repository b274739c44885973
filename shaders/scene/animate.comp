// Vertices of moving geometry, one per invocation: morph targets, then joints or the object's transform, by the same
// operations in the same order as placeVertices() in framework/scene/motion/deform.h, which moves them for passes on
// the host. Points of subdivision cages go to a buffer of their own, of which subdivide.comp makes vertices.
#include "scene/octahedral.glsl"

layout(local_size_x = 64) in;

// Two texels per vertex: xyz at rest, w: shape; xyz normal, w: alpha of the colour.
uniform textureBuffer rest;
// Two texels per shape (a primitive of an object, or its cage): first joint, first weight, number of morph targets,
// object | sets of joints << 16; first entry in the skin + 1 (0 if it has no joints), first texel of the targets, first
// vertex, number of vertices (0 if stencils make them).
uniform utextureBuffer shapes;
uniform utextureBuffer skinJoints;   // sets of four joints per vertex, one set after the other
uniform textureBuffer skinWeights;
uniform textureBuffer targets;       // two texels per vertex and target: displacements of position and normal
// Objects from `firstPose` (three rows of the transform to the world, then x: visible), joints from `firstJoint`
// (three rows), weights from `firstWeight`, four per texel.
uniform textureBuffer poses;
layout(std430) writeonly buffer Positions { vec4 positions[]; };
layout(std430) buffer Attributes { vec4 attributes[]; };  // xy: octahedral normal, zw: uv, which is left unchanged
layout(std430) writeonly buffer Points { vec4 points[]; };

layout(push_constant) uniform Constants {
  uint count;        // invocations: vertices, then points
  uint vertices;     // invocations that are vertices
  uint firstVertex;  // in `positions`
  uint firstPose, firstJoint, firstWeight;  // texels
};

mat4x3 rowsAt(uint texel) {
  int i = int(texel);
  return transpose(mat3x4(texelFetch(poses, i), texelFetch(poses, i + 1), texelFetch(poses, i + 2)));
}

float weightAt(uint i) { return texelFetch(poses, int(firstWeight + i / 4u))[i % 4u]; }

// Cofactors instead of the inverse transpose, so that normals are also correct for transforms that flatten an object.
mat3 normalMatrix(mat4x3 m) {
  mat3 a = mat3(m);
  return (determinant(a) < 0.0 ? -1.0 : 1.0) * mat3(cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1]));
}

void main() {
  uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
  if (i >= count) return;
  vec4 first = texelFetch(rest, int(2u * i));
  vec4 second = texelFetch(rest, int(2u * i + 1u));
  vec3 position = first.xyz, normal = second.xyz;
  uvec4 what = texelFetch(shapes, int(2u * uint(first.w))), where = texelFetch(shapes, int(2u * uint(first.w)) + 1);
  if (where.w == 0u) return;
  uint object = firstPose + 4u * (what.w & 0xffffu), sets = what.w >> 16;
  mat4x3 toWorld = rowsAt(object);
  if (texelFetch(poses, int(object + 3u)).x < 0.5) {
    position = toWorld[3];
    normal = vec3(0.0, 1.0, 0.0);
  } else {
    uint vertex = i - where.z;
    for (uint t = 0u; t < what.z; ++t) {
      float weight = weightAt(what.y + t);
      if (weight == 0.0) continue;
      int texel = int(where.y + 2u * (t * where.w + vertex));
      position += weight * texelFetch(targets, texel).xyz;
      normal += weight * texelFetch(targets, texel + 1).xyz;
    }
    if (where.x != 0u) {
      toWorld = mat4x3(0.0);
      for (uint set = 0u; set < sets; ++set) {
        int entry = int(where.x - 1u + set * where.w + vertex);
        uvec4 joints = texelFetch(skinJoints, entry);
        vec4 weights = texelFetch(skinWeights, entry);
        for (int k = 0; k < 4; ++k)
          if (weights[k] != 0.0) toWorld += weights[k] * rowsAt(firstJoint + 3u * (what.x + joints[k]));
      }
    }
    position = toWorld * vec4(position, 1.0);
    normal = normalMatrix(toWorld) * normal;
    float size = length(normal);
    normal = size > 0.0 && size < 1e38 ? normal / size : vec3(0.0, 1.0, 0.0);  // also covers infinity and NaN
  }
  if (i < vertices) {
    positions[firstVertex + i] = vec4(position, second.w);
    attributes[firstVertex + i].xy = octEncode(normal);
  } else {
    points[i - vertices] = vec4(position, 1.0);
  }
}
