// Texture and material look-ups on the CPU, the reference for shaders/scene/scene.glsl.
#include <array>
#include <cmath>

#include "framework/scene/scene.h"
#include "framework/scene/texture_taps.h"

namespace fovea::scene {
const std::array<float, 256>& srgbTable() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (int i = 0; i < 256; ++i) {
      const double e = i / 255.0;
      t[size_t(i)] = float(e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4));
    }
    return t;
  }();
  return table;
}

TextureTaps textureTaps(const Scene& scene, const TextureUse& use, glm::vec2 uv) {
  TextureTaps taps;
  if (!use || use.texture >= scene.textures.size()) return taps;
  const Texture& t = scene.textures[use.texture];
  if (t.width == 0 || t.height == 0) return taps;
  const TexelSquare s = texelSquare(t.width, t.height, use, uv);
  const auto at = [&](uint32_t x, uint32_t y) { return t.rgba.data() + (size_t(y) * t.width + x) * 4; };
  return {{at(s.column[0], s.row[0]), at(s.column[1], s.row[0]), at(s.column[0], s.row[1]),
           at(s.column[1], s.row[1])},
          s.right,
          s.lower,
          t.srgb};
}

glm::vec4 sampleTexture(const Scene& scene, const TextureUse& use, glm::vec2 uv) {
  return sample(textureTaps(scene, use, uv));
}

glm::vec4 reflectance(const Scene& scene, const Material& material, glm::vec2 uv) {
  const glm::vec4 color = material.baseColor * sampleTexture(scene, material.baseColorTexture, uv);
  return {glm::vec3(color) * (1.0f - material.meanMetallic()), color.a};
}

glm::vec3 emission(const Scene& scene, const Material& material, glm::vec2 uv) {
  return material.emission * glm::vec3(sampleTexture(scene, material.emissionTexture, uv));
}

float coverage(const Scene& scene, const Material& material, glm::vec2 uv, float alpha, bool fullMaterials) {
  if (!material.masked) return 1;
  const float all = alpha * reflectance(scene, material, uv).a;
  if (fullMaterials && material.blended) return glm::clamp(all, 0.0f, 1.0f);
  return all >= material.alphaCutoff ? 1.0f : 0.0f;
}

}  // namespace fovea::scene
