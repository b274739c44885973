// The sum of all light, in graphs that process the irradiance after pass deferred.
#include "fovea/pass.h"
#include "passes/bundles.h"
#include "passes/materials.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Compose : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "compose",
        "irradiance times the reflectance of the visible surfaces, plus glossy reflections and direct light",
        PassKind::Graphics);
    d.view();
    d.input("gbuffer", "gbuffer",
            gbufferMembers(Usage::StorageRead, {"distance", "normal", "albedo", "specular"}),
            "surfaces seen by the eye");
    const ResourceSpec color = image2D(VK_FORMAT_R16G16B16A16_SFLOAT);
    d.input("irradiance", color, Usage::StorageRead,
            "rgb: indirect irradiance / pi of each pixel, W/(sr m^2); background 0");
    d.input("gloss", color, Usage::StorageRead,
            "rgb: with full materials, indirect light under the lobe of each surface, W/(sr m^2) (pass "
            "deferred); if not wired, the irradiance is used instead")
        .when(fullMaterials());
    d.input(
         "reflections", color, Usage::StorageRead,
         "rgb: with full materials, indirect light under the narrow lobes of smooth surfaces, W/(sr m^2), in "
         "place of `gloss`; a: 0 where there is none (pass reflections)")
        .when(fullMaterials());
    d.input("direct", color, Usage::StorageRead, "rgb: radiance to which the indirect light is added")
        .makeOptional();
    const ResourceSpec picture = ofLight(
        image2D(VK_FORMAT_R16G16B16A16_SFLOAT, widthOf("gbuffer.albedo"), heightOf("gbuffer.albedo")));
    d.output("indirect", picture, Usage::ColorAttachment,
             "rgb: indirect radiance towards the eye, rho E / pi and glossy reflections; background 0");
    d.output("radiance", picture, Usage::ColorAttachment, "rgb: `direct` (if wired) plus `indirect`");
    requireMaterials(d);
    d.fullscreen("compose/compose.frag", {"indirect", "radiance"})
        .define("HAS_DIRECT", wired("direct"))
        .define("GLOSS", fullMaterials() * (SizeExpr(2) - wired("gloss")))
        .define("REFLECTIONS", wired("reflections"));
    return d;
  }
};

FOVEA_PASS(Compose);

}  // namespace
}  // namespace fovea::passes
