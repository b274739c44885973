// Light paths from the sources into the scene; what they hit becomes VPLs (Keller, "Instant Radiosity", 1997).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/shader_twins/vpl.h"

namespace fovea::passes {

struct EmitSettings {
  uint32_t count = 1000;    // VPLs to store
  uint32_t bounces = 2;     // VPLs along one path, without the one on an emissive triangle
  uint32_t seed = 0;        // of the quasi-random numbers: another seed, other paths
  uint32_t neighbours = 8;  // for the area of a VPL
  bool emissiveTriangles = true;
};

struct EmitResult {
  std::vector<scene::Vpl> vpls;  // at most `count`; order: along a space-filling curve
  uint64_t paths = 0;            // that the flux was divided by
  uint64_t rays = 0;             // traced in all
  uint64_t escaped = 0;          // rays that left the scene
};

// Traces until `count` VPLs are stored, or until so many paths found nothing that the scene cannot be reached by its lights.
//
// The stopping rule does not bias the picture. Let M + 1 be the first path whose VPLs no longer fit; that path is thrown
// away and the flux is divided by M. Given M, the first M paths are exchangeable (the condition that they fit is symmetric
// in them), so the mean of any path quantity over them has the expectation of a single path: the argument of inverse
// binomial sampling, (r - 1) / (n - 1). Paths that escape count. The slots still free at the end (fewer than the VPLs of
// one path) are filled by splitting the brightest VPLs in two, which changes no sum.
EmitResult traceLightPaths(const scene::Frame& frame, const scene::RayScene& rays,
                           const EmitSettings& settings);

// Fills Vpl::area: pi r_k^2 / k with the distance r_k to the k-th nearest VPL whose normal is within 60 degrees, which is
// unbiased for the inverse of the density of a Poisson process; at most `limit`.
void estimateAreas(std::vector<scene::Vpl>& vpls, uint32_t k, float limit);

// Sorts by Morton code of the position, so that VPL i shades in interleave subset i mod n^2 and neighbours fall into
// different subsets: every subset samples the whole scene alike.
void sortAlongCurve(std::vector<scene::Vpl>& vpls);

}  // namespace fovea::passes
