// The triangles of a step: the scene's, or the simplified mesh's.
#ifndef FOVEA_SHADOW_ATLAS_TRIANGLES_GLSL
#define FOVEA_SHADOW_ATLAS_TRIANGLES_GLSL

#ifdef SIMPLIFIED
layout(set = 0) uniform samplerBuffer simplified;  // three vertices a triangle
#else
#include "common/scene.glsl"
#endif

struct Triangle {
  vec3 a, b, c;
  uvec3 vertices;
  uint material;
};

#ifdef SIMPLIFIED
Triangle loadTriangle(uint index) {
  int i = 3 * int(index);
  return Triangle(texelFetch(simplified, i).xyz, texelFetch(simplified, i + 1).xyz, texelFetch(simplified, i + 2).xyz,
                  uvec3(0), 0u);
}
bool isMasked(Triangle t) { return false; }  // masked triangles are never simplified
#else
Triangle loadTriangle(uint index) {
  uvec4 t = texelFetch(sceneTriangles, int(index));
  return Triangle(texelFetch(scenePositions, int(t.x)).xyz, texelFetch(scenePositions, int(t.y)).xyz,
                  texelFetch(scenePositions, int(t.z)).xyz, t.xyz, t.w & 0xffffu);
}
bool isMasked(Triangle t) { return loadMaterial(t.material).alphaCutoff > 0.0; }
#endif

vec3 seenFrom(VplView v, vec3 p) {
  vec3 w = p - v.positionSlot.xyz;
  return vec3(dot(v.tangent.xyz, w), dot(v.bitangent.xyz, w), dot(v.normal.xyz, w));
}

#endif
