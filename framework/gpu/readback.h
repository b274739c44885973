// Copies of buffers and images to the host that arrive frames later, so that the frame loop never waits.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "framework/gpu/resources.h"

namespace fovea::gpu {

class Device;

// A frame uses the slot frame % framesInFlight; staging memory is kept and grows when a copy needs more.
class ReadbackRing {
 public:
  ReadbackRing(Device& device, uint32_t framesInFlight);

  // The fence of frame - framesInFlight must have signalled; its data is dropped.
  void beginFrame(uint64_t frame);

  // Records a copy under `key`, one per key and frame. The caller has made the source readable by transfer
  // (COPY stage, TRANSFER_READ) and, for images, put it into TRANSFER_SRC_OPTIMAL or GENERAL: `layout`.
  void copy(VkCommandBuffer cmd, const std::string& key, const Buffer& source, uint64_t offset,
            uint64_t bytes);
  // Mip 0, all layers, tightly packed.
  void copy(VkCommandBuffer cmd, const std::string& key, const Image& source, VkImageLayout layout);
  // Once, after the last copy of the frame: makes the copies visible to the host.
  void endFrame(VkCommandBuffer cmd);

  // Call only after the frame's fence (or timeline value) has signalled. Empty when there is no such copy or
  // the slot went to a later frame; valid until that slot's next beginFrame.
  std::span<const std::byte> data(uint64_t frame, const std::string& key) const;

 private:
  struct Copy {
    Buffer staging;
    uint64_t bytes = 0;
    bool used = false;  // in the slot's present frame
  };
  struct Slot {
    std::optional<uint64_t> frame;
    std::map<std::string, Copy> copies;
  };
  Copy& stage(const std::string& key, uint64_t bytes);
  Device& device_;
  std::vector<Slot> slots_;
  Slot* current_ = nullptr;
};

}  // namespace fovea::gpu
