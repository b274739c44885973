// Another bounce of light from voxel to voxel: light-inject -> mipmap -> bounce -> mipmap -> ...
#include "fovea/pass.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Bounce : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("bounce",
                      "radiance of every voxel side after one more bounce: direct light plus rho E / pi, "
                      "gathered with six cones");
    d.input("voxels", "voxels", voxelMembers({"index", "occupied", "surface", "info"}, Usage::TexelRead),
            "voxelised surfaces");
    d.input("radiance", voxelRadianceBuffer(), Usage::TexelRead,
            "radiance of every side, which lights the other sides");
    d.input("mips", "voxel-mips", voxelMipMembers({"color"}), "mip hierarchy of that radiance");
    d.input("direct", voxelRadianceBuffer(), Usage::TexelRead,
            "direct radiance from light-inject, to which the bounced light is added, also for later bounces; "
            "if not wired, `radiance` is used, which is correct for the first bounce only")
        .makeOptional();
    d.output("bounced", voxelRadianceBuffer(countOf("voxels.surface")), Usage::StorageWrite,
             "rgb: direct + rho E / pi, W/(sr m^2); w: its luminance; 0 for empty sides, undefined beyond "
             "the last voxel");
    d.step("bounce/bounce.comp").define("HAS_DIRECT", wired("direct")).threads(countOf("voxels.surface"));
    return d;
  }
};

FOVEA_PASS(Bounce);

}  // namespace
}  // namespace fovea::passes
