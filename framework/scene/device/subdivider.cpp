#include "framework/scene/device/subdivider.h"

#include <string>
#include <vector>

#include "fovea/error.h"
#include "framework/gpu/device.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/gpu/shader/shader.h"
#include "framework/scene/device/named_buffers.h"
#include "framework/scene/device/texel_table.h"

namespace fovea::scene {
namespace {

// Push constants of subdivide.comp.
struct SubdivideConstants {
  uint32_t firstRange, count, firstPoint, firstVertex;
  float side;
};

constexpr const char* kLowerLevel = "lower the subdivision level of the surfaces that deform";

}  // namespace

struct Subdivider::Impl {
  struct Table {
    uint32_t firstRange, count;
  };
  gpu::Device& device;
  std::vector<Table> tables;
  gpu::Buffer ranges, entries;
  gpu::Pipeline pipeline;

  Impl(gpu::Device& d, std::span<const Stencils> stencils)
      : device(d), pipeline(d, gpu::ComputePipelineDesc{d.shaders().compile("scene/subdivide.comp")}) {
    static_assert(sizeof(Stencils::Range) == 8 && sizeof(Stencils::Entry) == 16);
    std::vector<Stencils::Range> allRanges;
    std::vector<Stencils::Entry> allEntries;
    for (const Stencils& s : stencils) {
      tables.push_back({uint32_t(allRanges.size()), s.vertexCount()});
      for (Stencils::Range r : s.ranges()) {
        r.first += uint32_t(allEntries.size());
        allRanges.push_back(r);
      }
      allEntries.insert(allEntries.end(), s.entries().begin(), s.entries().end());
    }
    ranges = texelTable(device, "stencil ranges", std::move(allRanges), kLowerLevel);
    entries = texelTable(device, "stencil entries", std::move(allEntries), kLowerLevel);
  }
};

Subdivider::Subdivider(gpu::Device& device, std::span<const Stencils> tables)
    : impl_(std::make_unique<Impl>(device, tables)) {}
Subdivider::~Subdivider() = default;

void Subdivider::record(VkCommandBuffer cmd, gpu::Buffer& points, gpu::Buffer& positions,
                        gpu::Buffer& attributes, std::span<const Surface> surfaces) const {
  if (surfaces.empty()) return;
  const gpu::Pipeline& pipeline = impl_->pipeline;
  bindNamed(impl_->device, cmd, pipeline,
            {{"ranges", impl_->ranges.texelView(VK_FORMAT_R32G32_UINT)},
             {"entries", impl_->entries.texelView(VK_FORMAT_R32G32B32A32_UINT)},
             {"points", points.texelView(VK_FORMAT_R32G32B32A32_SFLOAT)}},
            {{"Positions", &positions}, {"Attributes", &attributes}});
  const uint32_t group = pipeline.interface().localSize[0];
  for (const Surface& s : surfaces) {
    const Impl::Table& t = impl_->tables.at(s.table);
    const SubdivideConstants constants{t.firstRange, t.count, s.firstPoint, s.firstVertex,
                                       s.mirrored ? -1.0f : 1.0f};
    vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0, sizeof constants, &constants);
    vkCmdDispatch(cmd, (t.count + group - 1) / group, 1, 1);
  }
}

}  // namespace fovea::scene
