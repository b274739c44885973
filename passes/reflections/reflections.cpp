// What smooth surfaces reflect.
#include "fovea/pass.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/sizes.h"
#include "shaders/records/gather_cache.h"

namespace fovea::passes {
namespace {

using namespace graph;

void declarePorts(PassDeclaration& d) {
  constexpr Usage read = Usage::StorageRead, write = Usage::StorageWrite;
  d.view();
  d.input("mirrors", image2D(VK_FORMAT_R32G32B32A32_UINT), read,
          "pixels that reflect in a narrow lobe (pass mirrors)");
  d.output("samples",
           ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, widthOf("mirrors"), heightOf("mirrors"))), write,
           "rgb: mean indirect light under the lobe, W/(sr m^2), at one pixel of each block of 2 x 2; a: "
           "code of that pixel as in pass near-field, negative where it does not reflect, for pass "
           "temporal-accumulation");
  d.output("distances", image2D(VK_FORMAT_R32_SFLOAT, widthOf("mirrors"), heightOf("mirrors")), write,
           "harmonic mean of the distances from each block to what its rays met, m, 0 where it does not "
           "reflect or all rays went into the surface, for pass reflection-vectors");
  d.parameter(
      "bounces", integer(2, 1, 64),
      "reflections of the light before it reaches the visible surface; 2 matches a path tracer of depth 4");
  d.parameter("first_samples", integer(16, 1, 1024),
              "rays per sample after a camera cut, when there is no history to build on");
  d.counter("mirrors", "pixels from which rays leave");
  d.counter("rays", kRaysDoc);
  d.counter("gathered", "rays at whose ends light of further bounces was gathered rather than known");
  d.require(fullMaterials(), "materials are `diffuse`, and diffuse surfaces have no narrow lobe",
            "leave the pass out, or make the materials of the view `full`");
  requireSize(d, "mirrors", ceilDiv(viewWidth(), 2), ceilDiv(viewHeight(), 2), "half its view",
              "wire mirrors of the view that the pass looks through");
}

constexpr Usage kReadWrite = Usage::StorageRead | Usage::StorageWrite;

class Reflections : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("reflections",
                      "indirect light under the narrow lobes of smooth surfaces, found with a ray per block "
                      "of pixels and frame: VPLs would show as blurred discs there");
    d.rays().recorded();
    declarePorts(d);
    d.scratch("traced",
              image2D(VK_FORMAT_R32G32B32A32_SFLOAT, ceilDiv(viewWidth(), 2), ceilDiv(viewHeight(), 2)),
              kReadWrite,
              "what the rays of each block found, before neighbours share it; a: mean of 1 / distance, 1/m");
    d.scratch("cells", buffer("GatherCell", sizeof(scene::GatherCell), scene::kGatherCells), kReadWrite,
              "light gathered in the frames so far")
        .keep(Lifetime::View);
    d.step("reflections/trace.comp").define("RAY_PASSAGE", 1);
    d.step("reflections/merge.comp").define("RAY_PASSAGE", 1).threads(scene::kGatherCells);
    d.step("reflections/filter.comp").over("samples");
    return d;
  }

  void record(RecordContext& ctx) override {
    const uint32_t rays = ctx.firstFrame() ? uint32_t(ctx.parameters().integer("first_samples")) : 1;
    for (uint32_t part = 0; part < rays; ++part)
      ctx.step("trace").constant("part", part).constant("parts", rays).dispatchOver("traced");
    ctx.run("merge");
    ctx.run("filter");
  }
};

FOVEA_PASS(Reflections);

}  // namespace
}  // namespace fovea::passes
