// Accumulates few samples per frame over many frames; samples stay on the surfaces on which they were taken. For an
// image with a sample at every pixel, this reduces flicker.
#include <bit>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/sizes.h"

namespace fovea::passes {
namespace {

using namespace graph;

// How many frames the history of another estimate may count: after a jump of the gaze two, and one more in each frame.
float mostOfOthers(const scene::Frame& frame) {
  if (!(frame.saccade > 0)) return 1e6f;
  return 2 + float(scene::kSaccadeFrames) * (1 - frame.saccade);
}

class TemporalAccumulation : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("temporal-accumulation",
                      "running mean at every pixel of samples that some or all pixels get in a frame; it "
                      "follows the surfaces and restarts where one comes into view",
                      PassKind::Graphics);
    const SizeExpr width = widthOf("gbuffer.distance"), height = heightOf("gbuffer.distance");
    d.input("gbuffer", "gbuffer", gbufferMembers(Usage::StorageRead, {"distance", "normal"}),
            "surfaces seen by the eye");
    d.input("origin", image2D(VK_FORMAT_R32_UINT), Usage::StorageRead,
            "x | y << 16: the pixel of `history` that showed the surface, 0xffffffff if there is none (pass "
            "motion-vectors)");
    d.input("samples", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "samples for blocks: rgb of one pixel of a block, a: its code from pass near-field, negative "
            "where its surface asks for no samples (pass reflections), smaller than `mean` by a power of "
            "two; or for every pixel, as large as `mean`: rgb, a: how many times as long the mean is there, "
            "if above 1 (`longer` of pass contact-rays)");
    d.input("history", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "`mean` of the previous frame");
    d.input("gloss", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "rgb: other light at the same pixels as `samples` (`gloss` of pass near-field)")
        .when(fullMaterials());
    d.input("gloss_history", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::StorageRead,
            "`gloss_mean` of the previous frame")
        .when(fullMaterials());
    d.input("change", changeBuffer(), Usage::TexelRead,
            "y: s, after which a history of n samples is worth n / (1 + n s), as light has changed; z: share "
            "of their history that samples have lost (pass eye-paths)")
        .makeOptional();
    d.input("tiles", image2D(VK_FORMAT_R8_UNORM), Usage::StorageRead,
            "tiles with samples (pass mirrors), outside which the mean is 0; if not wired, all are drawn")
        .makeOptional();
    d.output("mean", ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, width, height)), Usage::ColorAttachment,
             "rgb: mean of the samples, in their unit; a: number of their rays, negative where the last "
             "sample was "
             "for a block wider than a texel of `samples`");
    d.output("gloss_mean",
             ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, max(wired("gloss") * width, 1),
                             max(wired("gloss") * height, 1))),
             Usage::ColorAttachment,
             "rgb: mean of `gloss`, in its unit; a: as in `mean`; a single undefined texel if that is not "
             "wired");
    d.parameter(
        "frames", real(16, 1, 1000),
        "length of the mean, in samples: each has at least the weight of one in this many; for blocks "
        "wider than a texel of `samples`, which change all at once, the length is multiplied by the "
        "ratio of the widths");
    d.parameter("first_samples", integer(16, 1, 1024),
                "rays of a sample after a camera cut, as in pass near-field: its weight in the mean");
    d.parameter(
        "fovea_samples", integer(1, 1, 16),
        "rays of the sample of a block, as in pass near-field; the samples of blocks wider than a texel of "
        "`samples` are single rays");
    d.parameter(
        "saccade_samples", integer(1, 1, 16),
        "rays of a sample for 8 frames after a jump of the gaze and up to so many when light changes, "
        "if these are more, as in pass near-field; samples for blocks wider than a texel of `samples` "
        "remain single rays, and their contribution to the mean counts less where a narrower block "
        "follows");
    d.parameter("plane_tolerance", real(0.005, 1e-6, 1),
                "largest distance from a pixel's tangent plane that counts as the same surface, relative to "
                "the pixel's distance from the eye");
    d.parameter("normal_angle", real(25, 1, 90, "degrees"),
                "least angle between normals of different surfaces");
    // Samples are for blocks if a texel of them covers several pixels.
    const SizeExpr blocks = min(ceilDiv(widthOf("mean"), widthOf("samples")) - 1, 1), gloss = wired("gloss");
    const auto accumulate = [&](const char* name, std::vector<std::string> means) -> StepSpec& {
      return d.fullscreen("temporal-accumulation/temporal_accumulation.frag", std::move(means))
          .called(name)
          .define("BLOCKS", blocks)
          .define("CHANGES", wired("change"))
          .tiles("tiles");
    };
    d.require(same(wired("gloss"), wired("gloss_history")),
              "of `gloss` and `gloss_history` only one is wired",
              "wire `gloss_mean` of the previous frame to `gloss_history`, or neither of them");
    requireSameSize(d, "gloss", "samples");
    requireSize(d, "gloss_history", width, height, "`mean`", "wire `gloss_mean` of the previous frame");
    accumulate("mean", {"mean"}).when(!gloss).define("GLOSS", 0);
    accumulate("mean with gloss", {"mean", "gloss_mean"}).when(gloss).define("GLOSS", 1);
    return d;
  }

  void record(RecordContext& ctx) override {
    const Parameters& p = ctx.parameters();
    const uint32_t pixels = ctx.extent("mean").width, texels = ctx.extent("samples").width;
    const auto shift =
        int32_t(std::bit_width((pixels + texels - 1) / texels - 1));  // a texel is 2^shift pixels wide
    Commands commands = ctx.step(ctx.has("gloss") ? "mean with gloss" : "mean");
    const bool first = ctx.firstFrame();
    const auto firstRays = float(p.integer("first_samples")), rays = float(p.integer("fovea_samples")),
               changedRays = std::max(float(p.integer("saccade_samples")), rays);
    const bool jumped = !first && ctx.frame().saccade > 0;
    const float most = first ? firstRays : changedRays;
    commands.constant("frames", float(p.real("frames")));
    if (shift > 0)
      commands.constant("leastCos", std::cos(glm::radians(float(p.real("normal_angle")))))
          .constant("shift", shift)
          .constant("rays", first ? firstRays : rays)
          .constant("changedRays", most)
          .constant("wideRays", first ? firstRays : 1)
          .constant("jumped", float(jumped));
    else
      commands.constant("weight", first || jumped ? most : 1)
          .constant("mostOfOthers", mostOfOthers(ctx.frame()));
    commands.drawFullscreen();
  }
};

FOVEA_PASS(TemporalAccumulation);

}  // namespace
}  // namespace fovea::passes
