// Where the VPLs shine from: what shadow-atlas needs of them before pass vpl-intensity can say how strong they are.
#include "fovea/pass.h"
#include "framework/shader_twins/voxel_grid.h"
#include "framework/shader_twins/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Place : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("vpl-origins", "VPLs at the places that they shine from, each as 1 m^2 of its surface");
    d.input("vpls", buffer("VplState", sizeof(scene::VplState)), Usage::TexelRead, "a slot each");
    d.input("radiosity", buffer("VplRadiosity", 16), Usage::TexelRead, "rgb: B_l, W/m^2; slots as in `vpls`");
    d.input("voxels", "voxels",
            {member("index", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
             member("surface", buffer("VoxelSide", sizeof(scene::VoxelSide)), Usage::TexelRead)},
            "the grid that the VPLs come from");
    d.output("placed", buffer("Vpl", sizeof(scene::Vpl), countOf("vpls")), Usage::StorageWrite,
             "in their slots; an empty slot, and one with a value that is no number, is all zeros");
    // At 0 a VPL lies inside whatever else its voxel averages and is shadowed by it; far out it sees round
    // what should shadow it. Mean light of ir_v with one bounce against traced paths in Sponza, 128^3: 0.96
    // at 0.1 cells, 1.00 at 0.15, 1.08 at 0.2, 1.17 at 0.25, 1.26 at 0.5; in the Cornell box 1.00 to 1.01
    // whatever it is.
    d.parameter("offset", real(0.15, 0, 10, "cells"),
                "moves a VPL along its normal, out of the surface that its voxel averages");
    d.parameter(
        "least", real(0, 0, 1e6, "W/sr"),
        "intensity that no VPL has less of: one of 0 gets no shadow map, which a VPL without light of "
        "its own needs when pass vpl-intensity gives it some");
    return d;
  }

  void prepare(PrepareContext& ctx) override { kernel_ = ctx.compute("vpl-origins/vpl_origins.comp"); }

  void record(RecordContext& ctx) override {
    const uint32_t count = uint32_t(ctx.count("vpls"));
    ctx.use(kernel_).constant("vplCount", count).dispatchThreads(count);
  }

 private:
  Kernel kernel_;
};

FOVEA_PASS(Place);

}  // namespace
}  // namespace fovea::passes
