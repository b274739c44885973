// One depth map a light (six for a point light), as layers of one image.
#include "framework/gpu/resources.h"
#include "framework/graph/registry.h"
#include "framework/scene/frame.h"
#include "framework/scene/gpu_scene.h"
#include "framework/scene/lights.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kMaxLayers = scene::kMaxLights * 6;  // kMaxShadowLayers in shaders/common/shadow.glsl
constexpr uint32_t kViewBytes = 112;                    // struct ShadowView in shaders/common/shadow.glsl

class ShadowMap : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("shadow-map",
                      "depth maps of all lights: directional and spot one layer each, point six",
                      PassKind::ComputeAndGraphics);
    d.output(
        "maps", "shadow-maps",
        {member("depth",
                image2DArray(VK_FORMAT_D32_SFLOAT, parameter("size"), parameter("size"),
                             environment("scene.shadow_layers")),
                Usage::DepthAttachment,
                "1: nearest to the light, 0: nothing hit; layers in the order of the lights"),
         member("views", buffer("ShadowView", kViewBytes, kMaxLayers), Usage::StorageWrite | Usage::Uniform,
                "projection of each layer, shaders/common/shadow.glsl; those past the layers hold nothing")},
        "what each light sees");
    ParameterSpec size = integer(2048, 16, 16384);
    size.unit = "texels";
    d.parameter("size", size, "width and height of a map");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    views_ = ctx.compute("shadow-map/views.comp");
    for (const bool tested : {false, true})
      draw_[tested] = ctx.graphics({.vertex = "shadow-map/depth.vert",
                                    .fragment = tested ? "shadow-map/depth.frag" : "",
                                    .defines = {{"TESTED", tested ? "1" : "0"}},
                                    .depth = "maps.depth",
                                    .depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL});
  }

  void record(RecordContext& ctx) override {
    ctx.use(views_).dispatch(1);
    ctx.barrier();
    const Attachment depth{"maps.depth", Attachment::Load::Clear, {.depthStencil = {0.0f, 0}}};
    const uint32_t layers = scene::shadowLayers(ctx.frame().lights);
    ctx.render(
        {}, &depth,
        [&] {
          if (layers > 0)
            for (const scene::DrawRun& run : ctx.frame().gpu->drawRuns()) draw(ctx, run, layers);
        },
        ctx.image("maps.depth").desc().layers);
  }

 private:
  void draw(RecordContext& ctx, const scene::DrawRun& run, uint32_t layers) const {
    const bool tested = run.kind == scene::DrawKind::Tested;
    Commands commands = ctx.use(draw_[tested]);
    if (tested) commands.constant("firstTriangle", run.firstTriangle);
    commands.drawIndexed(ctx.frame().gpu->indices().handle(), 3 * run.triangleCount, 3 * run.firstTriangle,
                         layers);
  }
  Kernel views_, draw_[2];
};

FOVEA_PASS(ShadowMap);

}  // namespace
}  // namespace fovea::passes
