// Rays of probes, and what they find.
#include "fovea/pass.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "shaders/records/probes.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr Usage kReadWrite = Usage::StorageRead | Usage::StorageWrite;

void declarePorts(PassDeclaration& d) {
  d.view();
  d.input("probes", "probes",
          {member("irradiance", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::Sampled),
           member("distance", image2D(VK_FORMAT_R32G32_SFLOAT), Usage::Sampled),
           member("states", buffer("Probe", sizeof(scene::Probe)), Usage::TexelRead)},
          "`probes` of pass probe-blend in the previous frame");
  const SizeExpr side = parameter("probes"), rays = parameter("rays");
  d.output("rays", "probe-rays",
           {member("grid", buffer("ProbeGrid", sizeof(scene::ProbeGrid)), kReadWrite,
                   "where the cells of the probes lie (shaders/records/probes.h)"),
            member("directions", buffer("ProbeDirection", sizeof(glm::vec4), rays), kReadWrite,
                   "xyz: directions of the rays, unit, the same for all probes"),
            member("hits", buffer("ProbeHit", sizeof(glm::vec4), side * side * side * rays), kReadWrite,
                   "of each probe in turn, one a ray; rgb: radiance that arrives, W/(sr m^2); a: distance to "
                   "what is met, m, of backs the negative of its fifth, 0 where no ray was traced")},
           "what the rays of this frame met");
  d.parameter("probes", integer(16, 1, 32),
              "cells along the longest axis of the scene's bounds, with a probe in each");
  d.parameter("spacing", real(0, 0, 1e6, "m"), "least width of a cell, which makes the probes fewer");
  d.parameter("rays", integer(128, 8, 512), "rays of each probe; of one inside geometry a quarter of them");
  d.parameter("outside_share", integer(1, 1, 16),
              "probes that light nothing in the fovea trace one of so many of their rays");
  d.parameter("bias", real(0.25, 0, 2, "spacings of the grid"),
              "how far points are moved off their surface where probes light them, as in pass probe-sample");
  d.parameter(
      "feedback", flag(true),
      "whether surfaces that rays meet reflect the light that `probes` knows; if not, they reflect only "
      "that of lights and of emissive surfaces, and the probes hold one bounce");
  d.counter("rays", kRaysDoc);
  d.counter("probes", "probes in the grid");
  d.counter("inside", "probes inside geometry, which light nothing");
  d.require(same(countOf("probes.states"), side * side * side),
            "`probes` is of another number of probes than the grid has room for",
            "wire pass probe-blend of the same rays, in the previous frame");
}

class ProbeRays : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("probe-rays", "rays from a grid of probes over the scene and the light that they find");
    d.rays();
    declarePorts(d);
    const SizeExpr side = parameter("probes"), probes = side * side * side;
    d.scratch("shares", buffer("uint", 4, probes), kReadWrite,
              "each probe traces one of so many of its rays; 0 outside of the grid");
    d.step("probe-rays/begin.comp").threads(parameter("rays"));
    d.step("probe-rays/probes.comp").threads(probes);
    d.step("probe-rays/trace.comp")
        .define("RAY_PASSAGE", fullMaterials())
        .define("FEEDBACK", parameter("feedback"))
        .threads(parameter("rays"), probes);
    return d;
  }
};

FOVEA_PASS(ProbeRays);

}  // namespace
}  // namespace fovea::passes
