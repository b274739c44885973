#include "samples/fovea/view/picture/compare.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fovea/error.h"
#include "samples/fovea/view/picture/texels.h"

namespace fovea::view {
namespace {

graph::OutputData floatImage(uint32_t width, uint32_t height) {
  graph::OutputData data;
  data.desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  data.desc.width = width;
  data.desc.height = height;
  data.bytes.resize(size_t(width) * height * 4 * sizeof(float));
  return data;
}

void setFloat(graph::OutputData& data, size_t index, float value) {
  std::memcpy(data.bytes.data() + index * sizeof value, &value, sizeof value);
}

image::Picture pictureOf(const graph::OutputData& data, float exposure) {
  const Layout layout = layoutOf(data.desc);
  const image::Image pixels = image::toRgb({layout.width, layout.height, layout.channels, numbers(data)});
  return layout.encoded ? image::fromDisplay(pixels) : image::fromRadiance(pixels, exposure);
}

constexpr double kPixelsPerDegree = 67;  // for FLIP, as in `fovea compare`

}  // namespace

bool FrameMean::canAdd(const graph::ResourceDesc& desc) {
  if (desc.kind == graph::ResourceKind::Buffer) return false;
  const Layout layout = layoutOf(desc);
  return layout.type == Layout::Type::Float && !layout.encoded && layout.channels >= 3;
}

graph::OutputData FrameMean::add(const graph::OutputData& frame) {
  const Layout layout = layoutOf(frame.desc);
  const std::vector<float> values = numbers(frame);
  if (frames_ == 0 || sums_.size() != values.size()) {
    sums_.assign(values.size(), 0);
    frames_ = 0;
  }
  ++frames_;
  graph::OutputData mean = floatImage(layout.width, layout.height);
  for (size_t i = 0; i < values.size(); ++i) {
    sums_[i] += double(values[i]);
    const size_t pixel = i / layout.channels, channel = i % layout.channels;
    setFloat(mean, 4 * pixel + channel, float(sums_[i] / frames_));
    if (layout.channels == 3) setFloat(mean, 4 * pixel + 3, 1);
  }
  return mean;
}

graph::OutputData difference(const graph::OutputData& a, const graph::OutputData& b) {
  const Layout x = layoutOf(a.desc), y = layoutOf(b.desc);
  const bool pictures =
      a.desc.kind == graph::ResourceKind::Image && b.desc.kind == graph::ResourceKind::Image;
  if (!pictures || x.width != y.width || x.height != y.height ||
      std::min(x.channels, 3u) != std::min(y.channels, 3u))
    throw Error(ExitCode::BadInput, "the two sources are no pictures of one size and kind",
                "compare the same output of both graphs");
  const std::vector<float> u = numbers(a), v = numbers(b);
  graph::OutputData out = floatImage(x.width, x.height);
  for (size_t i = 0; i < size_t(x.width) * x.height; ++i) {
    for (uint32_t c = 0; c < 3; ++c) {
      const uint32_t channel = std::min(c, std::min(x.channels, 3u) - 1);
      setFloat(out, 4 * i + c, std::abs(u[i * x.channels + channel] - v[i * y.channels + channel]));
    }
    setFloat(out, 4 * i + 3, 1);
  }
  return out;
}

image::PerRegion<image::Measures> measure(const graph::OutputData& picture,
                                          const graph::OutputData& reference, float exposure, glm::vec2 gaze,
                                          float radius) {
  (void)difference(picture, reference);  // the sizes
  const auto width = float(picture.desc.width), height = float(picture.desc.height);
  return image::compare(pictureOf(picture, exposure), pictureOf(reference, exposure), std::nullopt,
                        {gaze.x * width, gaze.y * height, radius * width}, kPixelsPerDegree);
}

}  // namespace fovea::view
