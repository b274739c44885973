// Where the things that move are, for passes that keep what they made of the rest.
#pragma once

#include <algorithm>
#include <array>
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

// Of a dynamic object that is visible; around the whole of its animation where it deforms.
inline Bounds boundsOf(const Object& object, const ObjectTransform& place) {
  Bounds box;
  for (int c = 0; c < 8; ++c) {
    const glm::vec3 corner(c & 1 ? object.high.x : object.low.x, c & 2 ? object.high.y : object.low.y,
                           c & 4 ? object.high.z : object.low.z);
    box.include(object.deforms ? corner : place.fromObject(corner));
  }
  return box;
}

// Spheres in which all visible dynamic objects lie: xyz centre, w radius, below 0: unused. An object has one
// of its own while there are enough; the others share the last.
template <size_t kCount>
std::array<glm::vec4, kCount> moverSpheres(const Frame& frame) {
  std::array<Bounds, kCount> boxes;
  const Geometry& geometry = *frame.geometry;
  size_t used = 0;
  for (size_t i = 0; i < std::min(geometry.objects.size(), frame.objects.size()); ++i) {
    const Object& object = geometry.objects[i];
    if (!object.dynamic || object.vertexCount == 0 || !frame.objects[i].visible) continue;
    const Bounds box = boundsOf(object, frame.objects[i]);
    Bounds& into = boxes[std::min(used++, kCount - 1)];
    into.include(box.low);
    into.include(box.high);
  }
  std::array<glm::vec4, kCount> spheres;
  for (size_t i = 0; i < kCount; ++i)
    spheres[i] = i >= used ? glm::vec4(0, 0, 0, -1)
                           : glm::vec4(0.5f * (boxes[i].low + boxes[i].high),
                                       0.5f * glm::length(boxes[i].high - boxes[i].low));
  return spheres;
}

}  // namespace fovea::scene
