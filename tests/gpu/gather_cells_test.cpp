// Tests the cells in which light is remembered on the device (shaders/rays/gather_cache.glsl).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/gpu/shader/shader.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/frame.h"
#include "framework/session/test_device.h"
#include "shaders/records/gather_cache.h"
#include "tests/gpu/command_helpers.h"
#include "tests/support/shapes.h"

namespace fovea::scene {
namespace {

using test::testDevice;

// As in the shader below.
struct Sample {
  glm::vec3 light;
  float width = 1;  // of cells, m
  glm::vec3 position;
  float unused0 = 0;
  glm::vec3 normal{0, 1, 0};
  float unused1 = 0;
  glm::vec3 jitter{0};
  float unused2 = 0;
};

// In the cell that lies at x = cell + 1/2.
Sample sampleOf(uint32_t cell, glm::vec3 light) { return {light, 1, {float(cell) + 0.5f, 0.5f, 0.5f}}; }

class Cells {
 public:
  Cells() : device_(testDevice()), scene_(device_, model(), geometry_, 1, false, {.device = true}) {
    cells_ = gpu::Buffer(device_,
                         {"cells", kGatherCells * sizeof(GatherCell), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    clear();
    add_ = pipeline(R"(
struct Sample { vec3 light; float width; vec3 position, normal, jitter; };
layout(std430) readonly buffer Samples { Sample samples[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  Sample s = samples[i];
  addToCell(cellOf(s.position, s.normal, s.jitter, s.width), s.light);
}
)");
    merge_ = pipeline(R"(
void main() {
  if (gl_GlobalInvocationID.x < count) mergeSamples(gl_GlobalInvocationID.x, ageing);
}
)");
  }

  void clear() {
    const std::vector<GatherCell> none(kGatherCells);
    gpu::upload(device_, cells_, std::as_bytes(std::span(none)));
  }

  // One frame in which these samples come.
  void frame(std::vector<Sample> samples, float ageing = 0) {
    const uint32_t count = uint32_t(samples.size());
    samples.resize(std::max<size_t>(samples.size(), 1));
    gpu::Buffer list(device_,
                     {"samples", samples.size() * sizeof(Sample), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    gpu::upload(device_, list, std::as_bytes(std::span(samples)));
    run(add_, &list, count, ageing);
    run(merge_, nullptr, kGatherCells, ageing);
  }

  // Cells that are in the table, in the order of their red light.
  std::vector<GatherCell> known() {
    std::vector<GatherCell> all = test::as<GatherCell>(gpu::download(device_, cells_));
    std::erase_if(all, [](const GatherCell& c) { return c.key == 0; });
    std::ranges::sort(all, {}, [](const GatherCell& c) { return c.light.r; });
    return all;
  }

 private:
  const Scene& model() {
    model_.cameras.emplace_back();
    test::addQuad(model_, test::addMaterial(model_, glm::vec3(0.5f)), {}, {0, 0, 1}, {1, 0, 0});
    geometry_ = flatten(model_);
    return model_;
  }

  gpu::Pipeline pipeline(const std::string& body) {
    const std::string head = R"(#version 460
#extension GL_GOOGLE_include_directive : require
#define RAY_PASSAGE 0
#include "rays/gather_cache.glsl"
layout(local_size_x = 64) in;
layout(push_constant) uniform Constants { uint count; float ageing; };
)";
    return gpu::Pipeline(device_,
                         gpu::ComputePipelineDesc{device_.shaders().compileSource("cells.comp", head + body),
                                                  scene_.setLayout()});
  }

  void run(const gpu::Pipeline& pipeline, const gpu::Buffer* samples, uint32_t count, float ageing) {
    scene_.update(makeFrame(model_, geometry_, {8, 8}, 0, 1), 0);
    device_.runOnce([&](VkCommandBuffer cmd) {
      vkCmdBindPipeline(cmd, pipeline.bindPoint(), pipeline.handle());
      const VkDescriptorBufferInfo infos[2] = {
          {cells_.handle(), 0, VK_WHOLE_SIZE},
          {samples ? samples->handle() : VK_NULL_HANDLE, 0, VK_WHOLE_SIZE}};
      std::vector<VkWriteDescriptorSet> writes = {test::write(pipeline, "cells")};
      writes[0].pBufferInfo = &infos[0];
      if (samples) {
        writes.push_back(test::write(pipeline, "Samples"));
        writes[1].pBufferInfo = &infos[1];
      }
      device_.pushDescriptorSet(cmd, pipeline.bindPoint(), pipeline.layout(), 0, writes);
      const VkDescriptorSet set = scene_.set(0);
      const uint32_t offset = scene_.viewOffset(0);
      vkCmdBindDescriptorSets(cmd, pipeline.bindPoint(), pipeline.layout(), 1, 1, &set, 1, &offset);
      const struct {
        uint32_t count;
        float ageing;
      } constants{count, ageing};
      vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0, sizeof constants,
                         &constants);
      vkCmdDispatch(cmd, (count + 63) / 64 + (count == 0), 1, 1);
    });
  }

  gpu::Device& device_;
  Scene model_;
  Geometry geometry_;
  GpuScene scene_;
  gpu::Buffer cells_;
  gpu::Pipeline add_, merge_;
};

std::vector<Sample> samplesOf(uint32_t cell, int count, glm::vec3 light) {
  return std::vector<Sample>(size_t(count), sampleOf(cell, light));
}

TEST(GatherCells, MeanOfTheSamplesOfEachCell) {
  Cells cells;
  std::vector<Sample> samples = samplesOf(1, 300, {1, 2, 3});
  for (const Sample& s : samplesOf(2, 100, {2, 0.75f, 1e-6f})) samples.push_back(s);
  for (const Sample& s : samplesOf(2, 300, {6, 0.75f, 3e-6f})) samples.push_back(s);
  for (const Sample& s : samplesOf(3, 4000, glm::vec3(1e6f))) samples.push_back(s);  // words overflow
  cells.frame(samples);
  const auto known = cells.known();
  ASSERT_EQ(known.size(), 3u);
  const glm::vec3 want[] = {{1, 2, 3}, {5, 0.75f, 2.5e-6f}, glm::vec3(1e6f)};
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(known[size_t(i)].light[c], want[i][c], 1e-4f * want[i][c]) << i;
  for (const GatherCell& cell : known) EXPECT_EQ(cell.weight, kMostGathered) << "more do not count";
}

TEST(GatherCells, OldSamplesFadeAndAge) {
  Cells cells;
  cells.frame(samplesOf(5, 96, glm::vec3(1)));
  cells.frame(samplesOf(5, 32, glm::vec3(5)));
  EXPECT_FLOAT_EQ(cells.known()[0].light.r, 2);
  EXPECT_FLOAT_EQ(cells.known()[0].weight, 128);
  cells.frame(samplesOf(5, 64, glm::vec3(4)), 1 / 128.0f);  // 128 samples are worth 64
  EXPECT_FLOAT_EQ(cells.known()[0].light.r, 3);
  for (int i = 0; i < 20; ++i) cells.frame(samplesOf(5, 64, glm::vec3(7)));
  EXPECT_NEAR(cells.known()[0].light.r, 7, 0.02f);
  cells.frame({}, 16);
  EXPECT_LT(cells.known()[0].weight, kEnoughGathered);
}

// Cells without samples leave the table after a while, and others stay.
TEST(GatherCells, WhatIsNoLongerSeenLeaves) {
  Cells cells;
  cells.frame(samplesOf(1, 20, glm::vec3(1)));
  for (uint32_t frame = 1; frame < kMostIdle; ++frame) cells.frame(samplesOf(2, 1, glm::vec3(2)));
  EXPECT_EQ(cells.known().size(), 2u);
  cells.frame(samplesOf(2, 1, glm::vec3(2)));
  ASSERT_EQ(cells.known().size(), 1u);
  EXPECT_FLOAT_EQ(cells.known()[0].light.r, 2);
}

// Points of one cell share it, others do not; nor do the two sides of a thin wall, and cells of another width.
TEST(GatherCells, CellsOfSpace) {
  Cells cells;
  const auto at = [](glm::vec3 p, glm::vec3 n = {0, 1, 0}, float width = 0.3f, glm::vec3 jitter = {}) {
    return Sample{glm::vec3(1), width, p, 0, n, 0, jitter};  // 0.3 is rounded to 0.25
  };
  const auto same = [&](const Sample& a, const Sample& b) {
    cells.clear();
    cells.frame({a, b});
    return cells.known().size() == 1;
  };
  const glm::vec3 up(0, 1, 0);
  const Sample corner = at({0.01f, 0.01f, 0.01f});
  EXPECT_TRUE(same(corner, at({0.24f, 0.24f, 0.24f})));
  EXPECT_FALSE(same(corner, at({0.26f, 0.01f, 0.01f})));
  EXPECT_FALSE(same(corner, at({-0.01f, 0.01f, 0.01f})));
  EXPECT_TRUE(same(corner, at({0.26f, 0.01f, 0.01f}, up, 0.3f, {-0.1f, 0, 0})));
  EXPECT_FALSE(same(at({0, 0, 0}), at({0, 0, 0}, -up)));
  EXPECT_TRUE(same(at({0, 0, 0}, {0.1f, 0.9f, 0.1f}), at({0, 0, 0}, {-0.1f, 0.9f, 0.2f})));
  EXPECT_TRUE(same(at({5, 5, 5}, up, 0.27f), at({5, 5, 5}, up, 0.3f)));
  EXPECT_FALSE(same(at({5, 5, 5}, up, 0.6f), at({5, 5, 5}, up, 0.3f)));
}

// All cells that are wanted at the same time get a place, and none gets two.
TEST(GatherCells, ManyCellsAtOnce) {
  Cells cells;
  constexpr uint32_t kMany = 20000;
  std::vector<Sample> samples;
  for (uint32_t i = 0; i < 3 * kMany; ++i)
    samples.push_back(sampleOf(i % kMany, glm::vec3(float(1 + i % kMany))));
  cells.frame(samples);
  const auto known = cells.known();
  ASSERT_EQ(known.size(), size_t(kMany));
  for (uint32_t i = 0; i < kMany; ++i) {
    EXPECT_FLOAT_EQ(known[i].light.r, float(1 + i));
    EXPECT_EQ(known[i].weight, 3) << i;
  }
}

}  // namespace
}  // namespace fovea::scene
