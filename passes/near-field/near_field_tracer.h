// Light of what is near, in the part that VPLs shaded as discs take from it, by rays through the triangles:
// bias compensation (Novak et al., "Screen-space bias compensation for interactive high-quality global
// illumination with virtual point lights", I3D 2011).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::passes {

struct NearFieldSettings {
  float foveaRadius = 0.25f;       // image widths
  uint32_t spacing = 4;            // outside the fovea one pixel of so many squared has a ray: 2, 4 or 8
  uint32_t bounces = 2;            // reflections of light on its way to what the eye sees
  float area = 1;                  // of the discs, m^2; 0: no light, but `length`
  uint32_t turn = 0, samples = 1;  // of all that a pixel ever gets: the first one, and how many now
  uint32_t seed = 0;
  uint32_t threads = 0;  // 0: one a core; the result does not depend on it
};

struct NearFieldStatistics {
  uint64_t rays = 0,
           shaded = 0;  // shaded: of those from what the eye sees, ends at which light was looked for
  double hits = 0,
         length = 0;  // m; length / hits is the mean distance to what is seen from what the eye sees
};

// A VPL that is a disc of area A sends what is at a distance d the part A / (pi d^2 + A) of its light less
// than the point it stands for would. Cosine-weighted rays bring that part of the light they meet; where the
// part is small only as many as are worth it.
//
// image: a texel for a block of 2 x 2 pixels, rows of (size.x + 1) / 2. rgb: irradiance / pi at one pixel of
// the block, or, outside the fovea, of the `spacing` x `spacing` pixels that hold it; 0 if there is no
// sample. a: sampleCode().
NearFieldStatistics traceNearField(const scene::Frame& frame, const scene::View& view,
                                   const scene::RayScene& rays, const NearFieldSettings& settings,
                                   std::span<glm::vec4> image);

// What a sample is for, as pass temporal-accumulation reads it; exact as a half. Bits 0 to 3: side of the
// block in pixels, at most 8; 4 to 6 and 7 to 9: x and y in it of the pixel that was sampled; 10: that pixel
// shows no surface, so there is no sample.
constexpr uint32_t sampleCode(uint32_t side, glm::uvec2 pixel, bool found) {
  return side | pixel.x << 4 | pixel.y << 7 | (found ? 0u : 1u) << 10;
}

// Which pixel of a block of side x side pixels, a power of two, has its turn: neighbours come far from each
// other. block: its column and row. In blocks below each other columns differ, in those beside each other
// rows: so that blocks of 2 x 2 meet a strip one pixel wide in every frame.
glm::uvec2 samplePixel(uint32_t turn, uint32_t side, glm::uvec2 block);

}  // namespace fovea::passes
