// The part of a picture that must be shaded at every pixel, from what the eye resolves (Guenter et al., "Foveated 3D
// graphics", SIGGRAPH Asia 2012).
#pragma once

#include <vulkan/vulkan.h>

#include <glm/glm.hpp>

#include "fovea/declaration.h"
#include "framework/scene/frame.h"

namespace fovea::passes {

// Pixels from `low` up to, but not including, `high`.
struct Square {
  glm::ivec2 low{0}, high{0};

  Square grown(int by) const { return {low - by, high + by}; }
  Square within(VkExtent3D size) const {
    const glm::ivec2 most(size.width, size.height);
    return {glm::clamp(low, glm::ivec2(0), most), glm::clamp(high, glm::ivec2(0), most)};
  }
  glm::ivec4 corners() const { return {low, high}; }
};

// Adds the parameter `periphery` to a pass. `what` says what the pass does with 2.
void declarePeriphery(graph::PassDeclaration& d, const char* what);
// The square of a view for these parameters; with `periphery` 1 it contains any picture.
Square fineSquare(const scene::View& view, const graph::Parameters& parameters, int tile);

// The square around the fovea of a view. Its corners may lie outside the picture.
Square foveaSquare(const scene::View& view);

// The square around the gaze outside which one sample per 2 x 2 pixels is enough: it contains the fovea and all pixels
// at an eccentricity where the smallest period that the eye resolves is less than 4 pixels. Its corners are multiples
// of `tile` and may lie outside the picture.
Square fullDensity(const scene::View& view, int tile);

}  // namespace fovea::passes
