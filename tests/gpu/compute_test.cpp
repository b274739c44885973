// Tests compute pipelines: dispatch and readback, with every kind of resource bound by its reflected number.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "fovea/error.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/gpu/shader/shader.h"
#include "framework/session/test_device.h"
#include "tests/gpu/command_helpers.h"

namespace fovea {
namespace {

using namespace test;  // NOLINT: helpers

constexpr const char* kDouble = R"(#version 460
layout(local_size_x = 64) in;
layout(std430) readonly buffer Source { uint source[]; };
layout(std430) writeonly buffer Target { uint target[]; };
layout(push_constant) uniform Constants { uint count; uint factor; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) target[i] = source[i] * factor;
}
)";

TEST(Compute, RoundTrip) {
  gpu::Device& device = testDevice();
  constexpr uint32_t kCount = 1000;
  std::vector<uint32_t> input(kCount);
  std::iota(input.begin(), input.end(), 5u);
  gpu::Buffer source(device, {"source", kCount * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
  gpu::Buffer target(device, {"target", kCount * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
  gpu::upload(device, source, std::as_bytes(std::span(input)));
  const gpu::Pipeline pipeline(
      device, gpu::ComputePipelineDesc{device.shaders().compileSource("double.comp", kDouble)});

  device.runOnce([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, pipeline.bindPoint(), pipeline.handle());
    const VkDescriptorBufferInfo infos[2] = {{source.handle(), 0, VK_WHOLE_SIZE},
                                             {target.handle(), 0, VK_WHOLE_SIZE}};
    std::vector<VkWriteDescriptorSet> writes{write(pipeline, "Source"), write(pipeline, "Target")};
    writes[0].pBufferInfo = &infos[0];
    writes[1].pBufferInfo = &infos[1];
    device.pushDescriptorSet(cmd, pipeline.bindPoint(), pipeline.layout(), 0, writes);
    const uint32_t constants[2] = {kCount, 3};
    vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0, sizeof constants, constants);
    vkCmdDispatch(cmd, (kCount + 63) / 64, 1, 1);
  });
  const std::vector<uint32_t> output = as<uint32_t>(gpu::download(device, target));
  for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(output[i], (i + 5) * 3) << i;
}

// Binds every kind of resource at once by name: the driver must accept what reflection reports and read
// the same values.
TEST(Compute, EveryKindOfResource) {
  gpu::Device& device = testDevice();
  const gpu::Pipeline pipeline(device,
                               gpu::ComputePipelineDesc{device.shaders().compileSource("kinds.comp", R"(
layout(local_size_x = 1) in;
layout(std140) uniform Block { vec4 value; } block;
layout(std430) buffer Result { vec4 result[7]; };
uniform texture2D plain;
uniform sampler linearSampler;
uniform sampler2D combined;
uniform textureBuffer texels;
layout(rgba32f) uniform image2D stored;
layout(rgba32f) uniform imageBuffer storedTexels;
void main() {
  result[0] = block.value;
  result[1] = texelFetch(plain, ivec2(1, 0), 0);
  result[2] = texture(sampler2D(plain, linearSampler), vec2(0.5));
  result[3] = texture(combined, vec2(0.25, 0.5));
  result[4] = texelFetch(texels, 1);
  result[5] = imageLoad(stored, ivec2(0, 0));
  result[6] = imageLoad(storedTexels, 0);
  imageStore(stored, ivec2(1, 0), vec4(9.0));
  imageStore(storedTexels, 1, vec4(8.0));
}
)")});
  const VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
  const std::vector<float> two{1, 2, 3, 4, 5, 6, 7, 8};  // two texels
  const auto bytes = std::as_bytes(std::span(two));
  const auto image = [&](const char* name, VkImageUsageFlags usage, VkImageLayout layout) {
    gpu::Image i(device,
                 {.name = name,
                  .format = format,
                  .width = 2,
                  .usage = usage | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    gpu::upload(device, i, bytes, layout);
    return i;
  };
  gpu::Image plain = image("plain", VK_IMAGE_USAGE_SAMPLED_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  gpu::Image stored = image("stored", VK_IMAGE_USAGE_STORAGE_BIT, VK_IMAGE_LAYOUT_GENERAL);
  gpu::Buffer block(device, {"block", 32, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT});
  gpu::Buffer texels(device, {"texels", 32, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT});
  gpu::Buffer storedTexels(device, {"stored texels", 32, VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT});
  gpu::Buffer result(device, {"result", 7 * 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
  for (gpu::Buffer* b : {&block, &texels, &storedTexels}) gpu::upload(device, *b, bytes);
  const VkSampler linear = gpu::sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  EXPECT_EQ(linear, gpu::sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE));
  EXPECT_NE(linear, gpu::sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT));

  const VkDescriptorImageInfo plainInfo{linear, plain.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkDescriptorImageInfo storedInfo{VK_NULL_HANDLE, stored.view(), VK_IMAGE_LAYOUT_GENERAL};
  const VkDescriptorBufferInfo blockInfo{block.handle(), 0, 16},
      resultInfo{result.handle(), 0, VK_WHOLE_SIZE};
  const VkBufferView texelView = texels.texelView(format), storedView = storedTexels.texelView(format);
  EXPECT_EQ(texelView, texels.texelView(format));
  std::vector<VkWriteDescriptorSet> writes;
  for (const char* name : {"plain", "linearSampler", "combined"}) {
    writes.push_back(write(pipeline, name));
    writes.back().pImageInfo = &plainInfo;
  }
  writes.push_back(write(pipeline, "stored"));
  writes.back().pImageInfo = &storedInfo;
  writes.push_back(write(pipeline, "block"));
  writes.back().pBufferInfo = &blockInfo;
  writes.push_back(write(pipeline, "Result"));
  writes.back().pBufferInfo = &resultInfo;
  writes.push_back(write(pipeline, "texels"));
  writes.back().pTexelBufferView = &texelView;
  writes.push_back(write(pipeline, "storedTexels"));
  writes.back().pTexelBufferView = &storedView;
  ASSERT_EQ(writes.size(), pipeline.interface().bindings.size());
  device.runOnce([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, pipeline.bindPoint(), pipeline.handle());
    device.pushDescriptorSet(cmd, pipeline.bindPoint(), pipeline.layout(), 0, writes);
    vkCmdDispatch(cmd, 1, 1, 1);
  });
  const std::vector<float> r = as<float>(gpu::download(device, result));
  const float first[7] = {1, 5, 3, 1, 5, 1, 1};  // the first channel; [2] lies between the texels
  for (int i = 0; i < 7; ++i) EXPECT_EQ(r[i * 4], first[i]) << i;
  EXPECT_EQ(as<float>(gpu::download(device, stored, VK_IMAGE_LAYOUT_GENERAL))[4], 9);
  EXPECT_EQ(as<float>(gpu::download(device, storedTexels))[4], 8);
}

TEST(Compute, SharedSetIsRequiredWhenUsed) {
  gpu::Device& device = testDevice();
  const auto shader = device.shaders().compileSource("shared.comp", R"(
layout(local_size_x = 1) in;
layout(set = 1, binding = 0) uniform S { vec4 s; };
layout(std430) buffer Result { vec4 result; };
void main() { result = s; }
)");
  EXPECT_THROW(gpu::Pipeline(device, gpu::ComputePipelineDesc{shader}), Error);
}

TEST(Compute, OversizedWorkGroupIsNamed) {
  gpu::Device& device = testDevice();
  const auto shader = device.shaders().compileSource(
      "huge.comp", "layout(local_size_x = 1024, local_size_y = 64) in;\nvoid main() {}\n");
  try {
    const gpu::Pipeline pipeline(device, gpu::ComputePipelineDesc{shader});
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("1024x64x1"));
  }
}

TEST(Compute, PipelinesMove) {
  gpu::Device& device = testDevice();
  gpu::Pipeline a(device, gpu::ComputePipelineDesc{device.shaders().compileSource("double.comp", kDouble)});
  const VkPipeline handle = a.handle();
  gpu::Pipeline b = std::move(a);
  EXPECT_FALSE(a);  // NOLINT(bugprone-use-after-move): this is what is tested
  EXPECT_EQ(b.handle(), handle);
  b = gpu::Pipeline();
  EXPECT_FALSE(b);
}

}  // namespace
}  // namespace fovea
