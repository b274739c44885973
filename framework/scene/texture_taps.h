// A texture look-up in two steps, so that memory can be prefetched for many look-ups before it is needed. The
// functions are inline because path tracing performs millions of look-ups a second.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "framework/scene/scene.h"

namespace fovea::scene {

// The four texels of a look-up: left and right column, upper and lower row, and the weights of the right column and
// the lower row. LOD 0, texel centres at half-integers; bilinear, unless TextureUse::nearest, where the weights are 0.
struct TexelSquare {
  uint32_t column[2] = {}, row[2] = {};
  float right = 0, lower = 0;
};

// |i| must be at most 1e9 + 1 and size at most 2^29.
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

// width, height: size of the texture of `use`, each at least 1.
inline TexelSquare texelSquare(uint32_t width, uint32_t height, const TextureUse& use, glm::vec2 uv) {
  // Coordinates beyond these are far past the precision of a float; they must not overflow the conversion
  // to an integer.
  const auto tame = [](float texels) {
    return std::isfinite(texels) ? std::min(std::max(texels, -1e9f), 1e9f) : 0.0f;
  };
  const glm::vec2 p = use.transform * glm::vec3(uv, 1.0f);
  const float middle = use.nearest ? 0.0f : 0.5f;
  const float u = tame(p.x * float(width) - middle), v = tame(p.y * float(height) - middle);
  const auto floored = [](float f) { return int32_t(f) - int32_t(float(int32_t(f)) > f); };
  const int32_t x = floored(u), y = floored(v);
  TexelSquare s;
  for (int i = 0; i < 2; ++i) {
    s.column[i] = wrapTexel(x + i, int32_t(width), use.wrapU);
    s.row[i] = wrapTexel(y + i, int32_t(height), use.wrapV);
  }
  if (use.nearest) return s;
  s.right = u - float(x);
  s.lower = v - float(y);
  return s;
}

// The four texels around a point and the weights of the right column and the lower row. Valid for as long as
// the texture exists.
struct TextureTaps {
  // RGBA of the upper left, upper right, lower left and lower right texel; null if there is no texture, which
  // reads as white.
  const uint8_t* texel[4] = {};
  float right = 0, lower = 0;
  bool srgb = true;
  void prefetch() const {
    for (const uint8_t* t : texel) __builtin_prefetch(t);
  }
};

// sampleTexture(scene, use, uv) is sample(textureTaps(scene, use, uv)).
TextureTaps textureTaps(const Scene& scene, const TextureUse& use, glm::vec2 uv);

// The sRGB decoding of IEC 61966-2-1, tabulated for the 256 stored values.
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
