// Compute pipelines: dispatch and read back; every kind of resource bound by its reflected number.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "framework/base/diagnostic.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "tests/support/device.h"

namespace fovea {
namespace {

using test::testDevice;

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

const gpu::ReflectedBinding& binding(const gpu::Pipeline& pipeline, const std::string& name) {
  for (const gpu::ReflectedBinding& b : pipeline.interface().bindings) {
    if (b.name == name) return b;
  }
  throw std::runtime_error("no binding " + name);
}

VkWriteDescriptorSet write(const gpu::Pipeline& pipeline, const std::string& name) {
  const gpu::ReflectedBinding& b = binding(pipeline, name);
  VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  w.dstBinding = b.binding;
  w.descriptorCount = 1;
  w.descriptorType = gpu::descriptorType(b.kind);
  return w;
}

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
  const std::vector<std::byte> bytes = gpu::download(device, target);
  std::vector<uint32_t> output(kCount);
  std::memcpy(output.data(), bytes.data(), bytes.size());
  for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(output[i], (i + 5) * 3) << i;
}

}  // namespace
}  // namespace fovea
