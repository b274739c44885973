// Sharp shadow edges: rays on the device decide where shadow maps cannot.
#include <string>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/acuity.h"
#include "passes/bundles.h"
#include "passes/materials.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ShadowRays : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("shadow-rays",
                      "direct light by rays through the triangles, at the edges of shadows, which shadow "
                      "maps widen and shift in steps of their texels");
    d.view().rays();
    d.input(
        "gbuffer", "gbuffer",
        gbufferMembers(Usage::StorageRead, {"position", "normal", "face", "albedo", "emission", "specular"}),
        "surfaces seen by the eye");
    d.inout("direct", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead | Usage::StorageWrite,
            "rgb: radiance towards the eye, W/(sr m^2); a: 0 where the shadow map is in doubt; becomes 1 "
            "where rays decide");
    declarePeriphery(
        d,
        "1 traces all pixels in doubt; 2 leaves out those outside the fovea where the eye resolves "
        "no more than every second pixel");
    d.counter("pixels", "pixels that were in doubt and traced");
    d.counter("rays", "lights towards which such pixels have traced");
    d.step("shadow-rays/shadow_rays.comp")
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

FOVEA_PASS(ShadowRays);

}  // namespace
}  // namespace fovea::passes
