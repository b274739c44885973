// Eye paths with rays on the device; they measure the light that the VPLs stand for.
#include "shaders/records/eye_paths.h"
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/regions.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr Usage kReadWrite = Usage::StorageRead | Usage::StorageWrite;

void declarePorts(PassDeclaration& d) {
  d.output("paths", "eye-paths", eyePathOutput(parameter("points"), parameter("paths"), kReadWrite),
           "what the screen points show, where their paths end and the light found there; the paths of one "
           "point are `points` entries apart")
      .keep(Lifetime::View);
  d.output(
      "change", changeBuffer(), kReadWrite,
      "x: share c of the light found by the paths traced again that differs from what they found before, "
      "in [0, 1]; y: s = 16 j^2, after which a history of n samples is worth n / (1 + n s), j being the "
      "part of c that exceeds the changes in the frames before, or the share by which the light as a "
      "whole has grown or shrunk if that is more; z: s / (1 + s), the share that is lost, and a quarter "
      "less in each frame after; w: share by which the light as a whole has grown or shrunk, in [0, 1]");
  d.parameter("region", choice("fovea", {"fovea", "image", "mixed"}),
              "region in which the eye paths start, as in pass candidates");
  d.parameter("image_share", real(0.4, 0, 1),
              "share of starts in the whole image for region `mixed`, rounded to 64ths");
  d.parameter("points", integer(1024, 1, 65536),
              "number of screen points, the same as in pass vpl-intensity");
  d.parameter("paths", integer(8192, 64, 65536), "number of eye paths");
  d.parameter("bounces", integer(2, 1, 64),
              "reflections of the light before it reaches the visible surface: 1 is direct light at the "
              "ends, 2 matches a path tracer of depth 4");
  d.parameter("emission", flag(true),
              "whether the ends show the light that surfaces emit themselves; pass near-field brings it from "
              "there straight to what is seen");
  d.parameter("gathered", integer(2, 1, 256),
              "rays from each end that gather the second of these reflections");
  d.parameter("renew_frames", integer(1, 1, 1000),
              "frames in which all paths get new starts, a share of the points in each frame; the others "
              "keep theirs, so that the effect of a gaze jump comes in gradually");
  d.parameter("saccade_renew_frames", integer(0, 0, 1000),
              "in place of `renew_frames` for 8 frames after a jump of the gaze; 0 means no other");
  d.parameter("stray", real(0, 0, 1, "image widths"),
              "how far a start may be on screen from its place; a closer one that the eye still sees is "
              "kept, with the light it found, when it is due for renewal");
  d.parameter("trace_frames", integer(1, 1, 1000),
              "frames in which all paths are traced anew, those of a share of the points in each frame; "
              "the others keep the light they found unless their start is new; of them, twice as large a "
              "share is traced all the same as the light of the former has changed suddenly");
}

// Frames in which all starts are renewed.
uint32_t renewFrames(const RecordContext& ctx) {
  const Parameters& p = ctx.parameters();
  if (ctx.firstFrame()) return 1;
  const bool hurries = ctx.frame().saccade > 0 && p.integer("saccade_renew_frames") > 0;
  return uint32_t(p.integer(hurries ? "saccade_renew_frames" : "renew_frames"));
}

class EyePaths : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("eye-paths",
                      "diffuse paths from fixed screen points of the region, one bounce each, and the light "
                      "leaving the surfaces where they end, found with rays");
    d.view().rays();
    declarePorts(d);
    d.scratch("memory", buffer("EyePathMemory", sizeof(EyePathMemory)), kReadWrite,
              "what light has changed by in the frames so far")
        .keep(Lifetime::View);
    d.scratch("turns", buffer("uint", 4, parameter("points")), kReadWrite,
              "whether the paths of each point have a new start, and whether they wait");
    d.scratch("differences", buffer("EyePathDifference", sizeof(EyePathDifference), parameter("paths")),
              kReadWrite, "between the light that a path finds and what it found before");
    d.counter("rays", kRaysDoc);
    d.counter("ends", "paths that hit a surface");
    d.step("eye-paths/points.comp")
        .define("RAY_PASSAGE", fullMaterials())
        .constant(
            "imageShare64ths",
            [](const RecordContext& ctx) { return imageShare64ths(ctx.parameters().real("image_share")); })
        .constant("renew", renewFrames)
        .constant("strayNow",
                  [](const RecordContext& ctx) {
                    return ctx.firstFrame() ? 0.0f : float(ctx.parameters().real("stray"));
                  })
        .threads(parameter("points"));
    addPaths(d, "paths", 0);
    d.step("eye-paths/change.comp").groups(1);
    addPaths(d, "late paths", 1);
    d.step("eye-paths/unit.comp").groups(1);
    return d;
  }

 private:
  static void addPaths(PassDeclaration& d, const char* name, int late) {
    d.step("eye-paths/paths.comp")
        .called(name)
        .define("RAY_PASSAGE", fullMaterials())
        .define("EMISSION", parameter("emission"))
        .define("LATE", late)
        .threads(parameter("paths"));
  }
};

FOVEA_PASS(EyePaths);

}  // namespace
}  // namespace fovea::passes
