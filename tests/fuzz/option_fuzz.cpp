// Values of options: any text is a number within the range, which another reader of numbers finds as well, or is
// refused.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "fovea/error.h"
#include "framework/base/number.h"
#include "framework/session/inputs.h"

namespace {

using namespace fovea;  // NOLINT: what is under test

template <class Parse>
void parseOrRefuse(const Parse& parse) {
  try {
    parse();
  } catch (const Error& e) {
    if (e.code() != ExitCode::Usage) std::abort();
  }
}

bool isWithin(float value, float low, float high) { return value >= low && value <= high; }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto number = parseDecimal(text)) {
    char* end = nullptr;
    const double expected = std::strtod(text.c_str(), &end);
    const bool decimal = text.find_first_not_of("0123456789.eE+-") == std::string::npos;
    if (!std::isfinite(*number) || *number != expected || *end != 0 || !decimal) std::abort();
  }
  parseOrRefuse([&] {
    const glm::uvec2 s = session::parseSize(text);
    if (s.x < 1 || s.y < 1) std::abort();
  });
  parseOrRefuse([&] {
    const glm::vec2 gaze = session::parseGaze(text);
    if (!isWithin(gaze.x, 0, 1) || !isWithin(gaze.y, 0, 1)) std::abort();
  });
  parseOrRefuse([&] {
    const scene::Lens lens = session::parseLens(text);
    for (const float angle : {lens.outward, lens.inward, lens.up, lens.down})
      if (!isWithin(angle, 0.01f, 1.5f)) std::abort();
  });
  return 0;
}
