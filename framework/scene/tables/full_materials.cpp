#include "framework/scene/tables/full_materials.h"

#include <algorithm>
#include <cstring>

#include "framework/scene/lights.h"
#include "framework/scene/tables/albedos.h"

namespace fovea::scene {
namespace {

template <class Record>
void append(const Record& record, std::vector<glm::vec4>& texels) {
  static_assert(sizeof(Record) % sizeof(glm::vec4) == 0);
  const size_t first = texels.size();
  texels.resize(first + sizeof(Record) / sizeof(glm::vec4));
  std::memcpy(texels.data() + first, &record, sizeof(Record));
}

// Reflectance of a dielectric at normal incidence; ior 0 stands for infinity.
float normalReflectance(float ior) {
  const float root = (ior - 1) / (ior + 1);
  return ior == 0 ? 1 : root * root;
}

SurfaceRecord surfaceEntry(const Material& m, float preExposure,
                           const std::function<TextureRecord(const TextureUse&)>& textureEntry) {
  SurfaceRecord record;
  record.baseColor = glm::vec3(m.baseColor);
  record.metallic = m.metallic;
  record.specularF0 = normalReflectance(m.ior) * m.specularColor;
  record.specular = m.specular;
  record.roughness = m.roughness;
  record.normalScale = m.normalScale;
  record.transmission = m.transmission;
  record.unlit = m.unlit ? preExposure : 0;
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
  first.transparent = std::ranges::any_of(scene.materials, letsLightThrough);
  first.firstSurface = uint32_t(texels.size());
  for (const Material& m : scene.materials) append(surfaceEntry(m, preExposure(scene), textureEntry), texels);
  first.firstAlbedo = uint32_t(texels.size());
  texels.insert(texels.end(), lobeAlbedos().begin(), lobeAlbedos().end());
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
