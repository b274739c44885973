// Passes declared in files: any text is read or refused with an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "framework/base/json.h"
#include "framework/graph/pass/pass_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    fovea::Diagnostics diagnostics;
    fovea::graph::readPassFile(fovea::json::parse(text, "fuzz.pass.json"), "fuzz.pass.json", diagnostics);
  } catch (const fovea::Error&) {  // refused
  }
  return 0;
}
