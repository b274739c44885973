// Where visible surfaces were in the previous frame.
#ifndef FOVEA_MOTION_GLSL
#define FOVEA_MOTION_GLSL

#include "scene/objects.glsl"

// By how much a point of a triangle whose vertices move individually has moved since the previous frame, m in world
// space. position: in this frame; triangle: as sceneTriangle() returns it.
vec3 movedSince(vec3 position, uvec4 triangle) {
  mat3 now = mat3(scenePosition(triangle.x), scenePosition(triangle.y), scenePosition(triangle.z));
  mat3 before = mat3(scenePreviousPosition(triangle.x), scenePreviousPosition(triangle.y),
                     scenePreviousPosition(triangle.z));
  vec3 b = now[1] - now[0], c = now[2] - now[0], p = position - now[0], normal = cross(b, c);
  float area2 = dot(normal, normal);
  vec2 weights = vec2(dot(cross(p, c), normal), dot(cross(b, p), normal)) / max(area2, 1e-30);
  weights = area2 > 0.0 ? weights : vec2(1.0 / 3.0);
  return (now - before) * vec3(1.0 - weights.x - weights.y, weights);
}

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
