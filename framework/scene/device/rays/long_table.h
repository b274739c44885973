// Tables that rays read, which may have more texels than a device of few maxTexelBufferElements allows
// (shaders/device/texels.glsl). Private to framework/scene.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "fovea/error.h"
#include "framework/gpu/device.h"
#include "framework/gpu/resources.h"

namespace fovea::scene {

// Uploads `data`, whose elements have the size of a texel of four 32-bit components, and waits for the upload. Throws
// Error(OutOfMemory) if shaders could not read all of it.
template <class T>
gpu::Buffer longTable(gpu::Device& device, const char* name, std::vector<T> data) {
  constexpr uint64_t kTexelBytes = 16;
  if (data.empty()) data.emplace_back();  // Vulkan has no empty buffers
  const uint64_t bytes = data.size() * sizeof(T), range = device.limits().maxStorageBufferRange,
                 texels = uint64_t(device.limits().maxTexelBufferElements) * kTexelBytes;
  const uint64_t limit = device.lacks("maxTexelBufferElements") ? range : std::min(range, texels);
  if (bytes > limit)
    throw Error(ExitCode::OutOfMemory,
                std::string(name) + ": " + std::to_string(bytes) +
                    " bytes are more than a shader can read on this device, " + std::to_string(limit),
                "trace rays on the host: `--set rays=host`, or `tracer=host` in `ddgi` and `restir_gi`");
  gpu::Buffer buffer(
      device, {name, bytes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
               gpu::MemoryKind::Device});
  gpu::upload(device, buffer, std::as_bytes(std::span(data)));
  return buffer;
}

}  // namespace fovea::scene
