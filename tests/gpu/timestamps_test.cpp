// Tests timestamps, which arrive some frames later when two frames are in flight.
#include <gtest/gtest.h>

#include "fovea/error.h"
#include "framework/gpu/timestamps.h"
#include "framework/session/test_device.h"
#include "tests/gpu/command_helpers.h"

namespace fovea {
namespace {

using namespace test;  // NOLINT: helpers

TEST(Timestamps, GrowAndAreKeptPerFrame) {
  gpu::Device& device = testDevice();
  gpu::TimestampRing ring(device, 8, 2);
  const gpu::Buffer buffer(device, {"work", 64u << 20, 0});
  const auto frame = [&](uint64_t number, uint32_t stamps) {
    device.runOnce([&](VkCommandBuffer cmd) {
      ring.beginFrame(cmd, number);
      for (uint32_t i = 0; i < stamps; ++i) {
        EXPECT_EQ(ring.write(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT), i);
        barrier(cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
        vkCmdFillBuffer(cmd, buffer.handle(), 0, VK_WHOLE_SIZE, i);
      }
    });
  };
  EXPECT_FALSE(ring.results(0).has_value());
  frame(0, 3);
  frame(1, 5);
  const auto zero = ring.results(0), one = ring.results(1);
  ASSERT_TRUE(zero && one);
  ASSERT_EQ(zero->size(), 3u);
  ASSERT_EQ(one->size(), 5u);
  EXPECT_EQ(one->at(0), 0.0);
  for (size_t i = 1; i < one->size(); ++i) {
    // Filling 64 MiB takes more than 10 us and less than 10 s on any device, so this checks that the
    // unit is nanoseconds.
    EXPECT_GT(one->at(i) - one->at(i - 1), 1e4);
    EXPECT_LT(one->at(i) - one->at(i - 1), 1e10);
  }
  frame(2, 0);
  EXPECT_FALSE(ring.results(0).has_value());  // its slot went to frame 2
  EXPECT_TRUE(ring.results(2)->empty());
  EXPECT_TRUE(ring.results(1).has_value());
}

TEST(Timestamps, NothingBeforeTheGpuIsDone) {
  gpu::Device& device = testDevice();
  gpu::TimestampRing ring(device, 4, 2);
  device.runOnce([&](VkCommandBuffer cmd) {
    ring.beginFrame(cmd, 0);
    ring.write(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    ring.write(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  });
  device.runOnce([&](VkCommandBuffer cmd) {
    ring.beginFrame(cmd, 1);
    ring.write(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    EXPECT_TRUE(ring.results(0).has_value());
  });
  EXPECT_TRUE(ring.results(1).has_value());
}

TEST(Timestamps, TooManyAreRefused) {
  gpu::Device& device = testDevice();
  gpu::TimestampRing ring(device, 2, 1);
  device.runOnce([&](VkCommandBuffer cmd) {
    EXPECT_THROW(ring.write(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT), Error);  // before any frame
    ring.beginFrame(cmd, 0);
    ring.write(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    ring.write(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    EXPECT_THROW(ring.write(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT), Error);
  });
}

}  // namespace
}  // namespace fovea
