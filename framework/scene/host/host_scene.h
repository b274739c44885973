// The scene for kernels that run on the host: what descriptor set 1 holds on the device (shaders/scene/tables.glsl), in
// memory of the host.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/tables/material_table.h"
#include "shaders/records/scene.h"

namespace fovea::scene {

class HostScene {
 public:
  // Scene and geometry must outlive this. fullMaterials: whether materials have all that glTF says of them.
  HostScene(const Scene& scene, const Geometry& geometry, bool fullMaterials);
  // To be called before the kernels of a frame run, whose scene is that of the constructor. Frame::geometry must be that
  // of the moment, and must not change until they are done.
  void update(const Frame& frame);

  const FrameBlock& frame() const { return frame_; }
  const ViewBlock& view(uint32_t view) const { return views_[view]; }
  const LightRecord* lights() const { return lights_.data(); }
  const glm::vec4* materials() const { return materials_.texels.data(); }
  const glm::uvec4* emitters() const { return emitters_.data(); }
  const Geometry& geometry() const { return *geometry_; }
  // What rays meet in this frame. Threads may not ask at the same time.
  const RayScene& rays(Passing passing) const;

  // A texel of a texture; p: column, row, and index of the texture. linear: whether it is not sRGB-encoded.
  glm::vec4 texel(glm::ivec3 p, bool linear) const;
  glm::ivec2 environmentSize() const;  // texels; one texel if there is no map
  glm::vec3 environmentTexel(glm::ivec2 p) const;

 private:
  const Scene& scene_;
  const Geometry* geometry_;
  bool fullMaterials_, emittersMove_;
  MaterialTable materials_;
  std::vector<glm::uvec4> emitters_;
  FrameBlock still_, frame_;
  std::vector<ViewBlock> views_;
  std::vector<LightRecord> lights_;
  mutable std::array<std::shared_ptr<const RayScene>, 2> rays_;  // by Passing; null before a kernel asks
};

}  // namespace fovea::scene
