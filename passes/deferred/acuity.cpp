#include "passes/deferred/acuity.h"

#include <algorithm>
#include <glm/trigonometric.hpp>

namespace fovea::passes {

namespace {

// The smallest period that the eye resolves, in degrees, grows linearly with the eccentricity. These are the values
// of Guenter et al. (2012), with the most cautious of their slopes.
constexpr float kSmallestPeriod = 1.0f / 48, kPeriodSlope = 0.022f;

}  // namespace

Square fullDensity(const scene::View& view, float foveaRadius, float pixelsPerDegree, int tile) {
  const glm::vec2 size(view.size);
  const float density = pixelsPerDegree > 0 ? pixelsPerDegree : size.y / glm::degrees(view.verticalFov);
  const float eccentricity = (4 / density - kSmallestPeriod) / kPeriodSlope;  // degrees
  // Coordinates far outside would not fit into an integer.
  const float radius = std::min(std::max(foveaRadius * size.x, eccentricity * density), 1e6f);
  const glm::vec2 gaze = glm::clamp(view.gaze * size, -1e6f, 1e6f), tiles(static_cast<float>(tile));
  return {glm::ivec2(glm::floor((gaze - radius) / tiles)) * tile,
          glm::ivec2(glm::ceil((gaze + radius) / tiles)) * tile};
}

}  // namespace fovea::passes
