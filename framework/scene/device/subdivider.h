// Evaluates subdivision surfaces that deform on the device: stencil tables and the kernel that applies them
// every frame (shaders/scene/subdivide.comp).
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>
#include <span>

#include "framework/scene/subdivision/subdivision.h"

namespace fovea::gpu {
class Device;
class Buffer;
}  // namespace fovea::gpu

namespace fovea::scene {

class Subdivider {
 public:
  // Uploads the tables, whose order is kept, and waits for the upload. Throws Error(OutOfMemory) naming what did not
  // fit, also if the tables exceed the device's maxTexelBufferElements.
  Subdivider(gpu::Device& device, std::span<const Stencils> tables);
  ~Subdivider();

  // One surface of a frame. Several surfaces may share a table.
  struct Surface {
    uint32_t table = 0;
    uint32_t firstPoint = 0;   // its Stencils::pointCount() cage points in `points`
    uint32_t firstVertex = 0;  // its Stencils::vertexCount() vertices in `positions` and `attributes`
    bool mirrored = false;     // the points went through a transform of negative determinant
  };
  // points: one vec4 per point (xyz), read as a uniform texel buffer. positions: one vec4 per vertex (xyz and 1).
  // attributes: one vec4 per vertex, of which xy becomes the octahedral normal. Both are storage buffers, in the
  // space of the points. Uses push descriptors and push constants. Allocates nothing, except on the first use of a
  // buffer for its texel view, and records no barriers: the caller records one before (the points must be visible to
  // compute) and one after (compute writes).
  void record(VkCommandBuffer cmd, gpu::Buffer& points, gpu::Buffer& positions, gpu::Buffer& attributes,
              std::span<const Surface> surfaces) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::scene
