#include "framework/scene/tables/material_table.h"

#include "framework/scene/lights.h"
#include "shaders/records/scene.h"

namespace fovea::scene {
namespace {

uint32_t wrapCode(Wrap wrap) {
  return wrap == Wrap::Clamp ? kWrapClamp : wrap == Wrap::Mirror ? kWrapMirror : 0;
}

TextureRecord textureRecord(const Scene& scene, const TextureUse& use, const TexturePlace& placeOf) {
  const std::optional<glm::uvec3> place = placeOf(use.texture);
  if (!place) return {};
  const Texture& t = scene.textures[use.texture];
  const uint32_t flags = wrapCode(use.wrapU) | wrapCode(use.wrapV) << 2 | (t.srgb ? 0 : kTextureLinear) |
                         (use.set == 1 ? kTextureSecondSet : 0) | (use.nearest ? kTextureNearest : 0);
  const glm::mat3x2& m = use.transform;
  return {
      float(place->z), float(place->x), float(place->y), float(flags), {t.width, t.height}, m[2], m[0], m[1]};
}

// Materials as light finds them where nobody asks in which direction it leaves. All are taken for diffuse, also where
// the picture shows full materials; metals then keep their colour, as the mean of what they reflect differs little from
// that, and otherwise they are black.
glm::vec3 bouncedColor(const Material& material, bool fullMaterials) {
  const float metal = material.meanMetallic();
  if (!fullMaterials) return glm::vec3(material.baseColor) * (1.0f - metal);
  if (material.unlit) return glm::vec3(0);
  return glm::vec3(material.baseColor) * (1.0f - material.transmission * (1.0f - metal));
}

}  // namespace

MaterialTable materialTable(const Scene& scene, const Geometry& geometry, bool fullMaterials,
                            const TexturePlace& place) {
  static_assert(sizeof(MaterialRecord) % sizeof(glm::vec4) == 0);
  const auto texture = [&](const TextureUse& use) { return textureRecord(scene, use, place); };
  MaterialTable table;
  table.texels.resize(scene.materials.size() * (sizeof(MaterialRecord) / sizeof(glm::vec4)));
  auto* records = reinterpret_cast<MaterialRecord*>(table.texels.data());
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    MaterialRecord& record = records[i];
    record = {};
    record.baseColor = bouncedColor(m, fullMaterials);
    record.alpha = m.baseColor.a;
    record.emission = fullMaterials && m.unlit ? glm::vec3(0) : m.emission * preExposure(scene);
    const bool transmits = fullMaterials && m.transmission > 0;
    record.alphaCutoff = m.masked ? m.alphaCutoff : transmits ? -1.0f : 0.0f;
    record.colorTexture = texture(m.baseColorTexture);
    record.emissionTexture = texture(m.emissionTexture);
    if (m.doubleSided) record.colorTexture.flags += float(kMaterialDoubleSided);
    if (fullMaterials && m.blended) record.colorTexture.flags += float(kMaterialBlended);
    if (transmits) record.colorTexture.flags += float(kMaterialTransmits);
  }
  if (fullMaterials) table.full = appendFullMaterials(scene, geometry, texture, table.texels);
  return table;
}

}  // namespace fovea::scene
