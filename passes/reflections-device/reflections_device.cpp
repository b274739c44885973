// What smooth surfaces reflect, with rays on the device.
#include <string>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "shaders/common/records/gather_cache.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ReflectionsDevice : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("reflections-device",
                      "indirect light under the narrow lobes of smooth surfaces, as `reflections-host` finds "
                      "it, with rays that are traced on the device");
    d.view().rays();
    d.input("mirrors", image2D(VK_FORMAT_R32G32B32A32_UINT), Usage::StorageRead,
            "pixels that reflect in a narrow lobe (pass mirrors)");
    d.output("samples", image2D(VK_FORMAT_R16G16B16A16_SFLOAT, widthOf("mirrors"), heightOf("mirrors")),
             Usage::StorageWrite,
             "rgb: mean indirect light under the lobe, W/(sr m^2), at one pixel of each block of 2 x 2; a: "
             "code of that pixel as in pass near-field, negative where it does not reflect, for pass "
             "temporal-accumulation");
    d.output("distances", image2D(VK_FORMAT_R32_SFLOAT, widthOf("mirrors"), heightOf("mirrors")),
             Usage::StorageWrite,
             "distance from the surface of each block to what it shows, m, 0 where it does not reflect, for "
             "pass reflection-vectors");
    d.scratch("traced",
              image2D(VK_FORMAT_R32G32B32A32_SFLOAT, ceilDiv(viewWidth(), 2), ceilDiv(viewHeight(), 2)),
              Usage::StorageRead | Usage::StorageWrite,
              "what the rays of each block found, and its distance, before neighbours share it");
    d.scratch("cells", buffer("GatherCell", sizeof(scene::GatherCell), scene::kGatherCells),
              Usage::StorageRead | Usage::StorageWrite, "light gathered in the frames so far")
        .keep(Lifetime::View);
    d.parameter(
        "bounces", integer(2, 1, 64),
        "reflections of the light before it reaches the visible surface; 2 matches a path tracer of depth 4");
    d.parameter("first_samples", integer(16, 1, 1024),
                "rays per sample after a camera cut, when there is no history to build on");
    d.parameter("materials", choice("full", {"full"}), "what surfaces are: diffuse ones are no mirrors");
    d.counter("mirrors", "pixels from which rays leave");
    d.counter("rays",
              "rays traced, including those towards lights, which count once however many panes they pass");
    d.counter("gathered", "rays at whose ends light of further bounces was gathered rather than known");
    d.step("reflections-device/trace.comp")
        .define("RAY_PASSAGE", 1)
        .define("SURFACE_TEXTURES", 1)
        .constant("rays",
                  [](const RecordContext& ctx) {
                    return ctx.firstFrame() ? uint32_t(ctx.parameters().integer("first_samples")) : 1u;
                  })
        .over("traced");
    d.step("reflections-device/merge.comp").define("RAY_PASSAGE", 1).threads(scene::kGatherCells);
    d.step("reflections-device/filter.comp").over("samples");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    const VkExtent3D mirrors = ctx.extent("mirrors"), half = ctx.extent("traced");
    if (mirrors.width == half.width && mirrors.height == half.height) return;
    const auto text = [](VkExtent3D e) { return std::to_string(e.width) + "x" + std::to_string(e.height); };
    throw Error(ExitCode::BadInput,
                "pass `reflections-device`: `mirrors` has " + text(mirrors) + " texels, half its view has " +
                    text(half),
                "wire mirrors of the view that the pass looks through");
  }
};

FOVEA_PASS(ReflectionsDevice);

}  // namespace
}  // namespace fovea::passes
