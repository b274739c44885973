#include "passes/path-trace/emitters.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fovea::path_trace {
namespace {

using namespace scene;

// Mean over the channels and a few points, and never much below what the material emits without its texture.
float estimatedRadiance(const Frame& frame, uint32_t triangle) {
  constexpr float kPoints[4][2] = {{1 / 3.f, 1 / 3.f}, {0.15f, 0.7f}, {0.7f, 0.15f}, {0.15f, 0.15f}};
  const Material& material = frame.scene->materials[frame.geometry->triangles[triangle].material()];
  glm::vec3 sum(0);
  for (const auto& [u, v] : kPoints)
    sum += emittedRadiance(*frame.scene, material, surfaceAt(*frame.geometry, {triangle, 0, u, v}).uv);
  const glm::vec3 mean = glm::max(0.25f * sum, 0.05f * material.emission);
  return (mean.r + mean.g + mean.b) / 3;
}

}  // namespace

glm::vec3 emittedRadiance(const Scene& scene, const Material& material, glm::vec2 uv) {
  if (material.emission == glm::vec3(0)) return glm::vec3(0);
  return material.emission * glm::vec3(sampleTexture(scene, material.emissionTexture, uv));
}

Emitters::Emitters(const Frame& frame) : frame_(frame) {
  std::vector<Node> leaves;
  for (const uint32_t t : frame.geometry->emissive)
    if (const Node node = leaf(t); node.power > 0 && std::isfinite(node.power)) leaves.push_back(node);
  leaves_.assign(frame.geometry->emissive.size(), kNoIndex);
  if (leaves.empty()) return;
  nodes_.reserve(2 * leaves.size());
  build(0, leaves.begin(), leaves.end());
}

Emitters::Node Emitters::leaf(uint32_t triangle) const {
  const TriangleVertices t = triangleVertices(*frame_.geometry, triangle);
  const glm::vec3 &a = t.positions[0], &b = t.positions[1], &c = t.positions[2];
  const float twice = glm::length(glm::cross(b - a, c - a));
  Node node;
  node.triangle = triangle;
  node.centre = (a + b + c) / 3.0f;
  for (const glm::vec3& corner : t.positions) {
    const glm::vec3 to = corner - node.centre;
    node.radius2 = std::max(node.radius2, glm::dot(to, to));
  }
  node.area = twice / 2;
  node.power = estimatedRadiance(frame_, triangle) * node.area;
  node.flow = node.power * surfaceAt(t, 0, 0).geometricNormal;
  node.bothSides = frame_.scene->materials[frame_.geometry->triangles[triangle].material()].doubleSided;
  return node;
}

void Emitters::build(uint32_t parent, Iterator begin, Iterator end) {
  const auto self = uint32_t(nodes_.size());
  if (end - begin == 1) {
    nodes_.push_back(*begin);
    nodes_[self].parent = parent;
    const std::vector<uint32_t>& emissive = frame_.geometry->emissive;
    leaves_[size_t(std::ranges::lower_bound(emissive, begin->triangle) - emissive.begin())] = self;
    return;
  }
  Node node;
  node.parent = parent;
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (auto i = begin; i != end; ++i) {
    const glm::vec3 reach(std::sqrt(i->radius2));
    low = glm::min(low, i->centre - reach);
    high = glm::max(high, i->centre + reach);
    node.power += i->bothSides ? 2 * i->power : i->power;
    if (!i->bothSides) node.flow += i->flow;
  }
  const glm::vec3 size = high - low;
  node.centre = 0.5f * (low + high);
  node.radius2 = 0.25f * glm::dot(size, size);
  nodes_.push_back(node);
  const int longest = size.x > std::max(size.y, size.z) ? 0 : size.y > size.z ? 1 : 2;
  const auto middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, [longest](const Node& a, const Node& b) {
    return std::tie(a.centre[longest], a.triangle) < std::tie(b.centre[longest], b.triangle);
  });
  build(self, begin, middle);
  nodes_[self].second = uint32_t(nodes_.size());
  build(self, middle, end);
}

float Emitters::weight(const Node& node, const Receiver& receiver) {
  const glm::vec3 to = receiver.position - node.centre;
  const float d2 = std::max({glm::dot(to, to), node.radius2, 1e-20f}), d = std::sqrt(d2),
              along = glm::dot(node.flow, to) / d;
  float emitted = node.power + along;
  if (node.isTriangle()) {
    if (along <= 0 && !node.bothSides) return 0;
    emitted = std::abs(along) + 0.1f * node.power;
  }
  const float received = std::min((std::sqrt(node.radius2) - glm::dot(to, receiver.normal)) / d, 1.0f);
  return received > 0 ? emitted * received / d2 : 0;
}

EmitterPoint Emitters::sample(const Receiver& receiver, float choice, float u, float v) const {
  EmitterPoint point;
  if (empty() || !(weight(nodes_[0], receiver) > 0)) return point;
  float probability = 1;
  uint32_t at = 0;
  while (!nodes_[at].isTriangle()) {
    const float first = weight(nodes_[at + 1], receiver),
                second = weight(nodes_[nodes_[at].second], receiver);
    if (!(first + second > 0)) return point;
    // The random number is stretched after each decision, so that one is enough.
    const float share = first / (first + second);
    const bool toFirst = choice < share;
    choice = toFirst ? choice / share : (choice - share) / (1 - share);
    probability *= toFirst ? share : 1 - share;
    at = toFirst ? at + 1 : nodes_[at].second;
  }
  // Even over the triangle.
  const float root = std::sqrt(u);
  point.hit = {nodes_[at].triangle, 0, root * (1 - v), root * v};
  const SurfaceHit s = surfaceAt(*frame_.geometry, point.hit);
  point.position = s.position;
  point.normal = glm::dot(s.geometricNormal, receiver.position - s.position) > 0 ? s.geometricNormal
                                                                                 : -s.geometricNormal;
  point.uv = s.uv;
  point.material = s.material;
  point.density = probability / nodes_[at].area;
  return point;
}

float Emitters::density(uint32_t triangle, const Receiver& receiver) const {
  const std::vector<uint32_t>& emissive = frame_.geometry->emissive;
  const auto found = std::ranges::lower_bound(emissive, triangle);
  if (found == emissive.end() || *found != triangle) return 0;
  const uint32_t leaf = leaves_[size_t(found - emissive.begin())];
  if (leaf == kNoIndex || !(weight(nodes_[0], receiver) > 0)) return 0;
  float probability = 1;
  for (uint32_t at = leaf; at != 0; at = nodes_[at].parent) {
    const Node& parent = nodes_[nodes_[at].parent];
    const uint32_t first = nodes_[at].parent + 1, sibling = at == first ? parent.second : first;
    const float own = weight(nodes_[at], receiver), other = weight(nodes_[sibling], receiver);
    if (!(own > 0)) return 0;
    probability *= own / (own + other);
  }
  return probability / nodes_[leaf].area;
}

}  // namespace fovea::path_trace
