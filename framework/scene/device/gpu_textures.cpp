#include "framework/scene/device/gpu_textures.h"

#include <algorithm>
#include <cstring>

#include "fovea/error.h"
#include "framework/gpu/device.h"

namespace fovea::scene {

namespace {

// Barrier for all layers of the array, before (toCopy) or after the copies.
void changeLayout(VkCommandBuffer cmd, VkImage image, bool toCopy) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  const VkImageLayout copying = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  barrier.srcStageMask = toCopy ? VK_PIPELINE_STAGE_2_NONE : VK_PIPELINE_STAGE_2_COPY_BIT;
  barrier.srcAccessMask = toCopy ? VK_ACCESS_2_NONE : VK_ACCESS_2_TRANSFER_WRITE_BIT;
  barrier.dstStageMask = toCopy ? VK_PIPELINE_STAGE_2_COPY_BIT : VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.dstAccessMask = toCopy ? VK_ACCESS_2_TRANSFER_WRITE_BIT : VK_ACCESS_2_SHADER_READ_BIT;
  barrier.oldLayout = toCopy ? VK_IMAGE_LAYOUT_UNDEFINED : copying;
  barrier.newLayout = toCopy ? copying : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(cmd, &info);
}

std::vector<uint32_t> usedTextures(const Scene& scene, bool fullMaterials) {
  std::vector<bool> used(scene.textures.size());
  for (const Material& m : scene.materials)
    for (const auto member : kMaterialTextures) {
      const bool diffuse = member == &Material::baseColorTexture || member == &Material::emissionTexture;
      const uint32_t texture = (m.*member).texture;
      if ((diffuse || fullMaterials) && texture < used.size()) used[texture] = true;
    }
  std::vector<uint32_t> list;
  for (uint32_t i = 0; i < used.size(); ++i) {
    const Texture& t = scene.textures[i];
    if (used[i] && t.width > 0 && t.height > 0) list.push_back(i);
  }
  return list;
}

}  // namespace

GpuTextures::GpuTextures(gpu::Device& device, const Scene& scene, bool fullMaterials)
    : index_(scene.textures.size(), -1) {
  const std::vector<uint32_t> textures = usedTextures(scene, fullMaterials);
  const uint32_t maxSide = device.limits().maxImageDimension2D;
  std::vector<glm::uvec2> sizes;
  for (uint32_t t : textures) {
    const Texture& texture = scene.textures[t];
    if (std::max(texture.width, texture.height) > maxSide)
      throw Error(ExitCode::BadInput,
                  "texture `" + texture.name + "`: " + std::to_string(texture.width) + "x" +
                      std::to_string(texture.height) + " exceed this device's maxImageDimension2D " +
                      std::to_string(maxSide),
                  "scale the texture down");
    index_[t] = int32_t(sizes.size());
    sizes.push_back({texture.width, texture.height});
  }
  pages_ = packTextures(sizes, maxSide);
  gpu::ImageDesc desc;
  desc.name = "scene textures";
  desc.format = VK_FORMAT_R8G8B8A8_UNORM;
  desc.width = desc.height = pages_.side;
  desc.layers = pages_.pages;
  desc.array = true;
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  image_ = gpu::Image(device, desc);
  upload(device, scene, textures);
}

// Uploads page by page, so that the staging buffer holds only one. Texels outside all textures are never read.
void GpuTextures::upload(gpu::Device& device, const Scene& scene, const std::vector<uint32_t>& textures) {
  const size_t rowBytes = size_t(pages_.side) * 4;
  const gpu::Buffer staging(
      device, {"staging for " + image_.name(), rowBytes * pages_.side, 0, gpu::MemoryKind::Upload});
  device.runOnce([&](VkCommandBuffer cmd) { changeLayout(cmd, image_.handle(), true); });
  for (uint32_t page = 0; page < pages_.pages; ++page) {
    auto* to = static_cast<uint8_t*>(staging.mapped());
    std::memset(to, 255, rowBytes * pages_.side);
    for (size_t i = 0; i < textures.size(); ++i) {
      const TexturePages::Place& place = pages_.places[i];
      if (place.page != page) continue;
      const Texture& texture = scene.textures[textures[i]];
      for (size_t y = 0; y < texture.height; ++y)
        std::memcpy(to + (place.y + y) * rowBytes + place.x * size_t(4), &texture.rgba[y * texture.width * 4],
                    texture.width * size_t(4));
    }
    device.runOnce([&](VkCommandBuffer cmd) {
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, page, 1};
      copy.imageExtent = {pages_.side, pages_.side, 1};
      vkCmdCopyBufferToImage(cmd, staging.handle(), image_.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                             &copy);
      if (page + 1 == pages_.pages) changeLayout(cmd, image_.handle(), false);
    });
  }
}

const TexturePages::Place* GpuTextures::find(uint32_t texture) const {
  if (texture >= index_.size() || index_[texture] < 0) return nullptr;
  return &pages_.places[size_t(index_[texture])];
}

}  // namespace fovea::scene
