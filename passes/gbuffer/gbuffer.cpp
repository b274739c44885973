// What the eye sees: the nearest surface through the centre of every pixel.
#include "framework/gpu/resources.h"
#include "framework/graph/registry.h"
#include "framework/scene/frame.h"
#include "framework/scene/gpu_scene.h"

namespace fovea::passes {
namespace {

using namespace graph;

class GBuffer : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("gbuffer", "surfaces seen through the pixel centres, LOD-0 bilinear textures", PassKind::Graphics);
    d.view();
    d.output("gbuffer", "gbuffer",
             {member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::ColorAttachment,
                     "xyz: world space, m; w: distance to the eye, m, 0: background"),
              member("normal", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::ColorAttachment,
                     "xyz: shading normal, unit, on the eye's side of the face"),
              member("face", image2D(VK_FORMAT_R16G16_SFLOAT), Usage::ColorAttachment,
                     "normal of the triangle itself on the eye's side, octahedral"),
              member("albedo", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::ColorAttachment,
                     "rgb: diffuse reflectance, base colour times (1 - metallic)"),
              member("emission", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::ColorAttachment,
                     "rgb: emitted radiance, W/(sr m^2); background: the environment"),
              member("id", image2D(VK_FORMAT_R32_UINT), Usage::ColorAttachment,
                     "material | object << 16; background 0xffffffff"),
              member("depth", image2D(VK_FORMAT_D32_SFLOAT), Usage::DepthAttachment, "0: near plane, 1: far plane")},
             "one surface a pixel");
    d.parameter("cull", choice("auto", {"auto", "none"}),
                "back faces: `auto` hides those of single-sided materials, as glTF says, `none` shows all");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    const bool cull = ctx.parameters().text("cull") == "auto";
    draw_ = ctx.graphics({.vertex = "gbuffer/gbuffer.vert",
                          .fragment = "gbuffer/gbuffer.frag",
                          .defines = {{"CULL", cull ? "1" : "0"}},
                          .colors = {"gbuffer.position", "gbuffer.normal", "gbuffer.face", "gbuffer.albedo",
                                     "gbuffer.emission", "gbuffer.id"},
                          .depth = "gbuffer.depth"});
  }

  void record(RecordContext& ctx) override {
    const scene::GpuScene& gpu = *ctx.frame().gpu;
    const glm::vec3 sky = ctx.frame().scene->environment;
    const auto clear = Attachment::Load::Clear;
    const Attachment depth{"gbuffer.depth", clear, {.depthStencil = {1.0f, 0}}};
    ctx.render({{"gbuffer.position"}, {"gbuffer.normal"}, {"gbuffer.face"}, {"gbuffer.albedo"},
                {"gbuffer.emission", clear, {.color = {.float32 = {sky.r, sky.g, sky.b, 0}}}},
                {"gbuffer.id", clear, {.color = {.uint32 = {~0u}}}}},
               &depth, [&] { ctx.use(draw_).drawIndexed(gpu.indices().handle(), 3 * gpu.triangleCount()); });
  }

 private:
  Kernel draw_;
};

FOVEA_PASS(GBuffer);

}  // namespace
}  // namespace fovea::passes
