// Helpers that both exporters share: names that any file system accepts, folders and textures.
// Private to framework/scene.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fovea/image.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// Keeps letters, digits, `-` and `_` of `name` and replaces everything else by `_`; never empty. The result is also
// safe in a URI.
std::string safeFileName(const std::string& name);

// Makes names unique ("name", "name 2", "name 3"), so that a reader can find each thing again.
class UniqueNames {
 public:
  explicit UniqueNames(std::string separator = " ") : separator_(std::move(separator)) {}
  std::string add(const std::string& name);

 private:
  std::string separator_;
  std::map<std::string, uint32_t> seen_;
};

// The double with the fewest digits that converts back to this float, so that JSON has 0.42
// rather than 0.41999998688697815.
double shortest(float value);

// A position in the author's coordinates, with the fewest digits where the origin of the scene is 0.
glm::dvec3 authoredPlace(const Scene& scene, const glm::vec3& position);

// Creates the folder if it is missing. Throws Error(CannotWrite).
void makeFolder(const std::filesystem::path& folder);

// Writes the texels of an environment, which its turn does not change. Throws Error(CannotWrite).
void writeEnvironment(const std::filesystem::path& file, const EnvironmentMap& map);

// Converts 8-bit texels to an image of 3 or 4 channels; a PNG of it gives them back bit for bit.
image::Image texelImage(const Texture& texture, uint32_t channels);

}  // namespace fovea::scene
