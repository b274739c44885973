#include "passes/path-trace/lights.h"

#include <algorithm>
#include <cmath>

namespace fovea::path_trace {
namespace {

using namespace scene;

constexpr float kLeastDistance = 1e-6f;  // m
constexpr float kLeastFalloff = 1e-4f;   // of a cone, from full light to none, in cosines

// Squared, from 1 within the inner cone to 0 outside the outer one.
float coneFalloff(const Light& light, glm::vec3 toLight) {
  const float cosine = glm::dot(-toLight, light.direction), outer = std::cos(light.outerConeAngle),
              range = std::max(std::cos(light.innerConeAngle) - outer, kLeastFalloff);
  const float falloff = std::clamp((cosine - outer) / range, 0.0f, 1.0f);
  return falloff * falloff;
}

// A range of 0 has no end.
float rangeFalloff(const Light& light, float distance) {
  if (!(light.range > 0)) return 1;
  const float share = distance / light.range, square = share * share;
  return std::max(1 - square * square, 0.0f);
}

}  // namespace

IncidentLight incidentLight(const Light& light, glm::vec3 position) {
  IncidentLight incident;
  incident.irradiance = light.intensity * light.color;
  if (light.type == LightType::Directional) {
    incident.direction = -light.direction;
    return incident;
  }
  const glm::vec3 to = light.position - position;
  incident.distance = std::max(glm::length(to), kLeastDistance);
  incident.direction = to / incident.distance;
  incident.irradiance *= rangeFalloff(light, incident.distance) / (incident.distance * incident.distance);
  if (light.type == LightType::Spot) incident.irradiance *= coneFalloff(light, incident.direction);
  return incident;
}

}  // namespace fovea::path_trace
