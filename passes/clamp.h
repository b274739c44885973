// The clamp on the distance to a VPL (Eq. 2 of the paper). Shading and the intensities of VPLs have to agree on it, so
// all passes that use it declare the same parameters here.
#pragma once

#include <string>

#include "fovea/pass.h"
#include "fovea/scene.h"

namespace fovea::passes {

inline void declareClamp(graph::PassDeclaration& d, const std::string& doc) {
  d.parameter("clamp_distance", graph::real(1.5, 0, 1e6, "m or mean free paths"), doc);
  d.parameter(
      "clamp_unit", graph::choice("metres", {"metres", "mean-free-paths"}),
      "unit of `clamp_distance`: `metres` (the paper), or `mean-free-paths` of the scene, 4 V / S with "
      "the volume V of its bounds and the area S of its surfaces, so that one value suits scenes of any "
      "size");
}

// The clamp distance in metres, whatever its unit; 0 if there is no clamp.
inline float clampDistance(const graph::RecordContext& ctx) {
  const graph::Parameters& p = ctx.parameters();
  const float unit = p.text("clamp_unit") == "metres" ? 1 : ctx.frame().geometry->meanFreePath;
  return float(p.real("clamp_distance")) * unit;
}

}  // namespace fovea::passes
