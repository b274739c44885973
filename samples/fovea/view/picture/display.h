// Turns a resource that was read back into a picture for a page.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/graph.h"

namespace fovea::view {

// How a page wants to see a source. A value v is shown as (scale v - low) / (high - low).
struct Display {
  enum class Channel : uint8_t { Color, Red, Green, Blue, Alpha, Luminance };
  enum class Curve : uint8_t {
    Automatic,  // sRGB for colours with floating point, linear for everything else
    Srgb,
    Linear,
  };
  float scale = 1, low = 0, high = 1;
  Channel channel = Channel::Color;
  Curve curve = Curve::Automatic;
  bool fit = false;  // data and false colours: low and high are the least and largest value of the picture
  bool falseColor = false;  // dark to light with changing hue
  bool marks = true;        // NaN magenta, +infinity cyan, -infinity orange
  uint32_t width = 0;       // makes pictures smaller that are wider than this; 0 for none
  int quality = 92;         // of the JPEG, 1 to 100
};
// Reads "exposure=1.5&channel=red&false_color=1&low=0&high=4&width=200"; exposure is in stops. What is absent or wrong
// stays as above.
Display parseDisplay(std::string_view query);

// Rows from top to bottom, RGB.
struct Pixels {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb;
};
Pixels draw(const graph::OutputData& data, const Display& display);

// Throws Error(Internal) if the library fails.
std::string jpeg(const Pixels& pixels, int quality);

}  // namespace fovea::view
