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
//   environment     Only the eye sees it here, so it is left out; the alpha channel of the picture shows where it is.
//   range           Mitsuba does not limit the range of lights.
// Throws Error(CannotWrite).
std::filesystem::path exportMitsuba(const Scene& scene, const std::filesystem::path& folder,
                                    const MitsubaOptions& options, Diagnostics& warnings);

}  // namespace fovea::scene
