// Averages of light and foveated weight over ever larger cells, for cone tracing (METHOD 2, mipmap).
#include <string>

#include "framework/gpu/resources.h"
#include "framework/graph/registry.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Mipmap : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("mipmap", "mip hierarchy of the voxels' light and foveated weight, for cone tracing");
    d.input("voxels", "voxels",
            {member("index", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::Sampled),
             member("surface", buffer("VoxelSide", 64), Usage::TexelRead)},
            "surfaces in the voxels");
    d.input("radiance", buffer("VoxelRadiance", 16), Usage::TexelRead,
            "outgoing radiance of every voxel side");
    d.input("weights", buffer("VoxelWeight", 4), Usage::TexelRead,
            "foveated weight of every voxel side; without it the weights are 0")
        .makeOptional();
    const SizeExpr size = ceilDiv(widthOf("voxels.index"), 2);
    const SizeExpr width = size * (SizeExpr(1) + SizeExpr(5) * parameter("directional"));
    d.output("mips", "voxel-mips",
             {member("color", image3D(VK_FORMAT_R16G16B16A16_SFLOAT, width, size, size, kAllMips),
                     Usage::StorageRead | Usage::StorageWrite,
                     "rgb: radiance times a; a: surface area by that of a cell's face, over 1 where a cell "
                     "holds several surfaces"),
              member("weight", image3D(VK_FORMAT_R16_SFLOAT, width, size, size, kAllMips),
                     Usage::StorageRead | Usage::StorageWrite, "foveated weight times a of `color`")},
             "level 0 has cells of 2x2x2 voxels; levels that are not half of the one before are 0 "
             "(shaders/common/cone.glsl)")
        .keep(Lifetime::Scene);  // so that cells which are and stay empty need no store
    d.parameter("directional", flag(true),
                "six volumes side by side, +x -x +y -y +z -z, each of what looks that way: a thin wall does "
                "not show the light of its back");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    directional_ = ctx.parameters().flag("directional");
    const char* directional = directional_ ? "1" : "0";
    base_ = ctx.compute("mipmap/base.comp", {{"DIRECTIONAL", directional},
                                             {"WEIGHTED", ctx.has("weights") ? "1" : "0"},
                                             {"ODD", std::to_string(ctx.extent("voxels.index").width % 2)}});
    down_ = ctx.compute("mipmap/down.comp", {{"DIRECTIONAL", directional}});
  }

  void record(RecordContext& ctx) override {
    gpu::Image& color = ctx.image("mips.color");
    gpu::Image& weight = ctx.image("mips.weight");
    uint32_t size = ctx.extent("mips.color").height;
    ctx.use(base_)
        .bind("mipsColor", color.mipView(0))
        .bind("mipsWeight", weight.mipView(0))
        .dispatchThreads(size, size, size);
    for (uint32_t level = 1; level < color.desc().mips && size % 2 == 0; ++level) {
      size /= 2;
      ctx.barrier();
      ctx.use(down_)
          .bind("sourceColor", color.mipView(level - 1))
          .bind("sourceWeight", weight.mipView(level - 1))
          .bind("targetColor", color.mipView(level))
          .bind("targetWeight", weight.mipView(level))
          .constant("size", int32_t(size))
          .dispatchThreads(directional_ ? 6 * size : size, size, size);
    }
  }

 private:
  static constexpr int64_t kAllMips = 32;  // more than any size has
  bool directional_ = true;
  Kernel base_, down_;
};

FOVEA_PASS(Mipmap);

}  // namespace
}  // namespace fovea::passes
