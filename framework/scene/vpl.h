// Virtual point lights as passes exchange them. The same layout as shaders/common/vpl.glsl.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace fovea::scene {

struct Vpl {
  glm::vec3 position{0};   // world space, m
  float area = 0;          // surface area it stands for, m^2 (the disc kernel's size)
  glm::vec3 normal{0};     // unit, the side it shines to
  float unused0 = 0;
  glm::vec3 intensity{0};  // radiant intensity along the normal, W/sr = reflected flux / pi; all 0: an empty slot
  float unused1 = 0;
};
static_assert(sizeof(Vpl) == 48);

inline constexpr uint32_t kVplPage = 1024;  // VPLs in one uniform-buffer page (48 KiB)

}  // namespace fovea::scene
