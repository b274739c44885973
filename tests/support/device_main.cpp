#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include "framework/base/diagnostic.h"
#include "framework/gpu/shader.h"
#include "places.h"
#include "tests/support/device.h"

namespace fovea::test {
namespace {

std::unique_ptr<gpu::Device> device;
std::atomic<bool> ending{false};
std::atomic<int> lastMessages{0};  // while the device is destroyed

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

// A test that makes the layers speak has failed, whatever it computed.
class ValidationListener : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override {
    if (device) device->clearValidationMessages();
  }
  void OnTestEnd(const testing::TestInfo&) override {
    if (!device) return;
    for (const std::string& message : device->validationMessages())
      ADD_FAILURE() << "validation: " << message;
    device->clearValidationMessages();
  }
};

}  // namespace

gpu::DeviceOptions testDeviceOptions() {
  gpu::DeviceOptions options;
  options.validation = validationFromEnvironment();
  if (const char* name = std::getenv("FOVEA_TEST_DEVICE")) options.device = name;
  // Each test runs as a process of its own under CTest: a warm cache saves most of its time.
  options.cacheDirectory =
      std::filesystem::temp_directory_path() / ("fovea-tests-" + std::to_string(getuid()));
  return options;
}

gpu::Device& testDevice() {
  if (!device) {
    gpu::DeviceOptions options = testDeviceOptions();
    options.onValidationMessage = [](const std::string& message) {
      if (!ending) return;
      std::cerr << "validation: " << message << "\n";
      ++lastMessages;
    };
    device = std::make_unique<gpu::Device>(options);
    device->shaders().addSearchPath(std::filesystem::path(FOVEA_SOURCE_DIR) / "shaders");
  }
  return *device;
}

}  // namespace fovea::test

// Drivers and layers leave blocks behind when they are unloaded, in modules that no suppression can name any
// more. Leaks of our own Vulkan objects show below; leaks of plain memory are looked for in the unit tests.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new fovea::test::ValidationListener);
  const int result = RUN_ALL_TESTS();
  // Objects that were never destroyed are reported when the device goes.
  fovea::test::ending = true;
  fovea::test::device.reset();
  if (fovea::test::lastMessages > 0) {
    std::cerr << "FAILED: the tests left Vulkan objects behind\n";
    return 1;
  }
  return result;
}
