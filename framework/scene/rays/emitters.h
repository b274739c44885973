// Emissive triangles as light sources at which shaders aim rays (shaders/rays/emitters.glsl).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "shaders/records/emitters.h"

namespace fovea::scene {

// Triangles are chosen by a bound of the light that they send if nothing hides them: power, both cosines and distance,
// with a binary tree of bounding spheres and cones of normals, as in Conty Estevez and Kulla, "Importance sampling of
// many lights with adaptive tree splitting" (HPG 2018).
class Emitters {
 public:
  // fullMaterials: whether surfaces have all that glTF says of them; then those of unlit materials are only seen.
  explicit Emitters(const Frame& frame, bool fullMaterials = false);
  bool empty() const { return emitters_.empty(); }
  std::vector<EmitterRecord> records() const;
  std::span<const EmitterNode> nodes() const { return nodes_; }

 private:
  struct Emitter {
    uint32_t triangle = kNoIndex;
    bool doubleSided = false;
    float radiance = 0;   // estimate of its mean, over the channels, W/(sr m^2)
    float power = 0;      // mean of the channels, W / pi
    float area = 0;       // m^2
    float radius2 = 0;    // square of the distance between the centre and the farthest corner, m^2
    glm::vec3 centre{0};  // world space, m
    glm::vec3 normal{0};  // geometric, unit
  };
  struct Range {
    uint32_t first, last;  // of emitters_
    uint32_t middle() const { return first + (last - first) / 2; }
    bool isLeaf() const;
  };

  void build(uint32_t node, Range range);

  const Frame& frame_;
  std::vector<Emitter> emitters_;  // in the order of the leaves
  std::vector<EmitterNode> nodes_;
};

}  // namespace fovea::scene
