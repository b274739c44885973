// Internal to the executor: light between the units of the scene, which callers see, and those in which passes store it
// (Frame::preExposure).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fovea/graph.h"

namespace fovea::graph {

// What was copied of a resource, `texels`, as callers see it. Light (ResourceDesc::light) is converted to 32-bit floats
// in the units of the scene, and texels that exceeded the range of their format are counted.
OutputData inSceneUnits(const ResourceDesc& desc, std::span<const std::byte> texels, float preExposure);

// The bytes that callers give for an input: those of its texels or elements, and of light those of 32-bit floats.
uint64_t givenBytes(const ResourceDesc& desc);

// The texels of an image of light, from 32-bit floats in the units of the scene. What a 16-bit float cannot hold
// becomes the greatest that it can.
std::vector<std::byte> inStoredUnits(const ResourceDesc& desc, std::span<const std::byte> values,
                                     float preExposure);

}  // namespace fovea::graph
