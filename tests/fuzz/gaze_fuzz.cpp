// Tables of gazes: any text is read or refused with an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "framework/scene/motion/motion.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fovea::test::FuzzFile file(".csv");
  file.write(data, size);
  try {
    fovea::scene::readGazeCsv(file.path());
  } catch (const fovea::Error& e) {
    if (e.code() != fovea::ExitCode::BadInput) std::abort();
  }
  return 0;
}
