// The device that all tests of a process share.
#pragma once

#include <string>
#include <vector>

#include "framework/gpu/device.h"

namespace fovea::test {

// Created on first use with the validation that FOVEA_TEST_VALIDATION selects: off, on, sync (the default), gpu or
// best. FOVEA_TEST_DEVICE selects a device other than the best one, FOVEA_TEST_WITHOUT lists what to do without.
gpu::Device& testDevice();

// The options that testDevice() is created with, for tests that need a device of their own.
gpu::DeviceOptions testDeviceOptions();

// The validation messages since the last call.
std::vector<std::string> takeValidationMessages();

// Destroys the device at the end of a process and returns the validation messages that this causes, e.g. about
// objects that were never destroyed.
std::vector<std::string> destroyTestDevice();

}  // namespace fovea::test
