// Pictures: any bytes are an EXR, PFM, PNG or JPEG file, or are refused with an error. The first byte chooses how they
// are read.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "fovea/error.h"
#include "fovea/image.h"
#include "framework/image/header.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::array<fovea::test::FuzzFile, 3> files = {
      fovea::test::FuzzFile(".exr"), fovea::test::FuzzFile(".pfm"), fovea::test::FuzzFile(".png")};
  if (size == 0) return -1;
  const size_t how = data[0] % 4;
  ++data, --size;
  // A header may claim a picture of gigabytes, which the loader of models refuses before it decodes.
  if (fovea::image::headerSize({data, size}).value_or(fovea::image::HeaderSize{}).pixels() > 1 << 22)
    return -1;
  try {
    if (how == 3) {
      fovea::image::decode8(data, size, "fuzz");
    } else {
      files[how].write(data, size);
      fovea::image::read(files[how].path());
    }
  } catch (const fovea::Error& e) {
    if (e.code() != fovea::ExitCode::BadInput) std::abort();
  }
  return 0;
}
