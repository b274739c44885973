#include "framework/scene/device/rays/ray_tables.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <vector>

#include "framework/gpu/barrier.h"
#include "framework/gpu/device.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/gpu/shader/shader.h"
#include "framework/scene/device/named_buffers.h"
#include "framework/scene/device/rays/long_table.h"
#include "framework/scene/rays/bvh.h"

namespace fovea::scene {
namespace {

// Push constants of refit.comp.
struct Constants {
  uint32_t first, count;
};

}  // namespace

struct RayTables::Impl {
  gpu::Device& device;
  gpu::Buffer nodes, triangles;
  std::vector<Constants> levels;  // of the tree of what moves, the deepest first
  gpu::Pipeline refit;

  Impl(gpu::Device& d, const Scene& scene, const Geometry& geometry, bool wanted) : device(d) {
    const uint32_t all = wanted ? uint32_t(geometry.triangles.size()) : 0;
    const uint32_t still = std::min(geometry.staticTriangles, all);
    const Bvh moving = buildBvh(geometry, {still, all});
    const auto hasHoles = [&](uint32_t t) {
      const uint32_t material = geometry.triangles[t].material();
      return material < scene.materials.size() && scene.materials[material].masked;
    };
    BvhTables tables;
    tables.add(buildBvh(geometry, {0, still}), kBvhStill, geometry, hasHoles);
    const uint32_t base = tables.add(moving, kBvhMoving, geometry, hasHoles);
    nodes = longTable(device, "nodes that rays meet", std::move(tables.nodes));
    triangles = longTable(device, "triangles that rays meet", std::move(tables.triangles));
    if (moving.order.empty()) return;
    refit = gpu::Pipeline(d, gpu::ComputePipelineDesc{d.shaders().compile("scene/refit.comp")});
    for (size_t i = moving.levels.size() - 1; i-- > 1;)
      levels.push_back({base + moving.levels[i], moving.levels[i + 1] - moving.levels[i]});
    levels.push_back({kBvhMoving, 1});
  }
};

RayTables::RayTables(gpu::Device& device, const Scene& scene, const Geometry& geometry, bool wanted)
    : impl_(std::make_unique<Impl>(device, scene, geometry, wanted)) {}
RayTables::~RayTables() = default;

void RayTables::record(VkCommandBuffer cmd, gpu::Buffer& positions) {
  if (impl_->levels.empty()) return;
  const gpu::Pipeline& pipeline = impl_->refit;
  bindNamed(impl_->device, cmd, pipeline, {},
            {{"Positions", &positions}, {"Triangles", &impl_->triangles}, {"Nodes", &impl_->nodes}});
  const uint32_t group = pipeline.interface().localSize[0];
  for (const Constants& level : impl_->levels) {
    constexpr auto kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    gpu::memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, kCompute,
                       VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0, sizeof level, &level);
    const uint32_t groups = (level.count + group - 1) / group;
    dispatchRows(cmd, groups);
  }
}

gpu::Buffer& RayTables::nodes() const { return impl_->nodes; }
gpu::Buffer& RayTables::triangles() const { return impl_->triangles; }

}  // namespace fovea::scene
