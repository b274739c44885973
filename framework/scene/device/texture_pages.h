// Packing of many textures into the equal pages of one array image: no descriptor indexing needed.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace fovea::scene {

struct TexturePages {
  struct Place {
    uint32_t page = 0, x = 0, y = 0;  // texels, top-left corner
  };
  uint32_t side = 1;          // of the square pages, texels
  uint32_t pages = 1;         // at least one
  std::vector<Place> places;  // one a texture
};

// Shelf packing, tallest textures first; no margins, since shaders wrap by themselves. The side is a power of two (or maxSide),
// grown while few textures fit a page. Sizes must be within 1..maxSide (Error(BadInput) otherwise).
TexturePages packTextures(const std::vector<glm::uvec2>& sizes, uint32_t maxSide);

}  // namespace fovea::scene
