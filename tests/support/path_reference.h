// Indirect light by plain path tracing on the CPU, which the light of VPLs is compared with.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/scene.h"
#include "passes/path-trace/directions.h"
#include "passes/path-trace/lights.h"

namespace fovea::test {

class PathReference {
 public:
  // bounces is the number of diffuse reflections between the light and the surface that is seen.
  PathReference(const scene::Scene& s, const scene::Geometry& g, uint32_t bounces = 2)
      : scene_(s), geometry_(g), rays_(s, g), bounces_(bounces) {}

  // Indirect radiance towards the eye along a ray.
  glm::dvec3 indirect(glm::vec3 origin, glm::vec3 direction, uint32_t pixel, int samples) const {
    scene::SurfaceHit first;
    if (!hit({origin, direction}, first)) return glm::dvec3(0);
    const glm::dvec3 rho = albedo(first);
    glm::dvec3 sum(0);
    for (int k = 0; k < samples; ++k) {
      scene::SurfaceHit at = first;
      glm::dvec3 throughput = rho;
      for (uint32_t bounce = 0; bounce < bounces_; ++bounce) {
        const glm::vec3 w = cosineAround(at.shadingNormal, pixel, uint32_t(k), bounce);
        if (glm::dot(w, at.geometricNormal) <= 0) break;
        const glm::vec3 from = at.position + at.geometricNormal * rays_.epsilon();
        if (!hit({from, w}, at)) break;
        throughput *= albedo(at);
        sum += throughput * direct(at) / glm::pi<double>() / double(samples);
      }
    }
    return sum;
  }

 private:
  bool hit(const scene::Ray& ray, scene::SurfaceHit& at) const {
    const scene::RayHit h = rays_.intersect(ray);
    if (!h) return false;
    at = surfaceAt(geometry_, h);
    if (glm::dot(at.geometricNormal, ray.direction) > 0) {
      at.geometricNormal = -at.geometricNormal;
      at.shadingNormal = -at.shadingNormal;
    }
    return true;
  }
  glm::dvec3 albedo(const scene::SurfaceHit& at) const {
    return glm::dvec3(reflectance(scene_, scene_.materials[at.material], at.uv));
  }
  glm::dvec3 direct(const scene::SurfaceHit& at) const {
    glm::dvec3 e(0);
    for (const scene::Light& light : scene_.lights) {
      const path_trace::IncidentLight l = path_trace::incidentLight(light, at.position);
      const float cosine = glm::dot(at.shadingNormal, l.direction);
      if (cosine <= 0 || glm::dot(at.geometricNormal, l.direction) <= 0) continue;
      const glm::vec3 from = at.position + at.geometricNormal * rays_.epsilon();
      if (!rays_.occluded({from, l.direction, 0, l.distance * 0.9999f}))
        e += double(cosine) * glm::dvec3(l.irradiance);
    }
    return e;
  }
  static glm::vec3 cosineAround(glm::vec3 n, uint32_t pixel, uint32_t sample, uint32_t bounce) {
    const float u = uniformFloat(randomStream(77, pixel, 2 * bounce, sample));
    const float v = uniformFloat(randomStream(77, pixel, 2 * bounce + 1, sample));
    const float r = std::sqrt(u), phi = glm::two_pi<float>() * v;
    return path_trace::toWorld(path_trace::frameAround(n),
                               {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)});
  }
  const scene::Scene& scene_;
  const scene::Geometry& geometry_;
  scene::RayScene rays_;
  uint32_t bounces_;
};

// Indirect radiance of every pixel, 4 floats each, in the layout of the graphs' output. Another `stream` gives
// other random numbers.
inline std::vector<float> tracedIndirect(const scene::Scene& s, glm::uvec2 size, uint32_t bounces,
                                         int samples, uint32_t stream = 0) {
  const scene::Geometry g = flatten(s);
  const scene::Frame frame = makeFrame(s, g, size, 0, 1);
  const PathReference reference(s, g, bounces);
  std::vector<float> image;
  for (uint32_t y = 0; y < size.y; ++y)
    for (uint32_t x = 0; x < size.x; ++x) {
      const glm::vec3 direction =
          glm::normalize(frame.views[0].rayDirection({float(x) + 0.5f, float(y) + 0.5f}));
      const glm::dvec3 l =
          reference.indirect(frame.views[0].eye, direction, (stream * size.y + y) * size.x + x, samples);
      image.insert(image.end(), {float(l.r), float(l.g), float(l.b), 1.0f});
    }
  return image;
}

}  // namespace fovea::test
