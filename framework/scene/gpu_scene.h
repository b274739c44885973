// The scene on the device: descriptor set 1, the same for every pass of a frame (shaders/common/scene.glsl).
#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <vector>

#include "framework/scene/frame.h"

namespace fovea::gpu {
class Device;
class Buffer;
}  // namespace fovea::gpu

namespace fovea::scene {

inline constexpr uint32_t kMaxLights = 64;
inline constexpr uint32_t kMaxViews = 8;

class GpuScene {
 public:
  // Uploads everything; waits. Throws Error(OutOfMemory) naming what did not fit, Error(BadInput) on more than kMaxLights.
  GpuScene(gpu::Device& device, const Scene& scene, const Geometry& geometry, uint32_t framesInFlight);
  ~GpuScene();

  // Writes this frame's uniforms (frame, views, lights) into the slot of the frame in flight; no GPU wait, no allocation.
  void update(const Frame& frame, uint32_t slot);

  VkDescriptorSetLayout setLayout() const;
  // Binding 1, the view, is a dynamic uniform buffer: viewOffset(i) is the offset for Frame::views[i].
  VkDescriptorSet set(uint32_t slot) const;
  uint32_t viewOffset(uint32_t view) const;

  gpu::Buffer& indices() const;       // uint32, 3 a triangle, for indexed draws
  uint32_t triangleCount() const;
  uint32_t vertexCount() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::scene
