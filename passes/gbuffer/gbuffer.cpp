// G-buffer: the nearest surface through the centre of every pixel.
#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "fovea/pass.h"
#include "framework/gpu/resources.h"
#include "framework/scene/device/draw_clusters.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/materials.h"

namespace fovea::passes {
namespace {

using namespace graph;

// MATERIAL_DETAIL of materials/full_material.glsl that a material asks for.
int detailOf(const scene::Material& m) {
  const bool extended =
      m.specularTexture || m.specularColorTexture || m.transmission > 0 || m.clearcoat > 0 ||
      std::ranges::any_of(scene::kMaterialTextures, [&](auto use) { return (m.*use).set != 0; });
  if (extended) return 2;
  return m.metallicRoughnessTexture || m.normalTexture ? 1 : 0;
}

int detailOf(const scene::Scene& scene, const scene::Geometry& geometry) {
  if (!geometry.colors.empty()) return 2;
  int detail = 0;
  for (const scene::Material& m : scene.materials) detail = std::max(detail, detailOf(m));
  return detail;
}

class GBuffer : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "gbuffer",
        "G-buffer of the surfaces visible through the pixel centres, with bilinear texturing at LOD 0",
        PassKind::Graphics);
    d.recorded();
    d.view();
    const SizeExpr full = fullMaterials();
    d.output("gbuffer", "gbuffer", gbufferOutput(), "one surface per pixel");
    const ResourceSpec tint =
        image2D(VK_FORMAT_R16G16B16A16_SFLOAT, max(full * viewWidth(), 1), max(full * viewHeight(), 1));
    d.scratch("tint", tint, Usage::ColorAttachment | Usage::Sampled,
              "with full materials, of the transparent surfaces in front of each surface, rgb: logarithms of "
              "the relative colours of glass, a: the number of surfaces");
    d.parameter(
        "cull", choice("auto", {"auto", "none"}),
        "back faces: `auto` hides those of single-sided materials, as glTF specifies, `none` shows all");
    d.counter("triangles", "triangles drawn, which are those that may be in view");
    std::vector<std::string> images = {"gbuffer.distance", "gbuffer.normal",   "gbuffer.face",
                                       "gbuffer.albedo",   "gbuffer.emission", "gbuffer.id"};
    for (const bool textured : {false, true})
      d.fullscreen("gbuffer/resolve.frag", images)
          .called(textured ? "resolve with emission textures" : "resolve")
          .when(!full)
          .define("EMISSION_TEXTURES", textured)
          .define("FULL", 0);
    images.push_back("gbuffer.specular");
    for (const int detail : {0, 1, 2})
      for (const bool veiled : {false, true})
        d.fullscreen("gbuffer/resolve.frag", images)
            .called(fullResolve(detail, veiled))
            .when(full)
            .define("MATERIAL_DETAIL", detail)
            .define("TINT", veiled)
            .define("FULL", 1);
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    full_ = fullMaterials(ctx.parameters());
    const bool cull = ctx.parameters().text("cull") == "auto";
    for (const scene::DrawKind kind : scene::kDrawKinds)
      draw_[size_t(kind)] = ctx.graphics(
          {.vertex = "gbuffer/visibility.vert",
           .fragment = "gbuffer/visibility.frag",
           .defines = {{"TESTED", isTested(kind) ? "1" : "0"},
                       {"CULL", cull ? "1" : "0"},
                       {"PASSAGE", kind == scene::DrawKind::Transparent ? "1" : "0"}},
           .colors = {"gbuffer.triangle"},
           .depth = "gbuffer.depth",
           .cull =
               cull && kind == scene::DrawKind::SingleSided ? VkCullModeFlags(VK_CULL_MODE_BACK_BIT) : 0u});
    if (full_)
      tint_ = ctx.graphics({.vertex = "gbuffer/visibility.vert",
                            .fragment = "gbuffer/tint.frag",
                            .defines = {{"TESTED", "1"}, {"CULL", cull ? "1" : "0"}, {"PASSAGE", "0"}},
                            .colors = {"tint"},
                            .depth = "gbuffer.depth",
                            .depthCompare = VK_COMPARE_OP_LESS,
                            .depthWrite = false,
                            .additiveBlend = true});
  }

  void record(RecordContext& ctx) override {
    const scene::GpuScene& gpu = *ctx.frame().gpu;
    const scene::Geometry& geometry = *ctx.frame().geometry;
    if (gpu_ != &gpu) {
      clusters_ = scene::drawClusters(gpu.drawRuns(), geometry);
      const std::vector<scene::Material>& materials = ctx.frame().scene->materials;
      emissionTextures_ = std::any_of(materials.begin(), materials.end(),
                                      [](const scene::Material& m) { return bool(m.emissionTexture); });
      detail_ = detailOf(*ctx.frame().scene, geometry);
      veiled_ = full_ && std::any_of(materials.begin(), materials.end(), scene::letsLightThrough);
      gpu_ = &gpu;
    }
    scene::visibleRuns(clusters_, gpu.drawRuns(), geometry.staticTriangles, ctx.view().worldToClip, visible_);
    uint64_t drawn = 0;
    for (const scene::DrawRun& run : visible_) drawn += run.triangleCount;
    ctx.counter("triangles", double(drawn));
    const auto clear = Attachment::Load::Clear;
    const Attachment depth{"gbuffer.depth", clear, {.depthStencil = {1.0f, 0}}};
    ctx.render({{"gbuffer.triangle", clear, {.color = {.uint32 = {~0u}}}}}, &depth, draw_, [&] {
      for (const scene::DrawRun& run : visible_)
        ctx.use(draw_[size_t(run.kind)])
            .drawTriangles(gpu.indices().handle(), run.firstTriangle, run.triangleCount);
    });
    if (veiled_) drawTint(ctx);
    ctx.run(emissionTextures_ ? "resolve with emission textures" : "resolve");
    ctx.run(fullResolve(detail_, veiled_));
  }

 private:
  static std::string fullResolve(int detail, bool veiled) {
    static constexpr const char* kWith[] = {"", " with maps", " with extensions"};
    return std::string("resolve full materials") + kWith[detail] +
           (veiled ? " behind transparent surfaces" : "");
  }

  void drawTint(RecordContext& ctx) const {
    const Attachment depth{"gbuffer.depth", Attachment::Load::Keep};
    ctx.render({{"tint", Attachment::Load::Clear}}, &depth, std::span(&tint_, 1), [&] {
      for (const scene::DrawRun& run : visible_)
        if (run.kind == scene::DrawKind::Transparent)
          ctx.use(tint_).drawTriangles(ctx.frame().gpu->indices().handle(), run.firstTriangle,
                                       run.triangleCount);
    });
  }

  Kernel draw_[std::size(scene::kDrawKinds)], tint_;
  bool full_ = false, emissionTextures_ = false, veiled_ = false;
  int detail_ = 0;
  const scene::GpuScene* gpu_ = nullptr;  // the scene that the clusters belong to
  std::vector<scene::DrawCluster> clusters_;
  std::vector<scene::DrawRun> visible_;
};

FOVEA_PASS(GBuffer);

}  // namespace
}  // namespace fovea::passes
