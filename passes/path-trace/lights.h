// What arrives from the scene's lights.
#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "framework/scene/scene.h"

namespace fovea::path_trace {

struct IncidentLight {
  glm::vec3 irradiance{0};  // of a surface that faces the light, ignoring occlusion, W/m^2
  glm::vec3 direction{0};   // unit, to the light
  float distance = std::numeric_limits<float>::infinity();  // m; infinite for a directional light
};

// As the glTF extension KHR_lights_punctual defines it, with the recommended falloff of cones and ranges.
IncidentLight incidentLight(const scene::Light& light, glm::vec3 position);

}  // namespace fovea::path_trace
