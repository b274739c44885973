// Eye paths traced through the triangles; they measure the light that the VPLs stand for.
#include "passes/eye-paths/eye_path_tracer.h"

#include <algorithm>
#include <vector>

#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "framework/shader_twins/fovea.h"
#include "passes/bundles.h"
#include "passes/materials.h"

namespace fovea::passes {
namespace {

using namespace graph;

// How much more the square of an error weighs that all pixels share than one of noise: what is left of light that is
// gone is seen more.
constexpr float kBiasWeight = 16;
constexpr float kRegained = 0.25f;   // share of what was lost that is regained in each frame
constexpr float kUsualKept = 0.75f;  // share of the usual change that is kept from frame to frame

class EyePaths : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("eye-paths",
                      "diffuse paths from fixed screen points of the region, one bounce each, and the light "
                      "leaving the surfaces where they end",
                      PassKind::Host);
    d.view();
    d.output("paths", "eye-paths", eyePathOutput(parameter("points"), parameter("paths")),
             "what the screen points show, where their paths end and the light found there; the paths of one "
             "point are `points` entries apart");
    d.output(
        "change", changeBuffer(), Usage::HostWrite,
        "x: share c of the light found by the paths traced again that differs from what they found before, "
        "in [0, 1]; y: s = 16 j^2, after which a history of n samples is worth n / (1 + n s), j being the "
        "part of c that exceeds the changes in the frames before, or the share by which the light as a "
        "whole has grown or shrunk if that is more; z: s / (1 + s), the share that is lost, and a quarter "
        "less in each frame after");
    d.parameter("region", choice("fovea", {"fovea", "image", "mixed"}),
                "region in which the eye paths start, as in pass candidates");
    d.parameter("image_share", real(0.4, 0, 1),
                "share of starts in the whole image for region `mixed`, rounded to 64ths");
    d.parameter("fovea_radius", real(0.25, 0.001, 4, "image widths"), "radius of the fovea");
    d.parameter("points", integer(1024, 1, 65536),
                "number of screen points, the same as in pass vpl-intensity");
    d.parameter("paths", integer(8192, 64, 65536), "number of eye paths");
    d.parameter("bounces", integer(2, 1, 64),
                "reflections of the light before it reaches the visible surface: 1 is direct light at the "
                "ends, 2 matches a path tracer of depth 4");
    d.parameter(
        "emission", flag(true),
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
    declareMaterials(d, "`full` lets metals keep their colour");
    d.counter("rays", "rays traced, including those towards lights");
    d.counter("ends", "paths that hit a surface");
    d.counter("change", "share of the light that has changed, in [0, 1]");
    d.counter("drift", "share by which the light as a whole has grown or shrunk, in [0, 1]");
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const Parameters& p = ctx.parameters();
    EyePathSettings settings;
    const std::string& region = p.text("region");
    settings.region = region == "fovea"   ? scene::kRegionFovea
                      : region == "image" ? scene::kRegionImage
                                          : scene::kRegionMixed;
    settings.imageShare64ths = scene::imageShare64ths(p.real("image_share"));
    settings.foveaRadius = float(p.real("fovea_radius"));
    settings.points = uint32_t(p.integer("points"));
    settings.bounces = uint32_t(p.integer("bounces"));
    settings.emission = p.flag("emission");
    settings.fullMaterials = fullMaterials(p);
    settings.gathered = uint32_t(p.integer("gathered"));
    const bool hurries = frame.saccade > 0 && p.integer("saccade_renew_frames") > 0;
    settings.renewFrames = ctx.firstFrame() ? 1
                           : hurries        ? uint32_t(p.integer("saccade_renew_frames"))
                                            : uint32_t(p.integer("renew_frames"));
    settings.stray = ctx.firstFrame() ? 0 : float(p.real("stray"));
    settings.traceFrames = uint32_t(p.integer("trace_frames"));
    settings.turn = uint32_t(ctx.frameNumber());
    if (ctx.firstFrame()) usualChange_ = lost_ = 0;
    settings.usualChange = usualChange_;
    starts_.resize(ctx.count("paths.starts"));
    ends_.resize(ctx.count("paths.ends"));
    EyePathStatistics statistics;
    if (frame.scene != nullptr && frame.geometry != nullptr && !frame.geometry->empty())
      statistics = traceEyePaths(frame, ctx.view(),
                                 *scene::RayScene::cached(*frame.scene, *frame.geometry, passingOf(p)),
                                 settings, {starts_, ends_});
    else
      std::ranges::fill(starts_, EyePathStart{}), std::ranges::fill(ends_, EyePathEnd{});
    std::ranges::copy(starts_, ctx.outputAs<EyePathStart>("paths.starts").begin());
    std::ranges::copy(ends_, ctx.outputAs<EyePathEnd>("paths.ends").begin());
    ctx.counter("rays", double(statistics.rays));
    ctx.outputAs<glm::vec4>("change")[0] = changeOf(statistics);
    ctx.counter("ends", double(statistics.ends));
    ctx.counter("change", statistics.change);
    ctx.counter("drift", statistics.drift);
  }

 private:
  // The output `change`. Running means are made for what moves all the time, so only what is sudden or goes one way
  // ages them.
  glm::vec4 changeOf(const EyePathStatistics& statistics) {
    const float change = float(statistics.change),
                unfollowed = std::max(change - usualChange_, float(statistics.drift)),
                ageing = kBiasWeight * unfollowed * unfollowed;
    usualChange_ = std::max(change, kUsualKept * usualChange_);
    lost_ = std::max(ageing / (1 + ageing), lost_ - kRegained);
    return {change, ageing, lost_, 0};
  }

  std::vector<EyePathStart> starts_;  // as last written to the output
  std::vector<EyePathEnd> ends_;
  float lost_ = 0;         // z of the output
  float usualChange_ = 0;  // largest change of the frames so far, forgotten in a few of them
};

FOVEA_PASS(EyePaths);

}  // namespace
}  // namespace fovea::passes
