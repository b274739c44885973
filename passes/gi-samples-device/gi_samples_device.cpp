// Initial samples of ReSTIR GI with rays on the device.
#include "fovea/pass.h"
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
    d.step("gi-samples-device/sample.comp").define("RAY_PASSAGE", fullMaterials()).over("reservoirs");
    return d;
  }
};

FOVEA_PASS(GiSamplesDevice);

}  // namespace
}  // namespace fovea::passes
