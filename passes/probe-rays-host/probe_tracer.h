// Traces the rays of probes through the triangles: what each of them meets, and the light found there.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "passes/probe-rays-host/probe_field.h"

namespace fovea::passes {

struct ProbeRaySettings {
  scene::ProbeGrid grid;
  ProbeImages previous;  // what the probes knew after the previous frame
  bool feedback = true;  // whether surfaces reflect the light that probes know, else only that of emitters
  float bias = 0.25f;    // ProbeField
  // Probes that light nothing in the fovea trace one of so many rays; foveaRadius: image widths.
  uint32_t outsideShare = 1;
  float foveaRadius = 0.25f;
  bool fullMaterials = false;  // framework/scene/materials/bounced.h
  uint32_t threads = 0;        // 0 uses one per core; the result does not depend on it
};

struct ProbeRayStatistics {
  uint64_t rays = 0;    // including those towards lights
  uint64_t inside = 0;  // probes inside geometry
};

// A spherical Fibonacci set (Marques et al., "Spherical Fibonacci Point Sets for Illumination Integrals", CGF 2013),
// turned at random in each frame. xyz: unit.
void probeDirections(uint32_t seed, uint32_t frame, std::span<glm::vec4> directions);

// hits: of probe i from i * grid.rays on. rgb: radiance that arrives along the ray, W/(sr m^2); a: distance to what it
// meets, m, kFarAway if nothing; where that is the back of a single-sided surface, which is black, its negative times
// kBackShortened; 0 if the ray was not traced.
ProbeRayStatistics traceProbeRays(const scene::Frame& frame, const scene::View& view,
                                  const scene::RayScene& rays, const ProbeRaySettings& settings,
                                  std::span<const glm::vec4> directions, std::span<glm::vec4> hits);

}  // namespace fovea::passes
