#include "framework/scene/rays/emitters.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fovea::scene {

namespace {

constexpr uint32_t kInLeaf = kEmittersInLeaf;
constexpr float kRounding = kConeRounding, kLeastCosine = kLeastEmitterCosine;

// Mean over the channels and a few points. It only affects how often the triangle is chosen; the radiance of
// a point is exact.
double estimatedRadiance(const Frame& frame, uint32_t triangle, const Material& material) {
  constexpr float kPoints[4][2] = {{1 / 3.f, 1 / 3.f}, {0.15f, 0.7f}, {0.7f, 0.15f}, {0.15f, 0.15f}};
  glm::vec3 sum(0);
  for (const auto& p : kPoints)
    sum += 0.25f * emission(*frame.scene, material, surfaceAt(*frame.geometry, {triangle, 0, p[0], p[1]}).uv);
  // This keeps a dark estimate from hiding a bright spot between the points.
  sum = glm::max(sum, 0.05f * material.emission);
  return (double(sum.r) + sum.g + sum.b) / 3.0;
}

// Cosine of a - b, and its sine, for angles from 0 to pi; 1 and 0 if b is larger.
struct Angle {
  float cosine, sine;
};
Angle angleOf(float cosine) { return {cosine, std::sqrt(std::max(1 - cosine * cosine, 0.0f))}; }
Angle operator-(Angle a, Angle b) {
  if (a.cosine >= b.cosine) return {1, 0};
  return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
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
    const double radiance = estimatedRadiance(frame, t, materials[index]);
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
  places_.assign(g.emissive.size(), kNoIndex);
  for (uint32_t i = 0; i < emitters_.size(); ++i)
    places_[size_t(std::ranges::lower_bound(g.emissive, emitters_[i].triangle) - g.emissive.begin())] = i;
}

uint32_t Emitters::placeOf(uint32_t triangle) const {
  const std::vector<uint32_t>& emissive = frame_.geometry->emissive;
  const auto found = std::ranges::lower_bound(emissive, triangle);
  return empty() || found == emissive.end() || *found != triangle ? kNoIndex
                                                                  : places_[size_t(found - emissive.begin())];
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
    spread = std::max(spread - kRounding, -1.0f);
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

float Emitters::weight(const EmitterNode& node, const Receiver& receiver) {
  const glm::vec3 to = receiver.position - node.centre;
  const float d2 = glm::dot(to, to);
  if (d2 <= node.radius2) return node.power / std::max(node.radius2, 1e-20f);
  const float inverse = 1 / std::sqrt(d2);
  const float sine = std::sqrt(node.radius2) * inverse;
  const Angle bounds{std::sqrt(1 - sine * sine), sine};
  const Angle emitting = angleOf(glm::dot(to, node.axis) * inverse) - angleOf(node.spread) - bounds;
  const Angle receiving = angleOf(-glm::dot(to, receiver.normal) * inverse) - bounds;
  if (emitting.cosine < -kRounding || receiving.cosine < -kRounding) return 0;
  return node.power * std::max(emitting.cosine, kLeastCosine) * std::max(receiving.cosine, kLeastCosine) / d2;
}

float Emitters::weight(const Emitter& emitter, const Receiver& receiver) {
  const glm::vec3 to = receiver.position - emitter.centre;
  const float above = glm::dot(to, emitter.normal);
  if (!emitter.doubleSided && !(above > 0)) return 0;
  const float d2 = std::max({glm::dot(to, to), emitter.radius2, 1e-20f}), d = std::sqrt(d2),
              radius = std::sqrt(emitter.radius2);
  const float receiving = radius - glm::dot(to, receiver.normal);
  if (receiving < -kRounding * d) return 0;
  const float emitting = std::min(std::abs(above) + 0.1f * radius, d);
  return emitter.power * std::max(emitting, kLeastCosine * d) *
         std::max(std::min(receiving, d), kLeastCosine * d) / (d2 * d2);
}

float Emitters::firstHalf(uint32_t node, const Receiver& receiver) const {
  const float first = weight(nodes_[2 * node], receiver), second = weight(nodes_[2 * node + 1], receiver);
  return first + second > 0 ? first / (first + second) : -1.0f;
}

bool Emitters::within(glm::vec3 point, float reach) const {
  return !empty() && within(point, reach, 1, {0, uint32_t(emitters_.size())});
}

bool Emitters::within(glm::vec3 point, float reach, uint32_t node, Range range) const {
  const auto isNear = [&](glm::vec3 centre, float radius2) {
    const float radius = reach + std::sqrt(radius2);
    return glm::dot(point - centre, point - centre) <= radius * radius;
  };
  // The bounding sphere of a triangle may extend beyond that of its node, but no farther than this.
  if (!isNear(nodes_[node].centre, 9 * nodes_[node].radius2)) return false;
  if (range.isLeaf())
    return std::any_of(emitters_.begin() + range.first, emitters_.begin() + range.last,
                       [&](const Emitter& e) { return isNear(e.centre, e.radius2); });
  return within(point, reach, 2 * node, {range.first, range.middle()}) ||
         within(point, reach, 2 * node + 1, {range.middle(), range.last});
}

// The random number is rescaled after each decision, so one number is enough.
EmitterPoint Emitters::sample(const Receiver& receiver, float choice, float u, float v) const {
  EmitterPoint p;
  if (empty()) return p;
  Range range{0, uint32_t(emitters_.size())};
  float probability = 1;
  for (uint32_t node = 1; !range.isLeaf();) {
    const float first = firstHalf(node, receiver);
    if (first < 0) return p;
    const bool second = choice >= first;
    choice = second ? (choice - first) / (1 - first) : choice / first;
    probability *= second ? 1 - first : first;
    node = 2 * node + (second ? 1 : 0);
    (second ? range.first : range.last) = range.middle();
  }
  float total = 0, reached = 0;
  for (uint32_t i = range.first; i < range.last; ++i) total += weight(emitters_[i], receiver);
  if (!(total > 0)) return p;
  const Emitter* chosen = nullptr;
  for (uint32_t i = range.first; i < range.last; ++i) {
    const float own = weight(emitters_[i], receiver);
    if (!(own > 0)) continue;
    chosen = &emitters_[i];
    reached += own;
    if (choice * total < reached) break;
  }
  const float root = std::sqrt(u);
  p.triangle = chosen->triangle;
  p.u = root * (1.0f - v);
  p.v = root * v;
  const SurfaceHit s = surfaceAt(*frame_.geometry, {p.triangle, 0, p.u, p.v});
  p.position = s.position;
  p.normal = glm::dot(chosen->normal, receiver.position - chosen->centre) > 0 ? s.geometricNormal
                                                                              : -s.geometricNormal;
  p.radiance = emission(*frame_.scene, frame_.scene->materials[s.material], s.uv);
  p.density = probability * weight(*chosen, receiver) / (total * chosen->area);
  return p;
}

float Emitters::density(uint32_t triangle, const Receiver& receiver) const {
  const uint32_t place = placeOf(triangle);
  if (place == kNoIndex) return 0;
  Range range{0, uint32_t(emitters_.size())};
  float probability = 1;
  for (uint32_t node = 1; !range.isLeaf();) {
    const float first = firstHalf(node, receiver);
    if (first < 0) return 0;
    const bool second = place >= range.middle();
    probability *= second ? 1 - first : first;
    node = 2 * node + (second ? 1 : 0);
    (second ? range.first : range.last) = range.middle();
  }
  float total = 0;
  for (uint32_t i = range.first; i < range.last; ++i) total += weight(emitters_[i], receiver);
  const float own = weight(emitters_[place], receiver);
  return own > 0 ? probability * own / (total * emitters_[place].area) : 0;
}

}  // namespace fovea::scene
