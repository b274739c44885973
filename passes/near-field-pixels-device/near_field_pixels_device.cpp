// Light from nearby surfaces at the few pixels that are shaded anew, with rays on the device.
#include "fovea/pass.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/near-field-pixels-host/near_field_pixels_ports.h"

namespace fovea::passes {
namespace {

using namespace graph;

class NearFieldPixelsDevice : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("near-field-pixels-device",
                      "light from nearby surfaces at those pixels of a mask where it is not known, as "
                      "`near-field-pixels-host` finds it, with rays that are traced on the device");
    d.rays().recorded();
    declareNearFieldPixels(d, shadeMaskAlone(Usage::StorageRead), Usage::StorageRead,
                           Usage::StorageRead | Usage::StorageWrite);
    d.scratch("traced", image2D(VK_FORMAT_R32G32B32A32_SFLOAT, viewWidth(), viewHeight()),
              Usage::StorageRead | Usage::StorageWrite,
              "rgb: what the rays of a pixel found; a: 1 where they did, else 0");
    d.step("near-field-pixels-device/trace.comp").define("RAY_PASSAGE", fullMaterials());
    d.step("near-field-pixels-device/write.comp").over("near_field");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    const VkExtent3D view = ctx.extent("traced");
    checkNearFieldPixels(ctx, {view.width, view.height});
  }

  void record(RecordContext& ctx) override {
    const auto samples = uint32_t(ctx.parameters().integer("samples"));
    for (uint32_t turn = 0; turn < samples; ++turn)
      ctx.step("trace").constant("turn_", turn).dispatchOver("traced");
    ctx.run("write");
  }
};

FOVEA_PASS(NearFieldPixelsDevice);

}  // namespace
}  // namespace fovea::passes
