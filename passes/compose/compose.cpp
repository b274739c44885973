// Final composition of the image: irradiance times reflectance, plus direct light.
#include "fovea/pass.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Compose : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("compose",
                      "irradiance times the reflectance of the visible surfaces, plus direct light",
                      PassKind::Graphics);
    const SizeExpr width = widthOf("gbuffer.albedo"), height = heightOf("gbuffer.albedo");
    const ResourceSpec color = image2D(VK_FORMAT_R16G16B16A16_SFLOAT, width, height);
    d.input("gbuffer", "gbuffer",
            {member("albedo", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead)},
            "surfaces seen by the eye");
    d.input("irradiance", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "rgb: indirect irradiance / pi of each pixel, W/(sr m^2); background 0");
    d.input("direct", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "rgb: radiance to which the indirect light is added")
        .makeOptional();
    d.output("indirect", color, Usage::ColorAttachment,
             "rgb: indirect radiance rho E / pi towards the eye; background 0");
    d.output("radiance", color, Usage::ColorAttachment, "rgb: `direct` (if wired) plus `indirect`");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    kernel_ = ctx.fullscreen("compose/compose.frag", {"indirect", "radiance"},
                             {{"HAS_DIRECT", ctx.has("direct") ? "1" : "0"}});
  }
  void record(RecordContext& ctx) override { ctx.use(kernel_).drawFullscreen(); }

 private:
  Kernel kernel_;
};

FOVEA_PASS(Compose);

}  // namespace
}  // namespace fovea::passes
