#include "passes/path-trace/emitters.h"

#include <algorithm>
#include <cmath>

namespace fovea::passes {

using namespace scene;

namespace {

float areaOf(const Geometry& g, uint32_t triangle) {
  const auto& v = g.triangles[triangle].v;
  return 0.5f * glm::length(
                    glm::cross(g.positions[v[1]] - g.positions[v[0]], g.positions[v[2]] - g.positions[v[0]]));
}

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

}  // namespace

Emitters::Emitters(const Frame& frame) : frame_(frame) {
  const Geometry& g = *frame.geometry;
  const auto& materials = frame.scene->materials;
  for (uint32_t t = 0; t < g.triangles.size(); ++t) {
    const uint32_t index = g.triangles[t].material();
    if (index >= materials.size() || materials[index].emission == glm::vec3(0)) continue;
    const double power =
        estimatedRadiance(frame, t, materials[index]) * areaOf(g, t) * (materials[index].doubleSided ? 2 : 1);
    if (!(power > 0) || !std::isfinite(power)) continue;
    triangles_.push_back(t);
    cumulative_.push_back(power + (cumulative_.empty() ? 0.0 : cumulative_.back()));
  }
  if (triangles_.empty()) return;
  density_.resize(g.triangles.size());
  for (size_t i = 0; i < triangles_.size(); ++i) {
    const double power = cumulative_[i] - (i == 0 ? 0.0 : cumulative_[i - 1]);
    density_[triangles_[i]] = float(power / cumulative_.back() / areaOf(g, triangles_[i]));
  }
}

EmitterPoint Emitters::sample(glm::vec3 receiver, float choice, float u, float v) const {
  const auto found =
      std::upper_bound(cumulative_.begin(), cumulative_.end(), double(choice) * cumulative_.back());
  const uint32_t t = triangles_[std::min(size_t(found - cumulative_.begin()), triangles_.size() - 1)];
  const float root = std::sqrt(u);
  const SurfaceHit s = surfaceAt(*frame_.geometry, {t, 0, root * (1.0f - v), root * v});
  const Material& material = frame_.scene->materials[s.material];
  const bool front = glm::dot(s.geometricNormal, receiver - s.position) > 0;
  EmitterPoint p;
  p.position = s.position;
  p.normal = front ? s.geometricNormal : -s.geometricNormal;
  p.density = density_[t];
  if (front || material.doubleSided) p.radiance = emission(*frame_.scene, material, s.uv);
  return p;
}

}  // namespace fovea::passes
