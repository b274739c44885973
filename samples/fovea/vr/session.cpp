#include "samples/fovea/vr/session.h"

#include <algorithm>
#include <utility>

namespace fovea::vr {
namespace {

constexpr XrDuration kPatience = 1'000'000'000;  // nanoseconds, of one wait for an image
constexpr int kWaits = 10;
constexpr auto kFarewell = std::chrono::seconds(5);  // for the runtime to end a session after it was asked to

}  // namespace

Swapchain::Swapchain(XrSession session, glm::uvec2 size) : size_(size) {
  uint32_t count = 0;
  check(xrEnumerateSwapchainFormats(session, 0, &count, nullptr), "asking for formats");
  std::vector<int64_t> formats(count);
  check(xrEnumerateSwapchainFormats(session, count, &count, formats.data()), "asking for formats");
  XrSwapchainCreateInfo info{XR_TYPE_SWAPCHAIN_CREATE_INFO};
  info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
  info.format = VK_FORMAT_R8G8B8A8_SRGB;
  if (std::ranges::find(formats, info.format) == formats.end())
    throw Error(ExitCode::NoDevice, "the headset shows no images of the format VK_FORMAT_R8G8B8A8_SRGB",
                "choose another OpenXR runtime");
  info.sampleCount = 1;
  info.width = size.x, info.height = size.y;
  info.faceCount = info.arraySize = info.mipCount = 1;
  check(xrCreateSwapchain(session, &info, &handle_), "making images for the headset");
  try {
    check(xrEnumerateSwapchainImages(handle_, 0, &count, nullptr), "asking for images");
    std::vector<XrSwapchainImageVulkan2KHR> images(count, {XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR});
    check(xrEnumerateSwapchainImages(handle_, count, &count,
                                     reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data())),
          "asking for images");
    for (const XrSwapchainImageVulkan2KHR& image : images) images_.push_back(image.image);
  } catch (...) {
    xrDestroySwapchain(handle_);
    throw;
  }
}

Swapchain::Swapchain(Swapchain&& other) noexcept
    : handle_(std::exchange(other.handle_, XR_NULL_HANDLE)),
      size_(other.size_),
      images_(std::move(other.images_)) {}

Swapchain::~Swapchain() {
  if (handle_) xrDestroySwapchain(handle_);
}

VkImage Swapchain::acquire() {
  uint32_t index = 0;
  check(xrAcquireSwapchainImage(handle_, nullptr, &index), "taking an image of the headset");
  XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO};
  wait.timeout = kPatience;
  XrResult result = XR_TIMEOUT_EXPIRED;
  for (int i = 0; i < kWaits && result == XR_TIMEOUT_EXPIRED; ++i)
    result = xrWaitSwapchainImage(handle_, &wait);
  check(result, "waiting for an image of the headset");
  if (result == XR_TIMEOUT_EXPIRED)
    throw Error(ExitCode::DeviceLost, "the headset did not give an image back within 10 seconds",
                "the log of the runtime may say why; start again once the headset works");
  return images_.at(index);
}

void Swapchain::release() {
  check(xrReleaseSwapchainImage(handle_, nullptr), "giving an image to the headset");
}

XrSwapchainSubImage Swapchain::whole() const {
  return {handle_, {{0, 0}, {int32_t(size_.x), int32_t(size_.y)}}, 0};
}

Session::Session(const Runtime& runtime, const gpu::Device& device, XrViewConfigurationType configuration)
    : runtime_(runtime), configuration_(configuration) {
  XrGraphicsBindingVulkan2KHR binding{XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR};
  binding.instance = device.instance();
  binding.physicalDevice = device.physical();
  binding.device = device.handle();
  binding.queueFamilyIndex = device.queueFamily();
  XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &binding};
  info.systemId = runtime.system();
  check(xrCreateSession(runtime.instance(), &info, &handle_), "beginning with the headset");
}

Session::~Session() { xrDestroySession(handle_); }

bool Session::follow() {
  XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
  for (;;) {
    event = {XR_TYPE_EVENT_DATA_BUFFER};
    const XrResult result = xrPollEvent(runtime_.instance(), &event);
    check(result, "asking for news of the headset");
    if (result == XR_EVENT_UNAVAILABLE) break;
    if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) {
      const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
      if (changed.session == handle_) change(changed.state);
    } else if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) {
      end_ = End::Lost;
      over_ = true;
    }
  }
  // A runtime that has been asked and does not answer must not keep the program.
  if (asked_ && std::chrono::steady_clock::now() - askedAt_ > kFarewell) over_ = true;
  return !over_;
}

void Session::change(XrSessionState state) {
  switch (state) {
    case XR_SESSION_STATE_READY: {
      XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO};
      info.primaryViewConfigurationType = configuration_;
      check(xrBeginSession(handle_, &info), "beginning with the frames of the headset");
      running_ = true;
      if (asked_) check(xrRequestExitSession(handle_), "asking for the end");
      break;
    }
    case XR_SESSION_STATE_STOPPING:
      check(xrEndSession(handle_), "ending the frames of the headset");
      running_ = false;
      break;
    case XR_SESSION_STATE_LOSS_PENDING:
      end_ = End::Lost;
      over_ = true;
      break;
    case XR_SESSION_STATE_EXITING:
      end_ = asked_ ? End::Asked : End::Stopped;
      over_ = true;
      break;
    default:
      break;
  }
}

void Session::askForEnd() {
  if (std::exchange(asked_, true)) return;
  askedAt_ = std::chrono::steady_clock::now();
  if (running_) {
    check(xrRequestExitSession(handle_), "asking for the end");
  } else {  // only a session that runs can be asked
    end_ = End::Asked;
    over_ = true;
  }
}

FrameTime Session::waitForFrame() {
  XrFrameState state{XR_TYPE_FRAME_STATE};
  check(xrWaitFrame(handle_, nullptr, &state), "waiting for a frame of the headset");
  check(xrBeginFrame(handle_, nullptr), "beginning a frame of the headset");
  return {state.predictedDisplayTime, state.predictedDisplayPeriod, state.shouldRender == XR_TRUE};
}

void Session::endFrame(const FrameTime& time, std::span<const XrCompositionLayerBaseHeader* const> layers) {
  XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO};
  info.displayTime = time.display;
  info.environmentBlendMode = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  info.layerCount = uint32_t(layers.size());
  info.layers = layers.data();
  check(xrEndFrame(handle_, &info), "showing a frame");
}

}  // namespace fovea::vr
