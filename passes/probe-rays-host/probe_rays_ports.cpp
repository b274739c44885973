#include "passes/probe-rays-host/probe_rays_ports.h"

#include "fovea/error.h"
#include "passes/bundles.h"
#include "shaders/common/records/probes.h"

namespace fovea::passes {

using namespace graph;

void declareProbeRays(PassDeclaration& d, ProbeRayUsages usages) {
  d.view();
  d.input("probes", "probes",
          {member("irradiance", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), usages.images),
           member("distance", image2D(VK_FORMAT_R32G32_SFLOAT), usages.images),
           member("states", buffer("Probe", sizeof(scene::Probe)), usages.states)},
          "`probes` of pass probe-blend in the previous frame");
  const SizeExpr side = parameter("probes"), rays = parameter("rays");
  d.output("rays", "probe-rays",
           {member("grid", buffer("ProbeGrid", sizeof(scene::ProbeGrid)), usages.output,
                   "where the cells of the probes lie (shaders/common/records/probes.h)"),
            member("directions", buffer("ProbeDirection", sizeof(glm::vec4), rays), usages.output,
                   "xyz: directions of the rays, unit, the same for all probes"),
            member("hits", buffer("ProbeHit", sizeof(glm::vec4), side * side * side * rays), usages.output,
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
      "that of lights and of surfaces that shine, and the probes hold one bounce");
  d.counter("rays", kRaysDoc);
  d.counter("probes", "probes in the grid");
  d.counter("inside", "probes inside geometry, which light nothing");
}

void checkProbeRays(const PassContext& ctx, const std::string& pass) {
  const uint64_t known = ctx.count("probes.states"),
                 probes = ctx.count("rays.hits") / ctx.count("rays.directions");
  if (known == probes) return;
  throw Error(ExitCode::BadInput,
              "pass `" + pass + "`: `probes` knows " + std::to_string(known) +
                  " probes, the grid has room for " + std::to_string(probes),
              "wire pass probe-blend of the same rays, in the previous frame");
}

}  // namespace fovea::passes
