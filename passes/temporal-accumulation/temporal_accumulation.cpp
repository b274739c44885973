// Few samples a frame become many over the frames: they stay on the surfaces where they were taken. Of an
// image with a sample for every pixel it is what changes from frame to frame that becomes less.
#include <bit>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "fovea/pass.h"

namespace fovea::passes {
namespace {

using namespace graph;

class TemporalAccumulation : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "temporal-accumulation",
        "running mean, at every pixel, of samples that few pixels, or all, get in a frame; it follows "
        "the surfaces and starts anew where one comes into view",
        PassKind::Graphics);
    const SizeExpr width = widthOf("gbuffer.position"), height = heightOf("gbuffer.position");
    d.input("gbuffer", "gbuffer",
            {member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::StorageRead),
             member("normal", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead)},
            "surfaces seen by the eye");
    d.input("origin", image2D(VK_FORMAT_R32_UINT), Usage::StorageRead,
            "x | y << 16: the pixel of `history` that showed the surface, 0xffffffff: none (pass "
            "motion-vectors)");
    d.input(
        "samples", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
        "rgb: of one pixel of a block; a: which, as pass near-field says it; a power of two times smaller "
        "than `mean`. Or rgb of every pixel, a 1, as large as `mean`");
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
    const uint32_t pixels = ctx.extent("mean").width, texels = ctx.extent("samples").width;
    shift_ = int32_t(std::bit_width((pixels + texels - 1) / texels - 1));
    kernel_ = ctx.fullscreen("temporal-accumulation/temporal_accumulation.frag", {"mean"},
                             {{"BLOCKS", shift_ > 0 ? "1" : "0"}});
  }
  void record(RecordContext& ctx) override {
    const Parameters& p = ctx.parameters();
    Commands commands = ctx.use(kernel_);
    commands.constant("weight", ctx.firstFrame() ? float(p.integer("first_samples")) : 1.0f)
        .constant("frames", float(p.real("frames")));
    if (shift_ > 0)
      commands.constant("leastCos", std::cos(glm::radians(float(p.real("normal_angle")))))
          .constant("shift", shift_);
    commands.drawFullscreen();
  }

 private:
  int32_t shift_ = 0;  // a texel of `samples` is 2^shift pixels wide
  Kernel kernel_;
};

FOVEA_PASS(TemporalAccumulation);

}  // namespace
}  // namespace fovea::passes
