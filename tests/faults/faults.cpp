// Makes functions of the system fail. A test puts this library before the others (LD_PRELOAD) and names the functions
// and their results in FOVEA_FAULTS: "vkMapMemory=-5,pthread_create=11". With "@N" a function works N times before it
// fails: "pthread_create=11@3".
#include <dlfcn.h>
#include <pthread.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdlib>
#include <optional>
#include <string>

namespace {

class Function {
 public:
  explicit Function(const char* name) : next_(dlsym(RTLD_NEXT, name)) {
    const char* variable = std::getenv("FOVEA_FAULTS");
    const std::string list = "," + std::string(variable ? variable : "") + ",",
                      start = "," + std::string(name) + "=";
    const size_t at = list.find(start);
    if (at == std::string::npos) return;
    const std::string fault = list.substr(at + start.size(), list.find(',', at + 1) - at - start.size());
    result_ = std::atoi(fault.c_str());
    if (const size_t count = fault.find('@'); count != std::string::npos)
      left_ = std::atoi(&fault[count + 1]);
  }

  // The result of the fault, or that of the function itself.
  template <class Signature, class... Arguments>
  auto call(Arguments... arguments) {
    using Result = decltype(std::declval<Signature>()(arguments...));
    return result_ && left_-- <= 0 ? static_cast<Result>(*result_)
                                   : reinterpret_cast<Signature>(next_)(arguments...);
  }

 private:
  void* next_;
  std::optional<int> result_;
  std::atomic<int> left_{0};
};

}  // namespace

extern "C" {

VkResult vkCreateInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* callbacks,
                          VkInstance* instance) {
  static Function function("vkCreateInstance");
  return function.call<PFN_vkCreateInstance>(info, callbacks, instance);
}

VkResult vkEnumeratePhysicalDevices(VkInstance instance, uint32_t* count, VkPhysicalDevice* devices) {
  static Function function("vkEnumeratePhysicalDevices");
  return function.call<PFN_vkEnumeratePhysicalDevices>(instance, count, devices);
}

VkResult vkMapMemory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize bytes,
                     VkMemoryMapFlags flags, void** data) {
  static Function function("vkMapMemory");
  return function.call<PFN_vkMapMemory>(device, memory, offset, bytes, flags, data);
}

VkResult vkAllocateDescriptorSets(VkDevice device, const VkDescriptorSetAllocateInfo* info,
                                  VkDescriptorSet* sets) {
  static Function function("vkAllocateDescriptorSets");
  return function.call<PFN_vkAllocateDescriptorSets>(device, info, sets);
}

VkResult vkQueueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence) {
  static Function function("vkQueueSubmit2");
  return function.call<PFN_vkQueueSubmit2>(queue, count, submits, fence);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) {
  static Function function("pthread_create");
  return function.call<int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>(
      thread, attributes, start, argument);
}

}  // extern "C"
