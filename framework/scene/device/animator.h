// Computes the vertices of everything that moves on the device: the morph targets, joints and transforms of a frame
// (shaders/scene/animate.comp), then the stencils of cages that deform. The result equals that of moveObjects().
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
  // Uploads the shapes at rest and waits for the upload. Throws Error(OutOfMemory) naming the array that did not fit,
  // also if it exceeds the device's maxTexelBufferElements.
  Animator(gpu::Device& device, const Scene& scene, const Geometry& geometry, uint32_t slots);
  ~Animator();

  // Writes the poses of a frame to one of the slots in flight. Objects for which the frame has no pose stay as they
  // are at time 0.
  void update(const Frame& frame, uint32_t slot);

  // positions, attributes: of all vertices (GpuScene); those from Geometry::staticVertices() on are written.
  // previous: one vec4 for each of these vertices, its position in the previous frame. Internal barriers are recorded
  // here; the caller's barriers must order the commands (transfer and compute) after all earlier readers and before
  // all later ones.
  void record(VkCommandBuffer cmd, uint32_t slot, gpu::Buffer& positions, gpu::Buffer& attributes,
              gpu::Buffer& previous);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::scene
