// Rays through bounding volume hierarchies (shaders/rays/bvh.glsl): one of the triangles that never move, and one of all
// others.
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
#include "framework/scene/device/rays/ray_tables.h"
#include "framework/scene/rays/bvh.h"

namespace fovea::scene {
namespace {

// On a GPU enough for a tree of 100,000 nodes to be done in three rounds.
constexpr uint32_t kNodesPerPart = 64;

// Push constants of refit.comp.
struct Constants {
  uint32_t place, begin, end;
};

class RayTrees : public RayTables {
 public:
  RayTrees(gpu::Device& device, const Scene& scene, const Geometry& geometry, gpu::Buffer& positions,
           bool wanted)
      : device_(device), positions_(positions) {
    const uint32_t all = wanted ? uint32_t(geometry.triangles.size()) : 0;
    const uint32_t still = std::min(geometry.staticTriangles, all);
    const Bvh moving = buildBvh(geometry, {still, all});
    const auto holes = [&](uint32_t t) { return mayHaveHoles(scene, geometry.triangles[t]); };
    BvhTables tables;
    tables.add(buildBvh(geometry, {0, still}), kBvhStill, geometry, holes);
    place_ = tables.add(moving, kBvhMoving, geometry, holes);
    nodes_ = longTable(device, "nodes that rays meet", std::move(tables.nodes));
    triangles_ = longTable(device, "triangles that rays meet", std::move(tables.triangles));
    if (moving.order.empty()) return;
    refit_ = gpu::Pipeline(device, gpu::ComputePipelineDesc{device.shaders().compile("scene/refit.comp")});
    RefitOrder order = refitOrder(moving, kNodesPerPart);
    order_ = table("order in which what moves is refitted", order.nodes);
    parts_ = table("parts of the tree of what moves", order.parts);
    rounds_ = std::move(order.rounds);
  }

  void record(VkCommandBuffer cmd) override {
    if (rounds_.empty()) return;
    bindNamed(device_, cmd, refit_, {},
              {{"Positions", &positions_},
               {"Triangles", &triangles_},
               {"Nodes", &nodes_},
               {"Order", &order_},
               {"Parts", &parts_}});
    const uint32_t groupSize = refit_.interface().localSize[0];
    for (size_t round = 0; round + 1 < rounds_.size(); ++round) {
      constexpr auto kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
      gpu::memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, kCompute,
                         VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
      const Constants constants{place_, rounds_[round], rounds_[round + 1]};
      vkCmdPushConstants(cmd, refit_.layout(), refit_.interface().stages, 0, sizeof constants, &constants);
      dispatchRows(cmd, (constants.end - constants.begin + groupSize - 1) / groupSize);
    }
  }

  VkAccelerationStructureKHR structure() const override { return VK_NULL_HANDLE; }
  gpu::Buffer* nodes() override { return &nodes_; }
  gpu::Buffer& triangles() override { return triangles_; }

 private:
  gpu::Buffer table(const char* name, const std::vector<uint32_t>& data) const {
    const auto bytes = std::as_bytes(std::span(data));
    gpu::Buffer buffer(device_,
                       {name, bytes.size(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryKind::Device});
    gpu::upload(device_, buffer, bytes);
    return buffer;
  }

  gpu::Device& device_;
  gpu::Buffer& positions_;
  gpu::Buffer nodes_, triangles_;
  // The tree of what moves:
  uint32_t place_ = 0;         // of its second node, less 1
  gpu::Buffer order_, parts_;  // see RefitOrder
  std::vector<uint32_t> rounds_;
  gpu::Pipeline refit_;
};

}  // namespace

std::unique_ptr<RayTables> rayTrees(gpu::Device& device, const Scene& scene, const Geometry& geometry,
                                    gpu::Buffer& positions, bool wanted) {
  return std::make_unique<RayTrees>(device, scene, geometry, positions, wanted);
}

}  // namespace fovea::scene
