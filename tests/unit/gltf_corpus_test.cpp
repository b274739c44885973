// The seeds of the fuzzer must stay valid models, one for each extension that is read.
#include <algorithm>

#include "framework/scene/gltf/internal.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

TEST(GltfCorpus, EverySeedLoadsAndEveryExtensionHasOne) {
  std::string all;
  for (const auto& entry : std::filesystem::directory_iterator(FOVEA_SOURCE_DIR "/tests/fuzz/corpus/gltf")) {
    const gltf::Source source = gltf::sourceOf(gltf::readFile(entry.path()), entry.path());
    all += source.json;
    if (source.json.find(gltf::kDraco) != std::string::npos && !gltf::isSupported(gltf::kDraco)) continue;
    Diagnostics warnings;
    EXPECT_GT(flatten(loadGltf(entry.path(), warnings)).triangles.size(), 0u) << entry.path();
  }
  for (const std::string& extension : gltf::supportedExtensions())
    EXPECT_NE(all.find('"' + extension + '"'), std::string::npos) << "no seed has " << extension;
}

}  // namespace
}  // namespace fovea::scene
