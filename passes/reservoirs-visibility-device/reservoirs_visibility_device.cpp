// Visibility of shared samples with rays on the device.
#include "fovea/pass.h"
#include "passes/materials.h"
#include "passes/reservoirs-visibility-host/reservoirs_visibility_ports.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ReservoirsVisibilityDevice : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("reservoirs-visibility-device",
                      "rays to the samples of indirect light that pixels are about to share, as "
                      "`reservoirs-visibility-host` traces them, on the device");
    d.rays();
    declareReservoirsVisibility(d, Usage::StorageRead, Usage::TexelRead, Usage::StorageWrite);
    d.step("reservoirs-visibility-device/visibility.comp")
        .define("RAY_PASSAGE", fullMaterials())
        .over("seen");
    return d;
  }

  void prepare(PrepareContext& ctx) override { checkReservoirsVisibility(ctx); }
};

FOVEA_PASS(ReservoirsVisibilityDevice);

}  // namespace
}  // namespace fovea::passes
