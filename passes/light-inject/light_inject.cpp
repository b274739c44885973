// Direct light on the voxels, from the lights' shadow maps (passes/geometry.md, light-inject). Static surfaces keep
// their radiance from frame to frame while the lights stay the same, except where the shadow of a moving object may
// have appeared or disappeared.
#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "framework/scene/motion/movers.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

bool same(const scene::Light& a, const scene::Light& b) {
  return a.type == b.type && a.color == b.color && a.intensity == b.intensity && a.range == b.range &&
         a.innerConeAngle == b.innerConeAngle && a.outerConeAngle == b.outerConeAngle &&
         a.position == b.position && a.direction == b.direction;
}

// Points at which a side evaluates each light: with many lights, few points are enough, as their shadows have edges in
// different places.
int32_t tapsOfEach(int32_t taps, size_t lights) {
  return std::clamp(16 * taps / int32_t(std::max<size_t>(lights, 1)), 1, taps);
}

class LightInject : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("light-inject",
                      "outgoing radiance of every voxel side: reflected direct light plus emission");
    d.recorded();
    d.input("voxels", "voxels", voxelMembers({"index", "surface", "info"}), "voxelised surfaces");
    d.input("maps", "shadow-maps", shadowMapMembers(),
            "shadow maps of the lights; if not wired, there are no shadows")
        .makeOptional();
    d.output(
         "radiance", voxelRadianceBuffer(countOf("voxels.surface")), Usage::StorageRead | Usage::StorageWrite,
         "rgb: L = rho E / pi, plus the emission unless `emission` is off, W/(sr m^2); w: its luminance; 0 "
         "for empty sides, undefined beyond the last voxel")
        .keep(Lifetime::Scene);
    d.scratch(
        "covered",
        buffer("CoveredTexels", 16, environment("scene.shadow_layers") * SizeExpr(scene::MoverBoxes::kCount)),
        Usage::StorageWrite | Usage::TexelRead, "regions of each map that moving objects may cover");
    d.scratch("work", buffer("WorkList", 32),
              Usage::StorageRead | Usage::StorageWrite | Usage::TexelRead | Usage::Indirect,
              "indirect dispatch over the list and the length of the list; indirect dispatch over all sides");
    d.scratch("listed", buffer("uint", 4, countOf("voxels.surface")), Usage::StorageWrite | Usage::TexelRead,
              "sides to light again");
    d.output("changed", buffer("VoxelChanged", 4, countOf("voxels.surface")), Usage::StorageWrite,
             "1 if the radiance of the side differs from that of the previous frame or the side belongs to a "
             "moving object; undefined beyond the last voxel");
    d.parameter(
        "keep", flag(true),
        "whether static sides keep their radiance while no light changes, except where the shadow of a "
        "moving object may have appeared or disappeared; if false, all sides are lit again in every frame");
    d.parameter("emission", flag(true), "whether the radiance includes the surfaces' own emission");
    ParameterSpec taps = integer(6, 1, 64);
    d.parameter(
        "taps", taps,
        "number of fixed points on each side at which a light and its shadow are evaluated; with more than "
        "16 lights each has fewer, at least one, so that the total is about that of 16 lights");
    d.parameter("offset", real(0.25, 0, 2, "cells"),
                "height above the side's plane at which shadows are evaluated, as the plane cuts through "
                "curved surfaces and edges");
    d.parameter("filter", choice("bilinear", {"none", "bilinear", "pcf"}),
                "shadow filter: `none` makes one comparison, `bilinear` interpolates four, `pcf` averages "
                "3x3 bilinear ones");
    const auto step = [&](const char* shader) -> StepSpec& {
      return d.step(shader)
          .define("SHADOWED", wired("maps"))
          .define("MOVER_BOXES", scene::MoverBoxes::kCount);
    };
    step("light-inject/covered.comp");
    for (size_t i = 0; i < kLights.size(); ++i) {
      const auto lights = static_cast<int64_t>(i);
      step("light-inject/select.comp")
          .called("select, " + kLights[i])
          .define("ONE_LIGHT", lights)
          .indirect("work", 16);
      step("light-inject/light_inject.comp")
          .called("light, " + kLights[i])
          .define("ONE_LIGHT", lights)
          .define("SHADOW_FILTER", parameter("filter"))
          .define("EMISSION", parameter("emission"))
          .constant("taps",
                    [](const RecordContext& ctx) {
                      return tapsOfEach(int32_t(ctx.parameters().integer("taps")), ctx.frame().lights.size());
                    })
          .indirect("work");
    }
    return d;
  }

  void record(RecordContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    auto& before = ctx.memory<Before>();
    const bool stay = before.gpu == frame.gpu && std::equal(before.lights.begin(), before.lights.end(),
                                                            frame.lights.begin(), frame.lights.end(), same);
    const bool all = !stay || !ctx.parameters().flag("keep");
    const scene::MoverBoxes now = scene::moverBoxes(frame), either = scene::around(now, before.movers);
    const uint32_t layers = scene::shadowLayers(frame.lights);
    const bool moving = !either.empty();
    Commands cover = ctx.step("covered");
    if (ctx.has("maps"))
      cover.constant("movers", either.corners).constant("layerCount", moving ? layers : 0u);
    cover.dispatchThreads(std::max(layers, 1u) * uint32_t(scene::MoverBoxes::kCount));
    const std::string& lights = kLights[frame.lights.size() != 1 ? 0 : layers == 1 ? 2 : 1];
    ctx.step("select, " + lights)
        .constant("relightAll", uint32_t(all))
        .constant("moving", uint32_t(moving))
        .dispatchIndirect("work", 16);
    ctx.run("light, " + lights);
    before = {frame.lights, frame.gpu, now};
  }

 private:
  static inline const std::array<std::string, 3> kLights = {"many lights", "one light", "one map"};
  // The previous frame.
  struct Before {
    std::vector<scene::Light> lights;
    const scene::GpuScene* gpu = nullptr;
    scene::MoverBoxes movers;  // bounds of the moving objects
  };
};

FOVEA_PASS(LightInject);

}  // namespace
}  // namespace fovea::passes
