// Where the things that move are, for passes that keep what they made of the rest.
#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "framework/scene/scene.h"

namespace fovea::scene {

// World space; empty: low > high.
struct MoverBox {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
  bool empty() const { return low.x > high.x; }
};

// Around all dynamic objects as the frame's geometry has them.
inline MoverBox moverBox(const Geometry& geometry) {
  MoverBox box;
  for (const Object& object : geometry.objects)
    for (uint32_t v = 0; object.dynamic && v < object.vertexCount; ++v) {
      box.low = glm::min(box.low, geometry.positions[object.firstVertex + v]);
      box.high = glm::max(box.high, geometry.positions[object.firstVertex + v]);
    }
  return box;
}

inline MoverBox around(const MoverBox& a, const MoverBox& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

// Some vertices are placed on the device: Geometry::positions need not have them, and moverBox() cannot tell.
inline bool anyDeforms(const Geometry& geometry) {
  for (const Object& object : geometry.objects)
    if (object.deforms) return true;
  return false;
}

}  // namespace fovea::scene
