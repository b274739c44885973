// An image in a buffer, tightly packed: mip after mip, each with all its layers.
#pragma once

#include <vulkan/vulkan.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "framework/gpu/format.h"
#include "framework/gpu/resources.h"

namespace fovea::gpu {

// Copies for as many mips as make up `bytes`, which is set to the size that they take in total.
inline std::vector<VkBufferImageCopy> packedMips(const Image& image, uint64_t& bytes) {
  const ImageDesc& d = image.desc();
  std::vector<VkBufferImageCopy> copies;
  uint64_t offset = 0;
  for (uint32_t mip = 0; mip < d.mips && offset < bytes; ++mip) {
    VkBufferImageCopy copy{};
    copy.bufferOffset = offset;
    copy.imageSubresource = {image.aspect(), mip, 0, d.layers};
    copy.imageExtent = {std::max(1u, d.width >> mip), std::max(1u, d.height >> mip),
                        std::max(1u, d.depth >> mip)};
    offset += uint64_t(copy.imageExtent.width) * copy.imageExtent.height * copy.imageExtent.depth * d.layers *
              formatInfo(d.format).bytesPerTexel;
    copies.push_back(copy);
  }
  bytes = offset;
  return copies;
}

}  // namespace fovea::gpu
