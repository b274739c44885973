// A picture and its reference as files, made ready for the error measures.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "framework/image/metrics.h"

namespace fovea::bench {

inline constexpr double kMaxRadius = 4;  // of a fovea, image widths: as the passes have it

// How to compare.
struct CompareOptions {
  std::string layer, gaze;  // empty: the files decide
  std::optional<float> radius, exposure;
  bool json = false;
};

struct Compared {
  image::Picture image, reference;
  std::optional<image::Halves> halves;  // of the reference
  std::optional<image::Picture>
      perfectIndirect;  // the picture's direct light and the reference's indirect light
  image::Disc fovea;
  glm::uvec2 size{0};
  // How they were read: "" of pictures without layers.
  std::string layer;
  float exposure = 1, radius = 0;  // radius: image widths
  glm::vec2 gaze{0};
};

// Floating-point files (EXR, PFM) hold radiance, others what a screen shows. Layer, exposure, gaze and radius
// come from the options, else from the picture's metadata, else from the reference's, else they are
// `radiance` (or the only layer), 1, the middle and kFoveaRadius. Halves: two files, or none, and then the
// layers `half_a` and `half_b` of the reference where they are. Throws Error(BadInput) on missing layers,
// other sizes, NaN and infinity, exposures that contradict each other and metadata that cannot be read;
// Error(Usage) on bad options.
Compared loadCompared(const std::string& image, const std::string& reference,
                      const std::vector<std::string>& halves, const CompareOptions& options);

// The same of pictures in memory, all of whose layers hold radiance; the names are for messages.
Compared compareRadiance(const std::string& imageName, image::File image, const std::string& referenceName,
                         image::File reference, const CompareOptions& options);

// What both commands say of how they compared, and their numbers: null where they are not known.
nlohmann::ordered_json describe(const Compared& compared);
std::string describeInWords(const Compared& compared);
std::string formatMeasure(double value);  // "0.00123", "-" where it is not known

}  // namespace fovea::bench
