#include "framework/scene/device/rays/ray_tables.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <span>
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
  uint32_t place, highest, deepest;
};

// A dispatch of refit.comp.
struct Dispatch {
  uint32_t highest, deepest;  // levels of the tree
  uint32_t groups;
};

// From the deepest level to the root. Of levels that are neighbours, a single group works on all that are small.
std::vector<Dispatch> dispatches(const std::vector<uint32_t>& levels, uint32_t groupSize) {
  const uint32_t small = 4 * groupSize;
  const auto nodes = [&](uint32_t level) { return levels[level + 1] - levels[level]; };
  std::vector<Dispatch> list;
  for (auto level = uint32_t(levels.size() - 1); level-- > 0;) {
    const bool isSmall = nodes(level) <= small;
    if (isSmall && !list.empty() && list.back().groups == 1)
      list.back().highest = level;
    else
      list.push_back({level, level, isSmall ? 1 : (nodes(level) + groupSize - 1) / groupSize});
  }
  return list;
}

}  // namespace

struct RayTables::Impl {
  gpu::Device& device;
  gpu::Buffer nodes, triangles;
  gpu::Buffer levels;  // of the tree of what moves
  uint32_t place = 0;  // of its second node, less 1
  gpu::Pipeline refit;
  std::vector<Dispatch> refits;

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
    place = tables.add(moving, kBvhMoving, geometry, hasHoles);
    nodes = longTable(device, "nodes that rays meet", std::move(tables.nodes));
    triangles = longTable(device, "triangles that rays meet", std::move(tables.triangles));
    if (moving.order.empty()) return;
    refit = gpu::Pipeline(d, gpu::ComputePipelineDesc{d.shaders().compile("scene/refit.comp")});
    refits = dispatches(moving.levels, refit.interface().localSize[0]);
    const auto bytes = std::as_bytes(std::span(moving.levels));
    levels = gpu::Buffer(device, {"levels of the tree of what moves", bytes.size(),
                                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryKind::Device});
    gpu::upload(device, levels, bytes);
  }
};

RayTables::RayTables(gpu::Device& device, const Scene& scene, const Geometry& geometry, bool wanted)
    : impl_(std::make_unique<Impl>(device, scene, geometry, wanted)) {}
RayTables::~RayTables() = default;

void RayTables::record(VkCommandBuffer cmd, gpu::Buffer& positions) {
  if (impl_->refits.empty()) return;
  const gpu::Pipeline& pipeline = impl_->refit;
  bindNamed(impl_->device, cmd, pipeline, {},
            {{"Positions", &positions},
             {"Triangles", &impl_->triangles},
             {"Nodes", &impl_->nodes},
             {"Levels", &impl_->levels}});
  for (const Dispatch& d : impl_->refits) {
    constexpr auto kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    gpu::memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, kCompute,
                       VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    const Constants constants{impl_->place, d.highest, d.deepest};
    vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0, sizeof constants, &constants);
    dispatchRows(cmd, d.groups);
  }
}

gpu::Buffer& RayTables::nodes() const { return impl_->nodes; }
gpu::Buffer& RayTables::triangles() const { return impl_->triangles; }

}  // namespace fovea::scene
