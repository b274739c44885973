// Rays by ray queries (shaders/rays/hardware.glsl).
#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "framework/gpu/barrier.h"
#include "framework/gpu/device.h"
#include "framework/gpu/rays/acceleration_structure.h"
#include "framework/gpu/resources.h"
#include "framework/scene/device/rays/long_table.h"
#include "framework/scene/device/rays/ray_tables.h"
#include "shaders/records/rays.h"

namespace fovea::scene {
namespace {

constexpr auto kBuild = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
constexpr auto kShaders = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr auto kRead = VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR;
constexpr auto kWrite = VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR;

// Triangles that have a structure of their own.
struct Part {
  const char* name;
  bool moves, holes;
  std::vector<uint32_t> triangles;  // indices into Geometry::triangles
};

std::array<Part, 4> partsOf(const Scene& scene, const Geometry& geometry, bool wanted) {
  std::array<Part, 4> parts{Part{"rays, still", false, false, {}},
                            {"rays, still with holes", false, true, {}},
                            {"rays, moving", true, false, {}},
                            {"rays, moving with holes", true, true, {}}};
  const auto count = wanted ? uint32_t(geometry.triangles.size()) : 0;
  for (uint32_t t = 0; t < count; ++t) {
    const bool holes = mayHaveHoles(scene, geometry.triangles[t]);
    parts[(t < geometry.staticTriangles ? 0 : 2) + (holes ? 1 : 0)].triangles.push_back(t);
  }
  return parts;
}

VkAccelerationStructureInstanceKHR instanceOf(const gpu::AccelerationStructure& structure) {
  VkAccelerationStructureInstanceKHR instance{};
  for (int i = 0; i < 3; ++i) instance.transform.matrix[i][i] = 1;
  instance.mask = 0xff;
  instance.flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
  instance.accelerationStructureReference = structure.address();
  return instance;
}

class RayStructures : public RayTables {
 public:
  RayStructures(gpu::Device& device, const Scene& scene, const Geometry& geometry, gpu::Buffer& positions,
                bool wanted) {
    const std::array<Part, 4> parts = partsOf(scene, geometry, wanted);
    std::vector<glm::uvec4> table(1);  // the first entries of the instances, and then those
    std::vector<uint32_t> corners;
    for (const Part& part : parts)
      for (const uint32_t t : part.triangles) {
        const Triangle& triangle = geometry.triangles[t];
        corners.insert(corners.end(), triangle.v, triangle.v + 3);
        table.emplace_back(triangle.v[0], triangle.v[1], triangle.v[2], part.holes ? t | kRayHoles : t);
      }
    if (!corners.empty()) {
      const auto bytes = std::as_bytes(std::span(corners));
      indices_ = gpu::Buffer(
          device, {"vertices that rays meet", bytes.size(), gpu::kBuildInputUsage, gpu::MemoryKind::Device});
      gpu::upload(device, indices_, bytes);
    }
    std::vector<VkAccelerationStructureInstanceKHR> instances;
    std::vector<gpu::AccelerationStructure*> fresh;
    uint32_t first = 0;
    for (const Part& part : parts) {
      const auto count = uint32_t(part.triangles.size());
      if (count == 0) continue;
      const gpu::TriangleInput input{&positions, uint32_t(geometry.positions.size()), &indices_, first, count,
                                     !part.holes};
      (part.moves ? moving_ : still_).emplace_back(device, part.name, input, part.moves);
      table[0][glm::length_t(instances.size())] = 1 + first;
      instances.push_back(instanceOf((part.moves ? moving_ : still_).back()));
      first += count;
    }
    instances_ = gpu::Buffer(
        device, {"instances that rays meet", parts.size() * sizeof(VkAccelerationStructureInstanceKHR),
                 gpu::kBuildInputUsage, gpu::MemoryKind::Upload});
    std::ranges::copy(instances, static_cast<VkAccelerationStructureInstanceKHR*>(instances_.mapped()));
    top_ = gpu::AccelerationStructure(device, "rays", instances_, uint32_t(instances.size()));
    triangles_ = longTable(device, "triangles that rays meet", std::move(table));
    device.runOnce([&](VkCommandBuffer cmd) {
      for (gpu::AccelerationStructure& s : still_) s.build(cmd);
      for (gpu::AccelerationStructure& s : moving_) s.build(cmd);
      buildTop(cmd);
    });
  }

  void record(VkCommandBuffer cmd) override {
    if (moving_.empty()) return;
    gpu::memoryBarrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                       kBuild, VK_ACCESS_2_SHADER_READ_BIT | kRead | kWrite);
    for (gpu::AccelerationStructure& s : moving_) s.update(cmd);
    buildTop(cmd);
  }

  VkAccelerationStructureKHR structure() const override { return top_.handle(); }
  gpu::Buffer* nodes() override { return nullptr; }
  gpu::Buffer& triangles() override { return triangles_; }

 private:
  void buildTop(VkCommandBuffer cmd) {
    gpu::memoryBarrier(cmd, kBuild, kWrite, kBuild, kRead | kWrite);
    top_.build(cmd);
    gpu::memoryBarrier(cmd, kBuild, kWrite, kShaders, kRead);
  }

  gpu::Buffer indices_, instances_, triangles_;
  std::vector<gpu::AccelerationStructure> still_, moving_;
  gpu::AccelerationStructure top_;
};

}  // namespace

std::unique_ptr<RayTables> rayStructures(gpu::Device& device, const Scene& scene, const Geometry& geometry,
                                         gpu::Buffer& positions, bool wanted) {
  return std::make_unique<RayStructures>(device, scene, geometry, positions, wanted);
}

}  // namespace fovea::scene
