// What both exporters write: names that any file system takes, whole files, textures. Private to
// framework/scene.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fovea/image.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// Letters, digits, `-` and `_` of `name`, everything else as `_`; never empty. Safe as a URI, too.
std::string safeFileName(const std::string& name);

// "name", "name 2", "name 3": names under which a reader can find each thing again.
class UniqueNames {
 public:
  explicit UniqueNames(std::string separator = " ") : separator_(std::move(separator)) {}
  std::string add(const std::string& name);

 private:
  std::string separator_;
  std::map<std::string, uint32_t> seen_;
};

// The double with the fewest digits that is this float again: what JSON should say, 0.42 and not
// 0.41999998688697815.
double shortest(float value);

// Makes the folder where it is missing. Throws Error(CannotWrite).
void makeFolder(const std::filesystem::path& folder);

// Under a temporary name first. Throws Error(CannotWrite) naming file and reason.
void writeWholeFile(const std::filesystem::path& file, const std::string& bytes);

// 8-bit texels as an image of 3 or 4 channels; they come back bit for bit from a PNG.
image::Image texelImage(const Texture& texture, uint32_t channels);

}  // namespace fovea::scene
