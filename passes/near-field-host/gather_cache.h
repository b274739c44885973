// A cache of the light that is gathered at surfaces, in cells of space: path space filtering with a hash table (Binder
// et al., "Massively parallel path space filtering", 2019). One gathered ray is a poor estimate, and an outlier makes a
// spot that stays for many frames; the mean over a cell is close to the truth, as light from a second reflection varies
// little over a small piece of surface.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "shaders/records/gather_cache.h"

namespace fovea::passes {

class GatherCache {
 public:
  GatherCache() : cells_(kCells) {}
  // What was gathered at one point.
  struct Sample {
    uint64_t cell = 0;
    glm::vec3 light{0};  // mean radiance over the hemisphere, W/(sr m^2)
  };

  // The cell of a point on a surface. Cells are about `width` metres wide; that is rounded to a power of two, so that
  // small changes keep the cells. jitter: in [-0.5, 0.5) for each axis, by which the point is moved in widths of a cell,
  // so that the borders of cells do not show. Sides that face different ways have different cells.
  static uint64_t cellOf(glm::vec3 position, glm::vec3 normal, glm::vec3 jitter, float width);
  // The mean of a cell, if it has enough samples. Threads may call it at the same time.
  std::optional<glm::vec3> find(uint64_t cell) const;
  // Adds the samples in their order, so the same samples always give the same cache. Old samples fade, at least half
  // of the weight belonging to the last `kMost`.
  void add(std::span<const Sample> samples);
  // Lets what is there count less, as light has changed: n samples as n / (1 + n ageing), while their mean stays.
  void age(float ageing);
  void clear() { cells_.assign(kCells, {}); }

  static constexpr float kEnough = scene::kEnoughGathered, kMost = scene::kMostGathered;  // samples in a cell
  static constexpr size_t kCells = 1 << 17;  // in the cache; if they do not suffice, the poorest are replaced

 private:
  struct Cell {
    uint64_t number = 0;
    glm::vec3 sum{0};
    float weight = 0;  // 0 if there is no cell in this place
  };
  // Where a cell is, or where it would be put.
  size_t placeOf(uint64_t cell) const;

  std::vector<Cell> cells_;
};

}  // namespace fovea::passes
