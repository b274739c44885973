// Rays of probes that are traced on the device.
#include "fovea/pass.h"
#include "passes/materials.h"
#include "passes/probe-rays-host/probe_rays_ports.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ProbeRaysDevice : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("probe-rays-device",
                      "rays from a grid of probes over the scene and the light that they find, as "
                      "`probe-rays-host` finds it, with rays that are traced on the device");
    d.rays();
    declareProbeRays(d, {Usage::Sampled, Usage::TexelRead, Usage::StorageRead | Usage::StorageWrite});
    const SizeExpr side = parameter("probes"), probes = side * side * side;
    d.scratch("shares", buffer("uint", 4, probes), Usage::StorageRead | Usage::StorageWrite,
              "each probe traces one of so many of its rays; 0 outside of the grid");
    d.step("probe-rays-device/begin.comp").threads(parameter("rays"));
    d.step("probe-rays-device/probes.comp").threads(probes);
    d.step("probe-rays-device/trace.comp")
        .define("RAY_PASSAGE", fullMaterials())
        .define("FEEDBACK", parameter("feedback"))
        .threads(parameter("rays"), probes);
    return d;
  }

  void prepare(PrepareContext& ctx) override { checkProbeRays(ctx); }
};

FOVEA_PASS(ProbeRaysDevice);

}  // namespace
}  // namespace fovea::passes
