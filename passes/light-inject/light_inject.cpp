// Direct light on the voxels, from the lights' shadow maps (METHOD 2, light-inject).
#include "framework/graph/registry.h"

namespace fovea::passes {
namespace {

using namespace graph;

class LightInject : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("light-inject",
                      "outgoing radiance of every voxel side: reflected direct light plus emission");
    d.input("voxels", "voxels",
            {member("index", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::Sampled),
             member("surface", buffer("VoxelSide", 64), Usage::TexelRead),
             member("info", buffer("VoxelInfo", 16), Usage::TexelRead)},
            "surfaces in the voxels");
    d.input("maps", "shadow-maps",
            {member("depth", image2DArray(VK_FORMAT_D32_SFLOAT, 1, 1, 1), Usage::Sampled),
             member("views", buffer("ShadowView", 112), Usage::Uniform)},
            "what each light sees; without it nothing throws a shadow")
        .makeOptional();
    d.output("radiance", buffer("VoxelRadiance", 16, countOf("voxels.surface")), Usage::StorageWrite,
             "rgb: L = rho E / pi + emission, W/(sr m^2), w: its luminance; 0 for empty sides, undefined "
             "past the last voxel");
    ParameterSpec taps = integer(6, 1, 64);
    d.parameter("taps", taps,
                "points of a side's surface at which light and shadow are looked up, always the same ones");
    d.parameter("offset", real(0.25, 0, 2, "cells"),
                "how far above the side's plane shadows are looked up: the plane cuts through what is curved "
                "or has an edge");
    d.parameter(
        "filter", choice("bilinear", {"none", "bilinear", "pcf"}),
        "a shadow look-up: `none` one comparison, `bilinear` between four, `pcf` average of 3x3 such");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    const std::string& filter = ctx.parameters().text("filter");
    kernel_ =
        ctx.compute("light-inject/light_inject.comp", {{"SHADOWED", ctx.has("maps") ? "1" : "0"},
                                                       {"SHADOW_FILTER", filter == "none"       ? "0"
                                                                         : filter == "bilinear" ? "1"
                                                                                                : "2"}});
  }
  void record(RecordContext& ctx) override {
    ctx.use(kernel_).dispatchThreads(uint32_t(ctx.count("voxels.surface")));
  }

 private:
  Kernel kernel_;
};

FOVEA_PASS(LightInject);

}  // namespace
}  // namespace fovea::passes
