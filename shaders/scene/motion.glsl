// Where visible surfaces were in the previous frame.
#ifndef FOVEA_MOTION_GLSL
#define FOVEA_MOTION_GLSL

#include "scene/objects.glsl"

// The corners of a triangle in the previous frame, world space, m. triangle: as sceneTriangle() returns it.
mat3 cornersBefore(uvec4 triangle) {
  return mat3(scenePreviousPosition(triangle.x), scenePreviousPosition(triangle.y), scenePreviousPosition(triangle.z));
}

// The weights of the corners at a point of their plane.
vec3 cornerWeights(mat3 corners, vec3 point) {
  vec3 b = corners[1] - corners[0], c = corners[2] - corners[0], p = point - corners[0], normal = cross(b, c);
  float area2 = dot(normal, normal);
  vec2 weights = vec2(dot(cross(p, c), normal), dot(cross(b, p), normal)) / max(area2, 1e-30);
  weights = area2 > 0.0 ? weights : vec2(1.0 / 3.0);
  return vec3(1.0 - weights.x - weights.y, weights);
}

// By how much a point of a triangle whose vertices move individually has moved since the previous frame, m in world
// space. position: in this frame; triangle: as sceneTriangle() returns it.
vec3 movedSince(vec3 position, uvec4 triangle) {
  mat3 now = cornersNow(triangle);
  return (now - cornersBefore(triangle)) * cornerWeights(now, position);
}

// The place in this frame of a point that moves along with a triangle, world space, m. position: its place in the
// previous frame; triangle: as sceneTriangle() returns it.
vec3 movedTo(vec3 position, uvec4 triangle) {
  return cornersNow(triangle) * cornerWeights(cornersBefore(triangle), position);
}

// The rotation of a triangle since the previous frame.
mat3 turnSince(uvec4 triangle) { return axesOf(cornersNow(triangle)) * transpose(axesOf(cornersBefore(triangle))); }

// How a surface has moved since the previous frame: a point that moves along with it was at turn * point + way, m in
// world space.
struct Motion {
  mat3 turn;
  vec3 way;
};

// The motion of what the G-buffer shows at `position` (world space, m). id, triangle: from there.
Motion motionOf(vec3 position, uint id, uint triangle) {
  uint object = id >> 16;
  Motion motion = Motion(mat3(1.0), vec3(0.0));
  if (object != 0u && objectDeforms(object)) {
    motion.way = -movedSince(position, sceneTriangle(triangle));
  } else if (object != 0u) {
    mat4x3 fromObject = previousObjectTransform(object), toObject = inverseObjectTransform(object);
    motion.turn = mat3(fromObject) * mat3(toObject);
    motion.way = fromObject * vec4(toObject[3], 1.0);
  }
  return motion;
}

// Where a point, which moves along with the surface, was in the previous frame; world space, m.
vec3 pointBefore(Motion motion, vec3 point) { return motion.turn * point + motion.way; }

#endif
