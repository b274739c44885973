// Mip hierarchy of light and foveated weight over successively larger cells, for cone tracing (passes/geometry.md,
// mipmap).
#include <glm/glm.hpp>
#include <string>

#include "fovea/pass.h"
#include "framework/gpu/resources.h"
#include "framework/scene/frame.h"
#include "framework/scene/motion/movers.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Mipmap : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("mipmap", "mip hierarchy of the voxels' light and foveated weight, for cone tracing");
    d.recorded();
    d.input("voxels", "voxels", voxelMembers({"index", "surface"}), "voxelised surfaces");
    d.input("radiance", voxelRadianceBuffer(), Usage::TexelRead, "outgoing radiance of every voxel side");
    d.input("weights", voxelWeightBuffer(), Usage::TexelRead,
            "foveated weight of every voxel side; if not wired, the weights are 0")
        .makeOptional();
    d.input("changed", buffer("VoxelChanged", 4), Usage::TexelRead,
            "which sides have new radiance in this frame (pass light-inject); cells without such a side are "
            "left unchanged; if not wired, all cells are recomputed")
        .makeOptional();
    const SizeExpr size = ceilDiv(widthOf("voxels.index"), 2);
    const SizeExpr width = size * (SizeExpr(1) + SizeExpr(5) * parameter("directional"));
    d.output("mips", "voxel-mips", voxelMipOutput(width, size, kAllMips),
             "level 0 has cells of 2x2x2 voxels; levels that are not exactly half the size of the one before "
             "are 0 (shaders/voxels/cone.glsl)")
        .keep(Lifetime::Scene);  // so that cells that stay empty need not be stored
    // One bit for each cell of level 1 and above: something below it changed.
    const SizeExpr half = ceilDiv(size, 2);
    d.scratch("dirty", buffer("uint", 4, ceilDiv(half * half * half, 16) + SizeExpr(kAllMips)),
              Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite, "cells to recompute");
    d.parameter("importance", choice("cones", {"rays", "cones"}),
                "method of pass importance; with `rays` nothing reads the weights, and they are 0");
    d.parameter("directional", flag(true),
                "whether six volumes are stored side by side, +x -x +y -y +z -z, one for each facing "
                "direction, so that a thin wall does not show the light of its other side");
    const auto step = [&](const char* shader) -> StepSpec& {
      return d.step(shader)
          .define("DIRECTIONAL", parameter("directional"))
          .define("WEIGHTED", weighted())
          .define("KEEPS", keeps());
    };
    d.fill("dirty", 0).when(keeps());
    step("mipmap/base.comp")
        .define("ODD", widthOf("voxels.index") - (ceilDiv(widthOf("voxels.index") - 1, 2) * 2))
        .define("MOVER_BOXES", scene::MoverBoxes::kCount);
    step("mipmap/down.comp");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    weighted_ = ctx.evaluate(weighted()) != 0;
    keeps_ = ctx.evaluate(keeps()) != 0;
  }

  void record(RecordContext& ctx) override {
    uint32_t size = ctx.extent("mips.color").height, firstBit = 0;
    ctx.run("fill dirty");
    recordBase(ctx, size);
    for (uint32_t level = 1; level < ctx.mips("mips.color") && size % 2 == 0; ++level) {
      size /= 2;
      Commands down = ctx.step("down");
      down.mip("sourceColor", "mips.color", level - 1)
          .mip("targetColor", "mips.color", level)
          .constant("size", int32_t(size));
      if (weighted_)
        down.mip("sourceWeight", "mips.weight", level - 1).mip("targetWeight", "mips.weight", level);
      if (keeps_) down.constant("firstBit", firstBit);
      down.dispatchThreads(size, size, size);
      firstBit += size * size * size;
    }
  }

 private:
  static constexpr int64_t kAllMips = 32;  // more than any size needs

  struct Before {
    scene::MoverBoxes movers;              // bounds of the moving objects in the previous frame
    const scene::GpuScene* gpu = nullptr;  // scene of the previous frame
  };

  void recordBase(RecordContext& ctx, uint32_t size) {
    Commands base = ctx.step("base");
    base.mip("mipsColor", "mips.color", 0);
    if (weighted_) base.mip("mipsWeight", "mips.weight", 0);
    if (keeps_) {
      auto& before = ctx.memory<Before>();
      const bool all = before.gpu != ctx.frame().gpu;
      const scene::MoverBoxes now = scene::moverBoxes(ctx.frame());
      base.constant("movers", scene::around(now, before.movers).corners).constant("all_", uint32_t(all));
      before = {now, ctx.frame().gpu};
    }
    base.dispatchThreads(size, size, size);
  }

  static SizeExpr weighted() { return wired("weights") && is("importance", "cones"); }
  static SizeExpr keeps() { return wired("changed") && !weighted(); }  // the weights differ in every frame

  bool weighted_ = false, keeps_ = false;
};

FOVEA_PASS(Mipmap);

}  // namespace
}  // namespace fovea::passes
