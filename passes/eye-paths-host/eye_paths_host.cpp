// Eye paths traced through the triangles; they measure the light that the VPLs stand for.
#include "passes/eye-paths-host/eye_path_ports.h"
#include "passes/eye-paths-host/eye_path_tracer.h"

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

class EyePathsHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("eye-paths-host",
                      "diffuse paths from fixed screen points of the region, one bounce each, and the light "
                      "leaving the surfaces where they end, found with rays on the CPU",
                      PassKind::Host);
    d.view();
    declareEyePaths(d, Usage::HostWrite, Lifetime::Transient);
    d.counter("rays", kRaysDoc);
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
    settings.foveaRadius = ctx.view().foveaRadius;
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
    return {change, ageing, lost_, float(statistics.drift)};
  }

  std::vector<EyePathStart> starts_;  // as last written to the output
  std::vector<EyePathEnd> ends_;
  float lost_ = 0;         // z of the output
  float usualChange_ = 0;  // largest change of the frames so far, forgotten in a few of them
};

FOVEA_PASS(EyePathsHost);

}  // namespace
}  // namespace fovea::passes
