// The scene on the device: descriptor set 1, the same for every pass of a frame (shaders/scene/scene.glsl).
#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <vector>

#include "framework/scene/device/draw_runs.h"
#include "framework/scene/frame.h"
#include "shaders/records/scene.h"

namespace fovea::gpu {
class Device;
class Buffer;
}  // namespace fovea::gpu

namespace fovea::scene {

inline constexpr uint32_t kMaxViews = 8;

// Where passes trace rays.
struct RaysWanted {
  bool host = false, device = false;
  bool operator==(const RaysWanted&) const = default;
};

// A scene may have no triangles, lights or textures.
class GpuScene : public FrameDescriptors {
 public:
  // Uploads everything and waits for the upload. Throws Error(OutOfMemory) naming what did not fit, and
  // Error(BadInput) if there are more than kMaxLights lights, if these need more than kMaxShadowLayers shadow maps, or if
  // a texture is larger than the device supports.
  // fullMaterials: whether a pass asks for all that glTF says of materials. Their base colours are then those of
  // bouncedColor() in tables/material_table.cpp, with which metals are not black.
  // rays: where passes trace rays; elsewhere they meet nothing. On the host, scene and geometry must outlive this.
  GpuScene(gpu::Device& device, const Scene& scene, const Geometry& geometry, uint32_t framesInFlight,
           bool fullMaterials = false, RaysWanted rays = {});
  ~GpuScene() override;

  // Frame::geometry is not read. Throws Error(BadInput) if there are more than kMaxViews views, or as above.
  void update(const Frame& frame, uint32_t slot) override;
  // Records the commands that bring positions() and attributes() to that frame and write the previous frame's
  // positions of moving vertices, which binding 9 shows.
  void recordMoves(VkCommandBuffer cmd, uint32_t slot) const override;
  bool moves() const override;
  const HostScene* host(const Frame& frame) override;

  VkDescriptorSetLayout setLayout() const override;
  VkDescriptorSet set(uint32_t slot) const override;
  uint32_t viewOffset(uint32_t view) const override;

  gpu::Buffer& indices() const;  // uint32, 3 per triangle, for indexed draws
  // The buffers behind bindings 3 to 6. They are also usable as storage buffers, so that passes can move vertices on
  // the device.
  // uvec4 per triangle: 3 vertices, then material | object << 16; Geometry::lightTriangles follow those of the
  // picture.
  gpu::Buffer& triangles() const;
  gpu::Buffer& positions() const;   // vec4: world space, m; w: alpha of the vertex colour
  gpu::Buffer& attributes() const;  // vec4: octahedral normal, uv
  gpu::Buffer& previous() const;    // vec4: the previous frame's positions of the vertices that move
  gpu::Buffer& materials() const;   // MaterialRecord each, then what full materials need
  bool fullMaterials() const;
  RaysWanted rays() const;
  const std::vector<DrawRun>& drawRuns() const;
  uint32_t triangleCount() const;
  uint32_t vertexCount() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::scene
