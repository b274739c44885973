// Deferred shading with VPLs (Eq. 2 of the paper): interleaved sampling, then a geometry-aware
// filter on the irradiance.
#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <string>

#include "fovea/pass.h"
#include "framework/gpu/resources.h"
#include "passes/acuity.h"
#include "passes/bundles.h"
#include "passes/clamp.h"
#include "passes/deferred/records.h"
#include "passes/materials.h"
#include "passes/sizes.h"
#include "shaders/records/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

using deferred::kTileHeight;
using deferred::kTileWidth;

// A smaller subset would be too poor an estimate, and using fewer subsets costs little when there are few VPLs.
constexpr int64_t kSmallestSubset = 4;

// Subsets along a side of a block: as many as `interleave` says, halved until each has enough VPLs. Of 8, 4 and 2 it is
// the largest that both allow.
SizeExpr subsets() {
  const auto enough = [](int64_t n) {  // 1 if there are VPLs for n x n subsets
    return min(max(countOf("vpls") - SizeExpr(kSmallestSubset * n * n - 1), 0), 1);
  };
  const SizeExpr possible = SizeExpr(1) + enough(2) + SizeExpr(2) * enough(4) + SizeExpr(4) * enough(8);
  return min(parameter("interleave"), possible);
}

class Deferred : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("deferred",
                      "irradiance from all VPLs on the visible surfaces: each pixel uses one subset of the "
                      "VPLs, and a filter combines the subsets",
                      PassKind::ComputeAndGraphics);
    d.recorded();
    d.view();
    const SizeExpr width = widthOf("gbuffer.distance"), height = heightOf("gbuffer.distance");
    d.input("gbuffer", "gbuffer",
            gbufferMembers(Usage::StorageRead, {"distance", "normal", "face", "albedo", "specular"}),
            "surfaces seen by the eye");
    d.input("vpls", vplBuffer(), Usage::Uniform, "light sources; empty slots have zero intensity");
    d.input(
         "atlas", image2DArray(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead,
         "distances seen from each VPL (paraboloid maps, both layouts); if not wired, VPLs cast no shadows")
        .makeOptional();
    d.input("direct", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "rgb: radiance to which the indirect light is added")
        .makeOptional();
    d.input(
         "near_field", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
         "rgb: irradiance / pi of each pixel that VPLs leave out (pass near-field), filtered together with "
         "that of the VPLs")
        .makeOptional()
        .when(parameter("near_light"));
    d.input("near_gloss", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "rgb: the same light under the lobe of each surface, W/(sr m^2) (`gloss` of pass near-field); "
            "if not wired, `near_field` is used instead; not used with `shade`")
        .when(parameter("near_light") * fullMaterials());
    d.input("traced", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "rgb: irradiance / pi from VPLs where rays have found it (pass contact-rays), to which "
            "`near_field` is added as it is; a: above 0 there, and written to `irradiance`; not used where "
            "`periphery` 2 skips pixels")
        .makeOptional();
    addMask(d);
    const ResourceSpec color = ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, width, height));
    d.output("irradiance", color, Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite,
             "rgb: filtered indirect irradiance / pi, W/(sr m^2); multiplied by the reflectance rho it gives "
             "`indirect`; background 0; a: 1, or that of `traced`");
    d.output("gloss", glossImage(width, height), Usage::StorageRead | Usage::StorageWrite,
             "with full materials, rgb: filtered indirect light under the lobe of each surface, W/(sr m^2), "
             "a mean that contributes to `indirect` when multiplied by the share that the surface reflects; "
             "background 0; without `shade` only; otherwise one undefined texel");
    d.output("indirect", color, Usage::ColorAttachment,
             "rgb: indirect radiance towards the eye, rho E / pi and glossy reflections; background 0");
    d.output("radiance", color, Usage::ColorAttachment, "rgb: `direct` (if wired) plus `indirect`");
    d.scratch("partial", color, Usage::StorageRead | Usage::StorageWrite,
              "estimate of each pixel from its own subset");
    d.scratch("coarse",
              image2D(VK_FORMAT_R16G16B16A16_SFLOAT, max(coarse() * ceilDiv(width, 2), 1),
                      max(coarse() * ceilDiv(height, 2), 1)),
              Usage::StorageRead | Usage::StorageWrite,
              "for `periphery` 2, estimate of one pixel in each square of 2 x 2 from its own subset");
    d.scratch("partial_gloss", glossImage(width, height), Usage::StorageRead | Usage::StorageWrite,
              "as `partial`, for `gloss`");
    d.scratch("coarse_gloss", glossImage(coarse() * ceilDiv(width, 2), coarse() * ceilDiv(height, 2)),
              Usage::StorageRead | Usage::StorageWrite, "as `coarse`, for `gloss`");
    d.scratch(
        "edges", buffer("EdgeList", 16),
        Usage::StorageRead | Usage::StorageWrite | Usage::TexelRead | Usage::Indirect | Usage::TransferWrite,
        "indirect dispatch for `edge_pixels`; w: 1 + number of those pixels");
    d.scratch("edge_pixels", buffer("uint", 4, width * height), Usage::StorageWrite | Usage::TexelRead,
              "pixels whose filter window extends beyond their surface: x | y << 16");
    addParameters(d);
    addRequirements(d);
    addSteps(d);
    d.counter("incomplete",
              "pixels for which fewer than half of the subsets have a sample on the same surface nearby");
    d.counter("vpls_per_pixel",
              "average number of VPLs that shade one pixel; multiplied by `shaded_pixels` it gives the "
              "number of pixel-VPL pairs");
    d.counter("shaded_pixels",
              "pixels shaded with VPLs: all that show a surface, or only those in the blocks of `shade`");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    count_ = uint32_t(ctx.count("vpls"));
    side_ = uint32_t(ctx.evaluate(subsets()));
    masked_ = ctx.has("shade");
    preparePages(ctx, 1, pages_);
    if (ctx.evaluate(coarse()) != 0) preparePages(ctx, 2, coarsePages_);
  }

  void record(RecordContext& ctx) override {
    if (masked_) ctx.copy("base", "irradiance");  // for the pixels outside the blocks
    const VkExtent3D size = ctx.extent("partial");
    const int reach = int(2 * side_);  // of the filter beyond a pixel, where it searches for missing subsets
    const Square fine = fineSquare(ctx.view(), ctx.parameters(), kTileWidth);
    shade(ctx, pages_, fine.grown(reach).within(size), {});
    if (!coarsePages_.empty())
      shade(ctx, coarsePages_, Square{}.grown(1 << 20).within(ctx.extent("coarse")),
            {fine.low / 2 + reach, fine.high / 2 - reach});
    ctx.runSteps();
    ctx.counter("vpls_per_pixel", double(count_) / double(side_ * side_));
  }

 private:
  static SizeExpr coarse() { return parameter("periphery") - 1; }  // 0 or 1
  // An image that is needed for full materials, and else a single texel.
  static ResourceSpec glossImage(const SizeExpr& width, const SizeExpr& height) {
    return ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, max(fullMaterials() * width, 1),
                           max(fullMaterials() * height, 1)));
  }

  // Shades the part `area` of the grid of samples, without its part `hole`.
  void shade(RecordContext& ctx, const std::vector<Kernel>& pages, const Square& area, const Square& hole) {
    const auto groups = [](int samples, int tile) { return uint32_t((samples + tile - 1) / tile); };
    const glm::ivec2 extent = area.high - area.low;
    if (extent.x <= 0 || extent.y <= 0) return;
    for (uint32_t page = 0; page < pages.size(); ++page) {
      const uint32_t first = page * scene::kVplPage, inPage = std::min(count_ - first, scene::kVplPage);
      Commands commands = ctx.use(pages[page]);
      commands.range("vpls", uint64_t(first) * sizeof(scene::Vpl), uint64_t(inPage) * sizeof(scene::Vpl));
      commands.constant("clampDistance", clampDistance(ctx));
      if (ctx.has("atlas")) commands.constant("firstSlot", first);
      if (masked_) {
        commands.dispatchIndirect("shade.dispatch");
      } else {
        commands.constant("area", area.corners()).constant("hole", hole.corners());
        commands.dispatch(groups(extent.x, kTileWidth * int(side_)),
                          groups(extent.y, kTileHeight * int(side_)), side_ * side_);
      }
    }
  }

  static void addMask(PassDeclaration& d) {
    d.input("base", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead | Usage::TransferRead,
            "rgb: irradiance / pi of the pixels that `shade` leaves out (from pass reproject), background 0; "
            "used with `shade` only")
        .makeOptional();
    d.input("shade", "shade-mask", shadeMaskMembers(),
            "blocks of pixels to shade; if not wired, all pixels are shaded")
        .makeOptional();
  }

  static void addParameters(PassDeclaration& d) {
    d.parameter("kernel", choice("clamp", {"clamp", "disc"}),
                "replacement of 1 / d^2 near a VPL: `clamp` uses at least clamp_distance for d (the paper), "
                "`disc` uses 1 / (d^2 + A / pi), the light of a disc of the VPL's area seen along its axis");
    d.parameter("near_light", choice("all", {"none", "map", "all"}),
                "content of `near_field`, as `light` of pass near-field; with `none` it is left out");
    declareClamp(d, "least distance for the kernel `clamp`; 0 disables the clamp");
    d.parameter("interleave", integer(4, {1, 2, 4, 8}),
                "width n of a block: its n x n pixels divide the VPLs among them; reduced if a "
                "subset would hold fewer than 4 VPLs");
    d.parameter("shadow_bias", real(1, 0, 100),
                "tolerance of the shadow test, in half texels of the map's footprint at the surface");
    declarePeriphery(
        d,
        "outside the fovea, where the eye resolves no more than every second pixel, one pixel of each "
        "square of this width is shaded, and the filter interpolates; 1 shades all pixels");
    d.parameter("filter_angle", real(25, 1, 90, "degrees"),
                "least angle between normals of different surfaces");
    d.parameter("filter_plane", real(0.005, 1e-6, 1),
                "largest distance from a pixel's tangent plane that counts as the same surface, relative to "
                "the pixel's distance from the eye");
  }

  static void addSteps(PassDeclaration& d) {
    const SizeExpr masked = wired("shade");
    const auto filter = [&](const char* name, bool edges, int scale) -> StepSpec& {
      return d.step("deferred/resolve.comp")
          .called(name)
          .define("INTERLEAVE", subsets())
          .define("MASKED", masked)
          .define("BLOCK", parameter("interleave"))
          .define("EDGES", edges)
          .define("SCALE", scale)
          .define("TRACED", scale == 1 ? wired("traced") : SizeExpr(0))
          .define("NEAR_FIELD", wired("near_field"))
          .define("GLOSS", fullMaterials() * !masked)
          .constant("filterCos", [](const RecordContext& ctx) {
            return std::cos(glm::radians(float(ctx.parameters().real("filter_angle"))));
          });
    };
    for (const int scale : {1, 2}) {
      const SizeExpr runs = scale == 1 ? !masked : !masked * coarse();
      d.fill("edges", 1).called(scale == 1 ? "fill edges" : "fill coarse edges").when(runs);
      filter(scale == 1 ? "filter" : "filter coarse", false, scale)
          .when(runs)
          .constant("fine",
                    [](const RecordContext& ctx) {
                      return fineSquare(ctx.view(), ctx.parameters(), kTileWidth).corners();
                    })
          .groups(ceilDiv(widthOf("partial"), kTileWidth), ceilDiv(heightOf("partial"), kTileHeight));
      filter(scale == 1 ? "filter edges" : "filter coarse edges", true, scale).when(runs).indirect("edges");
    }
    filter("filter blocks", true, 1).when(masked).indirect("shade.dispatch");
    d.fullscreen("deferred/compose.frag", {"indirect", "radiance"})
        .when(isRead("indirect") || isRead("radiance"))
        .define("HAS_DIRECT", wired("direct"))
        .define("GLOSS", fullMaterials() * (masked + 1))
        .define("REFLECTIONS", 0);
  }

  static void addRequirements(PassDeclaration& d) {
    const SizeExpr width = widthOf("gbuffer.distance"), height = heightOf("gbuffer.distance"),
                   block = parameter("interleave");
    d.require(wired("base") || !wired("shade"), "`shade` leaves pixels out, but nothing is wired to `base`",
              "wire reproject.irradiance to base");
    requireSize(d, "shade.mask", width, height, "the image", "make it from the same G-buffer");
    d.require(!wired("shade") || (same(widthOf("base"), width) && same(heightOf("base"), height)),
              "`base` is not of the size of the image", "make it from the same G-buffer");
    d.require(same(countOf("shade.blocks"), ceilDiv(width, block) * ceilDiv(height, block)),
              "`shade` lists blocks of another size than `interleave`",
              "give both passes the same `interleave`");
    d.require(!wired("shade") || same(parameter("periphery"), 1),
              "`shade` says which blocks to shade, so `periphery` has nothing to decide",
              "leave `periphery` at 1, or `shade` unwired");
    d.require(wired("near_field") || !wired("near_gloss"),
              "`near_gloss` is wired without the light that it is a part of",
              "wire near-field's mean to near_field, too, or leave `near_gloss` unwired");
    requireSameSize(d, "near_gloss", "near_field");
    requireMaps(d, "atlas", "vpls");
    requireMaterials(d);
  }

  // The number of VPLs in a page is a constant in the shader, so there is a kernel for each: for a full first page, for
  // further full pages and for the rest.
  void preparePages(PrepareContext& ctx, int scale, std::vector<Kernel>& pages) {
    Defines defines{{"INTERLEAVE", std::to_string(side_)},
                    {"MASKED", masked_ ? "1" : "0"},
                    {"SCALE", std::to_string(scale)}};
    if (masked_) defines["BLOCK"] = std::to_string(ctx.parameters().integer("interleave"));
    defines["KERNEL_DISC"] = ctx.parameters().text("kernel") == "disc" ? "1" : "0";
    defines["NEAR_FIELD"] = ctx.has("near_field") ? "1" : "0";
    defines["SHADOWED"] = ctx.has("atlas") ? "1" : "0";
    defines["GLOSS"] = fullMaterials(ctx.parameters()) && !masked_ ? "1" : "0";
    defines["NEAR_GLOSS"] = ctx.has("near_gloss") && !masked_ ? "1" : "0";
    defines["TILED"] = "0";
    if (ctx.has("atlas")) {
      const VkExtent3D maps = ctx.extent("atlas");
      const uint64_t perLayer = std::max(maps.width / std::max(maps.height, 1u), 1u);
      defines["TILED"] = std::to_string(int(perLayer > 1));
    }
    for (uint32_t first = 0; first < count_; first += scene::kVplPage) {
      defines["PAGE_VPLS"] = std::to_string(std::min(count_ - first, scene::kVplPage));
      defines["ACCUMULATE"] = std::to_string(int(first > 0));
      pages.push_back(pages.size() > 1 && count_ - first >= scene::kVplPage
                          ? pages.back()
                          : ctx.compute("deferred/shade.comp", defines));
      if (scale > 1) pages.back().called("shade coarse");
    }
  }

  uint32_t count_ = 0, side_ = 1;
  bool masked_ = false;
  std::vector<Kernel> pages_, coarsePages_;
};

FOVEA_PASS(Deferred);

}  // namespace
}  // namespace fovea::passes
