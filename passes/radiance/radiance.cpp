// Radiosity of the VPLs: direct light plus one bounce gathered with cones (Eq. 3 of the paper; passes/vpls.md,
// radiance).
#include "fovea/pass.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Radiance : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "radiance",
        "radiosity of every VPL: direct light plus light gathered from the voxels with six cones (Eq. 3)");
    d.input("vpls", vplStateBuffer(), Usage::TexelRead, "VPLs; empty slots have life 0");
    d.input("voxels", "voxels", voxelMembers({"index", "occupied", "surface"}), "voxelised surfaces");
    d.input("radiance", voxelRadianceBuffer(), Usage::TexelRead, "outgoing radiance of every voxel side");
    d.input("mips", "voxel-mips", voxelMipMembers({"color"}),
            "mip hierarchy of that radiance; not needed for terms `direct`")
        .makeOptional();
    d.output("radiosity", radiosityBuffer(countOf("vpls")), Usage::StorageWrite,
             "rgb: B_l, W/m^2, the light that leaves the surface, including emission; w: its luminance; 0 "
             "for empty slots");
    d.parameter("terms", choice("both", {"both", "direct", "cones"}),
                "light to include: `direct` only light that comes straight from the lights, `cones` only "
                "light by way of another surface (the second bounce)");
    d.step("radiance/radiance.comp")
        .define("CONES", !is("terms", "direct"))
        .constant("count", countOf("vpls"))
        .over("vpls");
    d.require(is("terms", "direct") || wired("mips"), "the cones need the input `mips`",
              "wire `mips` to mipmap, or set terms to `direct`");
    return d;
  }
};

FOVEA_PASS(Radiance);

}  // namespace
}  // namespace fovea::passes
