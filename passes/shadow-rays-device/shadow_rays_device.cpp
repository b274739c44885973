// Sharp shadow edges: rays on the device decide where shadow maps cannot.
#include <string>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/acuity.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/shadow_edges.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ShadowRaysDevice : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("shadow-rays-device",
                      "direct light by rays through the triangles, at the edges of shadows, as "
                      "`shadow-rays-host` finds it, with rays that are traced on the device");
    d.view().rays();
    d.input(
        "gbuffer", "gbuffer",
        gbufferMembers(Usage::StorageRead, {"position", "normal", "face", "albedo", "emission", "specular"}),
        "surfaces seen by the eye");
    declareShadowEdges(d, Usage::StorageRead | Usage::StorageWrite);
    d.counter("rays", "lights towards which such pixels have traced");
    d.step("shadow-rays-device/shadow_rays.comp")
        .define("GLOSS", fullMaterials())
        .define("RAY_PASSAGE", fullMaterials())
        .constant(
            "fine",
            [](const RecordContext& ctx) { return fineSquare(ctx.view(), ctx.parameters(), 1).corners(); })
        .over("direct");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    checkMaterials(ctx);
    const VkExtent3D direct = ctx.extent("direct"), seen = ctx.extent("gbuffer.position");
    if (direct.width == seen.width && direct.height == seen.height) return;
    const auto text = [](VkExtent3D e) { return std::to_string(e.width) + "x" + std::to_string(e.height); };
    throw Error(ExitCode::BadInput, "`direct` has " + text(direct) + " pixels, its G-buffer " + text(seen),
                "wire direct light of the view that the G-buffer shows");
  }
};

FOVEA_PASS(ShadowRaysDevice);

}  // namespace
}  // namespace fovea::passes
