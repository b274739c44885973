// Stores the textures of a scene in the pages of an array image.
#pragma once

#include <vector>

#include "framework/gpu/resources.h"
#include "framework/scene/device/texture_pages.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// The textures that diffuse or full materials use, as 8-bit RGBA in their stored encoding; a single white texel if
// there are none.
class GpuTextures {
 public:
  // Throws Error(BadInput) naming a texture that is too large for the device, and Error(OutOfMemory).
  GpuTextures(gpu::Device& device, const Scene& scene, bool fullMaterials);
  // Null if no material uses the texture.
  const TexturePages::Place* find(uint32_t texture) const;
  gpu::Image& image() { return image_; }  // in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL

 private:
  void upload(gpu::Device& device, const Scene& scene, const std::vector<uint32_t>& textures);
  TexturePages pages_;
  std::vector<int32_t> index_;  // texture -> place; -1 if none
  gpu::Image image_;
};

}  // namespace fovea::scene
