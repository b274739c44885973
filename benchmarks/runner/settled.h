// When the times of a job can be trusted.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace fovea::bench {

// Whether the measured frames, the last ones, stand for what a frame takes: the median of their times is at most 1.5 times
// the fastest of them and of the two frames before. Frames in which the driver compiled a shader, or the machine was busy,
// do not, nor do fewer than three frames in all. `ms`: the times of all frames, the warm-up included.
inline bool settled(std::span<const double> ms, size_t measured) {
  constexpr size_t kBefore = 2;
  constexpr double kMost = 1.5;
  if (ms.size() < 1 + kBefore) return false;
  std::vector<double> own(ms.end() - ptrdiff_t(measured), ms.end());
  const size_t compared = std::min(ms.size(), measured + kBefore);
  const auto middle = own.begin() + ptrdiff_t(own.size() / 2);
  std::nth_element(own.begin(), middle, own.end());
  return *middle <= kMost * *std::min_element(ms.end() - ptrdiff_t(compared), ms.end());
}

}  // namespace fovea::bench
