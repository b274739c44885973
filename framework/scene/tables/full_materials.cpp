#include "framework/scene/tables/full_materials.h"

#include <cstring>

#include "framework/scene/materials/albedo_table.h"
#include "framework/scene/materials/microfacets.h"

namespace fovea::scene {
namespace {

template <class Record>
void append(const Record& record, std::vector<glm::vec4>& texels) {
  static_assert(sizeof(Record) % sizeof(glm::vec4) == 0);
  const size_t first = texels.size();
  texels.resize(first + sizeof(Record) / sizeof(glm::vec4));
  std::memcpy(texels.data() + first, &record, sizeof(Record));
}

SurfaceRecord surfaceEntry(const Material& m,
                           const std::function<TextureRecord(const TextureUse&)>& textureEntry) {
  SurfaceRecord record;
  record.baseColor = glm::vec3(m.baseColor);
  record.metallic = m.metallic;
  record.specularF0 = normalReflectance(m.ior) * m.specularColor;
  record.specular = m.specular;
  record.roughness = m.roughness;
  record.normalScale = m.normalScale;
  record.transmission = m.transmission;
  record.unlit = float(m.unlit);
  record.clearcoat = m.clearcoat;
  record.clearcoatRoughness = m.clearcoatRoughness;
  record.metallicRoughnessTexture = textureEntry(m.metallicRoughnessTexture);
  record.normalTexture = textureEntry(m.normalTexture);
  record.specularTexture = textureEntry(m.specularTexture);
  record.specularColorTexture = textureEntry(m.specularColorTexture);
  record.transmissionTexture = textureEntry(m.transmissionTexture);
  record.clearcoatTexture = textureEntry(m.clearcoatTexture);
  record.clearcoatRoughnessTexture = textureEntry(m.clearcoatRoughnessTexture);
  return record;
}

glm::vec4 albedoEntry(Albedo metal, Albedo dielectric) {
  return {metal.total(), metal.high, dielectric.high, 0};
}

void appendAlbedos(std::vector<glm::vec4>& texels) {
  const AlbedoTable &metal = AlbedoTable::schlick(), &dielectric = AlbedoTable::dielectric(1.5f);
  const auto share = [](uint32_t i) { return float(i) / float(kAlbedoSide - 1); };
  for (uint32_t row = 0; row < kAlbedoSide; ++row)
    for (uint32_t column = 0; column < kAlbedoSide; ++column) {
      const float root = kAlbedoLeastRoot + (1 - kAlbedoLeastRoot) * share(column);
      texels.push_back(
          albedoEntry(metal.at(root * root, share(row)), dielectric.at(root * root, share(row))));
    }
  for (uint32_t row = 0; row < kAlbedoSide; ++row)
    texels.push_back(albedoEntry(metal.average(share(row)), dielectric.average(share(row))));
}

TangentRecord tangentEntry(const TriangleTangents& t) {
  TangentRecord record;
  record.corner0 = t.corners[0];
  record.bitangentSign = t.bitangentSign;
  record.corner1 = t.corners[1];
  record.corner2 = t.corners[2];
  return record;
}

}  // namespace

FullMaterials appendFullMaterials(const Scene& scene, const Geometry& geometry,
                                  const std::function<TextureRecord(const TextureUse&)>& textureEntry,
                                  std::vector<glm::vec4>& texels) {
  FullMaterials first;
  first.firstSurface = uint32_t(texels.size());
  for (const Material& m : scene.materials) append(surfaceEntry(m, textureEntry), texels);
  first.firstAlbedo = uint32_t(texels.size());
  appendAlbedos(texels);
  if (!geometry.tangents.empty()) {
    first.firstTangent = uint32_t(texels.size());
    for (const TriangleTangents& t : geometry.tangents) append(tangentEntry(t), texels);
  }
  if (!geometry.colors.empty() || !geometry.secondUvs.empty()) {
    first.firstDetail = uint32_t(texels.size());
    for (size_t i = 0; i < geometry.positions.size(); ++i) {
      VertexDetail detail;
      if (!geometry.colors.empty()) detail.color = geometry.colors[i];
      detail.uv = geometry.secondUvs.empty() ? geometry.uvs[i] : geometry.secondUvs[i];
      append(detail, texels);
    }
  }
  return first;
}

}  // namespace fovea::scene
