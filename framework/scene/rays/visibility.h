// How much light passes along a ray.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::scene {

// The share of light that passes along the ray, by channels: 0 or 1, unless `rays` meet surfaces that let a part of it
// through. `count` counts the rays traced.
glm::vec3 visibility(const Frame& frame, const RayScene& rays, Ray ray, uint64_t& count);

}  // namespace fovea::scene
