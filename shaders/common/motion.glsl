// Where visible surfaces were in the previous frame.
#ifndef FOVEA_MOTION_GLSL
#define FOVEA_MOTION_GLSL

#include "common/scene.glsl"

// How a point of a triangle whose vertices move has moved since the previous frame, m in world space.
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

// Position in the previous frame of a point that moves along with the surface at `position`. id, triangle: of the
// G-buffer there.
vec3 pointBefore(vec3 point, vec3 position, uint id, uint triangle) {
  uint object = id >> 16;
  bool deforms = object != 0u && objectDeforms(object);
  if (deforms) point -= movedSince(position, sceneTriangle(triangle));
  if (object != 0u && !deforms)
    point = previousObjectTransform(object) * vec4(toObject(object, point), 1.0);
  return point;
}

vec3 positionBefore(vec3 position, uint id, uint triangle) { return pointBefore(position, position, id, triangle); }

#endif
