// Candidate positions for VPLs: one diffuse bounce from the surfaces in the fovea (the paper's VPL generation;
// passes/vpls.md, candidates).
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/regions.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Candidates : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("candidates", "voxels hit by one diffuse bounce from random pixels of the fovea");
    d.view();
    d.input("gbuffer", "gbuffer", gbufferMembers(Usage::Sampled, {"distance", "normal", "face"}),
            "surfaces seen by the eye");
    d.input("gbuffer2", "gbuffer", gbufferMembers(Usage::Sampled, {"distance", "normal", "face"}),
            "surfaces seen by a second eye, in view `second_view`; every other attempt starts there")
        .makeOptional();
    d.input("voxels", "voxels", voxelMembers({"index", "occupied", "surface"}),
            "voxels that the bounces hit");
    d.input("radiance", voxelRadianceBuffer(), Usage::TexelRead,
            "radiance of each voxel side; if not wired, the candidates' luminance is 0")
        .makeOptional();
    d.input("traced", "eye-paths", eyePathMembers(),
            "paths of pass eye-paths; every fourth candidate lies where one of them ends, with the light "
            "found there")
        .makeOptional();
    d.input("emitted", vplBuffer(), Usage::TexelRead,
            "VPLs of light paths (pass emit); attempt i then takes VPL i instead of a pixel")
        .makeOptional();
    d.output("candidates", candidateBuffer(parameter("count")), Usage::StorageWrite,
             "one entry per attempt; an attempt that hit nothing has no side and is otherwise zero");
    d.parameter("count", integer(1000, 1, 65536), "number of attempts, with one pixel and one ray each");
    d.parameter("region", choice("fovea", {"fovea", "image", "mixed"}),
                "pixels to start from; `mixed` takes a share of them from the whole image and the rest from "
                "the fovea");
    d.parameter("image_share", real(0.4, 0, 1),
                "share of the whole image for region `mixed`, rounded to 64ths");
    d.parameter("position", choice("average", {"average", "intersection"}),
                "where a candidate lies on its voxel side: at the average of the surface in it, or where the "
                "ray meets the plane through that average");
    d.parameter("per_frame", flag(true),
                "whether each frame uses new random numbers; if false, all frames use the same ones");
    d.parameter("second_view", text("right"),
                "view of `gbuffer2`, whose gaze is used; if the frame has no such view, the gaze of the "
                "first eye is used");
    d.counter("rays", "bounce rays traced");
    d.counter("candidates", "attempts that hit a voxel");
    d.counter("escaped", "bounces that left the scene");
    d.counter("background", "attempts whose pixel shows the background");
    d.counter("attempts", "attempts made, equal to `count`");
    d.step("candidates/candidates.comp")
        .define("TWO_EYES", wired("gbuffer2"))
        .define("HAS_RADIANCE", wired("radiance"))
        .define("INTERSECTION", is("position", "intersection"))
        .define("TRACED", wired("traced"))
        .define("EMITTED", wired("emitted"))
        .constant(
            "imageShare64ths",
            [](const RecordContext& ctx) { return imageShare64ths(ctx.parameters().real("image_share")); })
        .constant("secondGaze",
                  [](const RecordContext& ctx) {
                    const scene::View* second = ctx.frame().findView(ctx.parameters().text("second_view"));
                    return (second ? *second : ctx.view()).gaze;
                  })
        .constant("streamFrame",
                  [](const RecordContext& ctx) {
                    return ctx.parameters().flag("per_frame") ? uint32_t(ctx.frame().index) : 0u;
                  })
        .over("candidates");
    return d;
  }

  void record(RecordContext& ctx) override {
    ctx.runSteps();
    ctx.counter("attempts", double(ctx.count("candidates")));
  }
};

FOVEA_PASS(Candidates);

}  // namespace
}  // namespace fovea::passes
