// Captures of frames by RenderDoc, with its in-application interface.
#pragma once

#include <filesystem>

namespace fovea::gpu {

// To be made before the first device is opened, as RenderDoc's layer has to be there when the Vulkan instance is made.
class Capture {
 public:
  // Throws Error(BadInput) if RenderDoc's library is not installed.
  Capture();
  // Everything that the process submits to its devices between the two calls goes into the capture.
  void begin();
  // Throws Error(CannotWrite) if there is no capture, or if it cannot become this file.
  void end(const std::filesystem::path& file);

 private:
  struct Api;
  Api* api_ = nullptr;  // of the library, for the life of the process
};

}  // namespace fovea::gpu
