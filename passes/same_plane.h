// Whether two samples of a picture may share their light.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "shaders/records/contact.h"

namespace fovea::passes {

// Whether two points lie nearly on one plane: their normals differ by less than 26 degrees, and the other point is off
// the first one's tangent plane by at most a tenth of their distance. Positions in any unit; unit normals.
inline bool onSamePlane(glm::vec3 position, glm::vec3 normal, glm::vec3 otherPosition,
                        glm::vec3 otherNormal) {
  const glm::vec3 to = otherPosition - position;
  return glm::dot(normal, otherNormal) > kSamePlaneCos &&
         std::abs(glm::dot(to, normal)) <= kSamePlaneSlope * glm::length(to);
}

}  // namespace fovea::passes
