// Debug view: the VPLs and one of their properties.
#include <algorithm>
#include <glm/glm.hpp>

#include "fovea/pass.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint64_t kMostSlots = 1 << 16;  // the slot number takes half of a pixel's key

class ViewVpls : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "view-vpls",
        "debug view: every VPL visible to the eye, as a disc coloured by importance, age or luminance");
    d.view();
    d.input("state", vplStateBuffer(), Usage::TexelRead, "VPLs; empty slots are not drawn");
    d.input("vpls", vplBuffer(), Usage::TexelRead, "the same VPLs as light sources, for show `luminance`")
        .makeOptional();
    d.input("gbuffer", "gbuffer", gbufferMembers(Usage::Sampled, {"distance"}),
            "surfaces that occlude VPLs; if not wired, all VPLs are drawn")
        .makeOptional();
    d.input("picture", image2D(), Usage::Sampled,
            "rgb: radiance over which the VPLs are drawn; black if not wired")
        .makeOptional();
    d.output("image", ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, viewWidth(), viewHeight())),
             Usage::StorageWrite, "rgb: colours for pass `tonemap` at the scene's exposure; a: 1");
    d.scratch("keys", buffer("uint", 4, viewWidth() * viewHeight()),
              Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite,
              "key of the nearest VPL at each pixel");
    d.parameter("show", choice("importance", {"importance", "age", "luminance"}),
                "property shown by the colours, from violet (0) to yellow: importance, age in frames, or "
                "luminance of the intensity");
    d.parameter(
        "range", real(0, 0, 1e9),
        "value shown as the last colour; 0 uses 1 for importance, 60 frames for age, 1 W/sr for luminance");
    d.parameter("radius", real(3, 0.5, 64, "px"), "radius of a disc");
    const SizeExpr row = min(countOf("state"), 1024);
    d.fill("keys", 0xffffffffu);
    d.step("view-vpls/splat.comp")
        .define("DEPTH_TEST", wired("gbuffer"))
        .constant("size",
                  [](const RecordContext& ctx) {
                    const VkExtent3D size = ctx.extent("image");
                    return glm::ivec2(size.width, size.height);
                  })
        .groups(row, ceilDiv(countOf("state"), row));
    d.step("view-vpls/view_vpls.comp")
        .define("PICTURE", wired("picture"))
        .define("AGE", is("show", "age"))
        .define("LUMINANCE", is("show", "luminance"))
        .constant("scale",
                  [](const RecordContext& ctx) {
                    const Parameters& p = ctx.parameters();
                    const double range = p.real("range");
                    return float(1.0 / (range > 0 ? range : p.text("show") == "age" ? 60.0 : 1.0));
                  })
        .over("image");
    d.require(!is("show", "luminance") || wired("vpls"), "show `luminance` needs the input `vpls`",
              "wire the VPLs that the shading reads, or show something else");
    d.require(atMost(countOf("state"), int(kMostSlots)), "at most 65536 VPLs can be drawn", "use fewer");
    return d;
  }
};

FOVEA_PASS(ViewVpls);

}  // namespace
}  // namespace fovea::passes
