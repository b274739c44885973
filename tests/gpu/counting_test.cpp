// Tests that a shader counts the operations that its invocations run, and still computes the same.
#include <gtest/gtest.h>

#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/gpu/shader/operations.h"
#include "framework/session/test_device.h"
#include "tests/gpu/command_helpers.h"

namespace fovea {
namespace {

using namespace test;  // NOLINT: helpers

// Runs 64 * `groups` invocations over an array of as many numbers, whose values become theirs. Returns the operations.
uint64_t countIn(const std::string& main, std::vector<float>& values, uint32_t groups = 1) {
  gpu::Device& device = testDevice();
  const auto shader = device.shaders().compileSource("counted.comp", R"(
layout(local_size_x = 64) in;
layout(std430) buffer Values { float values[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  float x = values[i % 64];
)" + main + "}\n");
  const gpu::Pipeline pipeline(device, gpu::ComputePipelineDesc{gpu::countingShader(*shader)});
  gpu::Buffer buffer(device, {"values", values.size() * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
  gpu::Buffer operations(device, {"operations", gpu::kOperationsBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
  const uint64_t zero = 0;
  gpu::upload(device, buffer, std::as_bytes(std::span(values)));
  gpu::upload(device, operations, std::as_bytes(std::span(&zero, 1)));
  device.runOnce([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, pipeline.bindPoint(), pipeline.handle());
    const VkDescriptorBufferInfo infos[2] = {{buffer.handle(), 0, VK_WHOLE_SIZE},
                                             {operations.handle(), 0, VK_WHOLE_SIZE}};
    std::vector<VkWriteDescriptorSet> writes{write(pipeline, "Values"),
                                             write(pipeline, gpu::kOperationsBinding)};
    writes[0].pBufferInfo = &infos[0];
    writes[1].pBufferInfo = &infos[1];
    device.pushDescriptorSet(cmd, pipeline.bindPoint(), pipeline.layout(), 0, writes);
    vkCmdDispatch(cmd, groups, 1, 1);
  });
  values = as<float>(gpu::download(device, buffer));
  return as<uint64_t>(gpu::download(device, operations))[0];
}

TEST(Counting, BranchesAndLoopsCountAsOftenAsTheyRun) {
  std::vector<float> values(64, 2.0f);
  // 2 operations in each of i runs for i < 10, and 1 in all other invocations.
  EXPECT_EQ(countIn(R"(
  if (i < 10u) {
    for (uint k = 0u; k < i; ++k) x = x * 0.5 + 1.0;
  } else {
    x = x * 3.0;
  }
  values[i] = x;)",
                    values),
            2u * 45 + 54);
  for (uint32_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], i < 10 ? 2.0f : 6.0f) << i;
}

TEST(Counting, InvocationsThatReturnEarlyAreCounted) {
  std::vector<float> values(64, 2.0f);
  EXPECT_EQ(countIn("x = x * x; if (i >= 4u) { values[i] = x; return; } values[i] = x / 5.0 + 1.0;", values),
            64u + 2 * 4);
}

TEST(Counting, FunctionsAndWhatNothingUses) {
  std::vector<float> values(64, 2.0f);
  EXPECT_EQ(countIn("float unused = sqrt(x) + 7.0 * x; values[i] = x + x;", values), 64u);
}

TEST(Counting, MoreThan32Bits) {
  std::vector<float> values(64, 1.0f);
  EXPECT_EQ(countIn(R"(
  vec4 v = vec4(x);
  for (int k = 0; k < 9000; ++k) v = v * x + 0.5;
  if (v.x + v.y + v.z + v.w == 0.0) values[0] = v.x;)",
                    values, 1024),
            uint64_t(64 * 1024) * (9000 * 8 + 3));
}

}  // namespace
}  // namespace fovea
