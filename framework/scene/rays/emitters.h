// Emissive triangles as light sources that can be sampled: next-event estimation for rays on the host.
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

struct EmitterPoint {
  uint32_t triangle = kNoIndex;  // kNoIndex if no emitter faces the receiver
  float u = 0, v = 0;            // barycentric weights of the triangle's second and third vertex
  glm::vec3 position{0};         // world space, m
  glm::vec3 normal{0};           // unit, on the side of the receiver
  glm::vec3 radiance{0};         // W/(sr m^2)
  float density = 0;             // probability density of the choice, per m^2
};

// The surface that is lit.
struct Receiver {
  glm::vec3 position{0};  // world space, m
  glm::vec3 normal{0};    // unit
};

// Chooses triangles by a bound of the light that they send if nothing hides them: power, both cosines and distance,
// with a binary tree of bounding spheres and cones of normals, as in Conty Estevez and Kulla, "Importance sampling of
// many lights with adaptive tree splitting" (HPG 2018).
class Emitters {
 public:
  // fullMaterials: whether surfaces have all that glTF says of them; then those of unlit materials are only seen.
  explicit Emitters(const Frame& frame, bool fullMaterials = false);
  bool empty() const { return emitters_.empty(); }
  // Whether an emitter is within `reach` metres of a point, by the bounding spheres of triangles.
  bool within(glm::vec3 point, float reach) const;
  // A point that may light `receiver`. choice, u, v: uniform in [0, 1).
  EmitterPoint sample(const Receiver& receiver, float choice, float u, float v) const;
  // Density with which sample() chooses points of a triangle for this receiver, per m^2; 0 if the triangle does not
  // emit towards it.
  float density(uint32_t triangle, const Receiver& receiver) const;

  // What shaders need to choose the same points (shaders/rays/emitters.glsl).
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
  uint32_t placeOf(uint32_t triangle) const;  // index in emitters_; kNoIndex if it does not emit
  static float weight(const EmitterNode& node, const Receiver& receiver);
  static float weight(const Emitter& emitter, const Receiver& receiver);
  bool within(glm::vec3 point, float reach, uint32_t node, Range range) const;
  // The probability of turning to the first half of a node, below 0 if neither half sends light.
  float firstHalf(uint32_t node, const Receiver& receiver) const;

  const Frame& frame_;
  std::vector<Emitter> emitters_;  // in the order of the leaves
  std::vector<EmitterNode> nodes_;
  std::vector<uint32_t>
      places_;  // index in emitters_ of each triangle of Geometry::emissive; kNoIndex if it is dark
};

class EnvironmentMap;

// The share of the rays aimed at light sources that go to emissive surfaces; the others go to the environment. All do
// where there is none, and half of them where there are both.
inline float surfaceShare(const Emitters& emitters, const EnvironmentMap* environment) {
  return environment == nullptr ? 1.0f : emitters.empty() ? 0.0f : 0.5f;
}

}  // namespace fovea::scene
