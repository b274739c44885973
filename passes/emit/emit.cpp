// VPLs by light tracing: Keller's instant radiosity, the baseline that foveated placement is compared with.
#include <algorithm>

#include "fovea/pass.h"
#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "framework/shader_twins/vpl.h"
#include "passes/emit/light_paths.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kEmitStream = 0x656d6974u;  // keeps the random numbers of this pass apart from others

class Emit : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("emit", "light paths from the lights into the scene; what they hit becomes VPLs",
                      PassKind::Host);
    d.output("vpls", buffer("Vpl", sizeof(scene::Vpl), parameter("count")), Usage::HostWrite,
             "VPLs that together carry the lights' reflected flux, in the order of a space-filling curve; "
             "slots left over "
             "(no light, or none that reaches the scene) have no intensity");
    d.parameter("count", integer(1000, 1, 65536), "VPLs to store");
    d.parameter("bounces", integer(2, 0, 64),
                "VPLs along one light path: 2 is what a path tracer of depth 4 sees");
    d.parameter("per_frame", flag(true), "new light paths every frame; false: the same ones (a fixed seed)");
    d.parameter("emissive", flag(true),
                "emissive triangles send out light, too, as VPLs on themselves and as paths");
    d.parameter("neighbours", integer(8, 1, 64),
                "how many VPLs around one the area it stands for is estimated from");
    d.parameter(
        "averaged_frames", integer(1, 1, 65536),
        "frames whose mean is the picture: VPLs stand for so much less area each (kernel `disc`), as if all "
        "were in one frame");
    d.counter("paths", "light paths traced that count");
    d.counter("rays", "rays traced");
    d.counter("vpls", "slots filled");
    d.counter("escaped", "rays that left the scene");
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const Parameters& p = ctx.parameters();
    EmitSettings settings;
    settings.count = uint32_t(ctx.count("vpls"));
    settings.bounces = uint32_t(p.integer("bounces"));
    settings.neighbours = uint32_t(p.integer("neighbours"));
    settings.emissiveTriangles = p.flag("emissive");
    settings.seed =
        randomStream(frame.seed, p.flag("per_frame") ? uint32_t(frame.index) : 0u, kEmitStream, 0);
    EmitResult result;
    if (frame.scene != nullptr && frame.geometry != nullptr && !frame.geometry->empty())
      result = traceLightPaths(frame, *scene::RayScene::cached(*frame.scene, *frame.geometry), settings);
    for (scene::Vpl& v : result.vpls) v.area /= float(p.integer("averaged_frames"));
    const auto out = ctx.outputAs<scene::Vpl>("vpls");
    const auto end = std::copy(result.vpls.begin(), result.vpls.end(), out.begin());
    std::fill(end, out.end(), scene::Vpl{});
    ctx.counter("paths", double(result.paths));
    ctx.counter("rays", double(result.rays));
    ctx.counter("vpls", double(result.vpls.size()));
    ctx.counter("escaped", double(result.escaped));
  }
};

FOVEA_PASS(Emit);

}  // namespace
}  // namespace fovea::passes
