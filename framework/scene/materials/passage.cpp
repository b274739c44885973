#include "framework/scene/materials/passage.h"

#include <algorithm>

#include "framework/scene/materials/albedo_table.h"
#include "framework/scene/materials/microfacets.h"
#include "shaders/common/records/scene.h"

namespace fovea::scene {
namespace {

float mean(glm::vec3 c) { return (c.r + c.g + c.b) / 3.0f; }

}  // namespace

float coverage(const Scene& scene, const Material& material, glm::vec2 uv) {
  if (!material.masked) return 1;
  const float alpha = reflectance(scene, material, uv).a;
  if (material.blended) return std::clamp(alpha, 0.0f, 1.0f);
  return alpha >= material.alphaCutoff ? 1.0f : 0.0f;
}

float passage(const Scene& scene, const Material& material, glm::vec2 uv, float cosine) {
  if (!(material.transmission > 0)) return 0;
  static const AlbedoTable& table = AlbedoTable::dielectric(1.5f);
  const glm::vec4 metalAndRoughness = sampleTexture(scene, material.metallicRoughnessTexture, uv);
  const float enters = material.transmission * sampleTexture(scene, material.transmissionTexture, uv).r *
                       (1 - material.metallic * metalAndRoughness.b);
  const Albedo a = table.at(cosine, material.roughness * metalAndRoughness.g);
  const float f0 = mean(glm::min(normalReflectance(material.ior) * material.specularColor, 1.0f));
  const float reflects = material.specular * (f0 * a.low + a.high);
  return std::clamp(mean(glassColor(scene, material, uv)) * enters * (1 - reflects), 0.0f, kMostPassed);
}

glm::vec3 glassColor(const Scene& scene, const Material& material, glm::vec2 uv) {
  const glm::vec3 texel(sampleTexture(scene, material.baseColorTexture, uv));
  return glm::min(glm::vec3(material.baseColor) * texel, 1.0f);
}

}  // namespace fovea::scene
