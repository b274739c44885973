// Ground truth, which all other methods approximate.
#include "fovea/pass.h"
#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "passes/path-trace/path_tracer.h"

namespace fovea::path_trace {
namespace {

using namespace graph;

class PathTrace : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("path-trace",
                      "path tracer: light along all paths of at most `depth` edges, unbiased (ground truth)",
                      PassKind::Host);
    d.view();
    const ResourceSpec image = image2D(VK_FORMAT_R32G32B32A32_SFLOAT), color = ofLight(image);
    d.output("radiance", color, Usage::HostWrite, "rgb: `direct` plus `indirect`, W/(sr m^2)");
    d.output("direct", color, Usage::HostWrite,
             "rgb: emission plus light from the scene's lights reflected once, as in pass direct; in the "
             "background the environment, which illuminates nothing");
    d.output("indirect", color, Usage::HostWrite,
             "rgb: all other light; light from emissive triangles is included here, as VPLs carry it");
    d.output("variance", ofLight(image, 2), Usage::HostWrite,
             "rgb: estimated variance of the mean `radiance`");
    d.output("half_a", color, Usage::HostWrite, "rgb: radiance from one half of the samples");
    d.output("half_b", color, Usage::HostWrite,
             "rgb: radiance from the other half of the samples, independent of `half_a`");
    d.parameter(
        "depth", integer(4, 1, 64),
        "edges of the longest path: 1 is emission, 2 direct light, each further edge one indirect bounce");
    d.parameter("spp", integer(2000, 2, 1 << 24), "samples per pixel");
    d.parameter("sampling", choice("low-discrepancy", {"low-discrepancy", "independent"}),
                "random numbers: `low-discrepancy` uses Owen-scrambled Sobol' points, for images; "
                "`independent` is for statistics");
    d.parameter("filter", choice("centre", {"centre", "box"}),
                "pixel filter: `centre` sends rays through the pixel's centre, as pass gbuffer does, `box` "
                "through its whole area");
    d.parameter(
        "per_frame", flag(true),
        "whether each frame uses new random numbers; if false, all frames use the same ones (static noise)");
    d.parameter("threads", integer(0, 0, 1024),
                "number of threads, 0 for one per core; the image does not depend on it");
    d.parameter(
        "parts", integer(1, 1, 1 << 14),
        "of so many parts of the image, each every `parts`-th row, one is traced and the others stay black; "
        "the rows of all parts together are those of the whole image to the bit");
    d.parameter("part", integer(0, 0, (1 << 14) - 1), "which part, from 0; less than `parts`");
    d.require(atMost(parameter("part") + 1, parameter("parts")), "`part` is not less than `parts`",
              "the parts are counted from 0");
    d.counter("paths", "paths traced");
    d.counter("rays", "rays traced");
    d.counter("samples", "samples per pixel: `spp`, or fewer if the run was stopped");
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const Parameters& p = ctx.parameters();
    PathTraceSettings settings;
    settings.depth = uint32_t(p.integer("depth"));
    settings.samples = uint32_t(p.integer("spp"));
    settings.threads = uint32_t(p.integer("threads"));
    settings.parts = uint32_t(p.integer("parts"));
    settings.part = uint32_t(p.integer("part"));
    settings.independent = p.text("sampling") == "independent";
    settings.box = p.text("filter") == "box";
    settings.full = p.text("view.materials") == "full";
    settings.seed = hashCombine(frame.seed, p.flag("per_frame") ? uint32_t(frame.index) : 0u);
    settings.unit = frame.preExposure;
    settings.progress = [&](double share) { return ctx.progress(share); };
    const PathTraceImages images{ctx.outputAs<glm::vec4>("radiance"), ctx.outputAs<glm::vec4>("direct"),
                                 ctx.outputAs<glm::vec4>("indirect"), ctx.outputAs<glm::vec4>("variance"),
                                 ctx.outputAs<glm::vec4>("half_a"),   ctx.outputAs<glm::vec4>("half_b")};
    const PathTraceStatistics statistics =
        tracePaths(frame, ctx.view(),
                   *scene::RayScene::cached(*frame.scene, *frame.geometry,
                                            settings.full ? scene::Passing::Met : scene::Passing::Never),
                   settings, images);
    ctx.counter("paths", double(statistics.paths));
    ctx.counter("rays", double(statistics.rays));
    ctx.counter("samples", statistics.samples);
  }
};

FOVEA_PASS(PathTrace);

}  // namespace
}  // namespace fovea::path_trace
