#include "framework/session/test_device.h"

#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <utility>

#include "fovea/error.h"
#include "framework/base/paths.h"
#include "framework/gpu/shader/shader.h"

namespace fovea::test {

namespace {

// Not destroyed automatically, because the driver and the layers may already be gone at the end of the process.
gpu::Device* device = nullptr;
std::atomic<bool> ending{false};
std::vector<std::string> lastMessages;  // of the destruction of the device, which happens in one thread

gpu::Validation validationFromEnvironment() {
  const char* variable = std::getenv("FOVEA_TEST_VALIDATION");
  const std::string value = variable ? variable : "sync";
  if (value == "off") return gpu::Validation::Off;
  if (value == "on") return gpu::Validation::On;
  if (value == "sync") return gpu::Validation::Synchronization;
  if (value == "gpu") return gpu::Validation::GpuAssisted;
  if (value == "best") return gpu::Validation::BestPractices;
  throw Error(ExitCode::Usage, "FOVEA_TEST_VALIDATION is `" + value + "`", "use off, on, sync, gpu or best");
}

}  // namespace

gpu::DeviceOptions testDeviceOptions() {
  gpu::DeviceOptions options;
  options.validation = validationFromEnvironment();
  if (const char* name = std::getenv("FOVEA_TEST_DEVICE")) options.device = name;
  if (const char* features = std::getenv("FOVEA_TEST_WITHOUT")) {
    std::istringstream list(features);
    for (std::string feature; std::getline(list, feature, ',');) options.without.push_back(feature);
  }
  // Under CTest each test is a process of its own, and a warm shader cache saves most of its time.
  options.cacheDirectory =
      std::filesystem::temp_directory_path() / ("fovea-tests-" + std::to_string(getuid()));
  return options;
}

gpu::Device& testDevice() {
  if (!device) {
    gpu::DeviceOptions options = testDeviceOptions();
    options.onValidationMessage = [](const std::string& message) {
      if (ending) lastMessages.push_back(message);
    };
    device = new gpu::Device(options);
    for (const auto& folder : shaderFolders()) device->shaders().addSearchPath(folder);
  }
  return *device;
}

std::vector<std::string> takeValidationMessages() {
  if (!device) return {};
  std::vector<std::string> messages = device->validationMessages();
  device->clearValidationMessages();
  return messages;
}

std::vector<std::string> destroyTestDevice() {
  ending = true;
  delete std::exchange(device, nullptr);
  return lastMessages;
}

}  // namespace fovea::test
