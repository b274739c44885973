// The C++ version of shaders/common/hemisphere_rays.glsl, which explains the choice; both must be changed together.
// It holds six fixed directions over a hemisphere.
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace fovea::scene {

// Unit directions in the frame orthonormalFrame(normal); z is the cosine to the normal.
inline constexpr int kHemisphereRays = 6;
inline const std::array<glm::vec3, kHemisphereRays> kHemisphereRay = {{{0.0f, 0.0f, 1.0f},
                                                                       {0.850685713f, 0.162276979f, 0.5f},
                                                                       {0.108541764f, 0.859196535f, 0.5f},
                                                                       {-0.783603213f, 0.368735683f, 0.5f},
                                                                       {-0.592835184f, -0.631305350f, 0.5f},
                                                                       {0.417210920f, -0.758903846f, 0.5f}}};
inline constexpr float kHemisphereCosines = 3.5f;  // sum of the cosines

}  // namespace fovea::scene
