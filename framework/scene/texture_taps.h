// A texture look-up in two steps, so that what many of them need of the memory can be asked for before it is
// needed.
#pragma once

#include <cstdint>

#include "framework/scene/scene.h"

namespace fovea::scene {

// Where a look-up finds its four texels: columns left and right, rows upper and lower, and the weights of the
// right and the lower ones. LOD 0, bilinear, texel centres at half-integers.
struct TexelSquare {
  uint32_t column[2] = {}, row[2] = {};
  float right = 0, lower = 0;
};
// width, height: of use's texture, at least 1.
TexelSquare texelSquare(uint32_t width, uint32_t height, const TextureUse& use, glm::vec2 uv);

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
glm::vec4 sample(const TextureTaps& taps);

}  // namespace fovea::scene
