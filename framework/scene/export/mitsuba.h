// Exports a scene at one moment as a Mitsuba 3 scene (an XML file, PLY meshes and textures), for checking pictures
// with an independent renderer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>

#include "fovea/error.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

struct MitsubaOptions {
  double time = 0;  // s: the moment that is exported
  // Defaults of the file's parameters $width, $height, $spp and $depth.
  glm::uvec2 size{512, 512};
  uint32_t samples = 64;
  uint32_t depth = 4;  // as Mitsuba counts: 1 is emission alone, 2 adds direct light
  bool full = false;   // full materials; if false, diffuse ones
};

// Writes NAME.xml, meshes/*.ply and textures/* into `folder`, which is created if it is missing, and returns the path
// of NAME.xml. Both renderers agree on units, diffuse reflectance, bilinear LOD-0 textures, shading normals, camera
// and box filter. They differ in the following, which the file says in a comment or a warning reports:
//   alpha MASK      Mitsuba cannot threshold: the mask is an image of 0 and 1 with 4 texels per side for each texel,
//                   shown without a filter. The integrator is then `volpath`, because `path` lets masked surfaces
//                   cast shadows as if they had no holes and counts a hole as a bounce.
//   spot lights     The falloff is a projected image.
//   emission        A double-sided surface that emits becomes two copies, 1e-5 of the scene's diagonal apart.
//   normals         Mitsuba does not turn interpolated normals towards the visible side of the surface.
//   backs           The backs of single-sided surfaces are black in Mitsuba; here the eye looks through them.
//   environment     A map is written as an image. A mere colour, which only the eye sees here, is left out; the alpha
//                   channel of the picture shows where it is.
//   range           Mitsuba does not limit the range of lights.
//   full materials  Metals become `principled`, dielectrics the sum of a `plastic` and a `roughplastic`. Both lack the
//                   light that is scattered more than once among microfacets (2% of a metal of roughness 0.35) and
//                   separate masking from shadowing, and the diffuse layer sees a smooth surface: alike to 1% up to a
//                   roughness of about 0.2. A warning names what is left out.
// Throws Error(CannotWrite).
std::filesystem::path exportMitsuba(const Scene& scene, const std::filesystem::path& folder,
                                    const MitsubaOptions& options, Diagnostics& warnings);

}  // namespace fovea::scene
