// Rays of probes, which find the light around each of them.
#include <algorithm>
#include <string>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/materials.h"
#include "passes/probe-rays/probe_tracer.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ProbeRays : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("probe-rays",
                      "rays from a grid of probes over the scene, and the light that they find: emitted, of "
                      "lights, and of any number of bounces by what the probes knew in the previous frame",
                      PassKind::Host);
    d.view();
    d.input("probes", "probes",
            {member("irradiance", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::HostRead),
             member("distance", image2D(VK_FORMAT_R32G32_SFLOAT), Usage::HostRead),
             member("states", buffer("Probe", sizeof(scene::Probe)), Usage::HostRead)},
            "`probes` of pass probe-blend in the previous frame");
    const SizeExpr side = parameter("probes"), rays = parameter("rays");
    d.output(
        "rays", "probe-rays",
        {member("grid", buffer("ProbeGrid", sizeof(scene::ProbeGrid)), Usage::HostWrite,
                "where the cells of the probes lie (shaders/common/records/probes.h)"),
         member("directions", buffer("ProbeDirection", sizeof(glm::vec4), rays), Usage::HostWrite,
                "xyz: directions of the rays, unit, the same for all probes"),
         member("hits", buffer("ProbeHit", sizeof(glm::vec4), side * side * side * rays), Usage::HostWrite,
                "of each probe in turn, one a ray; rgb: radiance that arrives, W/(sr m^2); a: distance to "
                "what is met, m, of backs the negative of its fifth, 0 where no ray was traced")},
        "what the rays of this frame met");
    d.parameter("probes", integer(16, 1, 32),
                "cells along the longest axis of the scene's bounds, with a probe in each");
    d.parameter("spacing", real(0, 0, 1e6, "m"), "least width of a cell, which makes the probes fewer");
    d.parameter("rays", integer(128, 8, 512), "rays of each probe; of one inside geometry a quarter of them");
    d.parameter("outside_share", integer(1, 1, 16),
                "probes that light nothing in the fovea trace one of so many of their rays");
    d.parameter("fovea_radius", real(0.25, 0.001, 4, "image widths"), "radius of the fovea");
    d.parameter(
        "bias", real(0.25, 0, 2, "spacings of the grid"),
        "how far points are moved off their surface where probes light them, as in pass probe-sample");
    d.parameter(
        "feedback", flag(true),
        "whether surfaces that rays meet reflect the light that `probes` knows; if not, they reflect only "
        "that of lights and of surfaces that shine, and the probes hold one bounce");
    declareMaterials(d, "`full` lets metals keep their colour");
    d.counter("rays", "rays traced, including those towards lights");
    d.counter("probes", "probes in the grid");
    d.counter("inside", "probes inside geometry, which light nothing");
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const Parameters& p = ctx.parameters();
    const auto directions = ctx.outputAs<glm::vec4>("rays.directions"),
               hits = ctx.outputAs<glm::vec4>("rays.hits");
    ProbeRaySettings settings;
    settings.previous = {ctx.inputAs<glm::vec4>("probes.irradiance"),
                         ctx.inputAs<glm::vec2>("probes.distance"),
                         ctx.inputAs<scene::Probe>("probes.states")};
    settings.bias = float(p.real("bias"));
    settings.feedback = p.flag("feedback");
    settings.outsideShare = uint32_t(p.integer("outside_share"));
    settings.foveaRadius = float(p.real("fovea_radius"));
    settings.fullMaterials = fullMaterials(p);
    checkSize(settings.previous.states.size(), hits.size() / directions.size());
    std::ranges::fill(hits, glm::vec4(0));
    probeDirections(frame.seed, uint32_t(frame.index), directions);
    ProbeRayStatistics statistics;
    if (frame.scene != nullptr && frame.geometry != nullptr && !frame.geometry->empty()) {
      settings.grid = probeGrid(frame.geometry->boundsMin, frame.geometry->boundsMax,
                                uint32_t(p.integer("probes")), float(p.real("spacing")));
      statistics = traceProbeRays(frame, ctx.view(),
                                  *scene::RayScene::cached(*frame.scene, *frame.geometry, passingOf(p)),
                                  settings, directions, hits);
    }
    settings.grid.rays = uint32_t(directions.size());
    ctx.outputAs<scene::ProbeGrid>("rays.grid")[0] = settings.grid;
    ctx.counter("rays", double(statistics.rays));
    ctx.counter("probes", double(probesOf(settings.grid)));
    ctx.counter("inside", double(statistics.inside));
  }

 private:
  static void checkSize(size_t known, size_t probes) {
    if (known == probes) return;
    throw Error(ExitCode::BadInput,
                "pass `probe-rays`: `probes` knows " + std::to_string(known) +
                    " probes, the grid has room for " + std::to_string(probes),
                "wire pass probe-blend of the same rays, in the previous frame");
  }
};

FOVEA_PASS(ProbeRays);

}  // namespace
}  // namespace fovea::passes
