// The second eye from the first eye's finished lighting: demodulated irradiance warped onto the surfaces that the
// second eye sees, and the blocks of pixels that have no source and must be shaded (passes/shading.md, reproject).
#include <cmath>
#include <glm/glm.hpp>
#include <string>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/reproject/records.h"

namespace fovea::passes {
namespace {

using namespace graph;

using reproject::kRows;
using reproject::kRowWidth;
using reproject::kTile;

class Reproject : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "reproject",
        "irradiance of the first eye warped to the second eye, and the blocks of pixels left to shade");
    const SizeExpr width = widthOf("gbuffer.distance"), height = heightOf("gbuffer.distance");
    const SizeExpr tiles = ceilDiv(width, kTile) * ceilDiv(height, kTile);
    d.input("gbuffer", "gbuffer", gbufferMembers(Usage::StorageRead, {"distance", "normal", "face"}),
            "surfaces seen by the second eye");
    d.input("source_gbuffer", "gbuffer", gbufferMembers(Usage::StorageRead, {"distance", "normal"}),
            "surfaces seen by the first eye");
    d.input("source_irradiance", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "rgb: irradiance of the first eye to warp, the output `irradiance` of pass deferred");
    d.input("source_near_field", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "rgb: the part of it that comes from nearby surfaces (pass near-field), to warp on its own for "
            "pass near-field-pixels")
        .makeOptional();
    d.output("irradiance", ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, width, height)),
             Usage::StorageRead | Usage::StorageWrite,
             "rgb: warped irradiance; a: 1 where it has a source, 0.5 where it was filled from nearby "
             "pixels, 0 where there is neither and in the background");
    d.output("near_field", ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, width, height)),
             Usage::StorageWrite,
             "rgb: warped `source_near_field`; a: 1 where it has a source, else 0; undefined if nothing is "
             "wired there");
    const SizeExpr blocks =
        ceilDiv(width, parameter("interleave")) * ceilDiv(height, parameter("interleave"));
    d.output("shade", "shade-mask", shadeMaskOutput(width, height, blocks),
             "pixels that must be shaded for the second eye");
    d.scratch("tile_blocks", buffer("uint", 4, tiles),
              Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite,
              "number of blocks to shade in each tile of 16 x 16 pixels, later in all tiles before it");
    d.scratch("open_tiles", buffer("TileDispatch", 16),
              Usage::StorageRead | Usage::StorageWrite | Usage::Indirect | Usage::TransferWrite,
              "indirect dispatch for `open_list`, with one more group than it has tiles");
    d.scratch("open_list", buffer("uint", 4, tiles), Usage::StorageRead | Usage::StorageWrite,
              "tiles that contain a pixel without a source, in any order");
    addParameters(d);
    d.counter("pixels", "pixels that show a surface");
    d.counter("new_pixels", "pixels of these without a source");
    d.counter("filled_pixels", "pixels of these that take the light of their surface nearby");
    d.counter(
        "shaded_pixels",
        "pixels with a surface in blocks that contain a pixel with neither a source nor light from nearby");
    addSteps(d);
    return d;
  }

 private:
  static void addSteps(PassDeclaration& d) {
    const auto leastCos = [](const RecordContext& ctx) {
      return std::cos(glm::radians(float(ctx.parameters().real("normal_angle"))));
    };
    d.clear("shade.mask", 0);
    d.fill("tile_blocks", 0);
    d.fill("open_tiles", 1);
    d.step("reproject/warp.comp")
        .define("NEAR_FIELD", wired("source_near_field"))
        .constant("sourceWorldToClip", [](const RecordContext& ctx) { return sourceView(ctx).worldToClip; })
        .constant("leastCos", leastCos)
        .groups(ceilDiv(widthOf("irradiance"), kRowWidth), ceilDiv(heightOf("irradiance"), kRows));
    d.step("reproject/fill.comp")
        .define("INTERLEAVE", parameter("interleave"))
        .define("FILL", parameter("fill"))
        .constant("leastCos", leastCos)
        .indirect("open_tiles");
    d.step("reproject/scan.comp")
        .define("INTERLEAVE", parameter("interleave"))
        .constant("tiles", countOf("tile_blocks"))
        .groups(1);
    d.step("reproject/compact.comp")
        .define("INTERLEAVE", parameter("interleave"))
        .constant("tiles", countOf("tile_blocks"))
        .threads(countOf("tile_blocks"));
  }

  static void addParameters(PassDeclaration& d) {
    d.parameter("source_view", text("left"), "view in which the source was rendered");
    d.parameter("interleave", integer(4, {1, 2, 4, 8}),
                "width n of a block, as for the shading: a pixel without a source causes its whole block of "
                "n x n pixels to be shaded; 1, 2, 4 or 8");
    d.parameter(
        "fill", integer(0, 0, 4),
        "radius in pixels within which a pixel without a source takes the light of pixels on its surface "
        "that have one, inside its tile of 16 x 16 pixels; 0 disables this, so the pixel is shaded");
    d.parameter("plane_tolerance", real(0.005, 1e-6, 1),
                "largest distance of a source from a pixel's tangent plane that counts as the same surface, "
                "relative to the pixel's distance from the eye");
    d.parameter("normal_angle", real(25, 1, 90, "degrees"),
                "least angle between normals of different surfaces");
    d.parameter("least_weight", real(0.1, 1e-3, 1),
                "least sum of the bilinear weights of those of the four surrounding texels that lie on the "
                "pixel's surface");
  }

  static const scene::View& sourceView(const RecordContext& ctx) {
    const std::string& name = ctx.parameters().text("source_view");
    if (const scene::View* view = ctx.frame().findView(name)) return *view;
    std::string known;
    for (const scene::View& view : ctx.frame().views) known += (known.empty() ? "" : ", ") + view.name;
    throw Error(ExitCode::BadInput, "source_view `" + name + "` is no view of the frame",
                "there is: " + known);
  }
};

FOVEA_PASS(Reproject);

}  // namespace
}  // namespace fovea::passes
