// Positions of the VPLs as light sources, which pass shadow-atlas needs before pass vpl-intensity
// can find their intensity.
#include "fovea/pass.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Place : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("vpl-origins",
                      "VPLs at the positions from which they emit, each standing for 1 m^2 of its surface");
    d.input("vpls", vplStateBuffer(), Usage::TexelRead, "VPLs of this frame, one per slot");
    d.input("radiosity", radiosityBuffer(), Usage::TexelRead, "rgb: B_l, W/m^2; slots as in `vpls`");
    d.input("voxels", "voxels", voxelMembers({"index", "surface"}),
            "voxel grid in which the VPLs were found");
    d.output("placed", vplBuffer(countOf("vpls")), Usage::StorageWrite,
             "VPLs in their slots; an empty slot, or one with a value that is not finite, is all zeros");
    // At 0 a VPL lies inside the other surfaces that its voxel averages and is shadowed by them; with a large offset
    // it sees around surfaces that should shadow it. In Sponza with 128^3 voxels, the mean light of method ir_v with
    // one bounce is, relative to traced paths, 0.96 at 0.1 cells, 1.00 at 0.15, 1.08 at 0.2, 1.17 at 0.25 and 1.26 at
    // 0.5; in the Cornell box it is 1.00 to 1.01 at all offsets.
    d.parameter(
        "offset", real(0.15, 0, 10, "cells"),
        "distance by which a VPL is moved along its normal, out of the surface that its voxel averages");
    d.parameter("least", real(0, 0, 1e6, "W/sr"),
                "least intensity of a VPL; a VPL of intensity 0 gets no shadow map, but one without light of "
                "its own needs a map when pass vpl-intensity assigns light to it");
    d.step("vpl-origins/vpl_origins.comp").constant("vplCount", countOf("vpls")).over("vpls");
    return d;
  }
};

FOVEA_PASS(Place);

}  // namespace
}  // namespace fovea::passes
