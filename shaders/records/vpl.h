// Virtual point lights (VPLs) as passes exchange them.
#pragma once

#include "voxel.h"

SHARED_BEGIN(fovea::scene)

// VPLs in one page of a uniform buffer, which is the fast way to read data that every invocation reads: 48 KiB.
SHARED_CONSTANT uint kVplPage = 1024u;

// A VPL as the passes that shade read it. Its index in the list is its slot, which determines its map in the shadow
// atlas and, modulo the number of interleave subsets, the subset that it shades in.
struct Vpl {
  vec3 position SHARED_ZERO;  // world space, m
  float area SHARED_ZERO;     // surface area it stands for, m^2 (the size of the kernel `disc`)
  vec3 normal SHARED_ZERO;    // unit, on the side to which it emits
  float unused0 SHARED_ZERO;
  // Radiant intensity along the normal, W/sr = reflected flux / pi; all 0 in an empty slot.
  vec3 intensity SHARED_ZERO;
  float unused1 SHARED_ZERO;
};
SHARED_SIZE(Vpl, 48)
SHARED_OFFSET(Vpl, intensity, 32)

// State of a VPL that is kept from frame to frame, one entry per slot; a VPL keeps its slot for life. An empty slot
// is all zeros.
struct VplState {
  vec3 position SHARED_ZERO;     // world space, m, this frame
  float importance SHARED_ZERO;  // I of this frame, in [0, 1]
  vec3 normal SHARED_ZERO;       // unit, world space
  float life SHARED_ZERO;        // frames shown, including this one: 0 for an empty slot, 1 for a new VPL
  vec3 reflectance SHARED_ZERO;
  uint side SHARED_ZERO;  // voxel side of this frame
  // In the space of its object, so that the VPL follows the object. On an object that deforms
  // (ObjectRecord::deforms): its place in a triangle, given by the number of the triangle, counted from the first
  // non-static one, and the weights of the second and third vertex (attach() in scene/objects.glsl).
  vec3 localPosition SHARED_ZERO;
  float object SHARED_ZERO;
  // Unit, as found, in the space of its object or, on an object that deforms, along the axes of the triangle. Turns
  // of the surface are measured against it.
  vec3 localNormal SHARED_ZERO;
  float previousImportance SHARED_ZERO;  // of the frame before (Eq. 1)
};
SHARED_SIZE(VplState, 80)
SHARED_OFFSET(VplState, side, 44)
SHARED_OFFSET(VplState, localNormal, 64)

// A candidate for a VPL.
struct Candidate {
  vec3 position SHARED_ZERO;          // world space, m
  uint side SHARED_DEFAULT(kNoSide);  // voxel side; kNoSide for an attempt that hit nothing
  vec3 normal SHARED_ZERO;            // unit, world space
  float object SHARED_ZERO;
  vec3 reflectance SHARED_ZERO;
  float luminance SHARED_ZERO;     // of the side's radiance, W/(sr m^2)
  vec3 localPosition SHARED_ZERO;  // as in VplState
  float unused SHARED_ZERO;
};
SHARED_SIZE(Candidate, 64)
SHARED_OFFSET(Candidate, localPosition, 48)

SHARED_END
