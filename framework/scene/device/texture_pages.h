// Packs many textures into equally sized pages of one array image, so that no descriptor indexing is needed.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace fovea::scene {

struct TexturePages {
  struct Place {
    uint32_t page = 0, x = 0, y = 0;  // texels, top-left corner
  };
  uint32_t side = 1;          // side of the square pages, texels
  uint32_t pages = 1;         // at least one
  std::vector<Place> places;  // one per texture
};

// Packs on shelves, tallest textures first, without margins, since shaders wrap coordinates themselves. The side is
// a power of two (or maxSide), which grows while few textures fit on a page. Throws Error(BadInput) if a size is
// not within 1..maxSide.
TexturePages packTextures(const std::vector<glm::uvec2>& sizes, uint32_t maxSide);

}  // namespace fovea::scene
