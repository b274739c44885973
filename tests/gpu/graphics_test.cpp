// Tests graphics pipelines with dynamic rendering: coverage, winding, depth, blending and layers.
#include <gtest/gtest.h>

#include <functional>

#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/gpu/shader/shader.h"
#include "framework/session/test_device.h"
#include "tests/gpu/command_helpers.h"

namespace fovea {
namespace {

using namespace test;  // NOLINT: helpers

constexpr uint32_t kSize = 16;

// The shader fetches the vertices itself; `z` is the depth of all of them.
constexpr const char* kVertex = R"(
#extension GL_ARB_shader_viewport_layer_array : enable
uniform textureBuffer positions;
layout(push_constant) uniform Constants { float z; uint layerCount; vec4 colour; };
layout(location = 0) flat out uint vertexLayer;
void main() {
  gl_Position = vec4(texelFetch(positions, gl_VertexIndex).xy, z, 1.0);
  vertexLayer = gl_InstanceIndex;
#ifdef LAYERED
  gl_Layer = gl_InstanceIndex;
#endif
#ifdef CLIPPED
  gl_ClipDistance[0] = -gl_Position.y;  // keeps the upper half
#endif
}
)";

constexpr const char* kFragment = R"(
uniform texture2D tint;
layout(push_constant) uniform Constants { float z; uint layerCount; vec4 colour; };
layout(location = 0) flat in uint vertexLayer;
layout(location = 0) out vec4 target;
void main() {
  target = colour * texelFetch(tint, ivec2(0), 0) + vec4(0.0, 0.0, float(vertexLayer), 0.0);
#ifndef WITHOUT_geometryShader
  target.a += float(gl_PrimitiveID);
#endif
}
)";

struct Constants {
  float z = 0.5f;
  uint32_t layerCount = 1;
  float unused[2] = {};
  float colour[4] = {1, 0.5f, 0, 0};
};

class Graphics : public testing::Test {
 protected:
  Graphics() {
    // Two triangles that cover the left half of the target, counter-clockwise on the screen, whose y axis points down.
    const std::vector<float> corners{-1, -1, 0, 0, -1, 1, 0, 0, 0, -1, 0, 0,  //
                                     0,  -1, 0, 0, -1, 1, 0, 0, 0, 1,  0, 0};
    gpu::upload(device_, positions_, std::as_bytes(std::span(corners)));
    const float white[4] = {1, 1, 1, 1};
    gpu::upload(device_, tint_, std::as_bytes(std::span(white)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  }

  gpu::GraphicsPipelineDesc desc(const gpu::Defines& defines = {}) {
    gpu::GraphicsPipelineDesc d;
    d.vertex = device_.shaders().compileSource("test.vert", kVertex, defines);
    d.fragment = device_.shaders().compileSource("test.frag", kFragment);
    d.colorFormats = {VK_FORMAT_R32G32B32A32_SFLOAT};
    return d;
  }

  gpu::Image target(uint32_t layers = 1) {
    return gpu::Image(device_,
                      {.name = "target",
                       .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                       .width = kSize,
                       .height = kSize,
                       .layers = layers,
                       .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
  }

  void bind(VkCommandBuffer cmd, const gpu::Pipeline& pipeline, const Constants& constants) {
    vkCmdBindPipeline(cmd, pipeline.bindPoint(), pipeline.handle());
    const VkBufferView view = positions_.texelView(VK_FORMAT_R32G32B32A32_SFLOAT);
    const VkDescriptorImageInfo tint{VK_NULL_HANDLE, tint_.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    std::vector<VkWriteDescriptorSet> writes{write(pipeline, "positions")};
    writes[0].pTexelBufferView = &view;
    if (pipeline.interface().bindings.size() > 1) {
      writes.push_back(write(pipeline, "tint"));
      writes[1].pImageInfo = &tint;
    }
    device_.pushDescriptorSet(cmd, pipeline.bindPoint(), pipeline.layout(), 0, writes);
    vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0,
                       pipeline.interface().pushConstantBytes, &constants);
  }

  // Clears the colour to 0 and the depth to 1, records, and returns the colour target.
  std::vector<float> render(gpu::Image& color, gpu::Image* depth,
                            const std::function<void(VkCommandBuffer)>& record) {
    device_.runOnce([&](VkCommandBuffer cmd) {
      layoutBarrier(cmd, color, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
      if (depth)
        layoutBarrier(cmd, *depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
      VkRenderingAttachmentInfo c{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO}, d = c;
      c.imageView = color.view();
      c.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
      c.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
      c.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
      VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
      info.renderArea = {{0, 0}, {kSize, kSize}};
      info.layerCount = color.desc().layers;
      info.colorAttachmentCount = 1;
      info.pColorAttachments = &c;
      if (depth) {
        d.imageView = depth->view();
        d.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
        d.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        d.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        d.clearValue.depthStencil.depth = 1;
        info.pDepthAttachment = &d;
      }
      const VkViewport viewport{0, 0, kSize, kSize, 0, 1};
      vkCmdSetViewport(cmd, 0, 1, &viewport);
      vkCmdSetScissor(cmd, 0, 1, &info.renderArea);
      vkCmdBeginRendering(cmd, &info);
      record(cmd);
      vkCmdEndRendering(cmd);
      layoutBarrier(cmd, color, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
    });
    return as<float>(gpu::download(device_, color, VK_IMAGE_LAYOUT_GENERAL));
  }

  gpu::Device& device_ = testDevice();
  gpu::Buffer positions_{device_, {"positions", 6 * 16, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT}};
  gpu::Image tint_{device_,
                   {.name = "tint",
                    .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                    .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}};
};

TEST_F(Graphics, TrianglesCoverTheirPixels) {
  const gpu::Pipeline pipeline(device_, desc());
  gpu::Image color = target();
  const std::vector<float> p = render(color, nullptr, [&](VkCommandBuffer cmd) {
    bind(cmd, pipeline, {});
    vkCmdDraw(cmd, 6, 1, 0, 0);
  });
  uint32_t second = 0;
  for (uint32_t y = 0; y < kSize; ++y) {
    for (uint32_t x = 0; x < kSize; ++x) {
      const float* texel = &p[(y * kSize + x) * 4];
      ASSERT_EQ(texel[0], x < kSize / 2 ? 1.0f : 0.0f) << x << "," << y;
      ASSERT_EQ(texel[1], x < kSize / 2 ? 0.5f : 0.0f) << x << "," << y;
      second += texel[3] == 1.0f;  // gl_PrimitiveID
    }
  }
  if (device_.lacks("geometryShader")) return;
  EXPECT_NEAR(second, kSize * kSize / 4, kSize);  // one of the two halves of the half
}

// A triangle that is counter-clockwise on the screen is front-facing.
TEST_F(Graphics, CounterClockwiseIsFront) {
  const auto covered = [&](VkCullModeFlags cull) {
    gpu::GraphicsPipelineDesc d = desc();
    d.cull = cull;
    const gpu::Pipeline pipeline(device_, d);
    gpu::Image color = target();
    const std::vector<float> p = render(color, nullptr, [&](VkCommandBuffer cmd) {
      bind(cmd, pipeline, {});
      vkCmdDraw(cmd, 3, 1, 0, 0);  // top left, bottom left, top right: counter-clockwise
    });
    return p[(2 * kSize + 1) * 4] == 1.0f;
  };
  EXPECT_TRUE(covered(VK_CULL_MODE_NONE));
  EXPECT_TRUE(covered(VK_CULL_MODE_BACK_BIT));
  EXPECT_FALSE(covered(VK_CULL_MODE_FRONT_BIT));
}

TEST_F(Graphics, DepthTestAndDepthOnlyPipeline) {
  gpu::Image depth(device_,
                   {.name = "depth",
                    .format = VK_FORMAT_D32_SFLOAT,
                    .width = kSize,
                    .height = kSize,
                    .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
  gpu::GraphicsPipelineDesc d = desc();
  d.depthFormat = VK_FORMAT_D32_SFLOAT;
  const gpu::Pipeline pipeline(device_, d);
  gpu::Image color = target();
  const std::vector<float> p = render(color, &depth, [&](VkCommandBuffer cmd) {
    const auto draw = [&](float z, float red) {
      Constants c;
      c.z = z;
      c.colour[0] = red;
      bind(cmd, pipeline, c);
      vkCmdDraw(cmd, 6, 1, 0, 0);
    };
    draw(0.5f, 1);
    draw(0.25f, 2);  // in front: wins
    draw(0.75f, 3);  // behind: hidden
  });
  EXPECT_EQ(p[0], 2.0f);
  const std::vector<float> z =
      as<float>(gpu::download(device_, depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL));
  EXPECT_EQ(z[0], 0.25f);
  EXPECT_EQ(z[kSize - 1], 1.0f);
}

TEST_F(Graphics, NoFragmentShader) {
  gpu::Image depth(device_,
                   {.name = "depth",
                    .format = VK_FORMAT_D32_SFLOAT,
                    .width = kSize,
                    .height = kSize,
                    .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
  gpu::GraphicsPipelineDesc d = desc();
  d.fragment = nullptr;
  d.depthFormat = VK_FORMAT_D32_SFLOAT;
  const gpu::Pipeline pipeline(device_, d);
  gpu::Image color = target();
  render(color, &depth, [&](VkCommandBuffer cmd) {
    bind(cmd, pipeline, {});
    vkCmdDraw(cmd, 6, 1, 0, 0);
  });
  EXPECT_EQ(as<float>(gpu::download(device_, depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL))[0], 0.5f);
}

TEST_F(Graphics, AdditiveBlend) {
  gpu::GraphicsPipelineDesc d = desc();
  d.additiveBlend = true;
  const gpu::Pipeline pipeline(device_, d);
  gpu::Image color = target();
  const std::vector<float> p = render(color, nullptr, [&](VkCommandBuffer cmd) {
    bind(cmd, pipeline, {});
    for (int i = 0; i < 3; ++i) vkCmdDraw(cmd, 6, 1, 0, 0);
  });
  EXPECT_EQ(p[0], 3.0f);
  EXPECT_EQ(p[1], 1.5f);
}

TEST_F(Graphics, LayersFromTheVertexShader) {
  if (device_.lacks("shaderOutputLayer")) GTEST_SKIP() << "the device has no shaderOutputLayer";
  const gpu::Pipeline pipeline(device_, desc({{"LAYERED", "1"}}));
  gpu::Image color = target(4);
  const std::vector<float> p = render(color, nullptr, [&](VkCommandBuffer cmd) {
    bind(cmd, pipeline, {});
    vkCmdDraw(cmd, 6, 3, 0, 0);  // layer 3 stays empty
  });
  for (uint32_t layer = 0; layer < 4; ++layer) {
    const float* texel = &p[layer * kSize * kSize * 4];
    EXPECT_EQ(texel[0], layer < 3 ? 1.0f : 0.0f) << layer;
    EXPECT_EQ(texel[2], layer < 3 ? float(layer) : 0.0f) << layer;
  }
}

TEST_F(Graphics, ClipDistance) {
  const gpu::Pipeline pipeline(device_, desc({{"CLIPPED", "1"}}));
  gpu::Image color = target();
  const std::vector<float> p = render(color, nullptr, [&](VkCommandBuffer cmd) {
    bind(cmd, pipeline, {});
    vkCmdDraw(cmd, 6, 1, 0, 0);
  });
  EXPECT_EQ(p[0], 1.0f);
  EXPECT_EQ(p[(kSize - 1) * kSize * 4], 0.0f);
}

}  // namespace
}  // namespace fovea
