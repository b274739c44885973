// Virtual point lights as the shading passes read them. The same layout as framework/shader_twins/vpl.h.
#ifndef FOVEA_VPL_GLSL
#define FOVEA_VPL_GLSL

// 48 bytes; 1024 of them fill a page of a uniform buffer (the fast way to read data that every invocation reads). The
// list index of a VPL is its slot, which determines its map in the shadow atlas and, modulo the number of interleave
// subsets, the subset that it shades in.
struct Vpl {
  vec4 positionArea;   // xyz: world space, m; w: surface area it stands for, m^2 (size of the kernel `disc`)
  vec4 normal;         // xyz: unit, the side it shines to; w: unused
  vec4 intensity;      // rgb: radiant intensity along the normal, W/sr = reflected flux / pi; all 0: an empty slot
};

bool isLit(Vpl v) { return any(notEqual(v.intensity.rgb, vec3(0.0))); }

const uint kVplPage = 1024u;

// State of a VPL that is kept from frame to frame, one entry per slot; a VPL keeps its slot for life. 80 bytes; an
// empty slot is all zeros.
struct VplState {
  vec4 positionImportance;  // xyz: world space, this frame; w: importance I of this frame, in [0, 1]
  vec4 normalLife;          // xyz: unit, world space; w: frames shown, including this one: 0 empty, 1 new
  vec4 reflectanceSide;     // rgb: reflectance; w: voxel side of this frame (bits of a uint)
  vec4 localPosition;       // xyz: in the space of its object; w: object. On an object that deforms, the place
                            // in a triangle (attach() in common/scene.glsl)
  vec4 localNormal;         // xyz: unit, in the space of its object (on one that deforms, along the axes of the
                            // triangle), as found; w: importance of the previous frame (Eq. 1)
};

const uint kNoSide = 0xffffffffu;

// A candidate VPL. 64 bytes.
struct Candidate {
  vec4 positionSide;          // xyz: world space; w: voxel side (bits of a uint), kNoSide if the attempt hit nothing
  vec4 normalObject;          // xyz: unit, world space; w: object
  vec4 reflectanceLuminance;  // rgb: reflectance; w: luminance of the side's radiance, W/(sr m^2)
  vec4 localPosition;         // xyz: as in VplState; w: unused
};

#endif
