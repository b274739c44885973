// Fuzzes all that the viewer answers without a socket: checks, queries, pictures, numbers and commands.
#include "tests/fuzz/view_request_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static fovea::fuzz::ViewServer server;
  const auto [request, body] = server.parse({reinterpret_cast<const char*>(data), size});
  server.ask(request, body);
  return 0;
}
