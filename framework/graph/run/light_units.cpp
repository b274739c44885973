#include "framework/graph/run/light_units.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
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

// Calls `visit` with the rgb of each texel.
void forEachColor(std::vector<float>& values, VkFormat format, const auto& visit) {
  const uint32_t channels = gpu::formatInfo(format).channels;
  for (size_t texel = 0; texel < values.size(); texel += channels)
    visit(std::span<float>(&values[texel], std::min(channels, 3u)));
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
  const float unit = std::pow(preExposure, -float(desc.light));
  // Devices store what is too bright as the greatest number or as infinity.
  const float greatest = isHalf(desc.format) ? kGreatestHalf : std::numeric_limits<float>::max();
  forEachColor(values, desc.format, [&](std::span<float> color) {
    data.beyondRange += !std::ranges::all_of(color, [&](float v) { return v < greatest; });
    for (float& v : color) v *= unit;
  });
  data.desc.light = 0;
  data.desc.format = gpu::floatFormat(gpu::formatInfo(desc.format).channels);
  const auto bytes = std::as_bytes(std::span(values));
  data.bytes.assign(bytes.begin(), bytes.end());
  return data;
}

uint64_t givenBytes(const ResourceDesc& desc) {
  return resourceBytes(desc) * (desc.light > 0 && isHalf(desc.format) ? 2 : 1);
}

std::vector<std::byte> inStoredUnits(const ResourceDesc& desc, std::span<const std::byte> given,
                                     float preExposure) {
  std::vector<float> values =
      gpu::texelsToFloats(gpu::floatFormat(gpu::formatInfo(desc.format).channels), given);
  const float unit = std::pow(preExposure, float(desc.light));
  forEachColor(values, desc.format, [&](std::span<float> color) {
    for (float& v : color) v *= unit;
  });
  if (isHalf(desc.format))
    for (float& v : values) v = std::clamp(v, -kGreatestHalf, kGreatestHalf);
  return gpu::floatsToTexels(desc.format, values);
}

}  // namespace fovea::graph
