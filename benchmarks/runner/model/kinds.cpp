#include "benchmarks/runner/model/kinds.h"

#include <algorithm>

#include "fovea/error.h"

namespace fovea::bench {
namespace {

// Peaks, which nothing reaches, so that what follows from them is a bound. NVIDIA states 10 Grays/s for the RTX 2080 Ti
// (68 RT cores, 1.545 GHz), which are 0.0952 rays a cycle and core, and that each of the two generations after it
// doubled the tests of rays against triangles.
constexpr Kind kKinds[] = {
    {"headset",
     "Meta Quest 3 with Snapdragon XR2 Gen 2",
     {67.2e9, 3.0e12, 1.3e9},
     {"LPDDR5X-8400, 64 bits, of the Snapdragon 8 Gen 2, on which it is based",
      "up to 2.5 times the XR2 Gen 1, as Qualcomm states, whose Adreno 650 is reported to have 1.2 TFLOP/s",
      "not published; assumed to be the 1.3 Grays/s that Imagination stated for its mobile IMG CXT"}},
    {"laptop",
     "NVIDIA GeForce RTX 4060 Laptop GPU",
     {256e9, 14.6e12, 21.7e9},
     {"GDDR6 at 16 Gbit/s, 128 bits", "3072 cores x 2 x 2.37 GHz",
      "derived from NVIDIA's 10 Grays/s for the RTX 2080 Ti: 24 RT cores x 2.37 GHz x 0.0952 x 4"}},
    {"desktop",
     "NVIDIA GeForce RTX 4090",
     {1008e9, 82.6e12, 123e9},
     {"GDDR6X at 21 Gbit/s, 384 bits", "16384 cores x 2 x 2.52 GHz",
      "derived from NVIDIA's 10 Grays/s for the RTX 2080 Ti: 128 RT cores x 2.52 GHz x 0.0952 x 4"}},
    {"cpu",
     "AMD Ryzen 9 7950X",
     {83.2e9, 2.9e12, 1e9},
     {"DDR5-5200, 2 channels", "16 cores x 2 units of 8 lanes x 2 x 5.7 GHz", "assumed"}},
};

}  // namespace

std::span<const Kind> kinds() { return kKinds; }

const Kind& kindNamed(const std::string& name) {
  const auto* found = std::ranges::find_if(kKinds, [&](const Kind& kind) { return kind.name == name; });
  if (found != std::end(kKinds)) return *found;
  std::string names;
  for (const Kind& kind : kKinds) names += (names.empty() ? "" : ", ") + std::string(kind.name);
  throw Error(ExitCode::Usage, "--kind `" + name + "` is no kind of device",
              "use one of " + names + ", or give --bandwidth, --flops and --ray-rate");
}

}  // namespace fovea::bench
