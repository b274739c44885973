// Reads a picture and its reference from files and prepares them for the error measures.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "framework/image/eyes.h"
#include "framework/image/metrics.h"

namespace fovea::session {

inline constexpr double kMaxRadius = 4;  // of a fovea, image widths; the same limit as in the passes

struct CompareOptions {
  std::string layer, gaze;  // if empty, taken from the files
  std::optional<float> radius, exposure;
  bool json = false;
};

struct Compared {
  image::Picture image, reference;
  std::optional<image::Halves> halves;  // of the reference
  std::optional<image::Picture>
      perfectIndirect;  // direct light of the picture, indirect light of the reference
  image::Disc fovea;
  image::Window display, window;  // of the whole picture, and of what is compared of it
  // How the files were read; `layer` is empty for pictures without layers.
  std::string layer;
  float exposure = 1, radius = 0;  // radius: image widths
  glm::vec2 gaze{0};
};

// Floating-point files (EXR, PFM, HDR) hold radiance, others display values. Pictures with different data windows are
// compared where both have displayed pixels, which a warning tells; their display windows must be the same. Layer,
// exposure, gaze and radius come from the options, else from the metadata of the picture, else from those of the
// reference; the defaults are `radiance` (or the only layer), 1, the middle and kFoveaRadius. `halves` names two files
// or none; without them the layers `half_a` and `half_b` of the reference are used if they exist. Throws
// Error(BadInput) on missing layers, different sizes, channels that are no colours, NaN or infinity, contradicting
// exposures and unreadable metadata, and Error(Usage) on invalid options.
Compared loadCompared(const std::string& image, const std::string& reference,
                      const std::vector<std::string>& halves, const CompareOptions& options);

// The same for pictures in memory, all of whose layers hold radiance; the names appear in messages.
Compared compareRadiance(const std::string& imageName, image::File image, const std::string& referenceName,
                         image::File reference, const CompareOptions& options);

// Both eyes of a stereo picture. `left` also tells how the files were read.
struct ComparedEyes {
  Compared left, right;
  image::Image correspondence;  // see image::EyesComparison
  void addTo(image::EyesComparison& comparison) const;
};

// The layer of the options (or `radiance`) is that of the left eye; that of the right one has the suffix `_right`, and
// so have its halves in the reference. The layer `correspondence` comes from the picture, or else from the reference.
// Throws as loadCompared() does, and Error(BadInput) if one of these layers is missing or a file holds only a part of
// its picture.
ComparedEyes loadComparedEyes(const std::string& image, const std::string& reference,
                              const CompareOptions& options);
ComparedEyes compareEyes(const std::string& imageName, image::File image, const std::string& referenceName,
                         image::File reference, const CompareOptions& options);

// Describes how the pictures were compared and gives the measures, for both commands; a measure that is not
// known is null.
nlohmann::ordered_json describe(const Compared& compared);
std::string describeInWords(const Compared& compared);
std::string formatMeasure(double value);  // "0.00123", or "-" if it is not known

}  // namespace fovea::session
