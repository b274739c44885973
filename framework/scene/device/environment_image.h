// The environment map of a scene as shaders read it (scene/scene.glsl, environmentRadiance).
#pragma once

#include "framework/gpu/resources.h"
#include "framework/scene/environment/environment_map.h"

namespace fovea::scene {

// 32-bit floats, as the sun in a map may be brighter than halves can say; a single black texel without a map. In
// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL. Throws Error(BadInput) if the map is too large for the device, and
// Error(OutOfMemory).
gpu::Image environmentImage(gpu::Device& device, const EnvironmentMap* map, float preExposure);

}  // namespace fovea::scene
