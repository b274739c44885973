// Light at the ends of rays, with a memory of what was gathered there.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/rays/surface_tracer.h"
#include "passes/near-field-host/gather_cache.h"

namespace fovea::passes {

// What one thread adds while it asks for light: the rays it traced, how often it gathered light, and what it found for
// the cache.
struct GatheredLight {
  uint64_t rays = 0, gathered = 0;
  std::vector<GatherCache::Sample> samples;
};

// The mean radiance that reaches v after at most `bounces` reflections, and from emissive surfaces. stream: of random
// numbers. cache: if given, it comes from there where it is known; the caller adds the samples to it. cellWidth: of its
// cells, m.
glm::vec3 gatheredLight(const scene::SurfaceTracer& surfaces, const scene::TracedSurface& v, uint32_t bounces,
                        uint32_t stream, const GatherCache* cache, float cellWidth, GatheredLight& sum);

}  // namespace fovea::passes
