// Virtual point lights as the shading passes read them. The same layout as framework/scene/vpl.h.
#ifndef FOVEA_VPL_GLSL
#define FOVEA_VPL_GLSL

// 48 bytes; 1024 of them fill a page of a uniform buffer (the fast way to read what every invocation reads).
// The list index of a VPL is its slot: its layer in the shadow atlas and, modulo the number of interleave subsets, the
// subset that shades with it.
struct Vpl {
  vec4 positionArea;   // xyz: world space, m; w: surface area it stands for, m^2 (the disc kernel's size)
  vec4 normal;         // xyz: unit, the side it shines to; w: unused
  vec4 intensity;      // rgb: radiant intensity along the normal, W/sr = reflected flux / pi; all 0: an empty slot
};

const uint kVplPage = 1024u;

#endif
