#include "passes/acuity.h"

#include <algorithm>
#include <glm/trigonometric.hpp>

#include "framework/scene/fovea.h"

namespace fovea::passes {

namespace {

// The smallest period that the eye resolves, in degrees, grows linearly with the eccentricity. These are the values
// of Guenter et al. (2012), with the most cautious of their slopes.
constexpr float kSmallestPeriod = 1.0f / 48, kPeriodSlope = 0.022f;

}  // namespace

void declarePeriphery(graph::PassDeclaration& d, const char* what) {
  d.parameter("periphery", graph::integer(1, 1, 2), what);
}

Square fineSquare(const scene::View& view, const graph::Parameters& p, int tile) {
  if (p.integer("periphery") == 1) return Square{}.grown(1 << 20);
  return fullDensity(view, tile);
}

Square foveaSquare(const scene::View& view) {
  const scene::Fovea fovea = scene::makeFovea(view.gaze, glm::vec2(view.size), view.foveaRadius);
  // Coordinates far outside would not fit into an integer.
  const glm::vec2 centre = glm::clamp(fovea.centre, -1e6f, 1e6f);
  const float radius = std::min(fovea.radius, 1e6f);
  return {glm::ivec2(glm::floor(centre - radius)), glm::ivec2(glm::ceil(centre + radius))};
}

Square fullDensity(const scene::View& view, int tile) {
  const glm::vec2 size(view.size);
  const float density =
      view.pixelsPerDegree > 0 ? view.pixelsPerDegree : size.y / glm::degrees(view.verticalFov);
  const float eccentricity = (4 / density - kSmallestPeriod) / kPeriodSlope;  // degrees
  // Coordinates far outside would not fit into an integer.
  const float radius = std::min(std::max(view.foveaRadius * size.x, eccentricity * density), 1e6f);
  const glm::vec2 gaze = glm::clamp(view.gaze * size, -1e6f, 1e6f), tiles(static_cast<float>(tile));
  return {glm::ivec2(glm::floor((gaze - radius) / tiles)) * tile,
          glm::ivec2(glm::ceil((gaze + radius) / tiles)) * tile};
}

}  // namespace fovea::passes
