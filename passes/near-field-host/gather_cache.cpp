#include "passes/near-field-host/gather_cache.h"

#include <algorithm>
#include <cmath>

namespace fovea::passes {

uint64_t GatherCache::cellOf(glm::vec3 position, glm::vec3 normal, glm::vec3 jitter, float width) {
  const glm::vec3 size = glm::abs(normal);
  const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
  const int side = 2 * axis + (normal[axis] < 0 ? 1 : 0);
  const int level = width > 0 ? std::clamp(int(std::floor(std::log2(width))), -30, 30) : 0;
  const glm::vec3 place = glm::floor(position * std::ldexp(1.0f, -level) + jitter);
  const auto coordinate = [](float x) { return uint64_t(int64_t(std::clamp(x, -5e5f, 5e5f)) + 524288); };
  // 20 bits for each coordinate and 3 for the side. Cells of
  // different widths must not be mistaken for each other.
  const uint64_t cell =
      coordinate(place.x) | coordinate(place.y) << 20 | coordinate(place.z) << 40 | uint64_t(side) << 60;
  return cell ^ uint64_t(level + 64) * 0x9e3779b97f4a7c15u;
}

size_t GatherCache::placeOf(uint64_t cell) const {
  constexpr size_t kTried = 8;
  const size_t first = (cell * 0x9e3779b97f4a7c15u) >> 40;
  size_t poorest = first % kCells;
  for (size_t i = 0; i < kTried; ++i) {
    const size_t place = (first + i) % kCells;
    if (cells_[place].number == cell && cells_[place].weight > 0) return place;
    if (cells_[place].weight < cells_[poorest].weight) poorest = place;
  }
  return poorest;
}

std::optional<glm::vec3> GatherCache::find(uint64_t cell) const {
  const Cell& found = cells_[placeOf(cell)];
  if (found.number != cell || found.weight < kEnough) return std::nullopt;
  return found.sum / found.weight;
}

void GatherCache::age(float ageing) {
  if (!(ageing > 0)) return;
  for (Cell& cell : cells_) {
    const float kept = 1 / (1 + cell.weight * ageing);
    cell.sum *= kept;
    cell.weight *= kept;
  }
}

void GatherCache::add(std::span<const Sample> samples) {
  for (const Sample& sample : samples) {
    Cell& cell = cells_[placeOf(sample.cell)];
    if (cell.number != sample.cell) cell = {sample.cell};
    const float kept = std::min(1.0f, (kMost - 1) / std::max(cell.weight, 1.0f));
    cell.sum = cell.sum * kept + sample.light;
    cell.weight = cell.weight * kept + 1;
  }
}

}  // namespace fovea::passes
