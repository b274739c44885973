// A scene at one moment as a Mitsuba 3 scene: an XML file, PLY meshes and textures, for checking pictures
// with an independent renderer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>

#include "fovea/error.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

struct MitsubaOptions {
  double time = 0;  // s: where everything is that moves
  // Defaults of the file's parameters $width, $height, $spp and $depth.
  glm::uvec2 size{512, 512};
  uint32_t samples = 64;
  uint32_t depth = 4;  // 1: emission, 2: and direct light, as Mitsuba counts, too
};

// Writes NAME.xml, meshes/*.ply and textures/* into `folder` (made where it is missing); returns the path of
// NAME.xml. Same in both renderers: units, diffuse reflectance, bilinear LOD-0 textures, shading normals,
// camera, box filter. Not the same, and said in a comment of the file or as a warning:
//   alpha MASK      Mitsuba cannot threshold: an image of 0 and 1, 4 texels a side for each one, shown
//   without filter.
//                   The integrator is then `volpath`: `path` lets masked surfaces shadow as if they had no
//                   holes, and counts a hole as a bounce
//   spot lights     their falloff as a projected image
//   emission        of double-sided surfaces by two copies, 1e-5 of the scene's diagonal apart
//   normals         Mitsuba does not turn interpolated normals towards the side of the surface that is seen
//   backs           of single-sided surfaces are black there; here the eye looks through them
//   environment     is only seen here: it is left out, the picture's alpha says where it shows
//   range           of lights is not limited there
// Throws Error(CannotWrite).
std::filesystem::path exportMitsuba(const Scene& scene, const std::filesystem::path& folder,
                                    const MitsubaOptions& options, Diagnostics& warnings);

}  // namespace fovea::scene
