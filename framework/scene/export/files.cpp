#include "framework/scene/export/files.h"

#include <charconv>

#include "fovea/error.h"

namespace fovea::scene {
namespace fs = std::filesystem;

std::string safeFileName(const std::string& name) {
  std::string out;
  for (const char c : name.substr(0, 100)) {
    const bool plain =
        (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
    out += plain ? c : '_';
  }
  return out.empty() ? "unnamed" : out;
}

std::string UniqueNames::add(const std::string& name) {
  std::string candidate = name;
  for (uint32_t n = 2; !seen_.emplace(candidate, 0).second; ++n)
    candidate = name + separator_ + std::to_string(n);
  return candidate;
}

double shortest(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  double out = value;
  std::from_chars(text, end, out);
  return out;
}

glm::dvec3 authoredPlace(const Scene& scene, const glm::vec3& position) {
  return scene.origin + glm::dvec3(shortest(position.x), shortest(position.y), shortest(position.z));
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error))
    throw Error(
        ExitCode::CannotWrite,
        "cannot make the folder `" + folder.string() + "`: " + (error ? error.message() : "it is a file"),
        "choose another place");
}

void writeEnvironment(const fs::path& file, const EnvironmentMap& map) {
  image::Image picture{map.width(), map.height(), 3, {}};
  for (const glm::vec3& t : map.texels()) picture.data.insert(picture.data.end(), {t.r, t.g, t.b});
  image::write(file, {{"", std::move(picture)}});
}

image::Image texelImage(const Texture& texture, uint32_t channels) {
  image::Image image{texture.width, texture.height, channels, {}};
  const size_t count = size_t(texture.width) * texture.height;
  image.data.reserve(count * channels);
  for (size_t i = 0; i < count; ++i)
    for (uint32_t c = 0; c < channels; ++c) image.data.push_back(float(texture.rgba[4 * i + c]) / 255.0f);
  return image;
}

}  // namespace fovea::scene
