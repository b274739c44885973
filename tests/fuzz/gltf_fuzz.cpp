// libFuzzer entry: loading any bytes as a glTF model must give a scene or an Error and nothing else.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "framework/scene/gltf/internal.h"
#include "framework/scene/scene.h"
#include "tests/fuzz/fuzz_file.h"

namespace {

// The model lies in a folder of its own, so that a uri can find nothing but the file `b` there.
const std::filesystem::path& modelFile() {
  static const std::filesystem::path file = [] {
    std::string folder = (fovea::test::fuzzFolder() / "fovea-fuzz-XXXXXX").string();
    if (!mkdtemp(folder.data())) std::abort();
    std::ofstream(std::filesystem::path(folder) / "b", std::ios::binary) << std::string(256, '\x01');
    return std::filesystem::path(folder) / "m.gltf";
  }();
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fovea::Diagnostics warnings;
  try {
    const fovea::scene::Scene scene =
        fovea::scene::gltf::parseGltf({data, data + size}, modelFile(), warnings);
    const fovea::scene::Geometry g = fovea::scene::flatten(scene);
    for (const fovea::scene::Triangle& t : g.triangles)
      for (uint32_t v : t.v)
        if (v >= g.positions.size() || t.material() >= scene.materials.size()) std::abort();
  } catch (const fovea::Error& e) {
    if (e.code() == fovea::ExitCode::Internal) std::abort();
  }
  return 0;
}
