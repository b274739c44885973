// Internal to the executor: converts light between the units of the scene, in which callers give and receive it, and the
// pre-exposed units in which passes store it (Frame::preExposure).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/graph.h"

namespace fovea::graph {

// The `texels` of a resource as callers receive them. Light (ResourceDesc::light) becomes 32-bit floats in the units of
// the scene, and the texels that exceed the range of their format are counted.
OutputData inSceneUnits(const ResourceDesc& desc, std::span<const std::byte> texels, float preExposure);

// The number of bytes that a caller gives for an input: the size of its texels or elements, or of 32-bit floats if it is
// light.
uint64_t givenBytes(const ResourceDesc& desc);

// The texels of an image of light, from 32-bit floats in the units of the scene. Values beyond the range of 16-bit floats
// become the nearest that these can hold.
std::vector<std::byte> inStoredUnits(const ResourceDesc& desc, std::span<const std::byte> given,
                                     float preExposure);

}  // namespace fovea::graph
