#include "framework/scene/materials/bounced.h"

namespace fovea::scene {

glm::vec3 bouncedColor(const Material& material, bool fullMaterials) {
  const float metal = material.meanMetallic();
  if (!fullMaterials) return glm::vec3(material.baseColor) * (1.0f - metal);
  if (material.unlit) return glm::vec3(0);
  return glm::vec3(material.baseColor) * (1.0f - material.transmission * (1.0f - metal));
}

glm::vec3 bouncedReflectance(const Scene& scene, const Material& material, glm::vec2 uv, bool fullMaterials) {
  if (!fullMaterials) return glm::vec3(reflectance(scene, material, uv));
  return bouncedColor(material, true) * glm::vec3(sampleTexture(scene, material.baseColorTexture, uv));
}

}  // namespace fovea::scene
