#include "passes/reflections-host/reflections_ports.h"

#include "passes/bundles.h"
#include "passes/sizes.h"

namespace fovea::passes {

using namespace graph;

void declareReflections(PassDeclaration& d, Usage read, Usage write) {
  d.view();
  d.input("mirrors", image2D(VK_FORMAT_R32G32B32A32_UINT), read,
          "pixels that reflect in a narrow lobe (pass mirrors)");
  d.output("samples", image2D(VK_FORMAT_R16G16B16A16_SFLOAT, widthOf("mirrors"), heightOf("mirrors")), write,
           "rgb: mean indirect light under the lobe, W/(sr m^2), at one pixel of each block of 2 x 2; a: "
           "code of that pixel as in pass near-field, negative where it does not reflect, for pass "
           "temporal-accumulation");
  d.output("distances", image2D(VK_FORMAT_R32_SFLOAT, widthOf("mirrors"), heightOf("mirrors")), write,
           "harmonic mean of the distances from each block to what its rays met, m, 0 where it does not "
           "reflect or all rays went into the surface, for pass reflection-vectors");
  d.parameter(
      "bounces", integer(2, 1, 64),
      "reflections of the light before it reaches the visible surface; 2 matches a path tracer of depth 4");
  d.parameter("first_samples", integer(16, 1, 1024),
              "rays per sample after a camera cut, when there is no history to build on");
  d.counter("mirrors", "pixels from which rays leave");
  d.counter("rays", kRaysDoc);
  d.counter("gathered", "rays at whose ends light of further bounces was gathered rather than known");
}

void checkReflections(const PassContext& ctx, glm::uvec2 half) {
  checkSize(ctx, "mirrors", half, "half its view", "wire mirrors of the view that the pass looks through");
}

}  // namespace fovea::passes
