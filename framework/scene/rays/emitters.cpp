#include "framework/scene/rays/emitters.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fovea::scene {

namespace {

constexpr uint32_t kInLeaf = kEmittersInLeaf;

float vertexAlpha(const Geometry& g, uint32_t triangle, float u, float v) {
  if (g.colors.empty()) return 1;
  const uint32_t* corners = g.triangles[triangle].v;
  return g.colors[corners[0]].a * (1 - u - v) + g.colors[corners[1]].a * u + g.colors[corners[2]].a * v;
}

// Mean over the channels and a few points, as far as the surface is seen there. It only affects how often the triangle
// is chosen; the radiance of a point is exact.
double estimatedRadiance(const Frame& frame, uint32_t triangle, const Material& material,
                         bool fullMaterials) {
  constexpr float kPoints[4][2] = {{1 / 3.f, 1 / 3.f}, {0.15f, 0.7f}, {0.7f, 0.15f}, {0.15f, 0.15f}};
  const Geometry& g = *frame.geometry;
  glm::vec3 sum(0);
  for (const auto& [u, v] : kPoints) {
    const glm::vec2 uv = surfaceAt(g, {triangle, 0, u, v}).uv;
    sum += 0.25f * emission(*frame.scene, material, uv) *
           coverage(*frame.scene, material, uv, vertexAlpha(g, triangle, u, v), fullMaterials);
  }
  // This keeps a dark estimate from hiding a bright spot between the points.
  const bool varies =
      material.emissionTexture || (material.masked && (material.baseColorTexture || !g.colors.empty()));
  if (varies) sum = glm::max(sum, 0.05f * material.emission);
  return (double(sum.r) + sum.g + sum.b) / 3.0;
}

}  // namespace

bool Emitters::Range::isLeaf() const { return last - first <= kInLeaf; }

Emitters::Emitters(const Frame& frame, bool fullMaterials) : frame_(frame) {
  const auto& materials = frame.scene->materials;
  const Geometry& g = *frame.geometry;
  for (const uint32_t t : g.emissive) {
    const uint32_t index = g.triangles[t].material();
    if (index >= materials.size() || (fullMaterials && materials[index].unlit)) continue;
    const glm::vec3 &a = g.positions[g.triangles[t].v[0]], &b = g.positions[g.triangles[t].v[1]],
                    &c = g.positions[g.triangles[t].v[2]];
    const glm::vec3 normal = glm::cross(b - a, c - a);
    const float twice = glm::length(normal);
    const double radiance =
        estimatedRadiance(frame, t, materials[index], fullMaterials) * double(frame.preExposure);
    const double power = radiance * 0.5 * double(twice);
    if (!(radiance > 0) || !std::isfinite(power)) continue;
    const glm::vec3 centre = (a + b + c) / 3.0f, p = a - centre, q = b - centre, r = c - centre;
    const float radius2 = std::max({glm::dot(p, p), glm::dot(q, q), glm::dot(r, r)});
    // What is hidden has no area, but a place in the tree all the same, as it may be shown later.
    emitters_.push_back({t, materials[index].doubleSided, float(radiance), float(power), 0.5f * twice,
                         radius2, centre, twice > 0 ? normal / twice : glm::vec3(0)});
  }
  if (emitters_.empty()) return;
  nodes_.resize(2 * std::bit_ceil(emitters_.size()));
  build(1, {0, uint32_t(emitters_.size())});
}

std::vector<EmitterRecord> Emitters::records() const {
  std::vector<EmitterRecord> records;
  std::vector<std::pair<uint32_t, uint32_t>> sorted;
  for (uint32_t i = 0; i < emitters_.size(); ++i) sorted.emplace_back(emitters_[i].triangle, i);
  std::ranges::sort(sorted);
  for (uint32_t i = 0; i < emitters_.size(); ++i) {
    const Emitter& e = emitters_[i];
    records.push_back({e.triangle | (e.doubleSided ? kEmitterBothSides : 0), e.radiance, sorted[i].first,
                       sorted[i].second});
  }
  return records;
}

void Emitters::build(uint32_t node, Range range) {
  glm::vec3 low(INFINITY), high(-INFINITY);
  const auto begin = emitters_.begin() + range.first, end = emitters_.begin() + range.last;
  double power = 0;
  glm::vec3 axis(0);
  bool allDirections = false;
  for (auto e = begin; e != end; ++e) {
    for (const uint32_t v : frame_.geometry->triangles[e->triangle].v) {
      low = glm::min(low, frame_.geometry->positions[v]);
      high = glm::max(high, frame_.geometry->positions[v]);
    }
    power += e->power;
    axis += e->power * e->normal;
    allDirections = allDirections || e->doubleSided;
  }
  float spread = -1;
  if (const float length = glm::length(axis); length > 0 && !allDirections) {
    axis /= length;
    spread = 1;
    for (auto e = begin; e != end; ++e) spread = std::min(spread, glm::dot(axis, e->normal));
    spread = std::max(spread - kConeRounding, -1.0f);
  }
  const glm::vec3 size = high - low;
  nodes_[node] = {0.5f * (low + high), 0.25f * glm::dot(size, size), axis, spread, float(power), 0, 0, 0};
  if (range.isLeaf()) return;
  const int longest = size.x > std::max(size.y, size.z) ? 0 : size.y > size.z ? 1 : 2;
  std::nth_element(
      begin, emitters_.begin() + range.middle(), end, [longest](const Emitter& a, const Emitter& b) {
        return std::pair(a.centre[longest], a.triangle) < std::pair(b.centre[longest], b.triangle);
      });
  build(2 * node, {range.first, range.middle()});
  build(2 * node + 1, {range.middle(), range.last});
}

}  // namespace fovea::scene
