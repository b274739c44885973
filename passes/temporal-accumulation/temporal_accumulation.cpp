// Few samples a frame become many over the frames: they stay on the surfaces where they were taken.
#include <bit>
#include <cmath>

#include "framework/graph/registry.h"

namespace fovea::passes {
namespace {

using namespace graph;

class TemporalAccumulation : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "temporal-accumulation",
        "running mean, at every pixel, of samples that few pixels get in a frame; it follows the "
        "surfaces and starts anew where one comes into view",
        PassKind::Graphics);
    d.view();
    const SizeExpr width = widthOf("gbuffer.position"), height = heightOf("gbuffer.position");
    const auto position = [] {
      return member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::StorageRead);
    };
    const auto normal = [] {
      return member("normal", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead);
    };
    d.input("gbuffer", "gbuffer",
            {position(), normal(), member("id", image2D(VK_FORMAT_R32_UINT), Usage::StorageRead)},
            "surfaces seen by the eye");
    d.input("previous", "gbuffer", {position(), normal()}, "those of the frame before");
    d.input(
        "samples", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
        "rgb: of one pixel of a block; a: which, as pass near-field says it; a power of two times smaller "
        "than `mean`");
    d.input("history", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "`mean` of the frame before");
    d.output("mean", image2D(VK_FORMAT_R16G16B16A16_SFLOAT, width, height), Usage::ColorAttachment,
             "rgb: mean of the samples, in their unit; a: how many");
    d.parameter(
        "frames", real(16, 1, 1000),
        "that the mean goes back: each sample has at least the weight of one of so many; for larger blocks "
        "than others, which change all at once, of as many more as they are wide");
    d.parameter("first_samples", integer(16, 1, 1024),
                "what a sample counts as after a camera cut: as in pass near-field");
    d.parameter("plane_tolerance", real(0.005, 1e-6, 1),
                "distance from the tangent plane of a pixel, in parts of its distance to the eye, that "
                "belongs to its "
                "surface");
    d.parameter("normal_angle", real(25, 1, 90, "degrees"),
                "normals that differ by more belong to different surfaces");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    kernel_ = ctx.fullscreen("temporal-accumulation/temporal_accumulation.frag", {"mean"});
  }
  void record(RecordContext& ctx) override {
    const uint32_t pixels = ctx.extent("mean").width, texels = ctx.extent("samples").width;
    ctx.use(kernel_)
        .constant("weight", ctx.firstFrame() ? float(ctx.parameters().integer("first_samples")) : 1.0f)
        .constant("frames", float(ctx.parameters().real("frames")))
        .constant("leastCos", std::cos(float(ctx.parameters().real("normal_angle")) * 0.017453293f))
        .constant("shift", int32_t(std::bit_width((pixels + texels - 1) / texels - 1)))
        .drawFullscreen();
  }

 private:
  Kernel kernel_;
};

FOVEA_PASS(TemporalAccumulation);

}  // namespace
}  // namespace fovea::passes
