#include <algorithm>
#include <cmath>

#include "framework/base/diagnostic.h"
#include "framework/image/image.h"

namespace fovea::image {

float srgbEncode(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

float srgbDecode(float encoded) {
  const float x = std::clamp(encoded, 0.0f, 1.0f);
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

double meanSquaredError(const Image& a, const Image& b) {
  const auto size = [](const Image& i) {
    return std::to_string(i.width) + "x" + std::to_string(i.height) + " with " + std::to_string(i.channels) + " channels";
  };
  const uint32_t channels = std::min(a.channels, 3u);
  if (a.width != b.width || a.height != b.height || channels != std::min(b.channels, 3u))
    throw Error(ExitCode::BadInput, "images of different size cannot be compared: " + size(a) + " and " + size(b));
  const size_t count = size_t(a.width) * a.height;
  if (count == 0 || channels == 0) throw Error(ExitCode::BadInput, "empty images cannot be compared");
  double sum = 0;
  for (size_t i = 0; i < count; ++i) {
    for (uint32_t c = 0; c < channels; ++c) {
      const double difference = double(a.data[i * a.channels + c]) - b.data[i * b.channels + c];
      if (!std::isfinite(difference))
        throw Error(ExitCode::BadInput, "images with NaN or infinity cannot be compared: pixel " +
                                            std::to_string(i % a.width) + ", " + std::to_string(i / a.width));
      sum += difference * difference;
    }
  }
  return sum / (double(count) * channels);
}

}  // namespace fovea::image
