// Foveated weight of each voxel side that the eye sees (passes/vpls.md, weight-map).
#include "fovea/pass.h"
#include "framework/gpu/resources.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

// Pixels per thread and threads per work group, along each axis.
constexpr uint32_t kBlock = 4, kGroup = 8;

class WeightMap : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("weight-map", "foveated weight of every voxel side that the eye sees");
    d.view();
    d.input("gbuffer", "gbuffer", gbufferMembers(Usage::StorageRead, {"distance", "face"}),
            "surfaces seen by the eye");
    d.input("voxels", "voxels", voxelMembers({"index", "surface"}), "voxel grid whose sides are weighted");
    d.output("weights", voxelWeightBuffer(countOf("voxels.surface")),
             Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite,
             "one float per side: the largest foveated weight among the pixels that show it, 0 if unseen");
    d.parameter("region", choice("fovea", {"fovea", "image"}),
                "region of full weight: the disc around the gaze, outside which weights fall off, or the "
                "whole image");
    d.parameter("falloff", choice("edge", {"edge", "centre"}),
                "where the weights of region `fovea` begin to fall off: at the edge of the disc, as "
                "min(1, r_f / r), or at its centre, as 1 / r with r in pixels, at most 1");
    d.parameter("spacing", integer(1, 1, 16),
                "one pixel in each square of this width is used; above 1, sides that are smaller on the "
                "screen may be missed");
    d.counter("visible", "sides with a weight above 0");
    d.counter("unassigned",
              "pixels looked at that show a surface for which the grid has no side facing the eye");
    const SizeExpr tile = SizeExpr(kBlock * kGroup) * parameter("spacing");
    d.fill("weights", 0);
    d.step("weight-map/scatter.comp")
        .define("WHOLE_IMAGE", is("region", "image"))
        .define("FROM_CENTRE", is("falloff", "centre"))
        .define("BLOCK", kBlock)
        .define("GROUP", kGroup)
        .groups(ceilDiv(widthOf("gbuffer.distance"), tile), ceilDiv(heightOf("gbuffer.distance"), tile));
    return d;
  }
};

FOVEA_PASS(WeightMap);

}  // namespace
}  // namespace fovea::passes
