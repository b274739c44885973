// Debug view: the voxels as the eye sees them.
#include <string>
#include <utility>

#include "fovea/pass.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ViewVoxels : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("view-voxels", "debug view: the first voxel side along each ray from the eye");
    d.view();
    d.input("voxels", "voxels", voxelMembers({"index", "occupied", "surface"}), "surface voxels");
    d.input("radiance", voxelRadianceBuffer(), Usage::TexelRead, "radiance of each side, for show `radiance`")
        .makeOptional();
    d.input("weights", voxelWeightBuffer(), Usage::TexelRead,
            "foveated weight of each side, for show `weight`")
        .makeOptional();
    d.output("image", ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, viewWidth(), viewHeight())),
             Usage::StorageWrite, "rgb: colours for pass `tonemap` at the scene's exposure; a: 1");
    d.parameter("show", choice("albedo", {"albedo", "radiance", "weight", "normal"}),
                "quantity to show: reflectance, outgoing radiance, foveated weight (violet 0, yellow 1) or "
                "normal (0.5 + 0.5 n)");
    d.step("view-voxels/view_voxels.comp")
        .define("RADIANCE", is("show", "radiance"))
        .define("WEIGHT", is("show", "weight"))
        .define("NORMAL", is("show", "normal"))
        .over("image");
    for (const auto& [show, input] : {std::pair("radiance", "radiance"), std::pair("weight", "weights")})
      d.require(!is("show", show) || wired(input),
                "show `" + std::string(show) + "` needs the input `" + input + "`",
                "wire `" + std::string(input) + "`, or show something else");
    return d;
  }
};

FOVEA_PASS(ViewVoxels);

}  // namespace
}  // namespace fovea::passes
