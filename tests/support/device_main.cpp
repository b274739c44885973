// main() of the tests that need a device.
#include <gtest/gtest.h>

#include <iostream>

#include "fovea/passes.h"
#include "fovea/scenes.h"
#include "framework/session/test_device.h"

namespace {

// A test that causes a message of the validation layers has failed, whatever it computed.
class ValidationListener : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override { fovea::test::takeValidationMessages(); }
  void OnTestEnd(const testing::TestInfo&) override {
    for (const std::string& message : fovea::test::takeValidationMessages())
      ADD_FAILURE() << "validation: " << message;
  }
};

}  // namespace

// Drivers and layers leave blocks behind when they are unloaded, in modules that no suppression can name any more.
// Leaks of our own Vulkan objects are reported below; the unit tests look for leaks of plain memory.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  fovea::passes::registerAll();
  fovea::scenes::registerAll();
  testing::UnitTest::GetInstance()->listeners().Append(new ValidationListener);
  const int result = RUN_ALL_TESTS();
  // Objects that were never destroyed are reported when the device is destroyed.
  const std::vector<std::string> left = fovea::test::destroyTestDevice();
  for (const std::string& message : left) std::cerr << "validation: " << message << "\n";
  if (left.empty()) return result;
  std::cerr << "FAILED: the tests left Vulkan objects behind\n";
  return 1;
}
