// A texture look-up in two steps, so that what many of them need of the memory can be asked for before it is
// needed. Inline: the path tracer does millions a second.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "framework/scene/scene.h"

namespace fovea::scene {

// Where a look-up finds its four texels: columns left and right, rows upper and lower, and the weights of the
// right and the lower ones. LOD 0, bilinear, texel centres at half-integers.
struct TexelSquare {
  uint32_t column[2] = {}, row[2] = {};
  float right = 0, lower = 0;
};

// |i| at most 1e9 + 1, size at most 2^29.
inline uint32_t wrapTexel(int32_t i, int32_t size, Wrap wrap) {
  if (wrap == Wrap::Repeat && (size & (size - 1)) == 0) return uint32_t(i & (size - 1));
  if (i >= 0 && i < size) return uint32_t(i);
  switch (wrap) {
    case Wrap::Clamp:
      return uint32_t(std::min(std::max(i, 0), size - 1));
    case Wrap::Mirror: {
      const int32_t period = ((i % (2 * size)) + 2 * size) % (2 * size);
      return uint32_t(period < size ? period : 2 * size - 1 - period);
    }
    case Wrap::Repeat:
      break;
  }
  return uint32_t(((i % size) + size) % size);
}

// width, height: of use's texture, at least 1.
inline TexelSquare texelSquare(uint32_t width, uint32_t height, const TextureUse& use, glm::vec2 uv) {
  // Coordinates past any texture's size times this are noise in a float; they must not overflow the integer
  // conversion.
  const auto tame = [](float texels) {
    return std::isfinite(texels) ? std::min(std::max(texels, -1e9f), 1e9f) : 0.0f;
  };
  const glm::vec2 p = use.transform * glm::vec3(uv, 1.0f);
  const float u = tame(p.x * float(width) - 0.5f), v = tame(p.y * float(height) - 0.5f);
  const auto floored = [](float f) { return int32_t(f) - int32_t(float(int32_t(f)) > f); };
  const int32_t x = floored(u), y = floored(v);
  TexelSquare s;
  for (int i = 0; i < 2; ++i) {
    s.column[i] = wrapTexel(x + i, int32_t(width), use.wrapU);
    s.row[i] = wrapTexel(y + i, int32_t(height), use.wrapV);
  }
  s.right = u - float(x);
  s.lower = v - float(y);
  return s;
}

// The four texels around a point and the weights of the right and the lower ones. Valid as long as the
// texture.
struct TextureTaps {
  const uint8_t* texel[4] =
      {};  // RGBA: upper left, upper right, lower left, lower right; null: no texture, white
  float right = 0, lower = 0;
  bool srgb = true;
  void prefetch() const {
    for (const uint8_t* t : texel) __builtin_prefetch(t);
  }
};

// sampleTexture(scene, use, uv) is sample(textureTaps(scene, use, uv)).
TextureTaps textureTaps(const Scene& scene, const TextureUse& use, glm::vec2 uv);

// IEC 61966-2-1, tabulated for the 256 stored values.
const std::array<float, 256>& srgbTable();

inline glm::vec4 sample(const TextureTaps& taps, const std::array<float, 256>& srgb) {
  if (taps.texel[0] == nullptr) return glm::vec4(1.0f);
  const auto texel = [&](int i) -> glm::vec4 {
    const uint8_t* p = taps.texel[i];
    if (!taps.srgb) return glm::vec4(p[0], p[1], p[2], p[3]) / 255.0f;
    return {srgb[p[0]], srgb[p[1]], srgb[p[2]], float(p[3]) / 255.0f};
  };
  const glm::vec4 top = glm::mix(texel(0), texel(1), taps.right);
  const glm::vec4 bottom = glm::mix(texel(2), texel(3), taps.right);
  return glm::mix(top, bottom, taps.lower);
}
inline glm::vec4 sample(const TextureTaps& taps) { return sample(taps, srgbTable()); }

}  // namespace fovea::scene
