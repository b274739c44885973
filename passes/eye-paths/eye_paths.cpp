// Eye paths through the triangles themselves: what the light that VPLs stand for is measured by.
#include "passes/eye-paths/eye_path_tracer.h"

#include <algorithm>
#include <vector>

#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "framework/shader_twins/fovea.h"

namespace fovea::passes {
namespace {

using namespace graph;

class EyePaths : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "eye-paths",
        "diffuse paths from fixed points of the region on screen, one bounce each, and the light "
        "that leaves the surfaces where they end",
        PassKind::Host);
    d.view();
    d.output(
        "paths", "eye-paths",
        {member("starts", buffer("ScreenPoint", sizeof(EyePathStart), parameter("points")), Usage::HostWrite),
         member("ends", buffer("EyePathEnd", sizeof(EyePathEnd), parameter("paths")), Usage::HostWrite)},
        "what the screen points show; where their paths end, and the light there: those of one point lie "
        "`points` apart");
    d.parameter("region", choice("fovea", {"fovea", "image", "mixed"}),
                "where the eye paths start: as in pass candidates");
    d.parameter("image_share", real(0.4, 0, 1), "of region `mixed`: starts from the whole image, in 64ths");
    d.parameter("fovea_radius", real(0.25, 0.001, 4, "image widths"), "radius of the fovea");
    d.parameter("points", integer(1024, 1, 65536), "screen points: where pass vpl-intensity has as many");
    d.parameter("paths", integer(8192, 64, 65536), "eye paths");
    d.parameter("bounces", integer(2, 1, 64),
                "reflections of the light before it reaches what the eye sees: 2 is what a path tracer of "
                "depth 4 sees, 1 is direct light at the ends");
    d.parameter("gathered", integer(2, 1, 256), "rays from each end by which the second of them is found");
    d.parameter(
        "renew_frames", integer(1, 1, 1000),
        "in which all paths get new starts, a share of the points in each frame; the others start where "
        "they did, so that a jump of the gaze comes in gradually");
    d.parameter(
        "stray", real(0, 0, 1, "image widths"),
        "how far from where it is due a start may lie on screen: nearer ones that the eye still sees stay on "
        "their surface when their turn to be renewed comes, with the light that they found");
    d.parameter(
        "trace_frames", integer(1, 1, 1000),
        "in which all paths are traced anew, those of a share of the points in each frame; the others, "
        "unless their start is a new one, keep the light that they found");
    d.counter("rays", "rays traced, towards lights, too");
    d.counter("ends", "paths that found a surface");
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
    settings.gathered = uint32_t(p.integer("gathered"));
    settings.renewFrames = ctx.firstFrame() ? 1 : uint32_t(p.integer("renew_frames"));
    settings.stray = ctx.firstFrame() ? 0 : float(p.real("stray"));
    settings.traceFrames = uint32_t(p.integer("trace_frames"));
    settings.turn = uint32_t(ctx.frameNumber());
    starts_.resize(ctx.count("paths.starts"));
    ends_.resize(ctx.count("paths.ends"));
    EyePathStatistics statistics;
    if (frame.scene != nullptr && frame.geometry != nullptr && !frame.geometry->empty())
      statistics = traceEyePaths(frame, ctx.view(), *scene::RayScene::cached(*frame.scene, *frame.geometry),
                                 settings, {starts_, ends_});
    else
      std::ranges::fill(starts_, EyePathStart{}), std::ranges::fill(ends_, EyePathEnd{});
    std::ranges::copy(starts_, ctx.outputAs<EyePathStart>("paths.starts").begin());
    std::ranges::copy(ends_, ctx.outputAs<EyePathEnd>("paths.ends").begin());
    ctx.counter("rays", double(statistics.rays));
    ctx.counter("ends", double(statistics.ends));
  }

 private:
  std::vector<EyePathStart> starts_;  // as they were handed on last
  std::vector<EyePathEnd> ends_;
};

FOVEA_PASS(EyePaths);

}  // namespace
}  // namespace fovea::passes
