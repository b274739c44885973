// Runs graphs of test passes over an empty scene.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fovea/pass.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/run/execute.h"
#include "framework/scene/device/gpu_scene.h"

namespace fovea::test {

constexpr uint32_t kSide = 24;
constexpr VkFormat kFormat = VK_FORMAT_R32_UINT;

// The image that pass test-fill writes as `value`, filled with its `key` plus the frame's number.
inline graph::ResourceSpec image() { return graph::image2D(kFormat, kSide, kSide); }

void addTestShaders(graph::PrepareContext& context);

struct Runner {
  scene::Scene scene;
  scene::Geometry geometry;
  std::unique_ptr<scene::GpuScene> gpuScene;
  std::unique_ptr<graph::Executor> executor;
  std::shared_ptr<const graph::Plan> plan;
  uint64_t next = 0;

  explicit Runner(const std::string& text, const graph::CompileOptions& extra = {});
  graph::FrameResult frame(bool cameraCut = false);
};

std::vector<uint32_t> words(const graph::FrameResult& result, const std::string& output);
void expectAll(const graph::FrameResult& result, const std::string& output, uint32_t expected);

}  // namespace fovea::test
