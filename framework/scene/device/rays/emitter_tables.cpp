#include "framework/scene/device/rays/emitter_tables.h"

#include <algorithm>
#include <bit>
#include <glm/glm.hpp>
#include <vector>

#include "framework/gpu/barrier.h"
#include "framework/gpu/device.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/gpu/shader/shader.h"
#include "framework/scene/device/named_buffers.h"
#include "framework/scene/device/rays/long_table.h"
#include "framework/scene/tables/emitter_table.h"

namespace fovea::scene {
struct EmitterTables::Impl {
  gpu::Device& device;
  gpu::Buffer texels;
  uint32_t nodes = 0;  // of the tree, if any emitter may move
  gpu::Pipeline refit;

  Impl(gpu::Device& d, const Scene& scene, const Geometry& geometry, bool fullMaterials, bool wanted)
      : device(d) {
    std::vector<glm::uvec4> list =
        wanted ? emitterTable(scene, geometry, fullMaterials) : std::vector<glm::uvec4>(1);
    const bool moves = std::ranges::any_of(
        geometry.emissive, [&](uint32_t triangle) { return triangle >= geometry.staticTriangles; });
    if (const uint32_t count = list[0].x; moves && count > 0) {
      nodes = 2 * std::bit_ceil(count);
      refit = gpu::Pipeline(d, gpu::ComputePipelineDesc{d.shaders().compile("scene/refit_emitters.comp")});
    }
    texels = longTable(d, "light sources that rays are aimed at", std::move(list));
  }
};

EmitterTables::EmitterTables(gpu::Device& device, const Scene& scene, const Geometry& geometry,
                             bool fullMaterials, bool wanted)
    : impl_(std::make_unique<Impl>(device, scene, geometry, fullMaterials, wanted)) {}
EmitterTables::~EmitterTables() = default;

void EmitterTables::record(VkCommandBuffer cmd, gpu::Buffer& positions, gpu::Buffer& triangles) {
  if (impl_->nodes == 0) return;
  const gpu::Pipeline& pipeline = impl_->refit;
  constexpr auto kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  gpu::memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, kCompute,
                     VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  bindNamed(impl_->device, cmd, pipeline, {},
            {{"Positions", &positions}, {"Triangles", &triangles}, {"Emitters", &impl_->texels}});
  const uint32_t nodes = impl_->nodes;  // each has a group
  vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0, sizeof nodes, &nodes);
  dispatchRows(cmd, nodes);
}

gpu::Buffer& EmitterTables::texels() const { return impl_->texels; }

}  // namespace fovea::scene
