// The scales of a suite, such as a small one that takes an hour: the same sweeps with other sizes and amounts of work.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fovea/error.h"
#include "framework/base/json.h"

namespace fovea::bench {

struct Scale {
  static constexpr uint32_t kNoLimit = std::numeric_limits<uint32_t>::max();
  std::optional<std::string> size;     // like "128x128", of every sweep that does not vary its size
  std::optional<uint32_t> seeds, spp;  // of every sweep
  uint32_t maxFrames = kNoLimit, maxWarmup = kNoLimit;
  uint32_t maxValues = kNoLimit;    // of each list that a sweep goes through
  std::vector<std::string> scenes;  // only these of a sweep's scenes, or its first if it has none of them
};

// Reads the key `scales` of a suite, in the order of the file.
std::vector<std::pair<std::string, Scale>> readScales(json::ObjectReader& suite, Diagnostics& messages);

// Throws Error(Usage) that names the `known` scales if `scale` is not among them.
void checkScale(const std::string& scale, const std::vector<std::string>& known, const std::string& suite);

// At most `count` of the values, with equal steps in between; the first and the last are kept. `count` is at least 2.
template <class T>
std::vector<T> thinned(const std::vector<T>& values, size_t count) {
  if (values.size() <= count) return values;
  std::vector<T> kept;
  for (size_t i = 0; i < count; ++i)
    kept.push_back(values[size_t(std::lround(double(i) * double(values.size() - 1) / double(count - 1)))]);
  return kept;
}

}  // namespace fovea::bench
