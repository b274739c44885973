#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include "framework/base/diagnostic.h"
#include "framework/gpu/shader.h"
#include "tests/support/device.h"

namespace fovea::test {
namespace {

std::unique_ptr<gpu::Device> device;

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
    device = std::make_unique<gpu::Device>(testDeviceOptions());
    device->shaders().addSearchPath(std::filesystem::path(FOVEA_SOURCE_DIR) / "shaders");
  }
  return *device;
}

}  // namespace fovea::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new fovea::test::ValidationListener);
  const int result = RUN_ALL_TESTS();
  // Objects that outlive their test are reported when the device goes: the last chance to see a leak.
  fovea::test::device.reset();
  return result;
}
