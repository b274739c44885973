// Where visible surfaces were in the previous frame.
#ifndef FOVEA_MOTION_GLSL
#define FOVEA_MOTION_GLSL

#include "common/scene.glsl"

// Position of a surface in the previous frame; for one that deforms, its position now. id: of the G-buffer.
vec3 positionBefore(vec3 position, uint id) {
  uint object = id >> 16;
  for (int turn_ = 0; turn_ < int(object != 0u); ++turn_)  // a loop, as a CPU device runs unused branches
    if (!objectDeforms(object)) position = previousObjectTransform(object) * vec4(toObject(object, position), 1.0);
  return position;
}

#endif
