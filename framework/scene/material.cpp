// Texture and material look-ups on the CPU, the reference for shaders/common/scene.glsl.
#include <array>
#include <cmath>

#include "framework/scene/scene.h"
#include "framework/scene/texture_taps.h"

namespace fovea::scene {
namespace {

// IEC 61966-2-1, tabulated for the 256 stored values.
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

int64_t wrapTexel(int64_t i, int64_t size, Wrap wrap) {
  if (i >= 0 && i < size) return i;
  if (wrap == Wrap::Repeat && (size & (size - 1)) == 0) return i & (size - 1);
  switch (wrap) {
    case Wrap::Clamp:
      return std::min(std::max(i, int64_t(0)), size - 1);
    case Wrap::Mirror: {
      const int64_t period = ((i % (2 * size)) + 2 * size) % (2 * size);
      return period < size ? period : 2 * size - 1 - period;
    }
    case Wrap::Repeat:
      break;
  }
  return ((i % size) + size) % size;
}

glm::vec4 decode(const uint8_t* p, bool srgb, const std::array<float, 256>& table) {
  if (!srgb) return glm::vec4(p[0], p[1], p[2], p[3]) / 255.0f;
  return {table[p[0]], table[p[1]], table[p[2]], float(p[3]) / 255.0f};
}

// Coordinates past any texture's size times this are noise in a float; they must not overflow the integer
// conversion.
float tame(float texels) { return std::isfinite(texels) ? std::min(std::max(texels, -1e9f), 1e9f) : 0.0f; }

}  // namespace

TexelSquare texelSquare(uint32_t width, uint32_t height, const TextureUse& use, glm::vec2 uv) {
  const glm::vec2 p = use.transform * glm::vec3(uv, 1.0f);
  const float u = tame(p.x * float(width) - 0.5f), v = tame(p.y * float(height) - 0.5f);
  const float u0 = std::floor(u), v0 = std::floor(v);
  const int64_t x = int64_t(u0), y = int64_t(v0);
  TexelSquare s;
  for (int i = 0; i < 2; ++i) {
    s.column[i] = uint32_t(wrapTexel(x + i, width, use.wrapU));
    s.row[i] = uint32_t(wrapTexel(y + i, height, use.wrapV));
  }
  s.right = u - u0;
  s.lower = v - v0;
  return s;
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

glm::vec4 sample(const TextureTaps& taps) {
  if (taps.texel[0] == nullptr) return glm::vec4(1.0f);
  const auto& table = srgbTable();
  const auto texel = [&](int i) { return decode(taps.texel[i], taps.srgb, table); };
  const glm::vec4 top = glm::mix(texel(0), texel(1), taps.right);
  const glm::vec4 bottom = glm::mix(texel(2), texel(3), taps.right);
  return glm::mix(top, bottom, taps.lower);
}

glm::vec4 sampleTexture(const Scene& scene, const TextureUse& use, glm::vec2 uv) {
  return sample(textureTaps(scene, use, uv));
}

glm::vec4 reflectance(const Scene& scene, const Material& material, glm::vec2 uv) {
  const glm::vec4 color = material.baseColor * sampleTexture(scene, material.baseColorTexture, uv);
  return {glm::vec3(color) * (1.0f - material.metallic), color.a};
}

glm::vec3 emission(const Scene& scene, const Material& material, glm::vec2 uv) {
  return material.emission * glm::vec3(sampleTexture(scene, material.emissionTexture, uv));
}

}  // namespace fovea::scene
