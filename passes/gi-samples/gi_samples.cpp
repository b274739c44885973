// Initial samples of ReSTIR GI with rays on the device.
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "shaders/records/reservoir.h"

namespace fovea::passes {
namespace {

using namespace graph;

void declarePorts(PassDeclaration& d) {
  d.view();
  d.output("reservoirs", buffer("Reservoir", sizeof(Reservoir), viewWidth() * viewHeight()),
           Usage::StorageWrite, "the sample of each pixel, row after row; all zeros where there is none");
  d.parameter("depth", integer(4, 3, 64),
              "edges of the longest path from a light to the eye, as in pass path-trace");
  d.parameter("spacing", integer(1, 1, 2),
              "1: every pixel gets a sample; 2: in each frame one of each block of 2 x 2 pixels, in turn");
  d.parameter("outside_spacing", integer(1, 1, 2),
              "spacing outside of the fovea; `spacing` if that is larger");
  d.parameter("paths", integer(1, 1, 64), "paths that are traced for a sample, of which one is chosen");
  d.counter("rays", kRaysDoc);
  d.counter("samples", "pixels that show a surface and got a sample");
}

class GiSamples : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("gi-samples",
                      "one sample of the indirect light of each pixel: a ray, what it meets, and the light "
                      "that leaves from there");
    d.rays();
    declarePorts(d);
    d.step("gi-samples/sample.comp").define("RAY_PASSAGE", fullMaterials());
    return d;
  }

  void record(RecordContext& ctx) override {
    ctx.step("sample").dispatchThreads(ctx.view().size.x, ctx.view().size.y);
  }
};

FOVEA_PASS(GiSamples);

}  // namespace
}  // namespace fovea::passes
