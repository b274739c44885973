// Debug view: all maps of the shadow atlas in one image.
#include <algorithm>

#include "fovea/pass.h"
#include "framework/scene/frame.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ViewAtlas : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("view-atlas", "debug view: the maps of the shadow atlas side by side");
    d.input("atlas", image2DArray(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead,
            "distances seen from each VPL (paraboloid maps, both layouts)");
    const SizeExpr maps = ceilDiv(widthOf("atlas"), heightOf("atlas")) * layersOf("atlas");
    d.output(
        "image",
        ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, parameter("columns") * parameter("tile"),
                        ceilDiv(maps, parameter("columns")) * parameter("tile"))),
        Usage::StorageWrite,
        "grey: brighter for nearer surfaces, for pass `tonemap` at the scene's exposure; blue: no hit; a: 1");
    d.parameter("columns", integer(32, 1, 256), "maps per row");
    ParameterSpec tile = integer(32, 4, 1024);
    tile.unit = "px";
    d.parameter("tile", tile, "width and height of a map in the image (nearest texel)");
    d.parameter("range", real(0, 0, 1e9, "m"),
                "distance at which grey is halved; 0 uses an eighth of the scene's diagonal");
    d.step("view-atlas/view_atlas.comp")
        .constant("range",
                  [](const RecordContext& ctx) {
                    const scene::Geometry& g = *ctx.frame().geometry;
                    const float range = float(ctx.parameters().real("range")),
                                diagonal = g.empty() ? 0.0f : glm::length(g.boundsMax - g.boundsMin);
                    return range > 0 ? range : std::max(0.125f * diagonal, 1e-6f);
                  })
        .over("image");
    return d;
  }
};

FOVEA_PASS(ViewAtlas);

}  // namespace
}  // namespace fovea::passes
