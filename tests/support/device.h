// The device that all device tests share.
#pragma once

#include "framework/gpu/device.h"

namespace fovea::test {

// Made on first use, with validation layers: FOVEA_TEST_VALIDATION = off, on, sync (default), gpu or best.
// A validation message that appears during a test fails it. FOVEA_TEST_DEVICE chooses another device.
gpu::Device& testDevice();

// What testDevice() was made with, for tests that need a device of their own.
gpu::DeviceOptions testDeviceOptions();

}  // namespace fovea::test
