// The unit in which passes add up the light of eye paths, as a plain reference for passes/eye-paths/unit.comp.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <span>

#include "shaders/records/eye_paths.h"

namespace fovea::passes {

// The weighted light of all ends sums to kChannelSum of it in the brightest channel.
inline float sumUnit(std::span<const EyePathEnd> ends) {
  glm::dvec3 sum(0);
  for (const EyePathEnd& e : ends) sum += glm::dvec3(e.radiance) * double(e.weight);
  return float(std::max({sum.r, sum.g, sum.b}) / double(kChannelSum));
}

}  // namespace fovea::passes
