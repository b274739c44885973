// Tests buffers, images and transfers, and what happens when memory runs out.
#include "framework/gpu/resources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "fovea/error.h"
#include "framework/gpu/format.h"
#include "framework/session/test_device.h"
#include "tests/gpu/command_helpers.h"

namespace fovea {
namespace {

using namespace test;  // NOLINT: helpers
using testing::HasSubstr;

std::vector<uint32_t> counting(size_t count, uint32_t first) {
  std::vector<uint32_t> v(count);
  std::iota(v.begin(), v.end(), first);
  return v;
}

// The data needs more than one staging piece and starts at an offset; the bytes around it must not change.
TEST(Transfer, LargeBufferInPieces) {
  gpu::Device& device = testDevice();
  const size_t count = (40u << 20) / 4 + 13;
  gpu::Buffer buffer(device, {"large", count * 4, 0});
  const std::vector<uint32_t> all = counting(count, 7), part = counting(count - 10, 1000);
  gpu::upload(device, buffer, std::as_bytes(std::span(all)));
  gpu::upload(device, buffer, std::as_bytes(std::span(part)), 4 * 4);
  std::vector<uint32_t> expected = all;
  std::copy(part.begin(), part.end(), expected.begin() + 4);
  EXPECT_EQ(as<uint32_t>(gpu::download(device, buffer)), expected);
}

TEST(Transfer, MappedBuffers) {
  gpu::Device& device = testDevice();
  gpu::Buffer upload(device, {"mapped", 64, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::MemoryKind::Upload});
  ASSERT_NE(upload.mapped(), nullptr);
  const std::vector<uint32_t> data = counting(16, 3);
  gpu::upload(device, upload, std::as_bytes(std::span(data)));
  EXPECT_EQ(as<uint32_t>(gpu::download(device, upload)), data);
  EXPECT_EQ(gpu::Buffer(device, {"device", 64, 0}).mapped() != nullptr, device.sharesMemory());
}

TEST(Transfer, OverrunsAreRefused) {
  gpu::Device& device = testDevice();
  gpu::Buffer buffer(device, {"small", 64, 0});
  const std::vector<std::byte> data(60);
  EXPECT_THROW(gpu::upload(device, buffer, data, 8), Error);
  EXPECT_THROW(gpu::upload(device, buffer, data, ~uint64_t(0)), Error);
  EXPECT_NO_THROW(gpu::upload(device, buffer, data, 4));
}

struct ImageCase {
  const char* name;
  VkImageType type;
  VkFormat format;
  uint32_t width, height, depth, layers;
};

class ImageTransfer : public testing::TestWithParam<ImageCase> {};

TEST_P(ImageTransfer, RoundTrip) {
  gpu::Device& device = testDevice();
  const ImageCase& c = GetParam();
  const bool depthFormat = gpu::formatInfo(c.format).depth;
  gpu::Image image(device, {.name = c.name,
                            .type = c.type,
                            .format = c.format,
                            .width = c.width,
                            .height = c.height,
                            .depth = c.depth,
                            .layers = c.layers,
                            .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                     VK_IMAGE_USAGE_SAMPLED_BIT});
  const size_t bytes =
      size_t(c.width) * c.height * c.depth * c.layers * gpu::formatInfo(c.format).bytesPerTexel;
  std::vector<std::byte> data(bytes);
  if (depthFormat) {  // depth values have to be numbers in [0, 1]
    for (size_t i = 0; i < bytes / 4; ++i) {
      const float value = float(i) / float(bytes);
      std::memcpy(data.data() + i * 4, &value, 4);
    }
  } else {
    for (size_t i = 0; i < bytes; ++i)
      data[i] = std::byte((i * 37 + i / 251) & 0x3f);  // no NaN in any float format
  }
  const VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  gpu::upload(device, image, data, layout);
  EXPECT_EQ(gpu::download(device, image, layout), data);
  EXPECT_EQ(gpu::download(device, image, layout), data);  // the first one left the layout as it was
  EXPECT_THROW(gpu::upload(device, image, std::span(data).first(bytes - 1), layout), Error);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, ImageTransfer,
    testing::Values(ImageCase{"plain", VK_IMAGE_TYPE_2D, VK_FORMAT_R16G16B16A16_SFLOAT, 17, 9, 1, 1},
                    ImageCase{"array", VK_IMAGE_TYPE_2D, VK_FORMAT_R32_UINT, 8, 5, 1, 7},
                    ImageCase{"volume", VK_IMAGE_TYPE_3D, VK_FORMAT_R8G8B8A8_UNORM, 6, 5, 4, 1},
                    ImageCase{"narrow", VK_IMAGE_TYPE_2D, VK_FORMAT_R8_UINT, 3, 3, 1, 2},
                    ImageCase{"depth", VK_IMAGE_TYPE_2D, VK_FORMAT_D32_SFLOAT, 16, 16, 1, 2}),
    [](const testing::TestParamInfo<ImageCase>& info) { return info.param.name; });

TEST(Image, ViewsAreMadeOnce) {
  gpu::Device& device = testDevice();
  gpu::Image image(device, {.name = "views",
                            .format = VK_FORMAT_R8G8B8A8_UNORM,
                            .width = 16,
                            .height = 8,
                            .layers = 3,
                            .mips = 5,
                            .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
  EXPECT_EQ(image.view(), image.view());
  EXPECT_EQ(image.mipView(2), image.mipView(2));
  EXPECT_NE(image.mipView(1), image.mipView(2));
  EXPECT_NE(image.layerView(1, 0), image.layerView(1, 1));
  EXPECT_NE(image.layerView(1, 0), image.mipView(1));
  EXPECT_THROW(image.mipView(5), Error);
  EXPECT_THROW(image.layerView(0, 3), Error);
  gpu::Image moved = std::move(image);
  EXPECT_FALSE(image);  // NOLINT(bugprone-use-after-move): this is what is tested
  EXPECT_EQ(moved.name(), "views");
}

// Two resources share one allocation, as in the graph's heap. The caller keeps the ownership of the memory.
TEST(Image, PlacedResources) {
  gpu::Device& device = testDevice();
  const gpu::ImageDesc imageDesc{.name = "placed image",
                                 .format = VK_FORMAT_R32_UINT,
                                 .width = 32,
                                 .height = 32,
                                 .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
  const gpu::BufferDesc bufferDesc{"placed buffer", 4096, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
  const VkMemoryRequirements a = gpu::memoryRequirements(device, imageDesc);
  const VkMemoryRequirements b = gpu::memoryRequirements(device, bufferDesc);
  EXPECT_GE(a.size, 4096u);
  EXPECT_GE(b.size, 4096u);
  const uint64_t offset = (a.size + b.alignment - 1) / b.alignment * b.alignment;
  const uint64_t before = device.allocatedBytes();
  const VkDeviceMemory heap = device.allocate(offset + b.size, a.memoryTypeBits & b.memoryTypeBits,
                                              VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, "test heap");
  {
    gpu::Image image(device, imageDesc, heap, 0);
    gpu::Buffer buffer(device, bufferDesc, heap, offset);
    EXPECT_EQ(device.allocatedBytes(), before + offset + b.size);
    const std::vector<uint32_t> one = counting(1024, 0), two = counting(1024, 5000);
    gpu::upload(device, image, std::as_bytes(std::span(one)), VK_IMAGE_LAYOUT_GENERAL);
    gpu::upload(device, buffer, std::as_bytes(std::span(two)));
    EXPECT_EQ(as<uint32_t>(gpu::download(device, image, VK_IMAGE_LAYOUT_GENERAL)), one);
    EXPECT_EQ(as<uint32_t>(gpu::download(device, buffer)), two);
  }
  device.release(heap);
  EXPECT_EQ(device.allocatedBytes(), before);
}

// ---- Limits -----------------------------------------------------------------------------------------------

template <class F>
std::string errorOf(ExitCode code, F f) {
  try {
    f();
  } catch (const Error& e) {
    EXPECT_EQ(int(e.code()), int(code)) << e.what();
    return e.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(Limits, ImagesBeyondTheDevice) {
  gpu::Device& device = testDevice();
  gpu::ImageDesc desc{.name = "atlas", .format = VK_FORMAT_R32_SFLOAT, .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
  const auto make = [&] { gpu::Image image(device, desc); };
  desc.layers = device.limits().maxImageArrayLayers + 1;
  const std::string layers = errorOf(ExitCode::BadInput, make);
  EXPECT_THAT(layers, HasSubstr("`atlas`"));
  EXPECT_THAT(layers, HasSubstr("maxImageArrayLayers"));
  EXPECT_THAT(layers, HasSubstr(std::to_string(device.limits().maxImageArrayLayers)));
  desc.layers = 1;
  desc.width = device.limits().maxImageDimension2D + 1;
  EXPECT_THAT(errorOf(ExitCode::BadInput, make), HasSubstr("maxImageDimension2D"));
  desc.width = 0;
  EXPECT_THAT(errorOf(ExitCode::Internal, make), HasSubstr("width of 0"));
  desc.width = 8;
  desc.mips = 5;
  EXPECT_THAT(errorOf(ExitCode::BadInput, make), HasSubstr("mip count"));
  desc.mips = 1;
  desc.format = VK_FORMAT_E5B9G9R9_UFLOAT_PACK32;
  desc.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  EXPECT_THAT(errorOf(ExitCode::NoDevice, make), HasSubstr("rgb9_e5"));
}

TEST(Limits, BuffersBeyondTheDevice) {
  gpu::Device& device = testDevice();
  EXPECT_THAT(errorOf(ExitCode::OutOfMemory,
                      [&] {
                        gpu::Buffer(device, {"vast", ~uint64_t(0) / 2, 0});
                      }),
              HasSubstr("`vast`"));
  errorOf(ExitCode::Internal, [&] { gpu::Buffer(device, {"nothing", 0, 0}); });
  gpu::Buffer texels(device, {"texels", (uint64_t(device.limits().maxTexelBufferElements) + 1) * 1,
                              VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT});
  EXPECT_THAT(errorOf(ExitCode::BadInput, [&] { texels.texelView(VK_FORMAT_R8_UINT); }),
              HasSubstr("maxTexelBufferElements"));
}

TEST(Limits, MemoryLimitOfTheUser) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.memoryLimit = 10u << 20;
  gpu::Device device(options);
  EXPECT_EQ(device.memoryLimit(), 10u << 20);
  {
    const gpu::Buffer first(device, {"first", 6u << 20, 0});
    EXPECT_EQ(device.allocatedBytes(), 6u << 20);
    const std::string text = errorOf(ExitCode::OutOfMemory, [&] {
      gpu::Buffer(device, {"second", 5u << 20, 0});
    });
    EXPECT_THAT(text, HasSubstr("`second` needs 5.0 MiB"));
    EXPECT_THAT(text, HasSubstr("6.0 MiB of 10.0 MiB"));
    EXPECT_THAT(text, HasSubstr("raise the memory limit"));
    EXPECT_NO_THROW(gpu::Buffer(device, {"fits", 4u << 20, 0}));
    EXPECT_EQ(device.allocatedBytes(), 6u << 20);  // the failed and the passing one left nothing behind
  }
  EXPECT_EQ(device.allocatedBytes(), 0u);
  EXPECT_EQ(device.peakAllocatedBytes(), 10u << 20);
  EXPECT_EQ(device.validationMessages(), std::vector<std::string>{});
}

// Without a limit from the user, the size of the heap itself counts, though some drivers grant more.
TEST(Limits, HeapSizeHoldsWithoutALimit) {
  gpu::Device& device = testDevice();
  const uint64_t heap = device.memoryLimit();
  EXPECT_GT(heap, 0u);
  const std::string text = errorOf(ExitCode::OutOfMemory, [&] {
    device.allocate(heap + 1, ~0u, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, "too much");
  });
  EXPECT_THAT(text, HasSubstr("`too much`"));
}

}  // namespace
}  // namespace fovea
