// Sharp shadow edges: rays on the device decide where shadow maps cannot.
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/acuity.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/sizes.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ShadowRays : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("shadow-rays",
                      "direct light by rays through the triangles, at the edges of shadows, which shadow "
                      "maps widen and shift in steps of their texels");
    d.view().rays().recorded();
    d.input(
        "gbuffer", "gbuffer",
        gbufferMembers(Usage::StorageRead, {"distance", "normal", "face", "albedo", "emission", "specular"}),
        "surfaces seen by the eye");
    d.inout("direct", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead | Usage::StorageWrite,
            "rgb: radiance towards the eye, W/(sr m^2); a: 0 where the shadow map is in doubt; becomes 1 "
            "where rays decide");
    declarePeriphery(
        d,
        "1 traces all pixels in doubt; 2 leaves out those outside the fovea where the eye resolves "
        "no more than every second pixel");
    requireMaterials(d);
    requireSameSize(d, "direct", "gbuffer.distance");
    d.counter("pixels", "pixels that were in doubt and traced");
    d.counter("rays", "lights towards which such pixels have traced");
    d.step("shadow-rays/shadow_rays.comp")
        .define("GLOSS", fullMaterials())
        .define("RAY_PASSAGE", fullMaterials());
    return d;
  }

  void record(RecordContext& ctx) override {
    const Square fine = fineSquare(ctx.view(), ctx.parameters(), 1).within(ctx.extent("direct"));
    const glm::ivec2 size = fine.high - fine.low;
    if (size.x == 0 || size.y == 0) return;
    ctx.step("shadow_rays")
        .constant("fine", fine.corners())
        .dispatchThreads(uint32_t(size.x), uint32_t(size.y));
  }
};

FOVEA_PASS(ShadowRays);

}  // namespace
}  // namespace fovea::passes
