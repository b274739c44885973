// Suites of measurements: any text is read or refused with an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "benchmarks/runner/suite.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    fovea::bench::parseSuite(text, "fuzz.json", {});
  } catch (const fovea::Error& e) {
    if (e.code() == fovea::ExitCode::Internal) std::abort();
  }
  return 0;
}
