// libFuzzer entry for graph files; start it from tests/fuzz/corpus/graph.
#include "tests/fuzz/graph_fuzz.h"

#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (text.find("\"/") != std::string_view::npos) return -1;  // no files of the machine are read
  fovea::graph::test::fuzzGraph(text);
  return 0;
}
