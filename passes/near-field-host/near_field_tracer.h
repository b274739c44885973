// Light from nearby surfaces, in the part that VPLs shaded as discs take from it, and all light that comes straight
// from emissive surfaces and from an environment map, found with rays through the triangles. This is bias compensation
// (Novak et al., "Screen-space bias compensation for interactive high-quality global illumination with virtual point
// lights", I3D 2011).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "passes/near-field-host/gather_cache.h"

namespace fovea::passes {

struct NearFieldSettings {
  float foveaRadius = 0.25f;  // image widths
  uint32_t spacing = 4;       // outside the fovea one pixel of each block of this width has a ray: 2, 4 or 8
  uint32_t bounces = 2;       // reflections of light on its way to the visible surface
  float area = 1;             // area of the discs, m^2; if 0, only `length` is found, no light
  // On emissive surfaces and in an environment map; the ray aimed at these chooses one of them.
  uint32_t emitterPoints = 4;
  uint32_t turn = 0, samples = 1;  // of all samples a pixel ever gets, the first one taken now and how many
  uint32_t foveaFactor = 1;        // rays per sample in blocks of 2 x 2 pixels; they use up as many turns
  bool fullMaterials = false;      // framework/scene/materials/bounced.h
  bool mapAlone = false;           // whether only the light of the environment map is found
  uint32_t seed = 0;
  uint32_t threads = 0;  // 0 uses one per core; the result does not depend on it
  // If given, light of further bounces comes from here where it is known, and what is gathered is added.
  GatherCache* cache = nullptr;
  float cellWidth = 0;  // of its cells, m
  // Texels of the G-buffer, in half precision, for the lobes of surfaces.
  std::span<const uint64_t> normal, specular;
};

struct NearFieldStatistics {
  // `shaded` counts rays from visible surfaces at whose ends the light was evaluated, `gathered` those of them that
  // gathered light of further bounces there.
  uint64_t rays = 0, shaded = 0, gathered = 0;
  // length / hits is the mean distance, in m, from visible surfaces to the surfaces seen from them.
  double hits = 0, length = 0;
};

// A VPL that is a disc of area A sends to a point at distance d less light than the point light it stands for, by the
// fraction A / (pi d^2 + A). Cosine-weighted rays bring back that fraction of the light they meet; where the fraction
// is small, rays are traced only with a small probability. Other rays are aimed at emissive surfaces, whose light is
// left to them wholly.
//
// image: one texel per block of 2 x 2 pixels, in rows of (size.x + 1) / 2. rgb: irradiance / pi at one pixel of the
// block or, outside the fovea and not close to an emissive surface, of the `spacing` x `spacing` pixels that hold it;
// 0 if there is no sample. a: sampleCode().
// gloss: if not empty, the same with the mean of the light under the lobe of the surface in place of irradiance / pi.
NearFieldStatistics traceNearField(const scene::Frame& frame, const scene::View& view,
                                   const scene::RayScene& rays, const NearFieldSettings& settings,
                                   std::span<glm::vec4> image, std::span<glm::vec4> gloss = {});

// The same light at single pixels, each with `samples` rays of its own; `foveaRadius` and `spacing` are not used.
//
// light: one entry per pixel. rgb: irradiance / pi; a: 1. All zeros if the pixel shows no surface.
NearFieldStatistics traceNearFieldPixels(const scene::Frame& frame, const scene::View& view,
                                         const scene::RayScene& rays, const NearFieldSettings& settings,
                                         std::span<const glm::uvec2> pixels, std::span<glm::vec4> light);

// Code of a sample, as pass temporal-accumulation reads it; exact in half precision. Bits 0 to 3: width of the block
// in pixels, at most 8; 4 to 6 and 7 to 9: x and y in it of the sampled pixel; 10: that pixel shows no surface, so
// there is no sample.
constexpr uint32_t sampleCode(uint32_t side, glm::uvec2 pixel, bool found) {
  return side | pixel.x << 4 | pixel.y << 7 | (found ? 0u : 1u) << 10;
}

// Returns the pixel whose turn it is in a block of side x side pixels, a power of two; consecutive turns lie far
// apart. block: its column and row. Vertically adjacent blocks use different columns and horizontally adjacent ones
// different rows, so that 2 x 2 blocks sample a strip one pixel wide in every frame.
glm::uvec2 samplePixel(uint32_t turn, uint32_t side, glm::uvec2 block);

}  // namespace fovea::passes
