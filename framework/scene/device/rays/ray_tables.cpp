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

// On a GPU enough for a tree of 100,000 nodes to be done in three rounds.
constexpr uint32_t kNodesPerPart = 64;

// Push constants of refit.comp.
struct Constants {
  uint32_t place, begin, end;
};

}  // namespace

struct RayTables::Impl {
  gpu::Device& device;
  gpu::Buffer nodes, triangles;
  // The tree of what moves:
  uint32_t place = 0;               // of its second node, less 1
  gpu::Buffer orderedNodes, parts;  // see RefitOrder
  std::vector<uint32_t> rounds;
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
    place = tables.add(moving, kBvhMoving, geometry, hasHoles);
    nodes = longTable(device, "nodes that rays meet", std::move(tables.nodes));
    triangles = longTable(device, "triangles that rays meet", std::move(tables.triangles));
    if (moving.order.empty()) return;
    refit = gpu::Pipeline(d, gpu::ComputePipelineDesc{d.shaders().compile("scene/refit.comp")});
    RefitOrder order = refitOrder(moving, kNodesPerPart);
    orderedNodes = table("order in which what moves is refitted", order.nodes);
    parts = table("parts of the tree of what moves", order.parts);
    rounds = std::move(order.rounds);
  }

  gpu::Buffer table(const char* name, const std::vector<uint32_t>& data) const {
    const auto bytes = std::as_bytes(std::span(data));
    gpu::Buffer buffer(device,
                       {name, bytes.size(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryKind::Device});
    gpu::upload(device, buffer, bytes);
    return buffer;
  }
};

RayTables::RayTables(gpu::Device& device, const Scene& scene, const Geometry& geometry, bool wanted)
    : impl_(std::make_unique<Impl>(device, scene, geometry, wanted)) {}
RayTables::~RayTables() = default;

void RayTables::record(VkCommandBuffer cmd, gpu::Buffer& positions) {
  if (impl_->rounds.empty()) return;
  const gpu::Pipeline& pipeline = impl_->refit;
  bindNamed(impl_->device, cmd, pipeline, {},
            {{"Positions", &positions},
             {"Triangles", &impl_->triangles},
             {"Nodes", &impl_->nodes},
             {"Order", &impl_->orderedNodes},
             {"Parts", &impl_->parts}});
  const uint32_t groupSize = pipeline.interface().localSize[0];
  for (size_t round = 0; round + 1 < impl_->rounds.size(); ++round) {
    constexpr auto kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    gpu::memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, kCompute,
                       VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    const Constants constants{impl_->place, impl_->rounds[round], impl_->rounds[round + 1]};
    vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0, sizeof constants, &constants);
    dispatchRows(cmd, (constants.end - constants.begin + groupSize - 1) / groupSize);
  }
}

gpu::Buffer& RayTables::nodes() const { return impl_->nodes; }
gpu::Buffer& RayTables::triangles() const { return impl_->triangles; }

}  // namespace fovea::scene
