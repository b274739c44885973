// Pictures: any bytes are an EXR, HDR, PFM, PNG or JPEG file, or are refused with an error, whether they lie in a file
// or in memory.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "fovea/error.h"
#include "fovea/image.h"
#include "framework/image/header.h"
#include "tests/fuzz/fuzz_file.h"

namespace {

template <class Read>
void readOrRefuse(const Read& read) {
  try {
    read();
  } catch (const fovea::Error& e) {
    if (e.code() != fovea::ExitCode::BadInput && e.code() != fovea::ExitCode::OutOfMemory) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fovea::test::FuzzFile picture(".exr"), pfm(".pfm");
  static const int limited = setenv("FOVEA_MEMORY_LIMIT", "4", 1);  // MiB
  if (limited != 0 || size == 0) return -1;
  const fovea::test::FuzzFile& file = data[0] == 'P' ? pfm : picture;
  file.write(data, size);
  readOrRefuse([&] { fovea::image::read(file.path()); });
  // A header may claim a picture of gigabytes, which the loader of models refuses before it decodes.
  if (fovea::image::headerSize({data, size}).value_or(fovea::image::HeaderSize{}).pixels() <= 1 << 18)
    readOrRefuse([&] { fovea::image::decode8(data, size, "fuzz"); });
  return 0;
}
