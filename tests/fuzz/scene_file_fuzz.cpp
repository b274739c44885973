// libFuzzer entry: loading any text as a scene file must give a scene or an Error and nothing else.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "framework/scene/file/scene_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  // Models that happen to be installed would be loaded and large scenes made, which takes seconds and tests something
  // else.
  if (text.find(".gl") != std::string_view::npos) return -1;
  for (const std::string& name : fovea::scene::builtinNames())
    if (name != "cornellbox" && text.find('"' + name + '"') != std::string_view::npos) return -1;
  fovea::Diagnostics warnings;
  try {
    fovea::scene::parseSceneFile(fovea::json::parse(text, "fuzz.json"), "/nonexistent/fuzz.json", warnings);
  } catch (const fovea::Error& e) {
    if (e.code() == fovea::ExitCode::Internal) std::abort();
  }
  return 0;
}
