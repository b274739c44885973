// The materials of a scene in Mitsuba's words, with the image files that they need. Private to framework/scene.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "fovea/error.h"
#include "framework/scene/export/files.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

std::string triple(const glm::vec3& v);                 // "1, 2, 3"
std::string rgb(const char* name, const glm::vec3& v);  // an element

class MitsubaMaterials {
 public:
  // Keeps references to the scene, the names of the files in `folder` and the warnings.
  MitsubaMaterials(const Scene& scene, std::filesystem::path folder, bool full, UniqueNames& names,
                   Diagnostics& warnings);

  // The element of a material; its id is "m" and the index. Throws Error(CannotWrite), as radiance() does.
  std::string bsdf(uint32_t index);
  // The element `radiance` of an emissive material, W/(sr m^2).
  std::string radiance(const Material& m);

 private:
  std::string colour(const char* name, const TextureUse& use, const glm::vec3& factor);
  bool textured(const TextureUse& use) const { return use && use.texture < scene_.textures.size(); }
  std::string textureFile(const TextureUse& use, const std::string& suffix);
  std::string channel(const char* name, const TextureUse& use, uint32_t channel, float factor);
  std::string baked(const char* name, const Material& m, const std::string& suffix, uint32_t channels,
                    const std::function<glm::vec3(glm::vec2)>& valueAt);
  std::string opacity(const Material& m);
  std::string fullBsdf(const Material& m);
  std::string dielectric(const Material& m);
  std::string twice(const char* name, const Material& m);
  std::string metal(const Material& m);
  std::string withNormalMap(const Material& m, const std::string& inner);
  float meanRoughness(const Material& m) const;
  void warn(const std::string& message);

  const Scene& scene_;
  std::filesystem::path folder_;
  bool full_;
  UniqueNames& names_;
  Diagnostics& warnings_;
  std::map<std::string, std::string> files_;  // files of textures, by their content
};

}  // namespace fovea::scene
