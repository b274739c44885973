// The blocks and records of descriptor set 1 that change with the frame (shaders/records/scene.h).
#pragma once

#include <span>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/tables/full_materials.h"
#include "shaders/records/scene.h"

namespace fovea::scene {

// What is the same in every frame.
FrameBlock sceneBlock(const Scene& scene, const Geometry& geometry, const FullMaterials& full);
// The same with what the frame adds.
FrameBlock frameBlock(FrameBlock scene, const Frame& frame);
// Through the positions within their pixels that the view samples (View::jitter). Also for off-axis projections.
PixelRays pixelRays(const View& view);
ViewBlock viewBlock(const View& view);
// Throws Error(BadInput) if there are more than kMaxLights lights, or if they need more than kMaxShadowLayers shadow maps.
std::vector<LightRecord> lightRecords(std::span<const Light> lights, float preExposure);
ObjectRecord objectRecord(const ObjectTransform& object);

// Throws Error(BadInput) that says how many `what` the scene has, and how many are supported.
void checkCount(const char* what, size_t count, size_t limit);

}  // namespace fovea::scene
