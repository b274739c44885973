// State of the test runtime: one instance, one session, and what was submitted. It serves one thread at a time.
#pragma once

#include <vulkan/vulkan.h>
// clang-format off: the platform's header needs Vulkan's
#include <ctime>
#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>
// clang-format on

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/openxr/script.h"

namespace fovea::test {

struct Swapchain {
  uint32_t width = 0, height = 0;
  std::vector<VkImage> images;
  std::vector<VkDeviceMemory> memory;
  uint32_t next = 0;
  std::deque<uint32_t> acquired;  // oldest first
  bool waited = false;            // for the oldest
  int released = -1;              // the last one
};

struct Space {
  enum class Kind { View, Local, Stage, Gaze } kind = Kind::Local;
};

struct Action {
  XrActionType type{};
  std::set<std::string> paths;  // suggested
};

struct SessionState {
  VkDevice device = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  uint32_t queueFamily = 0;
  VkQueue queue = VK_NULL_HANDLE;
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;
  bool running = false, exitAsked = false, attached = false;
  uint32_t views = 0;  // of the configuration that it was begun with
  bool waited = false, begun = false;
  bool rendersThis = false, rendersNext = false;
  XrTime display = 0, before = 0;
  uint64_t waits = 0, submitted = 0;
  bool untracked = false;  // in this frame
};

class Runtime {
 public:
  Runtime();
  void violation(const std::string& text);
  void post(XrSessionState state);
  void post(const XrEventDataBuffer& event) { events.push_back(event); }
  // A failure that the script has for this call.
  XrResult scripted(const char* function);
  void happen();  // the events of the frame that begins
  double seconds() const { return session ? double(session->display) * 1e-9 - 1 : 0; }
  void endInstance();
  // Writes the picture of an image that the application has released.
  void write(const Swapchain& swapchain, uint64_t frame, size_t view);
  void destroy(Swapchain& swapchain);

  Script script;
  std::filesystem::path output;  // empty for none
  nlohmann::json frames = nlohmann::json::array(), violations = nlohmann::json::array();
  bool alive = false;
  std::set<std::string> extensions;
  std::deque<std::string> paths;  // XrPath is a number, from 1
  std::deque<XrEventDataBuffer> events;
  std::map<std::string, ScriptedEvent> failing;  // by function
  std::unique_ptr<SessionState> session;
  std::set<Swapchain*> swapchains;
  std::set<Space*> spaces;
  std::set<Action*> actions;
};

Runtime& runtime();

template <class Handle, class Object>
Handle handleOf(Object* object) {
  return reinterpret_cast<Handle>(object);
}

XrPosef poseOf(const Place& place);
PFN_xrVoidFunction functionNamed(const std::string& name);

}  // namespace fovea::test
