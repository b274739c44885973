// Stands for RenderDoc's library: it captures nothing, and writes which of its functions were called into its captures.
#include <renderdoc_app.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

namespace {

std::string calls, folder, file;

void maskOverlayBits(uint32_t, uint32_t) {}
void setPath(const char* path) { folder = path; }
void start(RENDERDOC_DevicePointer, RENDERDOC_WindowHandle) { calls += " start"; }
uint32_t end(RENDERDOC_DevicePointer, RENDERDOC_WindowHandle) {
  if (std::getenv("FOVEA_TEST_NO_CAPTURE")) return 0;
  file = folder + "_frame1.rdc";
  std::ofstream(file) << "RDOC" << calls << " end";
  return 1;
}
uint32_t count() { return file.empty() ? 0 : 1; }
uint32_t get(uint32_t, char* name, uint32_t* length, uint64_t*) {
  std::strcpy(name, file.c_str());
  *length = uint32_t(file.size()) + 1;
  return 1;
}

}  // namespace

extern "C" int RENDERDOC_GetAPI(RENDERDOC_Version, void** out) {
  static RENDERDOC_API_1_1_2 api{};
  api.MaskOverlayBits = maskOverlayBits;
  api.SetCaptureFilePathTemplate = setPath;
  api.StartFrameCapture = start;
  api.EndFrameCapture = end;
  api.GetNumCaptures = count;
  api.GetCapture = get;
  *out = &api;
  return 1;
}
