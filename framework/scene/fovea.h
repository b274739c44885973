// The fovea on the image plane.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "shaders/records/fovea.h"

namespace fovea::scene {

// Radius, in image widths, of a fovea of `angle` radians from the line of sight in a view with the
// projection `viewToClip` (View::viewToClip).
inline float foveaRadiusOfAngle(float angle, const glm::mat4& viewToClip) {
  return 0.5f * std::tan(angle) * viewToClip[0][0];
}

// gaze: in normalised image coordinates; imageSize: in pixels; foveaRadius: in image widths.
inline Fovea makeFovea(glm::vec2 gaze, glm::vec2 imageSize, float foveaRadius) {
  return {gaze * imageSize, foveaRadius * imageSize.x};
}

}  // namespace fovea::scene
