// VPLs by light tracing (Keller, "Instant Radiosity", 1997): the baseline for foveated placement.
#include <algorithm>

#include "fovea/pass.h"
#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/emit/light_paths.h"
#include "passes/materials.h"
#include "shaders/records/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kEmitStream = 0x656d6974u;  // keeps the random numbers of this pass apart from others

class Emit : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("emit", "VPLs where light paths traced from the lights hit the scene", PassKind::Host);
    d.output("vpls", vplBuffer(parameter("count")), Usage::HostWrite,
             "VPLs that together carry the lights' reflected flux, ordered along a space-filling curve; "
             "unused slots (no light, or none that reaches the scene) have zero intensity");
    d.parameter("count", integer(1000, 1, 65536), "VPLs to store");
    d.parameter("bounces", integer(2, 0, 64),
                "most VPLs along one light path; 2 matches a path tracer of depth 4");
    d.parameter(
        "per_frame", flag(true),
        "whether each frame traces new light paths; if false, a fixed seed gives the same ones every frame");
    d.parameter(
        "emissive", flag(true),
        "whether emissive triangles are light sources too: they get VPLs of their own and start light paths");
    d.parameter("neighbours", integer(8, 1, 64),
                "number of neighbouring VPLs from which the area of a VPL is estimated");
    d.parameter("averaged_frames", integer(1, 1, 65536),
                "number of frames averaged into the final image; each VPL's area (kernel `disc`) is divided "
                "by it, as if all VPLs were in one frame");
    d.counter("paths", "light paths that contribute");
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
    settings.fullMaterials = fullMaterials(p);
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
