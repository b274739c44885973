// Vertices of everything that moves, on the device: morph targets, joints and transforms of a frame
// (shaders/animate/animate.comp), then the stencils of cages that deform. Equal to moveObjects().
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>

#include "framework/scene/frame.h"

namespace fovea::gpu {
class Device;
class Buffer;
}  // namespace fovea::gpu

namespace fovea::scene {

class Animator {
 public:
  // Uploads the shapes at rest; waits. Throws Error(OutOfMemory) naming what did not fit, also when it
  // exceeds the device's maxTexelBufferElements.
  Animator(gpu::Device& device, const Scene& scene, const Geometry& geometry, uint32_t slots);
  ~Animator();

  // The poses of a frame, for one of the slots in flight. Objects that the frame says nothing about stay as
  // they are at time 0.
  void update(const Frame& frame, uint32_t slot);

  // positions, attributes: of all vertices (GpuScene); those past Geometry::staticVertices() are written.
  // previous: vec4, of these alone: their positions in the frame before. Barriers in between are its own; the
  // caller's keep it (transfer and compute) behind all earlier readers and before all later ones.
  void record(VkCommandBuffer cmd, uint32_t slot, gpu::Buffer& positions, gpu::Buffer& attributes,
              gpu::Buffer& previous);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::scene
