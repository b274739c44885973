// Bounds of everything that moves, for passes that keep what they computed for the rest.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <glm/glm.hpp>
#include <limits>

#include "framework/base/random.h"
#include "framework/scene/motion/deform.h"
#include "framework/scene/motion/motion.h"

namespace fovea::scene {

// Bounds of a visible dynamic object in world space; for an object that deforms, those of its whole animation.
inline Bounds boundsOf(const Object& object, const ObjectTransform& place) {
  Bounds box;
  for (int c = 0; c < 8; ++c) {
    const glm::vec3 corner(c & 1 ? object.high.x : object.low.x, c & 2 ? object.high.y : object.low.y,
                           c & 4 ? object.high.z : object.low.z);
    box.include(object.deforms ? corner : place.fromObject(corner));
  }
  return box;
}

// World-space boxes that enclose all dynamic objects; a box with low > high is unused. Each object has a box to
// itself while there are enough of them, and the others share the last one. A hidden object counts as the point to
// which its vertices collapse. shaders/scene/movers.glsl reads them.
struct MoverBoxes {
  static constexpr size_t kCount = 3;  // MOVER_BOXES in the shaders
  // Low and high corner of each box; w is 0.
  std::array<glm::vec4, 2 * kCount> corners = [] {
    std::array<glm::vec4, 2 * kCount> none;
    for (size_t i = 0; i < kCount; ++i) {
      none[2 * i] = glm::vec4(glm::vec3(std::numeric_limits<float>::max()), 0);
      none[2 * i + 1] = glm::vec4(glm::vec3(std::numeric_limits<float>::lowest()), 0);
    }
    return none;
  }();
  bool empty() const {
    for (size_t i = 0; i < kCount; ++i)
      if (corners[2 * i].x <= corners[2 * i + 1].x) return false;
    return true;
  }
  // One box around them all; low > high if all are unused.
  Bounds all() const {
    Bounds box;
    for (size_t i = 0; i < kCount; ++i) {
      box.low = glm::min(box.low, glm::vec3(corners[2 * i]));
      box.high = glm::max(box.high, glm::vec3(corners[2 * i + 1]));
    }
    return box;
  }
};

inline MoverBoxes moverBoxes(const Frame& frame) {
  std::array<Bounds, MoverBoxes::kCount> boxes;
  const Geometry& geometry = *frame.geometry;
  size_t used = 0;
  for (size_t i = 0; i < std::min(geometry.objects.size(), frame.objects.size()); ++i) {
    const Object& object = geometry.objects[i];
    if (!object.dynamic || object.vertexCount == 0) continue;
    const ObjectTransform& place = frame.objects[i];
    Bounds box;
    box.include(glm::vec3(place.toWorld[3]));
    if (place.visible) box = boundsOf(object, place);
    Bounds& into = boxes[std::min(used++, boxes.size() - 1)];
    into.include(box.low);
    into.include(box.high);
  }
  MoverBoxes result;
  for (size_t i = 0; i < boxes.size(); ++i) {
    result.corners[2 * i] = glm::vec4(boxes[i].low, 0);
    result.corners[2 * i + 1] = glm::vec4(boxes[i].high, 0);
  }
  return result;
}

// Boxes each of which encloses the box of `a` and the box of `b` with the same index.
inline MoverBoxes around(const MoverBoxes& a, const MoverBoxes& b) {
  MoverBoxes result;
  for (size_t i = 0; i < MoverBoxes::kCount; ++i) {
    result.corners[2 * i] = glm::min(a.corners[2 * i], b.corners[2 * i]);
    result.corners[2 * i + 1] = glm::max(a.corners[2 * i + 1], b.corners[2 * i + 1]);
  }
  return result;
}

// Spheres that enclose all visible dynamic objects. Each object has a sphere to itself while there are enough of
// them, and the others share the last one.
template <size_t kCount>
struct MoverSpheres {
  std::array<glm::vec4, kCount> spheres;  // xyz: centre; w: radius, negative if unused
  std::array<uint32_t, kCount> poses{};   // unchanged while what lies in the sphere keeps its pose
};

// Hash of everything that determines where the points of an object are.
inline uint32_t poseHash(const Object& object, size_t index, const Frame& frame) {
  uint32_t hash = uint32_t(index) + 1;
  auto add = [&](const float* values, size_t count) {
    for (size_t i = 0; i < count; ++i) hash = hashCombine(std::bit_cast<uint32_t>(values[i]), hash);
  };
  const ObjectPose pose = poseOf(object, index, frame);
  add(&pose.toWorld[0][0], 16);
  for (const glm::mat4& joint : pose.joints) add(&joint[0][0], 16);
  add(pose.weights.data(), pose.weights.size());
  return hash;
}

template <size_t kCount>
MoverSpheres<kCount> moverSpheres(const Frame& frame) {
  MoverSpheres<kCount> movers;
  std::array<Bounds, kCount> boxes;
  const Geometry& geometry = *frame.geometry;
  size_t used = 0;
  for (size_t i = 0; i < std::min(geometry.objects.size(), frame.objects.size()); ++i) {
    const Object& object = geometry.objects[i];
    if (!object.dynamic || object.vertexCount == 0 || !frame.objects[i].visible) continue;
    const Bounds box = boundsOf(object, frame.objects[i]);
    const size_t into = std::min(used++, kCount - 1);
    boxes[into].include(box.low);
    boxes[into].include(box.high);
    movers.poses[into] = hashCombine(movers.poses[into], poseHash(object, i, frame));
  }
  for (size_t i = 0; i < kCount; ++i)
    movers.spheres[i] = i >= used ? glm::vec4(0, 0, 0, -1)
                                  : glm::vec4(0.5f * (boxes[i].low + boxes[i].high),
                                              0.5f * glm::length(boxes[i].high - boxes[i].low));
  return movers;
}

}  // namespace fovea::scene
