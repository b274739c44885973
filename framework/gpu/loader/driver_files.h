// The files that describe the drivers of Vulkan to its loader.
#pragma once

#include <filesystem>

namespace fovea::gpu {

// The first of them that is no JSON; empty if all are. The loader calls such a file a lack of memory.
std::filesystem::path damagedDriverFile();

}  // namespace fovea::gpu
