// Transforms of the scene's objects, and points that move with them.
#ifndef FOVEA_OBJECTS_GLSL
#define FOVEA_OBJECTS_GLSL

#include "scene/scene.glsl"

// The coordinates of a point in an object's own space (VplState.localPosition) stay valid while the object moves.
const int kObjectTexels = 10;

mat4x3 objectRows(uint object, int row) {
  int i = int(object) * kObjectTexels + row;
  return transpose(mat3x4(texelOf(sceneObjects, i), texelOf(sceneObjects, i + 1), texelOf(sceneObjects, i + 2)));
}
mat4x3 objectTransform(uint object) { return objectRows(object, 0); }
mat4x3 previousObjectTransform(uint object) { return objectRows(object, 3); }
mat4x3 inverseObjectTransform(uint object) { return objectRows(object, 6); }
bool objectVisible(uint object) { return texelOf(sceneObjects, int(object) * kObjectTexels + 9).x > 0.5; }
bool objectWasVisible(uint object) { return texelOf(sceneObjects, int(object) * kObjectTexels + 9).y > 0.5; }

// The vertices of the object move individually (morph targets, joints), so a point keeps its place
// in a triangle instead.
bool objectDeforms(uint object) { return texelOf(sceneObjects, int(object) * kObjectTexels + 9).z > 0.5; }

vec3 fromObject(uint object, vec3 position) { return objectTransform(object) * vec4(position, 1.0); }
vec3 toObject(uint object, vec3 position) { return inverseObjectTransform(object) * vec4(position, 1.0); }
// Unit normals, also for non-uniform scales.
vec3 normalFromObject(uint object, vec3 n) { return normalize(transpose(mat3(inverseObjectTransform(object))) * n); }
vec3 normalToObject(uint object, vec3 n) { return normalize(transpose(mat3(objectTransform(object))) * n); }

// ---- Points of surfaces that deform -------------------------------------------------------------------------------

// A point keeps its place in a triangle of those used for voxels: the triangle's number past frame.firstMovingTriangle
// (exact as a float below 2^24) and the weights of its second and third vertex. A direction keeps its components
// along the triangle's axes.

// The point of the triangle that is nearest to `position` (Ericson 2005, 5.1.5).
vec3 attach(uint triangle, vec3 position) {
  uvec4 t = sceneTriangle(frame.firstMovingTriangle + triangle);
  vec3 a = scenePosition(t.x), ab = scenePosition(t.y) - a, ac = scenePosition(t.z) - a, ap = position - a;
  float d1 = dot(ab, ap), d2 = dot(ac, ap), bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
  float area = bb * cc - bc * bc;
  float v = area > 0.0 ? (cc * d1 - bc * d2) / area : 0.0, w = area > 0.0 ? (bb * d2 - bc * d1) / area : 0.0;
  if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) return vec3(triangle, v, w);
  // The nearest point is on the nearest edge.
  float onB = clamp(d1 / max(bb, 1e-30), 0.0, 1.0), onC = clamp(d2 / max(cc, 1e-30), 0.0, 1.0);
  vec3 bp = ap - ab, edge = ac - ab;
  float onEdge = clamp(dot(edge, bp) / max(dot(edge, edge), 1e-30), 0.0, 1.0);
  vec3 toB = ap - onB * ab, toC = ap - onC * ac, toEdge = bp - onEdge * edge;
  float b2 = dot(toB, toB), c2 = dot(toC, toC), e2 = dot(toEdge, toEdge);
  if (b2 <= c2 && b2 <= e2) return vec3(triangle, onB, 0.0);
  return c2 <= e2 ? vec3(triangle, 0.0, onC) : vec3(triangle, 1.0 - onEdge, onEdge);
}

vec3 attachedPosition(vec3 place) {
  uvec4 t = sceneTriangle(frame.firstMovingTriangle + uint(place.x));
  vec3 a = scenePosition(t.x);
  return a + place.y * (scenePosition(t.y) - a) + place.z * (scenePosition(t.z) - a);
}

// Unit columns: along the first edge, across it in the plane, and the normal.
mat3 triangleAxes(uint triangle) {
  uvec4 t = sceneTriangle(frame.firstMovingTriangle + triangle);
  vec3 a = scenePosition(t.x), edge = scenePosition(t.y) - a, n = cross(edge, scenePosition(t.z) - a);
  if (!(dot(n, n) > 0.0)) return mat3(1.0);
  edge = normalize(edge);
  n = normalize(n);
  return mat3(edge, cross(n, edge), n);
}

#endif
