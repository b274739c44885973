// Read-only arrays for moving geometry, as texel buffers, which are fast to read in shaders.
// Private to framework/scene.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fovea/error.h"
#include "framework/gpu/device.h"
#include "framework/gpu/resources.h"

namespace fovea::scene {

// Uploads `data` and waits for the upload. Throws Error(OutOfMemory) with `remedy` if the device's texel buffers
// are too short.
template <class T>
gpu::Buffer texelTable(gpu::Device& device, const char* name, std::vector<T> data, const char* remedy) {
  const uint64_t limit = device.limits().maxTexelBufferElements;
  if (data.size() > limit)
    throw Error(ExitCode::OutOfMemory,
                std::string(name) + ": " + std::to_string(data.size()) +
                    " elements exceed this device's maxTexelBufferElements " + std::to_string(limit),
                remedy);
  if (data.empty()) data.emplace_back();  // Vulkan has no empty buffers
  gpu::Buffer buffer(device, {name, data.size() * sizeof(T), VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                              gpu::MemoryKind::Device});
  gpu::upload(device, buffer, std::as_bytes(std::span(data)));
  return buffer;
}

}  // namespace fovea::scene
