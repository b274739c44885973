// Measures the light in a scene when it is loaded. The kernels that do so are compiled for the host from the shaders of
// the methods, in framework/host, which this room must not know: they register themselves.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "framework/scene/frame.h"
#include "shaders/records/light_meter.h"

namespace fovea::scene {

class LightMeter {
 public:
  virtual ~LightMeter() = default;
  // The picture of the frame's first view, row after row, with full materials.
  virtual std::vector<MeterPoint> picture(const Frame& frame) const = 0;
  // The share of the light from a direction (unit, towards it) that reaches each point, by channels.
  virtual std::vector<glm::vec4> sharesFrom(const Frame& frame, std::span<const MeterPoint> points,
                                            glm::vec3 direction) const = 0;
};

void setLightMeter(const LightMeter& meter);

}  // namespace fovea::scene
