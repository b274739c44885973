#include "framework/scene/materials/passage.h"

#include <algorithm>

#include "framework/base/random.h"
#include "framework/scene/materials/albedo_table.h"
#include "framework/scene/materials/microfacets.h"
#include "shaders/records/scene.h"

namespace fovea::scene {
namespace {

float meanChannel(glm::vec3 c) { return (c.r + c.g + c.b) / 3.0f; }

// What glass makes of the light that goes through it.
glm::vec3 glassColor(const Scene& scene, const Material& material, glm::vec2 uv) {
  const glm::vec3 texel(sampleTexture(scene, material.baseColorTexture, uv));
  return glm::min(glm::vec3(material.baseColor) * texel, 1.0f);
}

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
  const float f0 = meanChannel(glm::min(normalReflectance(material.ior) * material.specularColor, 1.0f));
  const float reflects = material.specular * (f0 * a.low + a.high);
  return std::clamp(meanChannel(glassColor(scene, material, uv)) * enters * (1 - reflects), 0.0f, kMostPassed);
}

glm::vec3 glassTint(const Scene& scene, const Material& material, glm::vec2 uv) {
  const glm::vec3 color = glm::max(glassColor(scene, material, uv), kDarkestGlass);
  return color / meanChannel(color);
}

glm::vec3 transmittance(const Scene& scene, const Material& material, glm::vec2 uv, float cosine) {
  const float covered = coverage(scene, material, uv);
  glm::vec3 share(1 - covered);
  if (material.transmission > 0)
    share += covered * passage(scene, material, uv, cosine) * glassTint(scene, material, uv);
  return share;
}

float passageChance(uint32_t key, glm::uvec2 pixel, uint32_t turn) {
  const glm::uvec2 at = (key & 8u) != 0 ? glm::uvec2(pixel.y, pixel.x) : pixel;
  const uint32_t along = (key & 16u) != 0 ? 0u - at.y : at.y;
  return uniformFloat(key + at.x * kPassageAcross + along * kPassageAlong +
                      turn * (kPassageTurn + (key & 7u) * kPassageTurns));
}

}  // namespace fovea::scene
