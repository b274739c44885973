// Radiosity of the VPLs: direct light plus one bounce gathered with cones (METHOD 2, radiance, Eq. 3).
#include "fovea/error.h"
#include "fovea/pass.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Radiance : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "radiance", "radiosity of every VPL: direct light and what six cones gather from the voxels (Eq. 3)");
    d.input("vpls", buffer("VplState", 80), Usage::TexelRead, "VPLs; empty slots have no life");
    d.input("voxels", "voxels",
            {member("index", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
             member("occupied", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
             member("surface", buffer("VoxelSide", 64), Usage::TexelRead)},
            "surfaces in the voxels");
    d.input("radiance", buffer("VoxelRadiance", 16), Usage::TexelRead,
            "outgoing radiance of every voxel side");
    d.input("mips", "voxel-mips",
            {member("color", image3D(VK_FORMAT_R16G16B16A16_SFLOAT, 1, 1, 1), Usage::Sampled)},
            "mips of that radiance; for terms `direct` not needed")
        .makeOptional();
    d.output(
        "radiosity", buffer("VplRadiosity", 16, countOf("vpls")), Usage::StorageWrite,
        "rgb: B_l, W/m^2, what the surface sends out, emission included; w: its luminance; empty slots 0");
    d.parameter("terms", choice("both", {"both", "direct", "cones"}),
                "`direct`: light that comes from the lights straight, `cones`: by way of another surface "
                "(the second bounce)");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    const bool direct = ctx.parameters().text("terms") == "direct";
    if (!direct && !ctx.has("mips"))
      throw Error(ExitCode::BadInput, "pass `radiance`: the cones need the input `mips`",
                  "wire `mips` to mipmap, or set terms to `direct`");
    kernel_ = ctx.compute("radiance/radiance.comp", {{"CONES", direct ? "0" : "1"}});
  }
  void record(RecordContext& ctx) override {
    const uint32_t count = uint32_t(ctx.count("vpls"));
    ctx.use(kernel_).constant("count", count).dispatchThreads(count);
  }

 private:
  Kernel kernel_;
};

FOVEA_PASS(Radiance);

}  // namespace
}  // namespace fovea::passes
