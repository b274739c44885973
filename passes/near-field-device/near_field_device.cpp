// Light from nearby surfaces, which VPLs shaded as discs leave out, with rays on the device.
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/materials.h"
#include "passes/near-field-host/near_field_ports.h"
#include "shaders/common/records/gather_cache.h"
#include "shaders/common/records/near_field.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr Usage kReadWrite = Usage::StorageRead | Usage::StorageWrite;

class NearFieldDevice : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("near-field-device",
                      "light from nearby surfaces, from surfaces that shine and from an environment map, as "
                      "`near-field-host` finds it, with rays that are traced on the device");
    d.view().rays().recorded();
    declareNearField(d, Usage::StorageRead, Usage::StorageWrite | Usage::TransferWrite);
    const SizeExpr texels = ceilDiv(viewWidth(), 2) * ceilDiv(viewHeight(), 2),
                   spacing = parameter("spacing"), columns = ceilDiv(viewWidth(), spacing),
                   rows = ceilDiv(viewHeight(), spacing);
    d.scratch("state", buffer("NearFieldState", sizeof(NearFieldState)), kReadWrite,
              "what is known of the rays' lengths, and what rays of this frame need to know")
        .keep(Lifetime::View);
    d.scratch("cells", buffer("GatherCell", sizeof(scene::GatherCell), scene::kGatherCells), kReadWrite,
              "light gathered in the frames so far")
        .keep(Lifetime::View);
    d.scratch("tiles", buffer("NearFieldTile", sizeof(NearFieldTile), columns * rows), kReadWrite,
              "where the rays of each tile of `spacing` x `spacing` pixels leave from");
    d.scratch("items", buffer("uint", 4, texels), kReadWrite,
              "blocks of pixels that have a sample, by their first texel, in any order");
    d.scratch("listed", buffer("uint", 4), kReadWrite | Usage::TransferWrite, "how many these are");
    d.scratch("dispatch", buffer("Dispatch", 4, 3), kReadWrite | Usage::Indirect | Usage::TransferWrite,
              "indirect dispatch over `items`");
    d.scratch("traced", buffer("vec4", 16, texels), kReadWrite,
              "samples of the listed blocks, before adjacent tiles share theirs");
    d.scratch("traced_gloss", buffer("vec4", 16, max(fullMaterials() * texels, 1)), kReadWrite,
              "with full materials, as `traced`, for `gloss`");
    addSteps(d);
    return d;
  }

  void prepare(PrepareContext& ctx) override { checkNearField(ctx, "near-field-device"); }

  void record(RecordContext& ctx) override {
    checkGBufferSize(ctx, "near-field-device", ctx.view().size);
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
    d.step("near-field-device/begin.comp")
        .define("CHANGE", wired("change"))
        .constant("share", [](const RecordContext& ctx) { return float(ctx.parameters().real("share")); })
        .constant("saccade", [](const RecordContext& ctx) { return ctx.frame().saccade; })
        .constant("isFirst", [](const RecordContext& ctx) { return uint32_t(ctx.firstFrame()); });
    withRays("near-field-device/tiles.comp")
        .define("MAP_ALONE", is("light", "map"))
        .constant("foveaRadius",
                  [](const RecordContext& ctx) { return nearFieldFovea(ctx.view(), ctx.parameters()); })
        .over("tiles");
    withRays("near-field-device/trace.comp")
        .define("MAP_ALONE", is("light", "map"))
        .define("GLOSS", fullMaterials())
        .define("LOBES", wired("gbuffer"));
    d.step("near-field-device/end.comp").groups(1);
    withRays("near-field-device/merge.comp").threads(scene::kGatherCells);
    d.step("near-field-device/filter.comp").define("GLOSS", fullMaterials()).over("samples");
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
  }
};

FOVEA_PASS(NearFieldDevice);

}  // namespace
}  // namespace fovea::passes
