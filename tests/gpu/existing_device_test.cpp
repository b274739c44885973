// Tests a device that the caller has made: sessions run on it, and what it lacks is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "fovea/session.h"
#include "framework/gpu/physical_device.h"
#include "framework/session/test_device.h"

namespace fovea::test {
namespace {

using testing::HasSubstr;

// As a program of somebody else has one, with nothing of ours but the list of required features.
class Theirs {
 public:
  // `change` decides what is enabled.
  explicit Theirs(const std::function<void(gpu::FeatureChain&)>& change = {}, bool pushes = true) {
    VkApplicationInfo app{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    app.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo instanceInfo{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    instanceInfo.pApplicationInfo = &app;
    gpu::check(vkCreateInstance(&instanceInfo, nullptr, &existing.instance), "their instance");
    uint32_t one = 1;
    vkEnumeratePhysicalDevices(existing.instance, &one, &existing.physical);
    for (const auto& [name, value] : features.required()) *value = VK_TRUE;
    VkPhysicalDeviceFeatures2 there{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    vkGetPhysicalDeviceFeatures2(existing.physical, &there);
    features.core.features.geometryShader = there.features.geometryShader;
    if (change) change(features);
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    if (pushes) existing.extensions = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
    std::vector<const char*> names;
    for (const std::string& name : existing.extensions) names.push_back(name.c_str());
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = uint32_t(names.size());
    info.ppEnabledExtensionNames = names.data();
    gpu::check(vkCreateDevice(existing.physical, &info, nullptr, &existing.device), "their device");
    vkGetDeviceQueue(existing.device, 0, 0, &existing.queue);
    existing.features = &features.core;
  }
  ~Theirs() {
    vkDestroyDevice(existing.device, nullptr);
    vkDestroyInstance(existing.instance, nullptr);
  }
  Theirs(const Theirs&) = delete;
  Theirs& operator=(const Theirs&) = delete;

  gpu::FeatureChain features;
  gpu::ExistingDevice existing;
};

gpu::DeviceOptions cached() {
  gpu::DeviceOptions options;
  options.cacheDirectory = testDeviceOptions().cacheDirectory;
  return options;
}

std::string refusal(ExitCode code, const gpu::ExistingDevice& existing, const gpu::DeviceOptions& options) {
  try {
    gpu::openDevice(existing, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

std::vector<std::byte> radianceOn(const std::shared_ptr<gpu::Device>& device, const scene::Scene& scene) {
  graph::Session session("direct", scene, {.device = device, .size = {32, 32}, .read = {"radiance"}});
  return session.render(0).outputs.at("radiance").bytes;
}

TEST(ExistingDevice, RendersAsOneOfOurs) {
  const scene::Scene scene = scene::builtin("cornellbox");
  const Theirs theirs, plain({}, false);
  gpu::DeviceOptions first = cached();
  first.device = "0";
  const std::vector<std::byte> expected = radianceOn(gpu::openDevice(first), scene);
  for (int i = 0; i < 2; ++i)  // it outlives what used it
    EXPECT_EQ(radianceOn(gpu::openDevice(theirs.existing, cached()), scene), expected);
  const std::shared_ptr<gpu::Device> without = gpu::openDevice(plain.existing, cached());
  EXPECT_TRUE(without->lacks(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME));
  EXPECT_EQ(radianceOn(without, scene), expected);
}

TEST(ExistingDevice, NamesEverythingThatItLacks) {
  const Theirs theirs([](gpu::FeatureChain& features) {
    features.v12.timelineSemaphore = VK_FALSE;
    features.v13.synchronization2 = VK_FALSE;
  });
  gpu::ExistingDevice existing = theirs.existing;
  const std::string text = refusal(ExitCode::NoDevice, existing, cached());
  EXPECT_THAT(text, HasSubstr("lacks timelineSemaphore, synchronization2\n"));
  EXPECT_THAT(text, HasSubstr("enable that when you make the device"));
  existing.queueFamily = 99;
  EXPECT_THAT(refusal(ExitCode::NoDevice, existing, cached()), HasSubstr("a queue with graphics, compute"));
  VkPhysicalDeviceFeatures2 alone = theirs.features.core;  // says nothing of later versions
  alone.pNext = nullptr;
  existing.features = &alone;
  EXPECT_THAT(refusal(ExitCode::NoDevice, existing, cached()), HasSubstr("dynamicRendering"));
}

TEST(ExistingDevice, IncompleteOrContradictoryOnesAreRefused) {
  const Theirs theirs;
  gpu::ExistingDevice existing = theirs.existing;
  existing.queue = VK_NULL_HANDLE;
  EXPECT_THAT(refusal(ExitCode::Usage, existing, cached()), HasSubstr("ExistingDevice::queue"));
  gpu::DeviceOptions options = cached();
  options.device = "nvidia";
  EXPECT_THAT(refusal(ExitCode::Usage, theirs.existing, options), HasSubstr("leave `device`"));
}

// Stands between fovea and Vulkan as OpenXR does.
TEST(DeviceMaker, MakesWhatIsAskedForAndChoosesTheDevice) {
  const scene::Scene scene = scene::builtin("cornellbox");
  VkPhysicalDevice chosen = VK_NULL_HANDLE, made = VK_NULL_HANDLE;
  int instances = 0;
  gpu::DeviceOptions options = cached();
  options.validation = gpu::Validation::On;
  options.maker =
      gpu::DeviceMaker{[&](const VkInstanceCreateInfo& info, VkInstance* instance) {
                         ++instances;
                         return vkCreateInstance(&info, nullptr, instance);
                       },
                       [&](VkInstance instance) {
                         uint32_t one = 1;
                         vkEnumeratePhysicalDevices(instance, &one, &chosen);
                         return chosen;
                       },
                       [&](VkPhysicalDevice physical, const VkDeviceCreateInfo& info, VkDevice* device) {
                         made = physical;
                         return vkCreateDevice(physical, &info, nullptr, device);
                       }};
  gpu::DeviceOptions first = cached();
  first.device = "0";
  const std::shared_ptr<gpu::Device> device = gpu::openDevice(options);
  EXPECT_EQ(instances, 1);
  EXPECT_TRUE(chosen);
  EXPECT_EQ(made, chosen);
  EXPECT_EQ(device->physical(), chosen);
  EXPECT_EQ(radianceOn(device, scene), radianceOn(gpu::openDevice(first), scene));
  EXPECT_THAT(device->validationMessages(), testing::IsEmpty());
}

TEST(DeviceMaker, IsRefusedBesideAnotherChoiceAndWithoutADevice) {
  gpu::DeviceOptions options = cached();
  options.maker = gpu::DeviceMaker{
      [](const VkInstanceCreateInfo& info, VkInstance* instance) {
        return vkCreateInstance(&info, nullptr, instance);
      },
      [](VkInstance) { return VkPhysicalDevice(VK_NULL_HANDLE); },
      [](VkPhysicalDevice, const VkDeviceCreateInfo&, VkDevice*) { return VK_ERROR_INITIALIZATION_FAILED; }};
  const auto code = [](const gpu::DeviceOptions& wanted) {
    try {
      gpu::openDevice(wanted);
    } catch (const Error& error) {
      return error.code();
    }
    return ExitCode::Ok;
  };
  EXPECT_EQ(code(options), ExitCode::NoDevice);
  options.device = "0";
  EXPECT_EQ(code(options), ExitCode::Usage);
}

}  // namespace
}  // namespace fovea::test
