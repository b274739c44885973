// Light paths from the sources into the scene, with VPLs where they hit (Keller, "Instant Radiosity", 1997).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "shaders/records/vpl.h"

namespace fovea::passes {

struct EmitSettings {
  uint32_t count = 1000;    // VPLs to store
  uint32_t bounces = 2;     // VPLs along one path, without the one on an emissive triangle
  uint32_t seed = 0;        // seed of the quasi-random numbers; another seed gives other paths
  uint32_t neighbours = 8;  // nearest VPLs used to estimate the area of a VPL
  bool emissiveTriangles = true;
  bool fullMaterials = false;  // as in framework/scene/materials/bounced.h
};

struct EmitResult {
  std::vector<scene::Vpl> vpls;  // at most `count`, ordered along a space-filling curve
  uint64_t paths = 0;            // number of paths by which the flux was divided
  uint64_t rays = 0;             // total number of rays traced
  uint64_t escaped = 0;          // rays that left the scene
};

// Traces until `count` VPLs are stored, or until so many paths have found nothing that the lights evidently do not
// reach the scene.
//
// The stopping rule does not bias the image. Let M + 1 be the first path whose VPLs no longer fit; that path is
// discarded and the flux is divided by M. Given M, the first M paths are exchangeable (the condition that they fit is
// symmetric in them), so the mean of any path quantity over them has the expectation of a single path; this is the
// argument of inverse binomial sampling, (r - 1) / (n - 1). Paths that escape count. The slots still free at the end
// (fewer than the VPLs of one path) are filled by splitting the brightest VPLs in two, which changes no sum.
EmitResult traceLightPaths(const scene::Frame& frame, const scene::RayScene& rays,
                           const EmitSettings& settings);

// Sets Vpl::area to pi r_k^2 / k, where r_k is the distance to the k-th nearest VPL whose normal is within 60
// degrees, but to no more than `limit`. The estimate is unbiased for the inverse of the density of a Poisson process.
void estimateAreas(std::vector<scene::Vpl>& vpls, uint32_t k, float limit);

// Sorts by the Morton code of the position. VPL i belongs to interleave subset i mod n^2, so neighbours fall into
// different subsets and every subset samples the whole scene evenly.
void sortAlongCurve(std::vector<scene::Vpl>& vpls);

}  // namespace fovea::passes
