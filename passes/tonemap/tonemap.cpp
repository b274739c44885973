// The display transform with which images are compared: T(x) = sRGB(clamp01(exposure * x)). The other curves are for
// viewing only.
#include "fovea/pass.h"
#include "framework/scene/frame.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Tonemap : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "tonemap",
        "display transform from linear radiance to an sRGB image, with the exact transfer function",
        PassKind::Graphics);
    d.input("radiance", image2D(), Usage::Sampled, "rgb: linear radiance, W/(sr m^2), any float format");
    d.input("adapted", image2D(VK_FORMAT_R32_SFLOAT, 1, 1), Usage::StorageRead,
            "exposure in place of the scene's own (pass adaptation)")
        .makeOptional();
    d.output("image", image2D(VK_FORMAT_R8G8B8A8_UNORM, widthOf("radiance"), heightOf("radiance")),
             Usage::ColorAttachment, "rgb: sRGB-encoded, a: 1");
    d.parameter("exposure", real(0, 0, 1e9),
                "factor from radiance to display intensity; 0 uses `adapted` or the scene's own exposure");
    d.parameter(
        "operator", choice("clamp", {"clamp", "reinhard", "agx"}),
        "curve before encoding: `clamp` is linear and clamps to 1 (used by every measure), `reinhard` is "
        "x / (1 + luminance), `agx` rolls highlights off towards white as film does (for viewing)");
    d.parameter("contrast", real(1, 0.5, 2), "exponent of the codes of `agx`; 1 changes nothing");
    d.parameter("saturation", real(1, 0, 2), "factor on the colour of the codes of `agx`; 1 changes nothing");
    d.counter("non_finite", "pixels whose radiance holds a NaN (shown black) or an infinity");
    d.fullscreen("tonemap/tonemap.frag", {"image"})
        .define("REINHARD", is("operator", "reinhard"))
        .define("AGX", is("operator", "agx"))
        .define("ADAPTED", wired("adapted"))
        .constant("sceneExposure", [](const RecordContext& ctx) { return ctx.frame().storedExposure(); })
        .constant("preExposure", [](const RecordContext& ctx) { return ctx.frame().preExposure; });
    return d;
  }
};

FOVEA_PASS(Tonemap);

}  // namespace
}  // namespace fovea::passes
