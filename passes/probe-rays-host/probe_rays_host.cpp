// Rays of probes, which find the light around each of them.
#include <algorithm>

#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/materials.h"
#include "passes/probe-rays-host/probe_rays_ports.h"
#include "passes/probe-rays-host/probe_tracer.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ProbeRaysHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "probe-rays-host",
        "rays from a grid of probes over the scene, and the light that they find: emitted, of "
        "lights, and of any number of bounces by what the probes knew in the previous frame; on the CPU",
        PassKind::Host);
    declareProbeRays(d, {Usage::HostRead, Usage::HostRead, Usage::HostWrite});
    return d;
  }

  void prepare(PrepareContext& ctx) override { checkProbeRays(ctx, "probe-rays-host"); }

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
    settings.foveaRadius = ctx.view().foveaRadius;
    settings.fullMaterials = fullMaterials(p);
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
};

FOVEA_PASS(ProbeRaysHost);

}  // namespace
}  // namespace fovea::passes
