#include "samples/fovea/view/picture/display.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "fovea/error.h"
#include "fovea/image.h"
#include "samples/fovea/view/http/request.h"
#include "samples/fovea/view/picture/texels.h"

namespace fovea::view {
namespace {

using Rgb = std::array<uint8_t, 3>;
constexpr Rgb kNan{255, 0, 255}, kInfinity{0, 255, 255}, kMinusInfinity{255, 140, 0};

uint8_t to8(float v) { return uint8_t(std::lround(255.0f * std::clamp(v, 0.0f, 1.0f))); }

// Display values of linear ones from 0 to 1.
struct SrgbTable {
  static constexpr size_t kSteps = 8192;
  std::array<uint8_t, kSteps + 1> values;
  SrgbTable() {
    for (size_t i = 0; i <= kSteps; ++i) values[i] = to8(image::srgbEncode(float(i) / float(kSteps)));
  }
  uint8_t at(float v) const { return values[size_t(std::clamp(v, 0.0f, 1.0f) * float(kSteps) + 0.5f)]; }
};

// D. A. Green's cubehelix (2011): lightness rises evenly while the hue turns once and a half.
struct Helix {
  std::array<Rgb, 256> colors;
  Helix() {
    for (size_t i = 0; i < colors.size(); ++i) {
      const double l = double(i) / 255, angle = 2 * M_PI * (0.5 / 3 + 1 - 1.5 * l),
                   amplitude = 1.2 * l * (1 - l) / 2, c = std::cos(angle), s = std::sin(angle);
      colors[i] = {to8(float(l + amplitude * (-0.14861 * c + 1.78277 * s))),
                   to8(float(l + amplitude * (-0.29227 * c - 0.90649 * s))),
                   to8(float(l + amplitude * 1.97294 * c))};
    }
  }
};

// From blue over white to red for t from -1 to 1.
Rgb signedColor(float t) {
  constexpr std::array<float, 3> kBelow{0.02f, 0.19f, 0.55f}, kAbove{0.60f, 0.03f, 0.09f},
      kMiddle{0.97f, 0.97f, 0.97f};
  const auto& end = t < 0 ? kBelow : kAbove;
  const float share = std::clamp(std::abs(t), 0.0f, 1.0f);
  Rgb color;
  for (size_t c = 0; c < 3; ++c) color[c] = to8(kMiddle[c] + share * (end[c] - kMiddle[c]));
  return color;
}

bool isColor(const Layout& layout, const Display& display) {
  return layout.channels >= 3 && display.channel == Display::Channel::Color &&
         (display.map == Display::Map::Automatic || display.map == Display::Map::Plain);
}

class Painter {
 public:
  Painter(const Layout& layout, const Display& display)
      : display_(display), channels_(layout.channels), color_(isColor(layout, display)) {
    const float range = display.high - display.low;
    factor_ = (range != 0 ? 1 / range : 1) * display.scale;
    const float furthest = std::max(std::abs(display.low), std::abs(display.high));
    signedFactor_ = display.scale / (furthest > 0 ? furthest : 1);
    offset_ = -display.low * (range != 0 ? 1 / range : 1);
    srgb_ = display.curve == Display::Curve::Srgb || (display.curve == Display::Curve::Automatic && color_ &&
                                                      layout.type == Layout::Type::Float && !layout.encoded);
  }

  // The number that a grey or false colour stands for.
  static float single(const float* texel, uint32_t channels, Display::Channel channel) {
    switch (channel) {
      case Display::Channel::Red:
        return texel[0];
      case Display::Channel::Green:
        return texel[std::min(1u, channels - 1)];
      case Display::Channel::Blue:
        return texel[std::min(2u, channels - 1)];
      case Display::Channel::Alpha:
        return texel[channels - 1];
      default:
        return channels >= 3 ? 0.2126f * texel[0] + 0.7152f * texel[1] + 0.0722f * texel[2] : texel[0];
    }
  }

  void paint(const float* texel, uint8_t* out) const {
    Rgb result;
    if (color_) {
      if (const auto mark = display_.marks ? markOf(texel, 3) : std::nullopt) {
        result = *mark;
      } else {
        for (size_t c = 0; c < 3; ++c) result[c] = level(texel[c]);
      }
    } else {
      const float v = single(texel, channels_, display_.channel);
      const auto mark = display_.marks ? markOf(&v, 1) : std::nullopt;
      const uint8_t grey = level(v);
      result = mark                                   ? *mark
               : display_.map == Display::Map::Helix  ? helix().colors[to8(v * factor_ + offset_)]
               : display_.map == Display::Map::Signed ? signedColor(v * signedFactor_)
                                                      : Rgb{grey, grey, grey};
    }
    std::copy(result.begin(), result.end(), out);
  }

 private:
  static const Helix& helix() {
    static const Helix table;
    return table;
  }
  static const SrgbTable& srgb() {
    static const SrgbTable table;
    return table;
  }
  static std::optional<Rgb> markOf(const float* values, size_t count) {
    for (size_t i = 0; i < count; ++i) {
      if (std::isnan(values[i])) return kNan;
      if (std::isinf(values[i])) return values[i] > 0 ? kInfinity : kMinusInfinity;
    }
    return std::nullopt;
  }
  uint8_t level(float v) const {
    const float shown = v * factor_ + offset_;
    if (std::isnan(shown)) return 0;
    return srgb_ ? srgb().at(shown) : to8(shown);
  }
  Display display_;
  uint32_t channels_;
  bool color_;
  float factor_ = 1, offset_ = 0, signedFactor_ = 1;
  bool srgb_ = false;
};

// What the picture's own values decide, where they are no colours: the map, and the range.
Display fitted(const Display& display, const Layout& layout, const std::vector<float>& values) {
  Display found = display;
  if (isColor(layout, display)) {
    found.map = Display::Map::Plain;
    return found;
  }
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  for (size_t i = 0; i + layout.channels <= values.size(); i += layout.channels) {
    const float v = Painter::single(&values[i], layout.channels, display.channel);
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (display.map == Display::Map::Automatic)
    found.map = low < 0 ? Display::Map::Signed : Display::Map::Plain;
  if (!display.fit || (layout.channels >= 3 && found.map == Display::Map::Plain)) return found;
  found.scale = 1;
  if (low <= high) found.low = low, found.high = high > low ? high : low + 1;
  return found;
}

// Each pixel becomes the mean of those that it covers.
Pixels shrunk(const Pixels& pixels, uint32_t width) {
  Pixels small;
  small.map = pixels.map, small.low = pixels.low, small.high = pixels.high;
  small.width = width;
  small.height = std::max(1u, uint32_t(uint64_t(pixels.height) * width / pixels.width));
  small.rgb.resize(size_t(small.width) * small.height * 3);
  for (uint32_t y = 0; y < small.height; ++y) {
    const uint32_t y0 = uint32_t(uint64_t(y) * pixels.height / small.height),
                   y1 = std::max(y0 + 1, uint32_t(uint64_t(y + 1) * pixels.height / small.height));
    for (uint32_t x = 0; x < small.width; ++x) {
      const uint32_t x0 = uint32_t(uint64_t(x) * pixels.width / small.width),
                     x1 = std::max(x0 + 1, uint32_t(uint64_t(x + 1) * pixels.width / small.width));
      std::array<uint32_t, 3> sum{};
      for (uint32_t v = y0; v < y1; ++v)
        for (uint32_t u = x0; u < x1; ++u)
          for (size_t c = 0; c < 3; ++c) sum[c] += pixels.rgb[(size_t(v) * pixels.width + u) * 3 + c];
      for (size_t c = 0; c < 3; ++c)
        small.rgb[(size_t(y) * small.width + x) * 3 + c] = uint8_t(sum[c] / ((y1 - y0) * (x1 - x0)));
    }
  }
  return small;
}

Display::Channel channelOf(std::string_view name) {
  using C = Display::Channel;
  constexpr std::array<std::pair<std::string_view, C>, 5> kNames{{{"red", C::Red},
                                                                  {"green", C::Green},
                                                                  {"blue", C::Blue},
                                                                  {"alpha", C::Alpha},
                                                                  {"luminance", C::Luminance}}};
  for (const auto& [text, channel] : kNames)
    if (text == name) return channel;
  return C::Color;
}

}  // namespace

Display parseDisplay(std::string_view query) {
  Display d;
  d.scale = float(std::exp2(queryNumber(query, "exposure", -40, 40, 0)));
  d.low = float(queryNumber(query, "low", -1e30, 1e30, 0));
  d.high = float(queryNumber(query, "high", -1e30, 1e30, 1));
  d.channel = channelOf(queryValue(query, "channel").value_or(""));
  const std::string curve = queryValue(query, "curve").value_or("");
  if (curve == "srgb") d.curve = Display::Curve::Srgb;
  if (curve == "linear") d.curve = Display::Curve::Linear;
  d.fit = queryValue(query, "fit") == "1";
  const std::string map = queryValue(query, "map").value_or("");
  if (map == "plain") d.map = Display::Map::Plain;
  if (map == "helix") d.map = Display::Map::Helix;
  if (map == "signed") d.map = Display::Map::Signed;
  d.marks = queryValue(query, "marks") != "0";
  d.width = uint32_t(queryNumber(query, "width", 0, 4096, 0));
  d.quality = int(queryNumber(query, "quality", 1, 100, d.quality));
  d.exact = queryValue(query, "exact") == "1";
  return d;
}

Pixels draw(const graph::OutputData& data, const Display& display) {
  const Layout layout = layoutOf(data.desc);
  const std::vector<float> values = numbers(data);
  const Display shown = fitted(display, layout, values);
  Pixels pixels{layout.width, layout.height,           {},
                shown.map,    shown.low / shown.scale, shown.high / shown.scale};
  if (shown.map == Display::Map::Signed) {
    pixels.high = std::max(std::abs(pixels.low), std::abs(pixels.high));
    pixels.low = -pixels.high;
  }
  pixels.rgb.resize(size_t(pixels.width) * pixels.height * 3);
  const Painter painter(layout, shown);
  for (size_t i = 0; i * layout.channels < values.size(); ++i)
    painter.paint(&values[i * layout.channels], &pixels.rgb[i * 3]);
  return display.width > 0 && pixels.width > display.width ? shrunk(pixels, display.width) : pixels;
}

std::string jpeg(const Pixels& pixels, int quality) {
  const std::unique_ptr<void, int (*)(tjhandle)> compressor(tjInitCompress(), tjDestroy);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): of the library
  const bool good =
      compressor && tjCompress2(compressor.get(), pixels.rgb.data(), int(pixels.width), 0, int(pixels.height),
                                TJPF_RGB, &bytes, &size, TJSAMP_444, quality, TJFLAG_FASTDCT) == 0;
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(bytes, tjFree);
  if (!good) throw Error(ExitCode::Internal, "a picture could not be compressed");
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace fovea::view
