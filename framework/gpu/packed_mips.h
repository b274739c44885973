// An image in a buffer: tightly packed, mip after mip, all layers of each.
#pragma once

#include <vulkan/vulkan.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "framework/gpu/format.h"
#include "framework/gpu/resources.h"

namespace fovea::gpu {

// The copies of as many mips as make up `bytes`, which is set to what they take in all.
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
