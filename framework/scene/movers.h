// Where the things that move are, for passes that keep what they made of the rest.
#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "framework/scene/motion.h"

namespace fovea::scene {

// World space; empty: low > high.
struct MoverBox {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
  bool empty() const { return low.x > high.x; }
};

// Around all dynamic objects of the frame; wider than they are, and around the whole of its animation where
// one deforms.
inline MoverBox moverBox(const Frame& frame) {
  const Bounds box = movingBounds(*frame.geometry, frame);
  return {box.low, box.high};
}

inline MoverBox around(const MoverBox& a, const MoverBox& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

}  // namespace fovea::scene
