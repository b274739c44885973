// Tables of gazes: any text is read or refused with an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "framework/scene/file/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    fovea::scene::parseGazeCsv({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
  } catch (const fovea::Error& e) {
    if (e.code() != fovea::ExitCode::BadInput) std::abort();
  }
  return 0;
}
