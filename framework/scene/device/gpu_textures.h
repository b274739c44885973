// The textures of a scene in pages of an array image.
#pragma once

#include <vector>

#include "framework/gpu/resources.h"
#include "framework/scene/device/texture_pages.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// Those textures that materials use, 8-bit RGBA as stored; without any, one white texel.
class GpuTextures {
 public:
  // Throws Error(BadInput) naming a texture too large for the device, Error(OutOfMemory).
  GpuTextures(gpu::Device& device, const Scene& scene);
  // Null when the texture is not among them.
  const TexturePages::Place* find(uint32_t texture) const;
  gpu::Image& image() { return image_; }  // in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL

 private:
  void upload(gpu::Device& device, const Scene& scene, const std::vector<uint32_t>& textures);
  TexturePages pages_;
  std::vector<int32_t> index_;  // texture -> place, -1: none
  gpu::Image image_;
};

}  // namespace fovea::scene
