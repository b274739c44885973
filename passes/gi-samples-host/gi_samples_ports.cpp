#include "passes/gi-samples-host/gi_samples_ports.h"

#include "passes/bundles.h"
#include "shaders/common/records/reservoir.h"

namespace fovea::passes {

using namespace graph;

void declareGiSamples(PassDeclaration& d, Usage write) {
  d.view();
  d.output("reservoirs", buffer("Reservoir", sizeof(Reservoir), viewWidth() * viewHeight()), write,
           "the sample of each pixel, row after row; all zeros where there is none");
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

}  // namespace fovea::passes
