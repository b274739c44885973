// Tests the choice of a device, the message when there is none, validation, and the caches.
#include "framework/gpu/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "fovea/error.h"
#include "framework/gpu/physical_device.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/session/test_device.h"
#include "tests/gpu/command_helpers.h"

namespace fovea {
namespace {

using namespace test;  // NOLINT: helpers
using testing::HasSubstr;

template <class F>
std::string noDevice(F f) {
  try {
    f();
  } catch (const Error& e) {
    EXPECT_EQ(int(e.code()), int(ExitCode::NoDevice)) << e.what();
    return e.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(DeviceChoice, ListingDescribesTheDevices) {
  const std::vector<gpu::DeviceInfo> list = gpu::listDevices();
  ASSERT_FALSE(list.empty());
  for (size_t i = 0; i < list.size(); ++i) {
    EXPECT_EQ(list[i].index, i);
    EXPECT_FALSE(list[i].name.empty());
    EXPECT_FALSE(list[i].driver.empty());
    EXPECT_GT(list[i].memoryBytes, 0u);
    EXPECT_THAT(list[i].apiVersion, testing::MatchesRegex("1\\.[0-9]+\\.[0-9]+"));
  }
}

TEST(DeviceChoice, ByIndexAndByPartOfTheName) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.validation = gpu::Validation::Off;
  const gpu::DeviceInfo first = gpu::listDevices().at(0);
  if (!first.missing.empty()) GTEST_SKIP() << first.name << " is not usable";
  options.device = "0";
  EXPECT_THAT(gpu::Device(options).name(), HasSubstr(first.name));
  options.device = first.name.substr(0, 4);
  for (char& c : options.device) c = char(std::toupper(c));
  EXPECT_THAT(gpu::Device(options).name(), HasSubstr(first.name));
}

TEST(DeviceChoice, WrongChoiceListsWhatThereIs) {
  gpu::DeviceOptions options = testDeviceOptions();
  for (const char* wrong : {"nonexistent", "99", "0x", "-1"}) {
    options.device = wrong;
    const std::string text = noDevice([&] { gpu::Device device(options); });
    EXPECT_THAT(text, HasSubstr(wrong));
    EXPECT_THAT(text, HasSubstr("0: " + gpu::listDevices().at(0).name));
  }
}

gpu::PhysicalDevice candidate(uint32_t index, VkPhysicalDeviceType type, const std::string& name,
                              std::vector<std::string> missing = {}) {
  gpu::PhysicalDevice d;
  d.type = type;
  d.info.index = index;
  d.info.name = name;
  d.info.missing = std::move(missing);
  return d;
}

TEST(DeviceChoice, BestUsableOneIsTaken) {
  const std::vector<gpu::PhysicalDevice> devices{
      candidate(0, VK_PHYSICAL_DEVICE_TYPE_CPU, "llvmpipe"),
      candidate(1, VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, "Old Card", {"dynamicRendering", "maintenance4"}),
      candidate(2, VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, "Graphics 500"),
      candidate(3, VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, "New Card"),
      candidate(4, VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, "New Card")};
  EXPECT_EQ(gpu::choose(devices, "").info.index, 3u);  // the first of equals
  EXPECT_EQ(gpu::choose(devices, "card").info.index, 3u);
  EXPECT_EQ(gpu::choose(devices, "4").info.index, 4u);
  EXPECT_EQ(gpu::choose(devices, "LLVM").info.index, 0u);
  const std::string text = noDevice([&] { gpu::choose(devices, "old"); });
  EXPECT_THAT(text, HasSubstr("`Old Card` lacks dynamicRendering, maintenance4"));
  const std::string none = noDevice([&] { gpu::choose({devices[1]}, ""); });
  EXPECT_THAT(none, HasSubstr("no usable Vulkan device"));
  EXPECT_THAT(none, HasSubstr("maintenance4"));
  EXPECT_THAT(noDevice([&] { gpu::choose({}, ""); }), HasSubstr("mesa-vulkan-drivers"));
}

// Runs in a process of its own, because the loader reads the variable only once.
TEST(NoDeviceDeathTest, NoDriver) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto child = [] {
    setenv("VK_ICD_FILENAMES", "/nonexistent/icd.json", 1);
    setenv("VK_DRIVER_FILES", "/nonexistent/icd.json", 1);
    if (!gpu::listDevices().empty()) std::exit(99);
    try {
      gpu::DeviceOptions options;
      options.useCache = false;
      gpu::Device device(options);
    } catch (const Error& e) {
      std::fprintf(stderr, "%s\n", e.what());
      std::exit(int(e.code()));
    }
    std::exit(0);
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(int(ExitCode::NoDevice)), "no Vulkan device found");
}

TEST(NoDeviceDeathTest, MissingValidationLayer) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto child = [] {
    setenv("VK_LAYER_PATH", "/nonexistent", 1);
    try {
      gpu::DeviceOptions options;
      options.useCache = false;
      options.validation = gpu::Validation::On;
      gpu::Device device(options);
    } catch (const Error& e) {
      std::fprintf(stderr, "%s\n", e.what());
      std::exit(int(e.code()));
    }
    std::exit(0);
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(int(ExitCode::NoDevice)),
              "VK_LAYER_KHRONOS_validation is not installed");
}

// ---- Features to do without -------------------------------------------------------------------------------

TEST(Without, LeavesTheFeatureOutAndTellsShaders) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.useCache = false;
  options.without = gpu::dispensableFeatures();
  gpu::Device device(options);
  EXPECT_FALSE(device.features().geometryShader);
  EXPECT_FALSE(device.features().shaderDrawParameters);
  EXPECT_FALSE(device.features().shaderOutputLayer);
  EXPECT_FALSE(device.features().shaderInt64);
  EXPECT_FALSE(device.pushesDescriptors());
  EXPECT_THAT(device.name(), HasSubstr("without geometryShader"));
  std::string source = "layout(local_size_x = 1) in;\n";
  for (const std::string& feature : options.without)
    source += "#ifndef WITHOUT_" + feature + "\n#error not defined\n#endif\n";
  device.shaders().compileSource("told.comp", source + "void main() {}\n");
}

// A shader that uses a feature all the same is refused, not handed to a driver that may do anything.
TEST(Without, ShadersThatUseTheFeatureAreRefused) {
  const struct {
    const char *feature, *body;
  } uses[] = {{"shaderDrawParameters", "gl_Position = vec4(gl_DrawID);"},
              {"shaderDrawParameters", "gl_Position = vec4(gl_BaseInstance);"},
              {"shaderOutputLayer", "gl_Layer = 1; gl_Position = vec4(0);"}};
  gpu::DeviceOptions options = testDeviceOptions();
  options.without = gpu::dispensableFeatures();
  gpu::Device device(options);
  for (const auto& [feature, body] : uses) {
    gpu::GraphicsPipelineDesc desc;
    desc.vertex = device.shaders().compileSource(
        "user.vert", std::string("#version 460\n#extension GL_ARB_shader_viewport_layer_array : enable\n") +
                         "void main() { " + body + " }\n");
    desc.depthFormat = VK_FORMAT_D32_SFLOAT;
    const std::string text = noDevice([&] { gpu::Pipeline pipeline(device, desc); });
    EXPECT_THAT(text, HasSubstr("user.vert"));
    EXPECT_THAT(text, HasSubstr(feature));
  }
  gpu::GraphicsPipelineDesc desc;
  desc.vertex = device.shaders().compileSource("plain.vert", "void main() { gl_Position = vec4(0); }\n");
  desc.fragment = device.shaders().compileSource(
      "user.frag", "layout(location = 0) out vec4 target;\nvoid main() { target = vec4(gl_PrimitiveID); }\n");
  desc.colorFormats = {VK_FORMAT_R32G32B32A32_SFLOAT};
  EXPECT_THAT(noDevice([&] { gpu::Pipeline pipeline(device, desc); }), HasSubstr("geometryShader"));
}

TEST(Without, UnknownFeaturesAreRefused) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.without = {"geometryShaders"};
  try {
    gpu::Device device(options);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(int(e.code()), int(ExitCode::Usage));
    EXPECT_THAT(e.what(), HasSubstr("`geometryShaders`"));
    for (const std::string& feature : gpu::dispensableFeatures()) EXPECT_THAT(e.what(), HasSubstr(feature));
  }
}

// Sets that stand in for pushed descriptors serve again when a command buffer begins anew, and each command has its
// own.
TEST(Without, DescriptorSetsHoldWhatTheirCommandWasGiven) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.without = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
  gpu::Device device(options);
  const gpu::Buffer results(device, {"results", 4 * 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
  const gpu::Pipeline pipeline(device,
                               gpu::ComputePipelineDesc{device.shaders().compileSource("fill.comp", R"(
layout(local_size_x = 1) in;
layout(std430) buffer Data { uint data[]; };
layout(push_constant) uniform C { uint value; };
void main() { data[0] = value; }
)")});
  for (uint32_t round = 0; round < 3; ++round) {
    device.runOnce([&](VkCommandBuffer cmd) {
      for (uint32_t i = 0; i < 4; ++i) {
        vkCmdBindPipeline(cmd, pipeline.bindPoint(), pipeline.handle());
        const VkDescriptorBufferInfo info{results.handle(), 256 * i, 256};
        std::vector<VkWriteDescriptorSet> writes{write(pipeline, "Data")};
        writes[0].pBufferInfo = &info;
        device.pushDescriptorSet(cmd, pipeline.bindPoint(), pipeline.layout(), 0, writes);
        const uint32_t value = 10 * round + i;
        vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0, 4, &value);
        vkCmdDispatch(cmd, 1, 1, 1);
      }
    });
    const std::vector<uint32_t> values = as<uint32_t>(gpu::download(device, results));
    for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(values.at(64 * i), 10 * round + i);
  }
  EXPECT_EQ(device.validationMessages(), std::vector<std::string>{});
}

TEST(Check, ResultsMapToExitCodes) {
  const auto code = [](VkResult result) {
    try {
      gpu::check(result, "doing a thing");
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("doing a thing"));
      EXPECT_THAT(e.what(), HasSubstr(gpu::resultName(result)));
      return e.code();
    }
    return ExitCode::Ok;
  };
  EXPECT_EQ(code(VK_SUCCESS), ExitCode::Ok);
  EXPECT_EQ(code(VK_ERROR_OUT_OF_DEVICE_MEMORY), ExitCode::OutOfMemory);
  EXPECT_EQ(code(VK_ERROR_OUT_OF_HOST_MEMORY), ExitCode::OutOfMemory);
  EXPECT_EQ(code(VK_ERROR_DEVICE_LOST), ExitCode::DeviceLost);
  EXPECT_EQ(code(VK_ERROR_UNKNOWN), ExitCode::Internal);
}

// ---- Validation -------------------------------------------------------------------------------------------

TEST(Validation, MistakesAreCaught) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.validation = gpu::Validation::On;
  gpu::Device device(options);
  EXPECT_EQ(device.validationMessages(), std::vector<std::string>{});
  const gpu::Buffer buffer(device, {"victim of the test", 64, 0});
  device.runOnce([&](VkCommandBuffer cmd) {  // without the usage that this needs
    vkCmdBindIndexBuffer(cmd, buffer.handle(), 0, VK_INDEX_TYPE_UINT32);
  });
  const std::vector<std::string> messages = device.validationMessages();
  ASSERT_FALSE(messages.empty());
  EXPECT_THAT(messages[0], HasSubstr("vkCmdBindIndexBuffer"));
  EXPECT_THAT(messages[0], HasSubstr("victim of the test"));  // objects carry their names
  device.clearValidationMessages();
  EXPECT_TRUE(device.validationMessages().empty());
}

TEST(Validation, LeakedObjectsAreReportedAtTheEnd) {
  std::vector<std::string> messages;
  gpu::DeviceOptions options = testDeviceOptions();
  options.validation = gpu::Validation::On;
  options.onValidationMessage = [&](const std::string& message) { messages.push_back(message); };
  {
    gpu::Device device(options);
    const VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
    VkFence fence = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateFence(device.handle(), &info, nullptr, &fence), VK_SUCCESS);
    EXPECT_TRUE(messages.empty());
  }
  EXPECT_THAT(messages, testing::Contains(HasSubstr("VK_OBJECT_TYPE_FENCE")));
}

void copyTwice(gpu::Device& device, bool withBarrier) {
  const gpu::Buffer a(device, {"a", 64, 0}), b(device, {"b", 64, 0}), c(device, {"c", 64, 0});
  device.runOnce([&](VkCommandBuffer cmd) {
    const VkBufferCopy copy{0, 0, 64};
    vkCmdCopyBuffer(cmd, a.handle(), b.handle(), 1, &copy);
    if (withBarrier)
      barrier(cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
              VK_ACCESS_2_TRANSFER_READ_BIT);
    vkCmdCopyBuffer(cmd, b.handle(), c.handle(), 1, &copy);
  });
}

TEST(Validation, SynchronizationModeSeesAMissingBarrier) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.validation = gpu::Validation::Synchronization;
  gpu::Device device(options);
  copyTwice(device, true);
  EXPECT_EQ(device.validationMessages(), std::vector<std::string>{});
  copyTwice(device, false);
  EXPECT_THAT(device.validationMessages(), testing::Contains(HasSubstr("READ_AFTER_WRITE")));
}

// An index past the end of a storage buffer, which only the instrumented shader can see.
TEST(Validation, GpuAssistedModeSeesAnOverrun) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.validation = gpu::Validation::GpuAssisted;
  gpu::Device device(options);
  if (device.lacks("shaderInt64"))
    GTEST_SKIP() << "without 64-bit integers the layer leaves out some checks, and says so";
  const gpu::Buffer buffer(device, {"short", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
  const gpu::Pipeline pipeline(device,
                               gpu::ComputePipelineDesc{device.shaders().compileSource("overrun.comp", R"(
layout(local_size_x = 1) in;
layout(std430) buffer Data { uint data[]; };
layout(push_constant) uniform C { uint index; };
void main() { data[index] = 1; }
)")});
  const auto run = [&](uint32_t index) {
    device.runOnce([&](VkCommandBuffer cmd) {
      vkCmdBindPipeline(cmd, pipeline.bindPoint(), pipeline.handle());
      const VkDescriptorBufferInfo info{buffer.handle(), 0, VK_WHOLE_SIZE};
      std::vector<VkWriteDescriptorSet> writes{write(pipeline, "Data")};
      writes[0].pBufferInfo = &info;
      device.pushDescriptorSet(cmd, pipeline.bindPoint(), pipeline.layout(), 0, writes);
      vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0, 4, &index);
      vkCmdDispatch(cmd, 1, 1, 1);
    });
  };
  run(15);
  EXPECT_EQ(device.validationMessages(), std::vector<std::string>{});
  run(16);
  EXPECT_THAT(device.validationMessages(), testing::Contains(HasSubstr("out of bounds")));
}

TEST(Validation, BestPracticesModeIsQuietForPlainWork) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.validation = gpu::Validation::BestPractices;
  gpu::Device device(options);
  copyTwice(device, true);
  EXPECT_EQ(device.validationMessages(), std::vector<std::string>{});
}

// ---- Caches -----------------------------------------------------------------------------------------------

TEST(PipelineCache, SavedOnDestructionAndDamageIsIgnored) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.cacheDirectory =
      std::filesystem::path(testing::TempDir()) / ("fovea-pipelines-" + std::to_string(getpid()));
  const auto make = [&] {
    gpu::Device device(options);
    const gpu::Pipeline pipeline(device,
                                 gpu::ComputePipelineDesc{device.shaders().compileSource(
                                     "trivial.comp", "layout(local_size_x = 1) in;\nvoid main() {}\n")});
    EXPECT_TRUE(bool(pipeline));
    EXPECT_EQ(device.validationMessages(), std::vector<std::string>{});
  };
  const auto blob = [&]() -> std::filesystem::path {
    for (const auto& entry : std::filesystem::directory_iterator(options.cacheDirectory)) {
      if (entry.path().filename().string().starts_with("pipelines-")) return entry.path();
    }
    return {};
  };
  make();
  ASSERT_FALSE(blob().empty());
  const auto size = std::filesystem::file_size(blob());
  make();  // with the blob
  std::ofstream(blob(), std::ios::binary) << "damaged";
  make();
  EXPECT_EQ(std::filesystem::file_size(blob()), size);
  std::filesystem::remove_all(options.cacheDirectory);
}

TEST(PipelineCache, OffMeansNoFiles) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.cacheDirectory =
      std::filesystem::path(testing::TempDir()) / ("fovea-nocache-" + std::to_string(getpid()));
  options.useCache = false;
  { gpu::Device device(options); }
  EXPECT_FALSE(std::filesystem::exists(options.cacheDirectory));
}

}  // namespace
}  // namespace fovea
