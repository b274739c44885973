// Asks a shader that reads the scene (descriptor set 1), one invocation for each question.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/gpu/shader/shader.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/frame.h"
#include "framework/session/test_device.h"
#include "tests/gpu/command_helpers.h"

namespace fovea::test {

// source: a compute shader with groups of 64 that reads the storage buffer `Queries` and writes `Answers`, one element
// for each query; the scene is as in `frame`, and seen through one of its views.
template <class Answer, class Query>
std::vector<Answer> askScene(scene::GpuScene& scene, const scene::Frame& frame, const std::string& source,
                             const std::vector<Query>& queries, uint32_t view = 0) {
  gpu::Device& device = testDevice();
  gpu::Buffer in(device, {"queries", queries.size() * sizeof(Query), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
  gpu::Buffer out(device, {"answers", queries.size() * sizeof(Answer), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
  gpu::upload(device, in, std::as_bytes(std::span(queries)));
  const gpu::Pipeline pipeline(
      device,
      gpu::ComputePipelineDesc{device.shaders().compileSource("queries.comp", source), scene.setLayout()});
  scene.update(frame, 0);
  device.runOnce([&](VkCommandBuffer cmd) {
    scene.recordMoves(cmd, 0);
    constexpr auto kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    barrier(cmd, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, kCompute,
            VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
    vkCmdBindPipeline(cmd, pipeline.bindPoint(), pipeline.handle());
    const VkDescriptorBufferInfo infos[2] = {{in.handle(), 0, VK_WHOLE_SIZE},
                                             {out.handle(), 0, VK_WHOLE_SIZE}};
    VkWriteDescriptorSet writes[2] = {write(pipeline, "Queries"), write(pipeline, "Answers")};
    writes[0].pBufferInfo = &infos[0];
    writes[1].pBufferInfo = &infos[1];
    device.pushDescriptorSet(cmd, pipeline.bindPoint(), pipeline.layout(), 0, writes);
    const VkDescriptorSet set = scene.set(0);
    const uint32_t offset = scene.viewOffset(view);
    vkCmdBindDescriptorSets(cmd, pipeline.bindPoint(), pipeline.layout(), 1, 1, &set, 1, &offset);
    vkCmdDispatch(cmd, uint32_t(queries.size() + 63) / 64, 1, 1);
  });
  return as<Answer>(gpu::download(device, out));
}

// Runs `body` once for each query: it reads vec4 q and writes vec4 r[3]. The frame's last view is the one it sees. head:
// stands before all else. Returns three vectors for each query.
inline std::vector<glm::vec4> evaluate(scene::GpuScene& scene, const scene::Frame& frame,
                                       const std::vector<glm::vec4>& queries, const std::string& body,
                                       const std::string& head = "") {
  const std::string source = R"(#version 460
#extension GL_GOOGLE_include_directive : require
)" + head + R"(
#include "materials/passage.glsl"
#include "scene/objects.glsl"
#include "scene/scene.glsl"
layout(local_size_x = 64) in;
layout(std430) readonly buffer Queries { vec4 queries[]; };
layout(std430) writeonly buffer Answers { vec4 answers[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= queries.length()) return;
  vec4 q = queries[i];
  vec4 r[3] = vec4[3](vec4(0), vec4(0), vec4(0));
)" + body + R"(
  for (int k = 0; k < 3; ++k) answers[3u * i + k] = r[k];
}
)";
  const uint32_t view = frame.views.empty() ? 0 : uint32_t(frame.views.size() - 1);
  std::vector<glm::vec4> results;
  for (const auto& three : askScene<std::array<glm::vec4, 3>>(scene, frame, source, queries, view))
    results.insert(results.end(), three.begin(), three.end());
  return results;
}

}  // namespace fovea::test
