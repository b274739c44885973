// Transforms of the scene's objects, and points that move with them. An object's own space is that of its mesh. Object
// 0 holds everything that never moves, and its own space is the world's.
#ifndef FOVEA_OBJECTS_GLSL
#define FOVEA_OBJECTS_GLSL

#include "scene/scene.glsl"

// Texels of an ObjectRecord in `sceneObjects`.
const int kObjectTexels = 10;

// Transforms of points, m: from the object to the world in this frame and in the previous one, and from the world to
// the object, all 0 if there is no inverse. row: texel of the record at which a transform starts.
mat4x3 objectRows(uint object, int row) {
  int i = int(object) * kObjectTexels + row;
  return transpose(mat3x4(texelOf(sceneObjects, i), texelOf(sceneObjects, i + 1), texelOf(sceneObjects, i + 2)));
}
mat4x3 objectTransform(uint object) { return objectRows(object, 0); }
mat4x3 previousObjectTransform(uint object) { return objectRows(object, 3); }
mat4x3 inverseObjectTransform(uint object) { return objectRows(object, 6); }
// Whether the object is shown in this frame, and in the previous one.
bool objectVisible(uint object) { return texelOf(sceneObjects, int(object) * kObjectTexels + 9).x > 0.5; }
bool objectWasVisible(uint object) { return texelOf(sceneObjects, int(object) * kObjectTexels + 9).y > 0.5; }

// Whether the vertices of the object move individually (morph targets, joints). A point of its surface then keeps its
// place in a triangle and not in the object's space.
bool objectDeforms(uint object) { return texelOf(sceneObjects, int(object) * kObjectTexels + 9).z > 0.5; }

// Points from and to an object's own space, m. Coordinates there stay valid while the object moves
// (VplState::localPosition).
vec3 fromObject(uint object, vec3 position) { return objectTransform(object) * vec4(position, 1.0); }
vec3 toObject(uint object, vec3 position) { return inverseObjectTransform(object) * vec4(position, 1.0); }
// Unit normals from and to an object's own space, also for non-uniform scales.
vec3 normalFromObject(uint object, vec3 n) { return normalize(transpose(mat3(inverseObjectTransform(object))) * n); }
vec3 normalToObject(uint object, vec3 n) { return normalize(transpose(mat3(objectTransform(object))) * n); }

// ---- Points of surfaces that deform -------------------------------------------------------------------------------

// A point keeps its place in a triangle. x: the number of the triangle past frame.firstMovingTriangle (exact as a float
// below 2^24); y, z: weights of its second and third vertex. A direction keeps its components along triangleAxes().

// The place in the triangle that is nearest to `position`, world space, m (Ericson, "Real-Time Collision Detection",
// 2005, 5.1.5). triangle: its number, counted from frame.firstMovingTriangle.
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

// Where a place is in this frame, world space, m.
vec3 attachedPosition(vec3 place) {
  uvec4 t = sceneTriangle(frame.firstMovingTriangle + uint(place.x));
  vec3 a = scenePosition(t.x);
  return a + place.y * (scenePosition(t.y) - a) + place.z * (scenePosition(t.z) - a);
}

// The corners of a triangle in this frame, world space, m. triangle: as sceneTriangle() returns it.
mat3 cornersNow(uvec4 triangle) {
  return mat3(scenePosition(triangle.x), scenePosition(triangle.y), scenePosition(triangle.z));
}

// Axes of the triangle with these corners, as unit columns: one along its first edge, one across that edge in the plane
// of the triangle, and the normal.
mat3 axesOf(mat3 corners) {
  vec3 edge = corners[1] - corners[0], n = cross(edge, corners[2] - corners[0]);
  if (!(dot(n, n) > 0.0)) return mat3(1.0);
  edge = normalize(edge);
  n = normalize(n);
  return mat3(edge, cross(n, edge), n);
}
// The axes of a triangle as it is now. triangle: its number, counted from frame.firstMovingTriangle.
mat3 triangleAxes(uint triangle) { return axesOf(cornersNow(sceneTriangle(frame.firstMovingTriangle + triangle))); }

#endif
