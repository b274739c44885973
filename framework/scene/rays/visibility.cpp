#include "framework/scene/rays/visibility.h"

#include <cmath>

#include "framework/scene/materials/passage.h"
#include "shaders/records/rays.h"

namespace fovea::scene {

glm::vec3 visibility(const Frame& frame, const RayScene& rays, Ray ray, uint64_t& count) {
  if (!rays.meetsTransparency()) {
    ++count;
    return glm::vec3(rays.occluded(ray) ? 0.0f : 1.0f);
  }
  const glm::vec3 direction = glm::normalize(ray.direction);
  glm::vec3 share(1);
  for (uint32_t pane = 0; pane < kMaxPanes; ++pane) {
    ++count;
    const RayHit hit = rays.intersect(ray);
    if (!hit) return share;
    const SurfaceHit s = surfaceAt(*frame.geometry, hit);
    const Material& material = frame.scene->materials[s.material];
    if (!letsLightThrough(material)) break;
    const float cosine = std::abs(glm::dot(s.shadingNormal, direction));
    share *= transmittance(*frame.scene, material, s.uv, cosine);
    if (share == glm::vec3(0)) break;
    ray.near = std::nextafter(hit.distance, ray.far) * (1.0f + 1e-6f);
  }
  return glm::vec3(0);
}

}  // namespace fovea::scene
