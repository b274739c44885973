#include "framework/scene/device/texture_pages.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "fovea/error.h"

namespace fovea::scene {

namespace {

constexpr uint32_t kFewPages = 4;      // larger pages waste more at their ends, many pages more in all
constexpr uint32_t kLargePage = 8192;  // texels; 256 MiB of RGBA8

TexturePages packInto(const std::vector<glm::uvec2>& sizes, const std::vector<uint32_t>& order,
                      uint32_t side) {
  struct Shelf {
    uint32_t page, y, height, used;
  };
  TexturePages result{side, 0, std::vector<TexturePages::Place>(sizes.size())};
  std::vector<Shelf> shelves;
  std::vector<uint32_t> filled;  // height of each page that shelves occupy
  for (uint32_t i : order) {
    const glm::uvec2 size = sizes[i];
    auto shelf = std::find_if(shelves.begin(), shelves.end(),
                              [&](const Shelf& s) { return s.height >= size.y && side - s.used >= size.x; });
    if (shelf == shelves.end()) {
      const auto page =
          std::find_if(filled.begin(), filled.end(), [&](uint32_t f) { return side - f >= size.y; });
      const uint32_t index = uint32_t(page - filled.begin());
      if (page == filled.end()) filled.push_back(0);
      shelf = shelves.insert(shelves.end(), {index, filled[index], size.y, 0});
      filled[index] += size.y;
    }
    result.places[i] = {shelf->page, shelf->used, shelf->y};
    shelf->used += size.x;
  }
  result.pages = std::max<uint32_t>(1, uint32_t(filled.size()));
  return result;
}

}  // namespace

TexturePages packTextures(const std::vector<glm::uvec2>& sizes, uint32_t maxSide) {
  uint32_t largest = 1;
  for (const glm::uvec2& size : sizes) {
    if (size.x < 1 || size.y < 1 || size.x > maxSide || size.y > maxSide)
      throw Error(ExitCode::BadInput,
                  "a texture of " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                      " texels is not within 1x1 and this device's " + std::to_string(maxSide) + "x" +
                      std::to_string(maxSide),
                  "scale the texture down");
    largest = std::max({largest, size.x, size.y});
  }
  std::vector<uint32_t> order(sizes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return sizes[a].y != sizes[b].y ? sizes[a].y > sizes[b].y : sizes[a].x > sizes[b].x;
  });
  uint32_t side = std::min(std::bit_ceil(largest), maxSide);
  TexturePages pages = packInto(sizes, order, side);
  while (pages.pages > kFewPages && side * 2 <= std::min(maxSide, kLargePage))
    pages = packInto(sizes, order, side *= 2);
  return pages;
}

}  // namespace fovea::scene
