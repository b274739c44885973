// Pictures: any bytes are an EXR, HDR, PFM, PNG or JPEG file, or are refused with an error, whether they lie in a file
// or in memory. What is read from a file is compared with itself, layer by layer, which is refused or gives no error.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "fovea/error.h"
#include "fovea/image.h"
#include "framework/image/header.h"
#include "framework/session/compared.h"
#include "tests/fuzz/fuzz_file.h"

namespace {

using namespace fovea;  // NOLINT: what is under test

template <class Read>
void readOrRefuse(const Read& read) {
  try {
    read();
  } catch (const Error& e) {
    if (e.code() != ExitCode::BadInput && e.code() != ExitCode::OutOfMemory) std::abort();
  }
}

void compareWithItself(const image::File& file, const std::string& layer) {
  session::CompareOptions options;
  options.layer = layer;
  options.radius = 0.25f, options.exposure = 1.0f, options.gaze = "0.5,0.5";
  const session::Compared c = session::compareRadiance("a", file, "b", file, options);
  if (image::pixelCount(c.image.display) != size_t(c.window.width) * c.window.height) std::abort();
  const double error = image::meanSquaredError(c.image, c.reference, c.fovea).whole;
  if (!(error == 0)) std::abort();
}

void readAndCompare(const std::filesystem::path& path) {
  const image::File file = image::read(path);
  for (const image::Layer& layer : file.layers) {
    if (layer.image.data.size() != image::pixelCount(layer.image) * layer.image.channels ||
        layer.channels.size() != layer.image.channels)
      std::abort();
    if (image::pixelCount(layer.image) < 1 << 12) readOrRefuse([&] { compareWithItself(file, layer.name); });
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const test::FuzzFile picture(".exr"), pfm(".pfm");
  static const int limited = setenv("FOVEA_MEMORY_LIMIT", "4", 1);  // MiB
  if (limited != 0 || size == 0) return -1;
  const test::FuzzFile& file = data[0] == 'P' ? pfm : picture;
  file.write(data, size);
  readOrRefuse([&] { readAndCompare(file.path()); });
  // A header may claim a picture of gigabytes, which the loader of models refuses before it decodes.
  if (image::headerSize({data, size}).value_or(image::HeaderSize{}).pixels() <= 1 << 18)
    readOrRefuse([&] { image::decode8(data, size, "fuzz"); });
  return 0;
}
