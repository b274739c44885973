// Comparison of two pictures of one moment: the mean of many frames, the difference of two pictures, and its size.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "fovea/graph.h"
#include "framework/image/metrics.h"

namespace fovea::view {

// The mean of frames of one source while nothing moves, as floats. Only pictures with floating point can be added up.
class FrameMean {
 public:
  static bool canAdd(const graph::ResourceDesc& desc);
  void reset() { frames_ = 0; }
  // Returns the mean with this frame, as an image of four 32-bit floats.
  graph::OutputData add(const graph::OutputData& frame);
  uint32_t frames() const { return frames_; }

 private:
  std::vector<double> sums_;
  uint32_t frames_ = 0;
};

// |a - b| of every channel, as an image of four 32-bit floats with alpha 1. Throws Error(BadInput) if they differ in
// size or channels, or are no pictures.
graph::OutputData difference(const graph::OutputData& a, const graph::OutputData& b);

// What image::compare() makes of two pictures, as displayed with this exposure. gaze: normalised; radius: of the fovea,
// in widths of the picture. Throws Error(BadInput) as it does.
image::PerRegion<image::Measures> measure(const graph::OutputData& picture,
                                          const graph::OutputData& reference, float exposure, glm::vec2 gaze,
                                          float radius);

}  // namespace fovea::view
