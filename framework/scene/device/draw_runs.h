// Groups triangles into runs of one draw each, so that a fragment shader tests materials only in the draws
// that need it.
#pragma once

#include <cstdint>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

enum class DrawKind : uint8_t {
  DoubleSided,  // opaque, both sides
  SingleSided,  // opaque, the front only
  Tested,       // alpha-masked, transparent or mixed: the material is looked up for every fragment
};

struct DrawRun {
  DrawKind kind = DrawKind::Tested;
  uint32_t firstTriangle = 0, triangleCount = 0;
};

// Where materials change too often, more draws would cost more than the tests that they save.
inline constexpr size_t kMaxDrawRuns = 256;

// Runs in the order of the triangles, covering all of them; a single `Tested` run if there would be
// more than kMaxDrawRuns. fullMaterials: glass is transparent.
std::vector<DrawRun> drawRuns(const Scene& scene, const Geometry& geometry, bool fullMaterials = false);

}  // namespace fovea::scene
