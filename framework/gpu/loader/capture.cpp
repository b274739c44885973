#include "framework/gpu/loader/capture.h"

#include <dlfcn.h>
#include <renderdoc_app.h>

#include <cstdlib>
#include <exception>
#include <string>
#include <system_error>

#include "fovea/error.h"
#include "framework/base/files.h"

namespace fovea::gpu {

namespace fs = std::filesystem;

struct Capture::Api : RENDERDOC_API_1_1_2 {};

Capture::Capture() {
  setenv("ENABLE_VULKAN_RENDERDOC_CAPTURE", "1", 1);  // what makes Vulkan's loader take the layer
  void* library = dlopen("librenderdoc.so", RTLD_NOW | RTLD_LOCAL);
  const auto getApi =
      library ? reinterpret_cast<pRENDERDOC_GetAPI>(dlsym(library, "RENDERDOC_GetAPI")) : nullptr;
  void* api = nullptr;
  if (!getApi || getApi(eRENDERDOC_API_Version_1_1_2, &api) != 1)
    throw Error(ExitCode::BadInput, "frames are captured by RenderDoc, which is not installed",
                "apt-get install librenderdoc");
  api_ = static_cast<Api*>(api);
  api_->MaskOverlayBits(eRENDERDOC_Overlay_None, eRENDERDOC_Overlay_None);
  api_->SetCaptureFilePathTemplate((fs::temp_directory_path() / "fovea").c_str());
}

void Capture::begin() { api_->StartFrameCapture(nullptr, nullptr); }

void Capture::end(const fs::path& file) {
  std::string made(4096, '\0');
  uint32_t length = uint32_t(made.size());
  if (api_->EndFrameCapture(nullptr, nullptr) != 1 || api_->GetNumCaptures() == 0 ||
      api_->GetCapture(api_->GetNumCaptures() - 1, made.data(), &length, nullptr) != 1)
    throw Error(ExitCode::CannotWrite, "RenderDoc could not capture the frame",
                "its log is in the folder for temporary files, under RenderDoc");
  made.resize(made.find('\0'));
  try {
    OutputFile output(file);
    fs::copy_file(made, output.temporary(), fs::copy_options::overwrite_existing);
    output.finish();
  } catch (const std::exception& e) {
    throw Error(ExitCode::CannotWrite, "cannot write " + file.string() + ": " + e.what());
  }
  std::error_code ignored;
  fs::remove(made, ignored);
}

}  // namespace fovea::gpu
