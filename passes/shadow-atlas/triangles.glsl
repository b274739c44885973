// The triangles of a step: the scene's, or the simplified mesh's.
#ifndef FOVEA_SHADOW_ATLAS_TRIANGLES_GLSL
#define FOVEA_SHADOW_ATLAS_TRIANGLES_GLSL

#include "device/texels.glsl"
#include "scene/scene.glsl"

#ifdef SIMPLIFIED
LARGE_TEXELS(vec4, simplified);  // SimplifiedMesh::corners of framework/scene/device/simplify.h
#endif

struct Triangle {
  vec3 a, b, c;
  uvec3 vertices;
  uint material;
};

Triangle wholeTriangle(uint index) {
  uvec4 t = texelOf(sceneTriangles, int(index));
  return Triangle(texelOf(scenePositions, int(t.x)).xyz, texelOf(scenePositions, int(t.y)).xyz,
                  texelOf(scenePositions, int(t.z)).xyz, t.xyz, t.w & 0xffffu);
}

#ifdef SIMPLIFIED
bool isMasked(uint index) { return texelOf(simplified, 3 * int(index)).w > 0.0; }

Triangle loadTriangle(uint index) {
#ifdef MASKED
  return wholeTriangle(uint(texelOf(simplified, 3 * int(index)).w) - 1u);
#else
  int i = 3 * int(index);
  return Triangle(texelOf(simplified, i).xyz, texelOf(simplified, i + 1).xyz, texelOf(simplified, i + 2).xyz,
                  uvec3(0u), 0u);
#endif
}
#else
bool isMasked(uint index) {
  return loadMaterial(texelOf(sceneTriangles, int(index)).w & 0xffffu).alphaCutoff != 0.0;
}

Triangle loadTriangle(uint index) { return wholeTriangle(index); }
#endif

vec3 inFrame(VplView v, vec3 w) { return vec3(dot(v.tangent, w), dot(v.bitangent, w), dot(v.normal, w)); }
vec3 seenFrom(VplView v, vec3 p) { return inFrame(v, p - v.position); }

RayTest rayTest(VplView v, Triangle t, float epsilon) {
  vec3 n = cross(t.b - t.a, t.c - t.a);
  return rayTest(seenFrom(v, t.a), seenFrom(v, t.b), seenFrom(v, t.c), inFrame(v, n), dot(n, t.a - v.position),
                 epsilon);
}

#endif
