#include "framework/image/error_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <string_view>

#include "fovea/error.h"
#include "framework/image/overlay.h"

namespace fovea::image {
namespace {

// Three by five dots per character; rows run from top to bottom, three bits each.
struct Glyph {
  char character;
  uint16_t dots;
};
constexpr Glyph kGlyphs[] = {{'0', 075557}, {'1', 026227}, {'2', 071747}, {'3', 071717}, {'4', 055711},
                             {'5', 074717}, {'6', 074757}, {'7', 071111}, {'8', 075757}, {'9', 075717},
                             {'.', 000002}, {'e', 007547}, {'-', 000700}, {'+', 002720}};
constexpr uint32_t kGlyphWidth = 4, kGlyphHeight = 5;  // including the gap behind it
constexpr uint32_t kLegendWidth = 64;                  // narrower images have no legend
constexpr float kPaper = 0.12f, kInk = 0.9f;

void setPixel(Image& picture, uint32_t x, uint32_t y, const Color& color) {
  for (uint32_t c = 0; c < 3; ++c) picture.at(x, y, c) = float(color[c]);
}

uint32_t textWidth(std::string_view text, uint32_t scale) {
  return uint32_t(text.size()) * kGlyphWidth * scale - scale;
}

void drawText(Image& picture, std::string_view text, uint32_t left, uint32_t top, uint32_t scale) {
  for (size_t i = 0; i < text.size(); ++i)
    for (const Glyph& glyph : kGlyphs)
      if (glyph.character == text[i])
        for (uint32_t dot = 0; dot < 15; ++dot)
          if (glyph.dots >> (14 - dot) & 1)
            for (uint32_t k = 0; k < scale * scale; ++k)
              setPixel(picture, left + (uint32_t(i) * kGlyphWidth + dot % 3) * scale + k % scale,
                       top + dot / 3 * scale + k / scale, {kInk, kInk, kInk});
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

// Draws the scale and its numbers from row `top` on.
void drawLegend(Image& picture, uint32_t top, uint32_t scale, double greatest) {
  const uint32_t margin = 2 * scale, bar = 4 * scale, length = picture.width - 2 * margin;
  for (uint32_t y = top; y < picture.height; ++y)
    for (uint32_t x = 0; x < picture.width; ++x) setPixel(picture, x, y, {kPaper, kPaper, kPaper});
  for (uint32_t y = 0; y < bar; ++y)
    for (uint32_t x = 0; x < length; ++x)
      setPixel(picture, margin + x, top + margin + y, mapColor((x + 0.5) / length));
  const std::string numbers[] = {"0", number(greatest / 2), number(greatest)};
  for (uint32_t i = 0; i < 3; ++i)
    drawText(picture, numbers[i], margin + (length - textWidth(numbers[i], scale)) * i / 2,
             top + 2 * margin + bar, scale);
}

}  // namespace

// Follows a path through CIELAB: lightness grows evenly while the hue turns from violet to yellow.
Color mapColor(double value) {
  const double t = std::isnan(value) ? 0 : std::clamp(value, 0.0, 1.0);
  const double lightness = 4 + 92 * t, hue = (290 + 170 * t) * std::numbers::pi / 180,
               chroma = 60 * std::pow(4 * t * (1 - t), 0.7) + 15 * t;
  Color color = linearFromXyz(xyzFromLab({lightness, chroma * std::cos(hue), chroma * std::sin(hue)}));
  for (double& c : color) c = srgbEncode(float(c));
  return color;
}

std::vector<float> pixelErrors(const Picture& picture, const Picture& reference) {
  checkComparable(picture.display, "the picture", reference.display, "the reference");
  std::vector<float> errors(size_t(reference.display.width) * reference.display.height);
  for (size_t i = 0; i < errors.size(); ++i) {
    double sum = 0;
    for (size_t c = 0; c < 3; ++c) {
      const double d = double(picture.display.data[3 * i + c]) - reference.display.data[3 * i + c];
      sum += d * d;
    }
    errors[i] = float(std::sqrt(sum / 3));
  }
  return errors;
}

Image errorPicture(const std::vector<float>& values, uint32_t width, double greatest, const Disc* fovea) {
  if (!(greatest > 0 && std::isfinite(greatest)))
    throw Error(ExitCode::BadInput, "the scale of an error picture ends above 0", "e.g. at 0.1");
  const uint32_t height = uint32_t(values.size() / width), scale = std::max(1u, width / 256);
  const uint32_t legend = width < kLegendWidth ? 0 : (4 + 3 * 2 + kGlyphHeight) * scale;
  Image picture{width, height, 3, std::vector<float>(size_t(width) * height * 3)};
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      setPixel(picture, x, y, mapColor(values[size_t(y) * width + x] / greatest));
  if (fovea) drawFovea(picture, *fovea);
  picture.height += legend;
  picture.data.resize(size_t(width) * picture.height * 3);
  if (legend > 0) drawLegend(picture, height, scale, greatest);
  return picture;
}

}  // namespace fovea::image
