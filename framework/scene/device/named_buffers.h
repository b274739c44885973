// Binds buffers to a compute pipeline by the names that its shader gives them, and dispatches any number of groups.
// Private to framework/scene.
#pragma once

#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <utility>

#include "framework/gpu/device.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"

namespace fovea::scene {

using NamedView = std::pair<const char*, VkBufferView>;
using NamedBuffer = std::pair<const char*, const gpu::Buffer*>;

// Texel buffers by their views, storage buffers as a whole. Every binding of set 0 must be among them, and there are at
// most 16.
inline void bindNamed(gpu::Device& device, VkCommandBuffer cmd, const gpu::Pipeline& pipeline,
                      std::initializer_list<NamedView> views, std::initializer_list<NamedBuffer> buffers) {
  std::array<VkWriteDescriptorSet, 16> writes{};
  std::array<VkDescriptorBufferInfo, 16> infos{};
  size_t count = 0;
  for (const gpu::ReflectedBinding& b : pipeline.interface().bindings) {
    VkDescriptorBufferInfo& info = infos.at(count);
    VkWriteDescriptorSet& w = writes.at(count++);
    w.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    w.dstBinding = b.binding;
    w.descriptorCount = 1;
    w.descriptorType = gpu::descriptorType(b.kind);
    for (const auto& [name, view] : views)
      if (b.name == name) w.pTexelBufferView = &view;
    for (const auto& [name, buffer] : buffers) {
      if (b.name != name) continue;
      info = {buffer->handle(), 0, VK_WHOLE_SIZE};
      w.pBufferInfo = &info;
    }
  }
  vkCmdBindPipeline(cmd, pipeline.bindPoint(), pipeline.handle());
  device.pushDescriptorSet(cmd, pipeline.bindPoint(), pipeline.layout(), 0, std::span(writes).first(count));
}

// So many groups that one row of a dispatch may not hold them; the shader counts on to the next row.
inline void dispatchRows(VkCommandBuffer cmd, uint32_t groups) {
  constexpr uint32_t kMostGroups = 32768;  // per row
  vkCmdDispatch(cmd, std::min(groups, kMostGroups), (groups + kMostGroups - 1) / kMostGroups, 1);
}

}  // namespace fovea::scene
