// Light from nearby surfaces, which VPLs shaded as discs leave out.
#include "shaders/records/near_field.h"
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/sizes.h"
#include "shaders/records/gather_cache.h"

namespace fovea::passes {
namespace {

using namespace graph;

void declarePorts(PassDeclaration& d) {
  constexpr Usage read = Usage::StorageRead, write = Usage::StorageWrite | Usage::TransferWrite;
  d.input("change", changeBuffer(), read,
          "y: s, after which n rays gathered before are worth n / (1 + n s), as light has changed; z: share "
          "of their history that samples have lost (pass eye-paths)")
      .makeOptional();
  d.input("gbuffer", "gbuffer", gbufferMembers(read, {"normal", "specular"}),
          "surfaces seen by the eye, whose lobes `gloss` is for; if not wired, it is the same as `samples`")
      .when(fullMaterials());
  d.input(
       "least_area", spreadBuffer(), read,
       "`spread` of another view that has the same VPLs; if not wired, it follows from the rays of this one")
      .makeOptional();
  const SizeExpr width = ceilDiv(viewWidth(), 2), height = ceilDiv(viewHeight(), 2);
  d.output("samples", ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, width, height)), write,
           "rgb: irradiance / pi, W/(sr m^2), at one pixel of each 2 x 2 block, or of each `spacing` x "
           "`spacing` block outside the fovea; a: code of the sampled pixel and of whether it shows a "
           "surface, for pass temporal-accumulation");
  d.output("gloss",
           ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, max(fullMaterials() * width, 1),
                           max(fullMaterials() * height, 1))),
           write,
           "with full materials, rgb: at the same pixels, the mean of the same light under the lobe of the "
           "surface, W/(sr m^2); a: as in `samples`; otherwise one undefined texel");
  d.output("spread", spreadBuffer(), write, "x: least area of a VPL's disc, m^2, for pass vpl-intensity");
  d.parameter("spacing", integer(4, {2, 4, 8}), "spacing of the rays outside the fovea; inside it is 2");
  d.parameter("vpls", integer(1000, 1, 1 << 20), "number of VPLs");
  d.parameter("share", real(50, 0.01, 1e6),
              "total area of all discs, in squares of the mean distance between visible surfaces and the "
              "surfaces seen from them, or of the diagonal of the scene where no surface sees another");
  d.parameter(
      "bounces", integer(2, 1, 64),
      "reflections of the light before it reaches the visible surface; 2 matches a path tracer of depth 4");
  d.parameter("first_samples", integer(16, 1, 1024),
              "rays per sample after a camera cut, when there is no history to build on");
  d.parameter("fovea_samples", integer(1, 1, 16),
              "rays per sample in the fovea, from one pixel in different directions");
  d.parameter("saccade_samples", integer(1, 1, 16),
              "rays per sample in the fovea for 8 frames after a jump of the gaze, if these are more, as the "
              "history of a new fovea is that of wide blocks, and up to so many when light changes");
  d.parameter(
      "reach", real(4, 1, 1000),
      "how far rays reach: one goes as far as a distance with a probability of this many times the part "
      "of the light that discs leave out there");
  d.parameter("emitter_points", integer(4, 1, 64),
              "points on emissive surfaces and in an environment map, of which the ray aimed at them chooses "
              "one; for a map there are as many cosine-weighted ones beside them");
  d.parameter("light", choice("all", {"none", "map", "all"}),
              "`map` brings the light of the scene's environment map alone, `none` nothing");
  d.counter("rays", kRaysDoc);
  d.counter("shaded", "rays from visible surfaces at whose ends the light was evaluated");
  d.counter("gathered",
            "those of them at whose ends light of further bounces was gathered rather than known");
  requireMaterials(d);
  requireSize(d, "gbuffer.normal", viewWidth(), viewHeight(), "its view",
              "wire the G-buffer of the view that the pass looks through");
}

constexpr Usage kReadWrite = Usage::StorageRead | Usage::StorageWrite;

// Image widths. With a `spacing` of 2, all of the picture is like the fovea.
float foveaRadius(const RecordContext& ctx) {
  constexpr float kEverywhere = 4;
  return ctx.parameters().integer("spacing") == 2 ? kEverywhere : ctx.view().foveaRadius;
}

class NearField : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "near-field",
        "light from nearby surfaces, in the part that VPLs shaded as discs take from it, and all light that "
        "comes straight from emissive surfaces and from an environment map, found with a few rays per frame");
    d.view().rays().recorded();
    declarePorts(d);
    const SizeExpr texels = ceilDiv(viewWidth(), 2) * ceilDiv(viewHeight(), 2),
                   spacing = parameter("spacing"), columns = ceilDiv(viewWidth() + spacing - 2, spacing),
                   rows = ceilDiv(viewHeight() + spacing - 2, spacing);
    d.scratch("state", buffer("NearFieldState", sizeof(NearFieldState)), kReadWrite,
              "what is known of the rays' lengths, and what rays of this frame need to know")
        .keep(Lifetime::View);
    d.scratch("sums", buffer("NearFieldSums", sizeof(NearFieldSums)), kReadWrite,
              "lengths of the rays of this frame");
    d.scratch("cells", buffer("GatherCell", sizeof(scene::GatherCell), scene::kGatherCells), kReadWrite,
              "light gathered in the frames so far")
        .keep(Lifetime::View);
    d.scratch("tiles", buffer("NearFieldTile", sizeof(NearFieldTile), columns * rows), kReadWrite,
              "where the rays of each tile of `spacing` x `spacing` pixels leave from");
    d.scratch("items", buffer("uint", 4, texels), kReadWrite,
              "blocks of pixels that have a sample, texels or wide tiles, in any order");
    d.scratch("listed", buffer("uint", 4), kReadWrite | Usage::TransferWrite, "how many these are");
    d.scratch("dispatch", buffer("Dispatch", 4, 3), kReadWrite | Usage::Indirect | Usage::TransferWrite,
              "indirect dispatch over `items`");
    d.scratch("traced", buffer("vec4", 16, texels), kReadWrite,
              "samples of the listed blocks, before adjacent tiles share theirs");
    d.scratch("traced_gloss", buffer("vec4", 16, max(fullMaterials() * texels, 1)), kReadWrite,
              "with full materials, as `traced`, for `gloss`");
    d.scratch("means", buffer("vec4", 16, columns * rows), kReadWrite, "filtered samples of wide tiles");
    d.scratch("means_gloss", buffer("vec4", 16, max(fullMaterials() * columns * rows, 1)), kReadWrite,
              "with full materials, as `means`, for `gloss`");
    addSteps(d);
    return d;
  }

  void record(RecordContext& ctx) override {
    const std::string& light = ctx.parameters().text("light");
    if (light == "none") {
      ctx.clear("samples", {});
      ctx.clear("gloss", {});
      ctx.fill("spread", 0);
      return;
    }
    ctx.fill("listed", 0);
    ctx.fill("dispatch", 1);
    begin(ctx, ctx.firstFrame() && light != "map");
    ctx.run("tiles");
    if (!ctx.firstFrame()) return trace(ctx, 1);
    const auto turns = uint32_t(ctx.parameters().integer("first_samples"));
    if (light != "map") {  // first the length alone, then the cache
      trace(ctx, 1);
      begin(ctx, false);
      trace(ctx, turns, false);
      begin(ctx, false);  // of these rays, the lengths do not count
    }
    trace(ctx, turns);
  }

 private:
  static void addSteps(PassDeclaration& d) {
    const auto withRays = [&](const char* shader) -> StepSpec& {
      return d.step(shader).define("RAY_PASSAGE", fullMaterials());
    };
    d.step("near-field/begin.comp")
        .define("CHANGE", wired("change"))
        .define("GIVEN_AREA", wired("least_area"))
        .constant("share", [](const RecordContext& ctx) { return float(ctx.parameters().real("share")); })
        .constant("saccade", [](const RecordContext& ctx) { return ctx.frame().saccade; })
        .constant("isFirst", [](const RecordContext& ctx) { return uint32_t(ctx.firstFrame()); });
    withRays("near-field/tiles.comp")
        .define("MAP_ALONE", is("light", "map"))
        .constant("foveaRadius", [](const RecordContext& ctx) { return foveaRadius(ctx); })
        .over("tiles");
    withRays("near-field/trace.comp")
        .define("MAP_ALONE", is("light", "map"))
        .define("GLOSS", fullMaterials())
        .define("LOBES", wired("gbuffer"));
    d.step("near-field/end.comp").groups(1);
    withRays("near-field/merge.comp").threads(scene::kGatherCells);
    d.step("near-field/filter.comp").define("GLOSS", fullMaterials()).threads(countOf("tiles"));
    d.step("near-field/write.comp").define("GLOSS", fullMaterials()).over("samples");
  }

  // onlyLength: whether the rays that follow find no light.
  static void begin(RecordContext& ctx, bool onlyLength) {
    ctx.step("begin").constant("onlyLength", uint32_t(onlyLength)).dispatch(1);
  }

  // Takes a sample over `turns` turns. learns: whether the lengths of its rays count.
  static void trace(RecordContext& ctx, uint32_t turns, bool learns = true) {
    for (uint32_t part = 0; part < turns; ++part)
      ctx.step("trace").constant("part", part).constant("parts", turns).dispatchIndirect("dispatch");
    if (learns) ctx.run("end");
    ctx.run("merge");
    ctx.run("filter");
    ctx.run("write");
  }
};

FOVEA_PASS(NearField);

}  // namespace
}  // namespace fovea::passes
