#include "framework/graph/run/light_units.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "framework/gpu/format.h"
#include "framework/graph/run/execute_state.h"

namespace fovea::graph {

namespace {

constexpr float kGreatestHalf = 65504;

bool isHalf(VkFormat format) {
  const gpu::FormatInfo& info = gpu::formatInfo(format);
  return info.bytesPerTexel / info.channels == sizeof(uint16_t);
}

std::vector<std::byte> bytesOf(const auto& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return {bytes.begin(), bytes.end()};
}

// Multiplies the rgb of texels by `unit`, and counts those that `counts` is true for beforehand.
uint64_t scale(std::vector<float>& values, uint32_t channels, float unit, const auto& counts) {
  uint64_t counted = 0;
  for (size_t texel = 0; texel < values.size(); texel += channels) {
    const std::span<float> light(&values[texel], std::min(channels, 3u));
    counted += std::ranges::any_of(light, counts);
    for (float& v : light) v *= unit;
  }
  return counted;
}

}  // namespace

OutputData inSceneUnits(const ResourceDesc& desc, std::span<const std::byte> texels, float preExposure) {
  OutputData data;
  data.desc = desc;
  if (desc.light == 0) {
    data.bytes.assign(texels.begin(), texels.end());
    return data;
  }
  std::vector<float> values = gpu::texelsToFloats(desc.format, texels);
  const uint32_t channels = gpu::formatInfo(desc.format).channels;
  // Devices store what is too bright as the greatest number or as infinity.
  const float greatest = isHalf(desc.format) ? kGreatestHalf : std::numeric_limits<float>::max();
  data.beyondRange = scale(values, channels, std::pow(preExposure, -float(desc.light)),
                           [&](float v) { return !(v < greatest); });
  data.desc.light = 0;
  data.desc.format = gpu::floatFormat(channels);
  data.bytes = bytesOf(values);
  return data;
}

uint64_t givenBytes(const ResourceDesc& desc) {
  return resourceBytes(desc) * (desc.light > 0 && isHalf(desc.format) ? 2 : 1);
}

std::vector<std::byte> inStoredUnits(const ResourceDesc& desc, std::span<const std::byte> given,
                                     float preExposure) {
  std::vector<float> values(given.size() / sizeof(float));
  std::memcpy(values.data(), given.data(), values.size() * sizeof(float));
  scale(values, gpu::formatInfo(desc.format).channels, std::pow(preExposure, float(desc.light)),
        [](float) { return false; });
  if (!isHalf(desc.format)) return bytesOf(values);
  std::vector<uint16_t> halves(values.size());
  std::ranges::transform(values, halves.begin(), [](float v) {
    return glm::packHalf1x16(std::clamp(v, -kGreatestHalf, kGreatestHalf));
  });
  return bytesOf(halves);
}

}  // namespace fovea::graph
