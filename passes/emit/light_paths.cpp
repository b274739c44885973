#include "passes/emit/light_paths.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <numeric>

#include "framework/base/low_discrepancy.h"
#include "framework/scene/materials/bounced.h"
#include "passes/emit/light_sampler.h"

namespace fovea::passes {
namespace {

using namespace scene;

// Shading normals redistribute the light that arrives: a gathering renderer weights it by cos_shading, but particles
// are counted by cos_geometric (Veach 1997, section 5.3). The bound keeps single VPLs from becoming too bright.
constexpr float kMaxNormalCorrection = 4.0f;

// Paths tried per requested VPL before giving up on a scene that its lights do not reach.
constexpr uint64_t kPathsPerVpl = 256;

class PathTracer {
 public:
  PathTracer(const Frame& frame, const RayScene& rays, const LightSampler& lights,
             const EmitSettings& settings)
      : frame_(frame), rays_(rays), lights_(lights), settings_(settings) {}

  // Returns the VPLs of path `index`, their intensities not yet divided by the number of paths.
  const std::vector<Vpl>& trace(uint32_t index) {
    vpls_.clear();
    Emission e = lights_.sample(index, settings_.seed);
    if (e.surface) store(e.ray.origin, e.normal, e.flux);
    glm::vec3 flux = e.flux;
    Ray ray = e.ray;
    for (uint32_t bounce = 1; bounce <= settings_.bounces; ++bounce) {
      ++rayCount;
      const RayHit hit = rays_.intersect(ray);
      if (!hit) {
        ++escaped;
        break;
      }
      if (bounce == 1) flux *= rangeWindow(hit.distance, e.range);
      if (!reflect(hit, bounce, index, flux, ray)) break;
    }
    return vpls_;
  }

  uint64_t rayCount = 0, escaped = 0;

 private:
  void store(glm::vec3 position, glm::vec3 normal, glm::vec3 reflectedFlux) {
    Vpl v;
    v.position = position;
    v.normal = normal;
    v.intensity = reflectedFlux / glm::pi<float>();
    if (v.intensity != glm::vec3(0)) vpls_.push_back(v);
  }

  // Stores the VPL of a hit, then applies Keller's termination: the path survives with a probability equal to the
  // surface's reflectivity, so its flux does not shrink. Returns true, and the next ray, if it survives.
  bool reflect(const RayHit& hit, uint32_t bounce, uint32_t index, glm::vec3& flux, Ray& ray) {
    const SurfaceHit s = surfaceAt(*frame_.geometry, hit);
    const float side = glm::dot(s.geometricNormal, ray.direction) < 0 ? 1.0f : -1.0f;
    const glm::vec3 normal = side * s.geometricNormal;
    const float cosGeometric = -glm::dot(normal, ray.direction);
    const float cosShading = -side * glm::dot(s.shadingNormal, ray.direction);
    if (cosShading <= 0 || cosGeometric <= 0) return false;
    const Material& material = frame_.scene->materials[s.material];
    const glm::vec3 rho =
        glm::clamp(bouncedReflectance(*frame_.scene, material, s.uv, settings_.fullMaterials), 0.0f, 1.0f);
    flux *= rho * std::min(cosShading / cosGeometric, kMaxNormalCorrection);
    store(s.position, normal, flux);
    const float survival = std::max({rho.r, rho.g, rho.b});
    const uint32_t dimension = 4 * (bounce + 1);  // groups 0 and 1 belong to the emission
    if (sobol(index, dimension + 2, settings_.seed) >= survival) return false;
    flux /= survival;
    ray = {};
    ray.origin = s.position + normal * rays_.epsilon();
    ray.direction = cosineDirection(normal, sobol(index, dimension, settings_.seed),
                                    sobol(index, dimension + 1, settings_.seed));
    return true;
  }

  const Frame& frame_;
  const RayScene& rays_;
  const LightSampler& lights_;
  const EmitSettings& settings_;
  std::vector<Vpl> vpls_;
};

// Splits the brightest VPL in two until the list is full.
void fillBySplitting(std::vector<Vpl>& vpls, uint32_t count) {
  while (!vpls.empty() && vpls.size() < count) {
    const auto brightest = std::max_element(vpls.begin(), vpls.end(), [](const Vpl& a, const Vpl& b) {
      return a.intensity.r + a.intensity.g + a.intensity.b < b.intensity.r + b.intensity.g + b.intensity.b;
    });
    brightest->intensity *= 0.5f;
    vpls.push_back(Vpl(*brightest));
  }
}

uint32_t spreadBits(uint32_t x) {  // spreads 10 bits to every third bit
  x = (x | (x << 16)) & 0x030000ffu;
  x = (x | (x << 8)) & 0x0300f00fu;
  x = (x | (x << 4)) & 0x030c30c3u;
  return (x | (x << 2)) & 0x09249249u;
}

}  // namespace

EmitResult traceLightPaths(const Frame& frame, const RayScene& rays, const EmitSettings& settings) {
  EmitResult result;
  const LightSampler lights(frame, settings.emissiveTriangles, rays.epsilon());
  if (lights.empty() || settings.count == 0) return result;
  EmitSettings fitting = settings;  // the longest path must fit into an empty list
  fitting.bounces = std::min(settings.bounces, settings.count - (lights.hasSurfaces() ? 1 : 0));
  if (fitting.bounces == 0 && !lights.hasSurfaces()) return result;  // paths without VPLs
  PathTracer tracer(frame, rays, lights, fitting);
  const uint64_t maxPaths = std::min<uint64_t>(kPathsPerVpl * settings.count + 4096, 0xffffffffu);
  bool full = false;
  while (!full && result.paths < maxPaths) {
    const std::vector<Vpl>& path = tracer.trace(uint32_t(result.paths));
    full = result.vpls.size() + path.size() > settings.count;
    if (full) break;
    result.vpls.insert(result.vpls.end(), path.begin(), path.end());
    ++result.paths;
  }
  result.rays = tracer.rayCount;
  result.escaped = tracer.escaped;
  for (Vpl& v : result.vpls) v.intensity /= float(result.paths);
  estimateAreas(result.vpls, settings.neighbours, float(rays.surfaceArea()));
  if (full) fillBySplitting(result.vpls, settings.count);
  sortAlongCurve(result.vpls);
  return result;
}

void estimateAreas(std::vector<Vpl>& vpls, uint32_t k, float limit) {
  std::vector<float> nearest;
  for (Vpl& v : vpls) {
    nearest.clear();  // squared distances of the k nearest so far, ascending
    for (const Vpl& w : vpls) {
      const glm::vec3 d = w.position - v.position;
      const float d2 = glm::dot(d, d);
      if (&w == &v || (nearest.size() == k && d2 >= nearest.back()) || glm::dot(v.normal, w.normal) < 0.5f)
        continue;
      if (nearest.size() == k) nearest.pop_back();
      nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), d2), d2);
    }
    v.area =
        nearest.empty() ? limit : std::min(glm::pi<float>() * nearest.back() / float(nearest.size()), limit);
  }
}

void sortAlongCurve(std::vector<Vpl>& vpls) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const Vpl& v : vpls) {
    low = glm::min(low, v.position);
    high = glm::max(high, v.position);
  }
  const float scale = 1023.0f / std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-6f});
  std::vector<std::pair<uint32_t, uint32_t>> order(vpls.size());
  for (uint32_t i = 0; i < vpls.size(); ++i) {
    const glm::uvec3 cell((vpls[i].position - low) * scale);
    order[i] = {spreadBits(cell.x) | spreadBits(cell.y) << 1 | spreadBits(cell.z) << 2, i};
  }
  std::sort(order.begin(), order.end());
  std::vector<Vpl> sorted;
  sorted.reserve(vpls.size());
  for (const auto& o : order) sorted.push_back(vpls[o.second]);
  vpls.swap(sorted);
}

}  // namespace fovea::passes
