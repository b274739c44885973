// Tables of heads: any text is read or refused with an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "framework/session/head_trace.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    fovea::session::parseHeadTrace({reinterpret_cast<const char*>(data), size}, "fuzz.csv", {});
  } catch (const fovea::Error& e) {
    if (e.code() != fovea::ExitCode::BadInput) std::abort();
  }
  return 0;
}
