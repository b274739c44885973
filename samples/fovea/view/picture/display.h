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
  enum class Map : uint8_t {
    Automatic,  // signed for single numbers of which any lies below 0, plain for everything else
    Plain,      // colours as they are, and grey
    Helix,      // dark to light with changing hue
    Signed,     // blue below 0, white at 0, red above, to the larger of |low| and |high|
  };
  float scale = 1, low = 0, high = 1;
  Channel channel = Channel::Color;
  Curve curve = Curve::Automatic;
  Map map = Map::Automatic;
  bool fit = false;    // data and false colours: low and high are the least and largest value of the picture
  bool marks = true;   // NaN magenta, +infinity cyan, -infinity orange
  uint32_t width = 0;  // makes pictures smaller that are wider than this; 0 for none
  int quality = 92;    // of the JPEG, 1 to 100
  bool exact = false;  // pixels as they are instead of a JPEG
};
// Reads "exposure=1.5&channel=red&map=helix&low=0&high=4&width=200"; exposure is in stops. What is absent or wrong
// stays as above.
Display parseDisplay(std::string_view query);

// Rows from top to bottom, RGB.
struct Pixels {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb;
  Display::Map map = Display::Map::Plain;  // that was used
  float low = 0, high = 1;                 // shown as the ends of its colours
};
Pixels draw(const graph::OutputData& data, const Display& display);

// Throws Error(Internal) if the library fails.
std::string jpeg(const Pixels& pixels, int quality);

}  // namespace fovea::view
