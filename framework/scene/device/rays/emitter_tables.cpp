#include "framework/scene/device/rays/emitter_tables.h"

#include <algorithm>
#include <bit>
#include <cstring>
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
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/emitters.h"

namespace fovea::scene {
namespace {

using Texels = std::vector<glm::uvec4>;

template <class Record>
void append(std::span<const Record> records, Texels& texels) {
  static_assert(sizeof(Record) % sizeof(glm::uvec4) == 0);
  const size_t first = texels.size();
  texels.resize(first + records.size_bytes() / sizeof(glm::uvec4));
  std::memcpy(texels.data() + first, records.data(), records.size_bytes());
}

Texels texelsOf(const Scene& scene, const Geometry& geometry, bool fullMaterials) {
  Frame frame;
  frame.scene = &scene;
  frame.geometry = &geometry;
  const Emitters emitters(frame, fullMaterials);
  const std::vector<EmitterRecord> records = emitters.records();
  EmitterHeader header;
  header.count = uint32_t(records.size());
  Texels texels(1);
  append(std::span<const EmitterRecord>(records), texels);
  header.firstNode = uint32_t(texels.size());
  append(emitters.nodes(), texels);
  if (const EnvironmentMap* map = scene.environmentMap.get()) {
    header.firstMap = uint32_t(texels.size());
    std::vector<float> values = map->columns();
    values.insert(values.end(), map->rows().begin(), map->rows().end());
    values.resize((values.size() + 3) / 4 * 4);
    for (size_t i = 0; i < values.size(); i += 4)
      texels.emplace_back(std::bit_cast<uint32_t>(values[i]), std::bit_cast<uint32_t>(values[i + 1]),
                          std::bit_cast<uint32_t>(values[i + 2]), std::bit_cast<uint32_t>(values[i + 3]));
  }
  std::memcpy(texels.data(), &header, sizeof header);
  return texels;
}

}  // namespace

struct EmitterTables::Impl {
  gpu::Device& device;
  gpu::Buffer texels;
  uint32_t nodes = 0;  // of the tree, if any emitter may move
  gpu::Pipeline refit;

  Impl(gpu::Device& d, const Scene& scene, const Geometry& geometry, bool fullMaterials, bool wanted)
      : device(d) {
    Texels list = wanted ? texelsOf(scene, geometry, fullMaterials) : Texels(1);
    const bool moves = std::ranges::any_of(
        geometry.emissive, [&](uint32_t triangle) { return triangle >= geometry.staticTriangles; });
    if (const uint32_t count = list[0].x; moves && count > 0) {
      nodes = 2 * std::bit_ceil(count);
      refit = gpu::Pipeline(d, gpu::ComputePipelineDesc{d.shaders().compile("animate/refit_emitters.comp")});
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
