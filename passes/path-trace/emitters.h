// Emissive triangles, and points on them towards which rays are aimed.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::path_trace {

// The surface that is lit.
struct Receiver {
  glm::vec3 position{0};  // world space, m
  glm::vec3 normal{0};    // unit
};

struct EmitterPoint {
  scene::RayHit hit;  // the triangle and the weights of its vertices; no triangle if none faces the receiver
  glm::vec3 position{0};  // world space, m
  glm::vec3 normal{0};    // geometric, unit, on the side of the receiver
  glm::vec2 uv{0};
  uint32_t material = 0;
  float density = 0;  // probability density of the choice, per m^2
};

// Radiance of a material in all directions, W/(sr m^2).
glm::vec3 emittedRadiance(const scene::Scene& scene, const scene::Material& material, glm::vec2 uv);

// A triangle is found by walking down a binary tree, each time to one of two halves, by an estimate of the light that
// they send: power over the square of the distance, with the cosines as far as they are known. Only the noise depends
// on how good the estimate is; where it says 0, only rays that go there by chance find the light.
class Emitters {
 public:
  explicit Emitters(const scene::Frame& frame);
  bool empty() const { return nodes_.empty(); }
  // A point that may light `receiver`. choice, u, v: uniform in [0, 1).
  EmitterPoint sample(const Receiver& receiver, float choice, float u, float v) const;
  // The density with which sample() chooses points of a triangle, per m^2.
  float density(uint32_t triangle, const Receiver& receiver) const;

 private:
  // A triangle, or two nodes, of which the first follows in the list.
  struct Node {
    glm::vec3 centre{0};  // of a sphere that holds all of it
    float radius2 = 0;
    float power = 0;    // W / pi, mean of the channels, of one side of a triangle and both sides of a node
    glm::vec3 flow{0};  // sum of power times normal, which cancels out where light goes to opposite sides
    uint32_t parent = 0, second = 0;
    uint32_t triangle = scene::kNoIndex;
    float area = 0;          // of the triangle, m^2
    bool bothSides = false;  // whether it emits to both
    bool isTriangle() const { return triangle != scene::kNoIndex; }
  };
  using Iterator = std::vector<Node>::iterator;

  Node leaf(uint32_t triangle) const;
  void build(uint32_t parent, Iterator begin, Iterator end);
  static float weight(const Node& node, const Receiver& receiver);

  const scene::Frame& frame_;
  std::vector<Node> nodes_;       // the first is the root
  std::vector<uint32_t> leaves_;  // the node of each triangle of Geometry::emissive
};

}  // namespace fovea::path_trace
