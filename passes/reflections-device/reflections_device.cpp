// What smooth surfaces reflect, with rays on the device.
#include "fovea/pass.h"
#include "passes/reflections-host/reflections_ports.h"
#include "shaders/common/records/gather_cache.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr Usage kReadWrite = Usage::StorageRead | Usage::StorageWrite;

class ReflectionsDevice : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("reflections-device",
                      "indirect light under the narrow lobes of smooth surfaces, as `reflections-host` finds "
                      "it, with rays that are traced on the device");
    d.rays().recorded();
    declareReflections(d, Usage::StorageRead, Usage::StorageWrite);
    d.scratch("traced",
              image2D(VK_FORMAT_R32G32B32A32_SFLOAT, ceilDiv(viewWidth(), 2), ceilDiv(viewHeight(), 2)),
              kReadWrite,
              "what the rays of each block found, before neighbours share it; a: mean of 1 / distance, 1/m");
    d.scratch("cells", buffer("GatherCell", sizeof(scene::GatherCell), scene::kGatherCells), kReadWrite,
              "light gathered in the frames so far")
        .keep(Lifetime::View);
    d.step("reflections-device/trace.comp").define("RAY_PASSAGE", 1);
    d.step("reflections-device/merge.comp").define("RAY_PASSAGE", 1).threads(scene::kGatherCells);
    d.step("reflections-device/filter.comp").over("samples");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    const VkExtent3D half = ctx.extent("traced");
    checkReflections(ctx, "reflections-device", {half.width, half.height});
  }

  void record(RecordContext& ctx) override {
    const uint32_t rays = ctx.firstFrame() ? uint32_t(ctx.parameters().integer("first_samples")) : 1;
    for (uint32_t part = 0; part < rays; ++part)
      ctx.step("trace").constant("part", part).constant("parts", rays).dispatchOver("traced");
    ctx.run("merge");
    ctx.run("filter");
  }
};

FOVEA_PASS(ReflectionsDevice);

}  // namespace
}  // namespace fovea::passes
