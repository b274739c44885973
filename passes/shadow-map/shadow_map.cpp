// One depth map per light (six for a point light), as layers of one image. Static geometry is drawn once, and again
// when a light changes; moving geometry is drawn over a copy of that.
#include <algorithm>
#include <vector>

#include "fovea/pass.h"
#include "framework/gpu/resources.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ShadowMap : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "shadow-map",
        "shadow maps of all lights, with one layer for a directional or spot light and six for a point light",
        PassKind::ComputeAndGraphics);
    d.recorded();
    const SizeExpr side = min(parameter("size"), environment("scene.shadow_texels"));
    d.output("maps", "shadow-maps", shadowMapOutput(side, environment("scene.shadow_layers")),
             "shadow maps of the lights")
        .keep(Lifetime::Scene);
    d.scratch("still", image2DArray(VK_FORMAT_D32_SFLOAT, side, side, environment("scene.shadow_layers")),
              Usage::DepthAttachment | Usage::TransferRead, "depth of static geometry")
        .keep(Lifetime::Scene);
    ParameterSpec size = integer(2048, 16, 16384);
    size.unit = "texels";
    d.parameter("size", size,
                "width and height of a map; less if many lights need many maps, which have at most 2^27 "
                "texels together");
    d.step("shadow-map/views.comp")
        .constant("size", widthOf("maps.depth"))
        .threads(int64_t{scene::kMaxLights});
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    for (const scene::DrawKind kind : scene::kDrawKinds) {
      const bool tested = isTested(kind), passage = kind == scene::DrawKind::Transparent;
      draw_[size_t(kind)] =
          ctx.graphics({.vertex = "shadow-map/depth.vert",
                        .fragment = tested ? "shadow-map/depth.frag" : "",
                        .defines = {{"TESTED", tested ? "1" : "0"}, {"PASSAGE", passage ? "1" : "0"}},
                        .depth = "maps.depth",
                        .depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL});
    }
  }

  void record(RecordContext& ctx) override {
    ctx.run("views");
    const scene::Geometry& geometry = *ctx.frame().geometry;
    const uint32_t all = uint32_t(geometry.triangles.size()), fixed = std::min(geometry.staticTriangles, all);
    const bool moves = fixed < all;
    auto& drawn = ctx.memory<Drawn>();
    if (!drawn.is(ctx.frame())) draw(ctx, moves ? "still" : "maps.depth", Attachment::Load::Clear, 0, fixed);
    drawn = {ctx.frame().lights, ctx.frame().gpu};
    if (!moves) return;
    ctx.copy("still", "maps.depth");
    draw(ctx, "maps.depth", Attachment::Load::Keep, fixed, all);
  }

 private:
  // Of what static geometry has been drawn.
  struct Drawn {
    std::vector<scene::Light> lights;
    const scene::GpuScene* gpu = nullptr;

    bool is(const scene::Frame& frame) const {
      return gpu == frame.gpu &&
             std::equal(lights.begin(), lights.end(), frame.lights.begin(), frame.lights.end(),
                        [](const scene::Light& a, const scene::Light& b) {
                          return a.type == b.type && a.position == b.position && a.direction == b.direction &&
                                 a.range == b.range && a.outerConeAngle == b.outerConeAngle;
                        });
    }
  };

  // Draws triangles [first, end) into all layers.
  void draw(RecordContext& ctx, const char* target, Attachment::Load load, uint32_t first,
            uint32_t end) const {
    const Attachment depth{target, load, {.depthStencil = {0.0f, 0}}};
    const uint32_t layers = scene::shadowLayers(ctx.frame().lights);
    ctx.render(
        {}, &depth, draw_,
        [&] {
          if (layers > 0)
            for (const scene::DrawRun& run : ctx.frame().gpu->drawRuns()) draw(ctx, run, layers, first, end);
        },
        ctx.layers(target));
  }

  void draw(RecordContext& ctx, const scene::DrawRun& run, uint32_t layers, uint32_t first,
            uint32_t end) const {
    first = std::max(first, run.firstTriangle);
    end = std::min(end, run.firstTriangle + run.triangleCount);
    if (first >= end) return;
    ctx.use(draw_[size_t(run.kind)])
        .drawTriangles(ctx.frame().gpu->indices().handle(), first, end - first, layers);
  }

  Kernel draw_[std::size(scene::kDrawKinds)];
};

FOVEA_PASS(ShadowMap);

}  // namespace
}  // namespace fovea::passes
