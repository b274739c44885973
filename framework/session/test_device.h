// The device that all tests of a process share.
#pragma once

#include <string>
#include <vector>

#include "framework/gpu/device.h"

namespace fovea::test {

// Made on first use, with validation layers: FOVEA_TEST_VALIDATION is off, on, sync (the default), gpu or best.
// FOVEA_TEST_DEVICE chooses another device than the best one.
gpu::Device& testDevice();

// What testDevice() is made with, for tests that need a device of their own.
gpu::DeviceOptions testDeviceOptions();

// What the validation layers have objected to since this was last asked.
std::vector<std::string> takeValidationMessages();

// Destroys the device at the end of a process, and returns what the layers object to meanwhile: objects left behind.
std::vector<std::string> destroyTestDevice();

}  // namespace fovea::test
