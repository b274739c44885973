// Triangles in runs that one draw can take, so that only those draws test materials in a shader that need to.
#pragma once

#include <cstdint>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

enum class DrawKind : uint8_t {
  DoubleSided,  // opaque, both sides
  SingleSided,  // opaque, the front only
  Tested,       // alpha-masked, or a mixture: look the material up for every fragment
};

struct DrawRun {
  DrawKind kind = DrawKind::Tested;
  uint32_t firstTriangle = 0, triangleCount = 0;
};

// Geometry where materials change all the time would take more draws than it saves tests.
inline constexpr size_t kMaxDrawRuns = 256;

// In the order of the triangles, covering all of them; one `Tested` run when there would be more than
// kMaxDrawRuns.
std::vector<DrawRun> drawRuns(const Scene& scene, const Geometry& geometry);

}  // namespace fovea::scene
