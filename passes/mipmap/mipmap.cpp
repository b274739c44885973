// Mip hierarchy of light and foveated weight over ever larger cells, for cone tracing (passes/README.md, mipmap).
#include <glm/glm.hpp>
#include <string>

#include "fovea/pass.h"
#include "framework/gpu/resources.h"
#include "framework/scene/frame.h"
#include "framework/scene/motion/movers.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Mipmap : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("mipmap", "mip hierarchy of the voxels' light and foveated weight, for cone tracing");
    d.input("voxels", "voxels",
            {member("index", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
             member("surface", buffer("VoxelSide", 64), Usage::TexelRead)},
            "voxelised surfaces");
    d.input("radiance", buffer("VoxelRadiance", 16), Usage::TexelRead,
            "outgoing radiance of every voxel side");
    d.input("weights", buffer("VoxelWeight", 4), Usage::TexelRead,
            "foveated weight of every voxel side; if not wired, the weights are 0")
        .makeOptional();
    d.input("changed", buffer("VoxelChanged", 4), Usage::TexelRead,
            "which sides have new radiance in this frame (pass light-inject); cells without such a side are "
            "left unchanged; if not wired, all cells are recomputed")
        .makeOptional();
    const SizeExpr size = ceilDiv(widthOf("voxels.index"), 2);
    const SizeExpr width = size * (SizeExpr(1) + SizeExpr(5) * parameter("directional"));
    d.output("mips", "voxel-mips",
             {member("color", image3D(VK_FORMAT_R16G16B16A16_SFLOAT, width, size, size, kAllMips),
                     Usage::StorageRead | Usage::StorageWrite,
                     "rgb: radiance times a; a: surface area relative to the area of a cell's face, over 1 "
                     "where a cell holds several surfaces"),
              member("weight", image3D(VK_FORMAT_R16_SFLOAT, width, size, size, kAllMips),
                     Usage::StorageRead | Usage::StorageWrite, "foveated weight times a of `color`")},
             "level 0 has cells of 2x2x2 voxels; levels that are not exactly half the size of the one before "
             "are 0 (shaders/common/cone.glsl)")
        .keep(Lifetime::Scene);  // so that cells that stay empty need not be stored
    // One bit for each cell of level 1 and above: something below it changed.
    const SizeExpr half = ceilDiv(size, 2);
    d.scratch("dirty", buffer("uint", 4, ceilDiv(half * half * half, 16) + SizeExpr(kAllMips)),
              Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite, "cells to recompute");
    d.parameter("importance", choice("cones", {"rays", "cones"}),
                "method of pass importance; with `rays` nothing reads the weights, and they are 0");
    d.parameter("directional", flag(true),
                "whether six volumes are stored side by side, +x -x +y -y +z -z, one for each facing "
                "direction, so that a thin wall does not show the light of its back");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    directional_ = ctx.parameters().flag("directional");
    weighted_ = ctx.has("weights") && ctx.parameters().text("importance") == "cones";
    keeps_ = ctx.has("changed") && !weighted_;  // the weights differ in every frame
    const Defines defines{{"DIRECTIONAL", directional_ ? "1" : "0"},
                          {"WEIGHTED", weighted_ ? "1" : "0"},
                          {"KEEPS", keeps_ ? "1" : "0"}};
    Defines base = defines;
    base["ODD"] = std::to_string(ctx.extent("voxels.index").width % 2);
    base["MOVER_BOXES"] = std::to_string(scene::MoverBoxes::kCount);
    base_ = ctx.compute("mipmap/base.comp", base);
    down_ = ctx.compute("mipmap/down.comp", defines);
  }

  void record(RecordContext& ctx) override {
    gpu::Image& color = ctx.image("mips.color");
    gpu::Image& weight = ctx.image("mips.weight");
    uint32_t size = ctx.extent("mips.color").height, firstBit = 0;
    if (keeps_) {
      ctx.fill("dirty", 0);
      ctx.barrier();
    }
    recordBase(ctx, size);
    for (uint32_t level = 1; level < color.desc().mips && size % 2 == 0; ++level) {
      size /= 2;
      ctx.barrier();
      Commands down = ctx.use(down_);
      down.bind("sourceColor", color.mipView(level - 1))
          .bind("targetColor", color.mipView(level))
          .constant("size", int32_t(size));
      if (weighted_)
        down.bind("sourceWeight", weight.mipView(level - 1)).bind("targetWeight", weight.mipView(level));
      if (keeps_) down.constant("firstBit", firstBit);
      down.dispatchThreads(size, size, size);
      firstBit += size * size * size;
    }
  }

 private:
  static constexpr int64_t kAllMips = 32;  // more than any size needs

  void recordBase(RecordContext& ctx, uint32_t size) {
    Commands base = ctx.use(base_);
    base.bind("mipsColor", ctx.image("mips.color").mipView(0));
    if (weighted_) base.bind("mipsWeight", ctx.image("mips.weight").mipView(0));
    if (keeps_) {
      const bool all = ctx.firstFrame() || gpu_ != ctx.frame().gpu;
      const scene::MoverBoxes now = scene::moverBoxes(ctx.frame());
      base.constant("movers", scene::around(now, before_).corners).constant("all_", uint32_t(all));
      before_ = now;
      gpu_ = ctx.frame().gpu;
    }
    base.dispatchThreads(size, size, size);
  }

  bool directional_ = true, weighted_ = false, keeps_ = false;
  scene::MoverBoxes before_;              // bounds of the moving objects in the previous frame
  const scene::GpuScene* gpu_ = nullptr;  // scene of the previous frame
  Kernel base_, down_;
};

FOVEA_PASS(Mipmap);

}  // namespace
}  // namespace fovea::passes
