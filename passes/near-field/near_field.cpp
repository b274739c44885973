// The light of what is near, which VPLs shaded as discs leave out.
#include "framework/graph/registry.h"
#include "framework/scene/voxel_grid.h"

namespace fovea::passes {
namespace {

using namespace graph;

class NearField : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "near-field",
        "light from voxels around what the eye sees, in the part that VPLs shaded as discs take "
        "from light so near");
    d.view();
    const SizeExpr width = widthOf("gbuffer.position"), height = heightOf("gbuffer.position");
    d.input("gbuffer", "gbuffer",
            {member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::StorageRead),
             member("normal", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead),
             member("face", image2D(VK_FORMAT_R16G16_SNORM), Usage::StorageRead)},
            "surfaces seen by the eye");
    d.input("voxels", "voxels",
            {member("index", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
             member("occupied", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
             member("surface", buffer("VoxelSide", sizeof(scene::VoxelSide)), Usage::TexelRead)},
            "what the rays meet");
    d.input("radiance", buffer("VoxelRadiance", 16), Usage::TexelRead, "of each voxel side");
    d.input("spread", buffer("VplSpread", 16), Usage::TexelRead, "area of the discs, of pass weights");
    d.output(
        "irradiance", image2D(VK_FORMAT_R16G16B16A16_SFLOAT, width, height), Usage::StorageWrite,
        "rgb: irradiance / pi, W/(sr m^2), by one ray a pixel in the fovea, one for four outside: for pass "
        "deferred to filter");
    d.parameter("fovea_radius", real(0.25, 0.001, 4, "image widths"), "radius of the fovea");
    d.parameter("reach", real(2, 0.1, 100), "length of the rays, in radii of the discs");
    d.parameter(
        "most", real(0, 0, 1e6),
        "times the mean of its 16x16 pixels that a ray can bring, so that the few that meet something "
        "bright do not show as sparks; 0: no limit");
    return d;
  }

  void prepare(PrepareContext& ctx) override { kernel_ = ctx.compute("near-field/near_field.comp"); }
  void record(RecordContext& ctx) override {
    const VkExtent3D size = ctx.extent("irradiance");
    ctx.use(kernel_).dispatch((size.width + 15) / 16, (size.height + 15) / 16);
  }

 private:
  Kernel kernel_;
};

FOVEA_PASS(NearField);

}  // namespace
}  // namespace fovea::passes
