#include "passes/emit/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "framework/base/low_discrepancy.h"
#include "framework/scene/lights.h"
#include "framework/scene/rays/directions.h"

namespace fovea::passes {
namespace {

using namespace scene;

double meanChannel(glm::dvec3 v) { return (v.x + v.y + v.z) / 3.0; }

glm::vec3 sphereDirection(float u, float v) {
  const float z = 1.0f - 2.0f * u, r = std::sqrt(std::max(0.0f, 1.0f - z * z)),
              phi = glm::two_pi<float>() * v;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// Treats the falloff saturate((c - co) / (ci - co))^2 as a density over the cosine c: constant inside the inner cone,
// whose share of the mass is (1 - ci), then a square whose integral is (ci - co) / 3.
float spotCosine(float cosInner, float cosOuter, float u) {
  const float inner = 1.0f - cosInner, edge = (cosInner - cosOuter) / 3.0f;
  const float x = u * (inner + edge);
  if (x >= edge) return std::min(cosInner + (x - edge), 1.0f);
  return cosOuter + (cosInner - cosOuter) * std::cbrt(x / edge);
}

}  // namespace

glm::dvec3 lightPower(const Light& light, double beamArea) {
  const glm::dvec3 intensity = glm::dvec3(light.color) * double(light.intensity);
  switch (light.type) {
    case LightType::Directional:
      return intensity * beamArea;
    case LightType::Point:
      return intensity * 4.0 * glm::pi<double>();
    case LightType::Spot:
      break;
  }
  const SpotCone cone = spotCone(light);
  const double ci = cone.cosInner, co = cone.cosOuter;
  return intensity * 2.0 * glm::pi<double>() * ((1.0 - ci) + (ci - co) / 3.0);
}

glm::vec3 cosineDirection(glm::vec3 normal, float u, float v) {
  const float r = std::sqrt(u), phi = glm::two_pi<float>() * v;
  const glm::vec3 local(r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1.0f - u)));
  return glm::normalize(toWorld(orthonormalFrame(normal), local));
}

float rangeWindow(float distance, float range) {
  if (range <= 0) return 1.0f;
  const float x = distance / range;
  return std::clamp(1.0f - x * x * x * x, 0.0f, 1.0f);
}

LightSampler::LightSampler(const Frame& frame, bool emissiveTriangles, float epsilon)
    : frame_(frame), epsilon_(epsilon) {
  if (frame.geometry == nullptr || frame.geometry->empty()) return;
  for (uint32_t i = 0; i < frame.lights.size(); ++i) {
    const glm::dvec3 silhouette = boxSilhouette(frame.lights[i].direction);
    add({i, kNoIndex, lightPower(frame.lights[i], silhouette.x + silhouette.y + silhouette.z), 0});
  }
  if (emissiveTriangles && frame.scene != nullptr) addEmissiveTriangles();
}

void LightSampler::add(Source source) {
  const double weight = meanChannel(source.power);
  if (!(weight > 0) || !std::isfinite(weight)) return;
  source.cumulative = weight + (sources_.empty() ? 0.0 : sources_.back().cumulative);
  power_ += source.power;
  sources_.push_back(source);
}

// The power of a textured triangle is estimated from a few points. The estimate only affects how often the triangle
// is chosen; the flux of a path is exact.
void LightSampler::addEmissiveTriangles() {
  const Geometry& g = *frame_.geometry;
  constexpr float kPoints[4][2] = {{1 / 3.f, 1 / 3.f}, {0.15f, 0.7f}, {0.7f, 0.15f}, {0.15f, 0.15f}};
  for (const uint32_t t : g.emissive) {
    if (g.triangles[t].material() >= frame_.scene->materials.size()) continue;
    const Material& m = frame_.scene->materials[g.triangles[t].material()];
    const glm::vec3 &a = g.positions[g.triangles[t].v[0]], &b = g.positions[g.triangles[t].v[1]],
                    &c = g.positions[g.triangles[t].v[2]];
    const double area = 0.5 * double(glm::length(glm::cross(b - a, c - a)));
    glm::dvec3 radiance(0);
    for (const auto& p : kPoints)
      radiance += glm::dvec3(emission(*frame_.scene, m, surfaceAt(g, {t, 0, p[0], p[1]}).uv)) / 4.0;
    // This keeps a dark estimate from hiding a bright spot between the points.
    radiance = glm::max(radiance, 0.05 * glm::dvec3(m.emission));
    add({kNoIndex, t, radiance * area * glm::pi<double>() * (m.doubleSided ? 2.0 : 1.0), 0});
    hasSurfaces_ = true;
  }
}

glm::vec3 LightSampler::boxSilhouette(glm::vec3 direction) const {
  const glm::vec3 size = frame_.geometry->boundsMax - frame_.geometry->boundsMin;
  return glm::abs(direction) * glm::vec3(size.y * size.z, size.z * size.x, size.x * size.y);
}

void LightSampler::sampleLight(const Light& light, const float u[4], Emission& e) const {
  e.range = light.type == LightType::Directional ? 0.0f : light.range;
  e.ray.origin = light.position;
  if (light.type == LightType::Point) {
    e.ray.direction = sphereDirection(u[1], u[2]);
  } else if (light.type == LightType::Spot) {
    const SpotCone cone = spotCone(light);
    const float cosine = spotCosine(cone.cosInner, cone.cosOuter, u[1]);
    const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), phi = glm::two_pi<float>() * u[2];
    const glm::vec3 local(sine * std::cos(phi), sine * std::sin(phi), cosine);
    e.ray.direction = glm::normalize(toWorld(orthonormalFrame(light.direction), local));
  } else {
    // The three faces of the box that the beam enters through, in proportion to their share of its cross-section.
    const glm::vec3 share = boxSilhouette(light.direction);
    const float x = u[3] * (share.x + share.y + share.z);
    const int axis = x < share.x ? 0 : x < share.x + share.y || share.z <= 0 ? 1 : 2;
    const glm::vec3 low = frame_.geometry->boundsMin, size = frame_.geometry->boundsMax - low;
    glm::vec3 p = low;
    p[axis] += light.direction[axis] > 0 ? 0.0f : size[axis];
    p[(axis + 1) % 3] += u[1] * size[(axis + 1) % 3];
    p[(axis + 2) % 3] += u[2] * size[(axis + 2) % 3];
    // Starts outside the box, so that scene geometry lying in the face of the box is hit as well.
    e.ray.origin = p - light.direction * (0.01f * glm::length(size));
    e.ray.direction = light.direction;
  }
}

void LightSampler::sampleTriangle(const Source& source, double probability, const float u[4], uint32_t index,
                                  uint32_t seed, Emission& e) const {
  const Geometry& g = *frame_.geometry;
  const Material& m = frame_.scene->materials[g.triangles[source.triangle].material()];
  const float root = std::sqrt(u[1]);
  const SurfaceHit s = surfaceAt(g, {source.triangle, 0, root * (1.0f - u[2]), root * u[2]});
  const auto& v = g.triangles[source.triangle].v;
  const double area = 0.5 * double(glm::length(glm::cross(g.positions[v[1]] - g.positions[v[0]],
                                                          g.positions[v[2]] - g.positions[v[0]])));
  const double sides = m.doubleSided ? 2.0 : 1.0;
  e.surface = true;
  e.normal = m.doubleSided && u[3] < 0.5f ? -s.geometricNormal : s.geometricNormal;
  e.flux = glm::vec3(glm::dvec3(emission(*frame_.scene, m, s.uv)) *
                     (area * glm::pi<double>() * sides / probability));
  e.ray.origin = s.position + e.normal * epsilon_;
  e.ray.direction = cosineDirection(e.normal, sobol(index, 4, seed), sobol(index, 5, seed));
}

Emission LightSampler::sample(uint32_t index, uint32_t seed) const {
  Emission e;
  const float u[4] = {sobol(index, 0, seed), sobol(index, 1, seed), sobol(index, 2, seed),
                      sobol(index, 3, seed)};
  const double total = sources_.back().cumulative;
  const auto found = std::upper_bound(sources_.begin(), sources_.end(), double(u[0]) * total,
                                      [](double x, const Source& s) { return x < s.cumulative; });
  const Source& source = found == sources_.end() ? sources_.back() : *found;
  const double probability = meanChannel(source.power) / total;
  if (source.triangle != kNoIndex) {
    sampleTriangle(source, probability, u, index, seed, e);
  } else {
    e.flux = glm::vec3(source.power / probability);
    sampleLight(frame_.lights[source.light], u, e);
  }
  return e;
}

}  // namespace fovea::passes
