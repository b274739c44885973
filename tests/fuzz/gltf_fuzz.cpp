// libFuzzer entry: loading any bytes as a glTF model must give a scene or an Error and nothing else.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "framework/scene/load.h"
#include "framework/scene/scene.h"

namespace {

// The model lies in a folder of its own, so that a uri can find nothing but the model itself.
const std::filesystem::path& modelFile() {
  static const std::filesystem::path file = [] {
    std::string folder = (std::filesystem::temp_directory_path() / "fovea-fuzz-XXXXXX").string();
    if (!mkdtemp(folder.data())) std::abort();
    return std::filesystem::path(folder) / "m.gltf";
  }();
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::ofstream(modelFile(), std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), std::streamsize(size));
  fovea::Diagnostics warnings;
  try {
    const fovea::scene::Scene scene = fovea::scene::loadGltf(modelFile(), warnings);
    const fovea::scene::Geometry g = fovea::scene::flatten(scene);
    for (const fovea::scene::Triangle& t : g.triangles)
      for (uint32_t v : t.v)
        if (v >= g.positions.size() || t.material() >= scene.materials.size()) std::abort();
  } catch (const fovea::Error& e) {
    if (e.code() == fovea::ExitCode::Internal) std::abort();
  }
  return 0;
}
