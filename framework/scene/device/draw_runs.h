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
  // The material is looked up for every fragment; a run may hold simpler kinds, too.
  Masked,       // with holes, by their alpha
  Transparent,  // let a share of the light through; with full materials only
};

inline constexpr DrawKind kDrawKinds[] = {DrawKind::DoubleSided, DrawKind::SingleSided, DrawKind::Masked,
                                          DrawKind::Transparent};
inline bool isTested(DrawKind kind) { return kind == DrawKind::Masked || kind == DrawKind::Transparent; }

struct DrawRun {
  DrawKind kind = DrawKind::Transparent;
  uint32_t firstTriangle = 0, triangleCount = 0;
};

// Where materials change too often, more draws would cost more than the tests that they save.
inline constexpr size_t kMaxDrawRuns = 256;

// Runs in the order of the triangles, covering all of them; if there would be more than kMaxDrawRuns, a single one,
// which is Transparent with full materials and Masked otherwise. fullMaterials: glass and alphaMode BLEND are
// transparent.
std::vector<DrawRun> drawRuns(const Scene& scene, const Geometry& geometry, bool fullMaterials = false);

}  // namespace fovea::scene
