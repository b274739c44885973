// Light from nearby surfaces at the few pixels that are shaded anew, with rays on the device.

#include <glm/glm.hpp>

#include "fovea/pass.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/sizes.h"

namespace fovea::passes {
namespace {

using namespace graph;

void declarePorts(PassDeclaration& d) {
  d.view();
  d.input("shade", "shade-mask", shadeMaskAlone(Usage::StorageRead), "pixels whose light must be known");
  d.input("spread", spreadBuffer(), Usage::StorageRead,
          "x: least area of a VPL's disc, m^2, from pass near-field");
  d.inout(
      "near_field", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead | Usage::StorageWrite,
      "rgb: irradiance / pi, W/(sr m^2); a: 0 where it is not known; becomes 1 where a pixel of `shade` got "
      "rays");
  d.parameter("samples", integer(1, 1, 1024), "rays per pixel; 4 x 4 pixels distribute theirs evenly");
  d.parameter(
      "bounces", integer(2, 1, 64),
      "reflections of the light before it reaches the visible surface; 2 matches a path tracer of depth 4");
  d.parameter(
      "reach", real(4, 1, 1000),
      "how far rays reach: one goes as far as a distance with a probability of this many times the part "
      "of the light that discs leave out there, as that of pass near-field");
  d.counter("rays", kRaysDoc);
  d.counter("pixels", "pixels that got rays");
  for (const char* port : {"shade.mask", "near_field"})
    requireSize(d, port, viewWidth(), viewHeight(), "its view",
                "wire images of the view that the pass looks through");
}

constexpr Usage kReadWrite = Usage::StorageRead | Usage::StorageWrite;

class NearFieldPixels : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("near-field-pixels",
                      "light from nearby surfaces at those pixels of a mask where it is not known");
    d.rays().recorded();
    declarePorts(d);
    d.scratch("traced", image2D(VK_FORMAT_R32G32B32A32_SFLOAT, viewWidth(), viewHeight()),
              kReadWrite | Usage::TransferWrite,
              "rgb: what the rays of a pixel found; a: 1 where they did, else 0");
    d.scratch("items", buffer("uint", 4, viewWidth() * viewHeight()), kReadWrite,
              "the pixels whose light is not known, in any order");
    d.scratch("listed", buffer("uint", 4), kReadWrite | Usage::TransferWrite, "how many these are");
    d.scratch("dispatch", buffer("Dispatch", 4, 3), kReadWrite | Usage::Indirect | Usage::TransferWrite,
              "indirect dispatch over `items`");
    d.step("near-field-pixels/list.comp").over("near_field");
    d.step("near-field-pixels/trace.comp").define("RAY_PASSAGE", fullMaterials());
    d.step("near-field-pixels/write.comp").indirect("dispatch");
    return d;
  }

  void record(RecordContext& ctx) override {
    const auto samples = uint32_t(ctx.parameters().integer("samples"));
    ctx.clear("traced", {});
    ctx.fill("listed", 0);
    ctx.fill("dispatch", 1);
    ctx.run("list");
    for (uint32_t turn = 0; turn < samples; ++turn)
      ctx.step("trace").constant("turn_", turn).dispatchIndirect("dispatch");
    ctx.run("write");
  }
};

FOVEA_PASS(NearFieldPixels);

}  // namespace
}  // namespace fovea::passes
