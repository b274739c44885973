#include "samples/fovea/view/picture/export.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fovea/error.h"
#include "framework/image/metrics.h"
#include "samples/fovea/view/picture/texels.h"

namespace fovea::view {
namespace {

// A folder of its own, which goes with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "fovea-view-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw Error(ExitCode::CannotWrite, "no temporary folder can be made for the picture");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path file(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// The image library writes files only, after checks that are worth keeping.
std::string written(const char* name, const image::Layer& layer, const Shot& shot) {
  const TemporaryFolder folder;
  image::Metadata metadata = shot.metadata ? *shot.metadata : image::Metadata();
  metadata["frame"] = std::to_string(shot.frame);
  image::write(folder.file(name), {layer}, metadata);
  std::ifstream stream(folder.file(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void refuseBuffer(const Shot& shot) {
  if (shot.data.desc.kind == graph::ResourceKind::Buffer)
    throw Error(ExitCode::BadInput, "a buffer is no picture", "read its numbers with `pixels`");
}

}  // namespace

std::string exrFile(const Shot& shot, const std::string& layer) {
  refuseBuffer(shot);
  const Layout layout = layoutOf(shot.data.desc);
  image::Image picture{layout.width, layout.height, layout.channels, numbers(shot.data)};
  return written("picture.exr", {layer, layout.channels == 4 ? image::toRgb(picture) : std::move(picture)},
                 shot);
}

std::string pngFile(const Shot& shot, const Display& display) {
  refuseBuffer(shot);
  const Pixels pixels = draw(shot.data, display);
  image::Image picture{pixels.width, pixels.height, 3, {}};
  picture.data.reserve(pixels.rgb.size());
  for (const uint8_t level : pixels.rgb) picture.data.push_back(float(level) / 255.0f);
  return written("picture.png", {"", std::move(picture)}, shot);
}

}  // namespace fovea::view
