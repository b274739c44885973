#include "framework/image/overlay.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace fovea::image {
namespace {

constexpr float kLine = 1.5f;  // pixels

// The share of a pixel covered by a line that passes its centre at `distance`.
float coverage(float distance, float width) {
  return std::clamp(0.5f * width + 0.5f - std::abs(distance), 0.0f, 1.0f);
}

// A white line on a wider black one is visible on any image.
void blend(Image& picture, uint32_t x, uint32_t y, float white, float black) {
  for (uint32_t c = 0; c < std::min(picture.channels, 3u); ++c) {
    float& value = picture.at(x, y, c);
    value = value * (1 - 0.6f * black);
    value += (1 - value) * white;
  }
}

}  // namespace

void drawFovea(Image& picture, const Disc& fovea) {
  const glm::vec2 centre(fovea.x, fovea.y);
  const float circle = fovea.radius, arm = std::max(4.0f, 0.012f * float(picture.width));
  for (uint32_t y = 0; y < picture.height; ++y)
    for (uint32_t x = 0; x < picture.width; ++x) {
      const glm::vec2 d = glm::vec2(float(x) + 0.5f, float(y) + 0.5f) - centre, a = glm::abs(d);
      const bool inCross = std::max(a.x, a.y) < arm;
      const float distance = std::min(std::abs(glm::length(d) - circle), inCross ? std::min(a.x, a.y) : 1e9f);
      const float black = coverage(distance, kLine + 2);
      if (black > 0) blend(picture, x, y, coverage(distance, kLine), black);
    }
}

}  // namespace fovea::image
