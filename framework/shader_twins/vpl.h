// Virtual point lights as passes exchange them. The same layout as shaders/common/vpl.glsl.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace fovea::scene {

struct Vpl {
  glm::vec3 position{0};  // world space, m
  float area = 0;         // surface area it stands for, m^2 (the disc kernel's size)
  glm::vec3 normal{0};    // unit, the side it shines to
  float unused0 = 0;
  glm::vec3 intensity{
      0};  // radiant intensity along the normal, W/sr = reflected flux / pi; all 0: an empty slot
  float unused1 = 0;
};
static_assert(sizeof(Vpl) == 48);

// What is known of a VPL that is kept from frame to frame. One entry a slot, a slot for life. All zeros: an
// empty slot.
struct VplState {
  glm::vec3 position{0};  // world space, this frame
  float importance = 0;   // I of this frame, in [0, 1]
  glm::vec3 normal{0};    // unit, world space
  float life = 0;         // frames it has been shown in, this one included: 0 an empty slot, 1 a new VPL
  glm::vec3 reflectance{0};
  uint32_t side = 0;  // voxel side of this frame
  // In the space of its object, so that it follows. On an object that deforms (ObjectTransform::deforms) its
  // place in a triangle: the triangle's number past the static ones, weights of its second and third vertex.
  glm::vec3 localPosition{0};
  float object = 0;
  // Unit, in the space of its object (that deforms: along the triangle's axes), as found: turns are measured
  // against it.
  glm::vec3 localNormal{0};
  float previousImportance = 0;  // of the frame before (Eq. 1)
};
static_assert(sizeof(VplState) == 80);

// A VPL that could be.
struct Candidate {
  glm::vec3 position{0};  // world space
  uint32_t side = ~0u;    // voxel side, ~0: an attempt that hit nothing
  glm::vec3 normal{0};    // unit, world space
  float object = 0;
  glm::vec3 reflectance{0};
  float luminance = 0;         // of the side's radiance, W/(sr m^2)
  glm::vec3 localPosition{0};  // as VplState has it
  float unused = 0;
};
static_assert(sizeof(Candidate) == 64);

inline constexpr uint32_t kNoSide = ~0u;

inline constexpr uint32_t kVplPage = 1024;  // VPLs in one uniform-buffer page (48 KiB)

}  // namespace fovea::scene
