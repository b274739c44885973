// Direct light on the voxels, from the lights' shadow maps (METHOD 2, light-inject). What never moves keeps
// its radiance from frame to frame while the lights stay, except where the shadow of what moves may have come
// or gone.
#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "framework/scene/motion/movers.h"

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
             member("info", buffer("VoxelInfo", 16), Usage::Uniform)},
            "surfaces in the voxels");
    d.input("maps", "shadow-maps",
            {member("depth", image2DArray(VK_FORMAT_D32_SFLOAT, 1, 1, 1), Usage::Sampled),
             member("views", buffer("ShadowView", 112), Usage::Uniform)},
            "what each light sees; without it nothing throws a shadow")
        .makeOptional();
    d.output("radiance", buffer("VoxelRadiance", 16, countOf("voxels.surface")),
             Usage::StorageRead | Usage::StorageWrite,
             "rgb: L = rho E / pi + emission, W/(sr m^2), w: its luminance; 0 for empty sides, undefined "
             "past the last voxel")
        .keep(Lifetime::Scene);
    d.scratch(
        "covered",
        buffer("CoveredTexels", 16, environment("scene.shadow_layers") * SizeExpr(scene::MoverBoxes::kCount)),
        Usage::StorageWrite | Usage::TexelRead, "what the moving things may cover of each map");
    d.scratch("work", buffer("WorkList", 32),
              Usage::StorageRead | Usage::StorageWrite | Usage::TexelRead | Usage::Indirect,
              "dispatch over the list and its length; dispatch over all sides");
    d.scratch("listed", buffer("uint", 4, countOf("voxels.surface")), Usage::StorageWrite | Usage::TexelRead,
              "sides to look up anew");
    d.output("changed", buffer("VoxelChanged", 4, countOf("voxels.surface")), Usage::StorageWrite,
             "1: this side has another radiance than in the frame before, or is of something that moves; "
             "undefined past the last voxel");
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
    Defines defines{{"SHADOWED", ctx.has("maps") ? "1" : "0"},
                    {"MOVER_BOXES", std::to_string(scene::MoverBoxes::kCount)}};
    covered_ = ctx.compute("light-inject/covered.comp", defines);
    const std::string& filter = ctx.parameters().text("filter");
    for (size_t i = 0; i < select_.size(); ++i) {
      defines["ONE_LIGHT"] = std::to_string(i);
      select_[i] = ctx.compute("light-inject/select.comp", defines);
      Defines filtered = defines;
      filtered["SHADOW_FILTER"] = filter == "none" ? "0" : filter == "bilinear" ? "1" : "2";
      kernel_[i] = ctx.compute("light-inject/light_inject.comp", filtered);
    }
  }
  void record(RecordContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const bool stay = gpu_ == frame.gpu && std::equal(lights_.begin(), lights_.end(), frame.lights.begin(),
                                                      frame.lights.end(), same);
    const bool all = ctx.firstFrame() || !stay || !ctx.parameters().flag("keep");
    const scene::MoverBoxes now = scene::moverBoxes(frame), either = scene::around(now, before_);
    const uint32_t layers = scene::shadowLayers(frame.lights);
    const bool moving = !either.empty();
    Commands cover = ctx.use(covered_);
    if (ctx.has("maps"))
      cover.constant("movers", either.corners).constant("layerCount", moving ? layers : 0u);
    cover.dispatchThreads(std::max(layers, 1u) * uint32_t(scene::MoverBoxes::kCount));
    ctx.barrier();
    const size_t lights = frame.lights.size() != 1 ? 0 : layers == 1 ? 2 : 1;
    ctx.use(select_[lights])
        .constant("relightAll", uint32_t(all))
        .constant("moving", uint32_t(moving))
        .dispatchIndirect("work", 16);
    ctx.barrier();
    ctx.use(kernel_[lights]).dispatchIndirect("work");
    lights_ = frame.lights;
    gpu_ = frame.gpu;
    before_ = now;
  }

 private:
  Kernel covered_;
  std::array<Kernel, 3> select_, kernel_;  // for any number of lights, for one, and for one with one map
  std::vector<scene::Light> lights_;       // of the frame before,
  const scene::GpuScene* gpu_ = nullptr;   // its scene,
  scene::MoverBoxes before_;               // and where what moves was
};

FOVEA_PASS(LightInject);

}  // namespace
}  // namespace fovea::passes
