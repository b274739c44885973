// Direct light on the voxels, from the lights' shadow maps (METHOD 2, light-inject). What never moves keeps
// its radiance from frame to frame while the lights stay, except where the shadow of what moves may have come
// or gone.
#include <algorithm>
#include <glm/glm.hpp>
#include <vector>

#include "framework/graph/registry.h"
#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "framework/scene/movers.h"

namespace fovea::passes {
namespace {

using namespace graph;

bool same(const scene::Light& a, const scene::Light& b) {
  return a.type == b.type && a.color == b.color && a.intensity == b.intensity && a.range == b.range &&
         a.innerConeAngle == b.innerConeAngle && a.outerConeAngle == b.outerConeAngle &&
         a.position == b.position && a.direction == b.direction;
}

class LightInject : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("light-inject",
                      "outgoing radiance of every voxel side: reflected direct light plus emission");
    d.input("voxels", "voxels",
            {member("index", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
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
             "past the last voxel")
        .keep(Lifetime::Scene);
    d.scratch("covered", buffer("CoveredTexels", 16, environment("scene.shadow_layers")),
              Usage::StorageWrite | Usage::TexelRead, "what the moving things may cover of each map");
    d.scratch("work", buffer("WorkList", 16),
              Usage::StorageRead | Usage::StorageWrite | Usage::TexelRead | Usage::Indirect,
              "dispatch and length of the list");
    d.scratch("listed", buffer("uint", 4, countOf("voxels.surface")), Usage::StorageWrite | Usage::TexelRead,
              "sides to look up anew");
    d.output("changed", buffer("VoxelChanged", 4, countOf("voxels.surface")), Usage::StorageWrite,
             "1: the radiance of this side was looked up anew, 0: it is that of the frame before; undefined "
             "past the "
             "last voxel");
    d.parameter("keep", flag(true),
                "sides of what never moves keep their radiance while no light changes, but where the shadow "
                "of something "
                "that moves may have come or gone; without it all are looked up in every frame");
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
    const gpu::Defines shadowed{{"SHADOWED", ctx.has("maps") ? "1" : "0"}};
    covered_ = ctx.compute("light-inject/covered.comp", shadowed);
    select_ = ctx.compute("light-inject/select.comp", shadowed);
    const std::string& filter = ctx.parameters().text("filter");
    kernel_ =
        ctx.compute("light-inject/light_inject.comp", {{"SHADOWED", ctx.has("maps") ? "1" : "0"},
                                                       {"SHADOW_FILTER", filter == "none"       ? "0"
                                                                         : filter == "bilinear" ? "1"
                                                                                                : "2"}});
  }
  void record(RecordContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const bool stay = gpu_ == frame.gpu && std::equal(lights_.begin(), lights_.end(), frame.lights.begin(),
                                                      frame.lights.end(), same);
    const bool all = ctx.firstFrame() || !stay || !ctx.parameters().flag("keep");
    const scene::MoverBox now = scene::moverBox(frame), either = scene::around(now, before_);
    const uint32_t layers = scene::shadowLayers(frame.lights);
    const bool moving = !either.empty();
    Commands cover = ctx.use(covered_);
    if (ctx.has("maps"))
      cover.constant("moversLow", glm::vec4(either.low, 0))
          .constant("moversHigh", glm::vec4(either.high, 0))
          .constant("layerCount", moving ? layers : 0u);
    cover.dispatchThreads(std::max(layers, 1u));
    ctx.barrier();
    ctx.use(select_)
        .constant("relightAll", uint32_t(all))
        .constant("moving", uint32_t(moving))
        .dispatchThreads(uint32_t(ctx.count("voxels.surface")));
    ctx.barrier();
    ctx.use(kernel_).dispatchIndirect("work");
    lights_ = frame.lights;
    gpu_ = frame.gpu;
    before_ = now;
  }

 private:
  Kernel covered_, select_, kernel_;
  std::vector<scene::Light> lights_;      // of the frame before,
  const scene::GpuScene* gpu_ = nullptr;  // its scene,
  scene::MoverBox before_;                // and where what moves was
};

FOVEA_PASS(LightInject);

}  // namespace
}  // namespace fovea::passes
