// Initial samples of ReSTIR GI with rays on the device.
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/gi-samples-host/gi_samples_ports.h"
#include "passes/materials.h"

namespace fovea::passes {
namespace {

using namespace graph;

class GiSamplesDevice : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("gi-samples-device",
                      "one sample of the indirect light of each pixel, as `gi-samples-host` finds it, with "
                      "rays that are traced on the device");
    d.rays();
    declareGiSamples(d, Usage::StorageWrite);
    d.step("gi-samples-device/sample.comp").define("RAY_PASSAGE", fullMaterials());
    return d;
  }

  void record(RecordContext& ctx) override {
    ctx.step("sample").dispatchThreads(ctx.view().size.x, ctx.view().size.y);
  }
};

FOVEA_PASS(GiSamplesDevice);

}  // namespace
}  // namespace fovea::passes
