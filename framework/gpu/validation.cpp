#include "framework/gpu/validation.h"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace fovea::gpu {
namespace {

constexpr size_t kMaxMessages = 200;  // otherwise a mistake in a loop would exhaust memory

// Whether a message does not point to a mistake of fovea.
bool ignored(Validation validation, const VkDebugUtilsMessengerCallbackDataEXT& data) {
  const std::string_view id = data.pMessageIdName ? data.pMessageIdName : "";
  // This mode announces the features that it enables for itself.
  if (validation == Validation::GpuAssisted) return id == "UNASSIGNED-GPU-Assisted Validation Setup";
  if (validation != Validation::BestPractices) return false;
  constexpr std::string_view kAdvice[] = {
      // The extensions that deliver these very messages.
      "UNASSIGNED-BestPractices-vkCreateInstance-specialuse-extension-debugging",
      // One allocation per resource is intended: there are a few hundred of them, and transient ones share a heap.
      "UNASSIGNED-BestPractices-vkAllocateMemory-small-allocation",
      "UNASSIGNED-BestPractices-vkBindMemory-small-dedicated-allocation",
      // Set-up transfers are fenced off from everything before and after them; the barriers of frames are exact.
      "UNASSIGNED-BestPractices-pipeline-stage-flags",
      "UNASSIGNED-BestPractices-ImageBarrierAccessLayout",
      // The layer knows only requirements queried from objects, not vkGetDevice{Buffer,Image}MemoryRequirements.
      "UNASSIGNED-BestPractices-vkBindBufferMemory-requirements-not-retrieved",
      "UNASSIGNED-BestPractices-vkBindImageMemory-requirements-not-retrieved",
      // A query whether a format is supported may well be answered with no.
      "UNASSIGNED-BestPractices-Error-Result",
  };
  return std::find(std::begin(kAdvice), std::end(kAdvice), id) != std::end(kAdvice);
}

}  // namespace

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto& log = *static_cast<MessageLog*>(user);
  if (ignored(log.validation, *data)) return VK_FALSE;
  if (log.forward) log.forward(data->pMessage);
  const std::lock_guard lock(log.mutex);
  if (log.messages.size() < kMaxMessages) log.messages.emplace_back(data->pMessage);
  return VK_FALSE;
}

}  // namespace fovea::gpu
