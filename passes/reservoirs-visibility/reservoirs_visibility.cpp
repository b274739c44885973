// Visibility of shared samples with rays on the device.
#include "fovea/pass.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/sizes.h"
#include "shaders/records/reservoir.h"

namespace fovea::passes {
namespace {

using namespace graph;

void declarePorts(PassDeclaration& d) {
  constexpr Usage images = Usage::StorageRead, lists = Usage::TexelRead, write = Usage::StorageWrite;
  d.view();
  d.input("gbuffer", "gbuffer", gbufferMembers(images, {"distance", "face"}), "surfaces seen by the eye");
  d.input(
       "moved", "moved-surfaces",
       {member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), images),
        member("face", image2D(VK_FORMAT_R16G16_SNORM), images)},
       "surfaces of the sources, if those belong to the previous frame (pass reservoirs-motion); otherwise "
       "they are pixels of `gbuffer`")
      .makeOptional();
  const ResourceSpec reservoirs = buffer("Reservoir", sizeof(Reservoir));
  d.input("own", reservoirs, lists, "reservoir of each pixel, row after row");
  d.input("others", reservoirs, lists, "reservoirs of the sources' pixels, row after row");
  d.input("sources", image2D(VK_FORMAT_R32_UINT), images,
          "x | y << 16: pixels of `others` that share their samples, for each pixel one or more side by "
          "side, at most 16; 0xffffffff for none");
  d.output("seen", image2D(VK_FORMAT_R32_UINT, widthOf("gbuffer.distance"), heightOf("gbuffer.distance")),
           write,
           "two bits for each source k; 2 k: the pixel sees the sample of the source, 2 k + 1: the source "
           "sees that of the pixel");
  d.counter("rays", "rays traced towards samples");
  d.counter("hidden", "rays that did not reach their sample");
  requireSameSize(d, "moved.position", "gbuffer.distance");
  const SizeExpr width = widthOf("gbuffer.distance"), height = heightOf("gbuffer.distance"),
                 each = ceilDiv(widthOf("sources"), width);
  d.require(same(heightOf("sources"), height) && same(each * width, widthOf("sources")) &&
                atMost(each, int(kMostSources)),
            "`sources` does not have the same number of texels, at most 16, for each pixel of `gbuffer`",
            "wire what belongs to one view");
  d.require(same(countOf("own"), width * height) && same(countOf("others"), width * height),
            "`own` and `others` do not have a reservoir for each pixel of `gbuffer`",
            "wire what belongs to one view");
}

class ReservoirsVisibility : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("reservoirs-visibility",
                      "rays to the samples of indirect light that pixels are about to share (ReSTIR GI)");
    d.rays();
    declarePorts(d);
    d.step("reservoirs-visibility/visibility.comp")
        .define("RAY_PASSAGE", fullMaterials())
        .define("MOVED", wired("moved"))
        .over("seen");
    return d;
  }
};

FOVEA_PASS(ReservoirsVisibility);

}  // namespace
}  // namespace fovea::passes
