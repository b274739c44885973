// The C++ version of shaders/common/vpl.glsl: both must be changed together. It defines virtual point lights (VPLs)
// as passes exchange them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace fovea::scene {

struct Vpl {
  glm::vec3 position{0};  // world space, m
  float area = 0;         // surface area it stands for, m^2 (the disc kernel's size)
  glm::vec3 normal{0};    // unit, the side it shines to
  float unused0 = 0;
  // Radiant intensity along the normal, W/sr = reflected flux / pi; all 0 in an empty slot.
  glm::vec3 intensity{0};
  float unused1 = 0;
};
static_assert(sizeof(Vpl) == 48);

// State of a VPL that is kept from frame to frame, one entry per slot; a VPL keeps its slot for life. An empty slot
// is all zeros.
struct VplState {
  glm::vec3 position{0};  // world space, this frame
  float importance = 0;   // I of this frame, in [0, 1]
  glm::vec3 normal{0};    // unit, world space
  float life = 0;         // frames shown, including this one: 0 for an empty slot, 1 for a new VPL
  glm::vec3 reflectance{0};
  uint32_t side = 0;  // voxel side of this frame
  // In the space of its object, so that the VPL follows the object. On an object that deforms
  // (ObjectTransform::deforms): its place in a triangle, given by the number of the triangle, counted from the first
  // non-static one, and the weights of the second and third vertex.
  glm::vec3 localPosition{0};
  float object = 0;
  // Unit, as found, in the space of its object or, on an object that deforms, along the axes of the triangle. Turns
  // of the surface are measured against it.
  glm::vec3 localNormal{0};
  float previousImportance = 0;  // of the frame before (Eq. 1)
};
static_assert(sizeof(VplState) == 80);

// A candidate VPL.
struct Candidate {
  glm::vec3 position{0};  // world space
  uint32_t side = ~0u;    // voxel side; ~0 for an attempt that hit nothing
  glm::vec3 normal{0};    // unit, world space
  float object = 0;
  glm::vec3 reflectance{0};
  float luminance = 0;         // of the side's radiance, W/(sr m^2)
  glm::vec3 localPosition{0};  // as in VplState
  float unused = 0;
};
static_assert(sizeof(Candidate) == 64);

inline constexpr uint32_t kNoSide = ~0u;

inline constexpr uint32_t kVplPage = 1024;  // VPLs in one uniform-buffer page (48 KiB)

}  // namespace fovea::scene
