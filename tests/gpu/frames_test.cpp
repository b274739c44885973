// What arrives frames later: timestamps and readback, with two frames in flight.
#include <gtest/gtest.h>

#include <numeric>

#include "framework/base/diagnostic.h"
#include "framework/gpu/readback.h"
#include "framework/gpu/timestamps.h"
#include "tests/gpu/command_helpers.h"
#include "tests/support/device.h"

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
    // Filling 64 MiB takes longer than 10 us and less than 10 s on anything: the unit is nanoseconds.
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

TEST(Readback, BuffersAndImagesOfSeveralFrames) {
  gpu::Device& device = testDevice();
  gpu::ReadbackRing ring(device, 2);
  const gpu::Buffer buffer(device, {"counters", 256, 0});
  gpu::Image image(device, {.name = "picture",
                            .format = VK_FORMAT_R32_UINT,
                            .width = 4,
                            .height = 2,
                            .layers = 3,
                            .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
  std::vector<uint32_t> texels(4 * 2 * 3);
  std::iota(texels.begin(), texels.end(), 100u);
  gpu::upload(device, image, std::as_bytes(std::span(texels)), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  const auto frame = [&](uint64_t number, uint64_t bytes) {
    device.runOnce([&](VkCommandBuffer cmd) {
      ring.beginFrame(number);
      vkCmdFillBuffer(cmd, buffer.handle(), 0, VK_WHOLE_SIZE, uint32_t(number) + 7);
      barrier(cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
              VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
      ring.copy(cmd, "counters", buffer, 16, bytes);
      if (number == 1) ring.copy(cmd, "picture", image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
      EXPECT_THROW(ring.copy(cmd, "counters", buffer, 0, 4), Error);  // one copy per key and frame
      ring.endFrame(cmd);
    });
  };
  frame(0, 16);
  frame(1, 32);
  EXPECT_EQ(as<uint32_t>(ring.data(0, "counters")), std::vector<uint32_t>(4, 7));
  EXPECT_EQ(as<uint32_t>(ring.data(1, "counters")), std::vector<uint32_t>(8, 8));
  EXPECT_EQ(as<uint32_t>(ring.data(1, "picture")), texels);
  EXPECT_TRUE(ring.data(0, "picture").empty());
  frame(2, 64);  // the slot of frame 0, with more bytes
  EXPECT_TRUE(ring.data(0, "counters").empty());
  EXPECT_EQ(as<uint32_t>(ring.data(2, "counters")), std::vector<uint32_t>(16, 9));
  frame(3, 16);  // the slot of frame 1, whose picture is not copied again
  EXPECT_TRUE(ring.data(3, "picture").empty());
}

}  // namespace
}  // namespace fovea
