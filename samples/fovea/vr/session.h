// A session with the headset: its states, its frames, and the images that it shows.
#pragma once

#include <chrono>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "framework/gpu/device.h"
#include "samples/fovea/vr/runtime.h"

namespace fovea::vr {

// Images of one view, of which the headset shows one while the next is made. Their texels are sRGB-coded, 8 bits each.
class Swapchain {
 public:
  // Throws Error(NoDevice) if the headset shows no images of this format.
  Swapchain(XrSession session, glm::uvec2 size);
  ~Swapchain();
  Swapchain(Swapchain&& other) noexcept;
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  // The next image, once the headset does not show it any more; it belongs to the caller until release(). Throws
  // Error(DeviceLost) if the runtime does not give one back within seconds.
  VkImage acquire();
  void release();
  XrSwapchainSubImage whole() const;

 private:
  XrSwapchain handle_ = XR_NULL_HANDLE;
  glm::uvec2 size_;
  std::vector<VkImage> images_;
};

struct FrameTime {
  XrTime display = 0;     // at which the middle of the frame is seen, in nanoseconds
  XrDuration period = 0;  // from frame to frame
  bool shown = true;      // whether anybody sees what is rendered
};

// How a session ended.
enum class End {
  Asked,    // the user or the program has asked for it
  Stopped,  // the runtime has
  Lost,     // the headset is gone
};

class Session {
 public:
  Session(const Runtime& runtime, const gpu::Device& device, XrViewConfigurationType configuration);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  XrSession handle() const { return handle_; }
  // Follows what the runtime has said: begins, pauses and ends. Returns false once the session is over.
  bool follow();
  bool running() const { return running_; }  // whether frames are due
  End end() const { return end_; }
  // Asks for the end, which follow() brings: at once if no frames are due.
  void askForEnd();

  FrameTime waitForFrame();  // and begins it
  // Shows these layers, or nothing.
  void endFrame(const FrameTime& time, std::span<const XrCompositionLayerBaseHeader* const> layers);

 private:
  void change(XrSessionState state);

  const Runtime& runtime_;
  XrViewConfigurationType configuration_;
  XrSession handle_ = XR_NULL_HANDLE;
  bool running_ = false, over_ = false, asked_ = false;
  std::chrono::steady_clock::time_point askedAt_;
  End end_ = End::Stopped;
};

}  // namespace fovea::vr
