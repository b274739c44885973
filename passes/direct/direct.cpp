// Direct lighting: light reflected once on its way from a light to the eye, plus the surfaces' own emission.
#include <string>
#include <vector>

#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "passes/bundles.h"
#include "passes/materials.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Direct : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "direct",
        "direct lighting: emission plus rho / pi times the unoccluded irradiance of each light, "
        "or with full materials all of its light that the surface reflects",
        PassKind::Graphics);
    d.recorded();
    d.view();
    d.input(
        "gbuffer", "gbuffer",
        gbufferMembers(Usage::StorageRead, {"distance", "normal", "face", "albedo", "emission", "specular"}),
        "surfaces seen by the eye");
    d.input("maps", "shadow-maps", shadowMapMembers(), "shadow maps of the lights");
    d.output(
        "direct",
        ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, widthOf("gbuffer.distance"),
                        heightOf("gbuffer.distance"))),
        Usage::ColorAttachment,
        "rgb: radiance towards the eye, W/(sr m^2), in the background that of the environment; a: 0 where "
        "the edge of a shadow lies between texels of a map, else 1");
    d.parameter("filter", choice("bilinear", {"none", "bilinear", "pcf"}),
                "shadow filter: `none` makes one comparison (jagged edges), `bilinear` interpolates four, "
                "`pcf` averages 3x3 bilinear ones (softer edges)");
    const auto shade = [&](const char* name, int kind) {
      d.fullscreen("direct/direct.frag", {"direct"})
          .called(name)
          .define("SHADOW_FILTER", parameter("filter"))
          .define("ONE_LIGHT", kind)
          .define("GLOSS", fullMaterials());
    };
    shade("many lights", 0);
    shade("one light", 1);
    shade("one map", 2);
    requireMaterials(d);
    return d;
  }

  void record(RecordContext& ctx) override {
    const std::vector<scene::Light>& lights = ctx.frame().lights;
    const bool oneMap = scene::shadowLayers(lights) == 1;
    ctx.run(lights.size() != 1 ? "many lights" : oneMap ? "one map" : "one light");
  }
};

FOVEA_PASS(Direct);

}  // namespace
}  // namespace fovea::passes
