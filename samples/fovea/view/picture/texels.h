// The numbers in a resource that was read back, and their statistics.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fovea/graph.h"

namespace fovea::view {

// Where and how the components of a picture lie in memory. A buffer is a picture that is one element high as well: its
// words are the channels, its elements the columns.
struct Layout {
  enum class Type : uint8_t { Float, Unsigned, Signed };
  Type type = Type::Float;  // after conversion to 32 bits
  uint32_t width = 0, height = 0, channels = 0;
  bool encoded = false;  // values are meant for a display as they are (8-bit images)
};
Layout layoutOf(const graph::ResourceDesc& desc);

// Part of a picture, in pixels from its upper left corner.
struct Region {
  uint32_t x = 0, y = 0, width = 0, height = 0;
};
Region wholeOf(const Layout& layout);

// Pixel after pixel, a 32-bit word per channel: floats bit for bit, wider than 32 bits cut off. Half floats and
// normalised integers become floats, whole numbers stay whole. The region must lie inside of the picture.
std::vector<uint32_t> words(const graph::OutputData& data, const Region& region);
// The same as numbers to draw: whole numbers are converted.
std::vector<float> numbers(const graph::OutputData& data, const Region& region);
std::vector<float> numbers(const graph::OutputData& data);

// Of one channel. The histogram covers [min, max] in equal parts and counts finite values.
struct ChannelStatistics {
  float min = 0, max = 0;
  double mean = 0;
  uint64_t finite = 0, nan = 0, infinite = 0;
  std::array<uint64_t, 64> histogram{};
};
std::vector<ChannelStatistics> statistics(const graph::OutputData& data, const Region& region);

}  // namespace fovea::view
