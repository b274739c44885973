// Where VPLs could be: one diffuse bounce from what is looked at (METHOD: candidates).
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "framework/shader_twins/fovea.h"
#include "framework/shader_twins/voxel_grid.h"
#include "framework/shader_twins/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

std::vector<MemberSpec> seenSurfaces() {
  return {member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::Sampled),
          member("normal", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::Sampled),
          member("face", image2D(), Usage::Sampled)};
}

class Candidates : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("candidates", "voxels that one diffuse bounce from random pixels of the fovea meets");
    d.view();
    d.input("gbuffer", "gbuffer", seenSurfaces(), "surfaces seen by the eye");
    d.input("gbuffer2", "gbuffer", seenSurfaces(),
            "surfaces seen by a second eye, view `second_view`: every other attempt starts there")
        .makeOptional();
    d.input("voxels", "voxels",
            {member("index", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
             member("occupied", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
             member("surface", buffer("VoxelSide", sizeof(scene::VoxelSide)), Usage::TexelRead)},
            "what bounces meet");
    d.input("radiance", buffer("VoxelRadiance", 16), Usage::TexelRead,
            "radiance of each voxel side; without it the candidates' luminance is 0")
        .makeOptional();
    d.output("candidates", buffer("Candidate", sizeof(scene::Candidate), parameter("count")),
             Usage::StorageWrite,
             "one an attempt; those that met nothing have no side and are zero otherwise");
    d.parameter("count", integer(1000, 1, 65536), "attempts: one pixel and one ray each");
    d.parameter("region", choice("fovea", {"fovea", "image", "mixed"}),
                "pixels to start from; mixed: a share from the whole image, the rest from the fovea");
    d.parameter("image_share", real(0.4, 0, 1), "of region `mixed`: that share, in 64ths");
    d.parameter("fovea_radius", real(0.25, 0.001, 4, "image widths"), "of the disc around the gaze");
    d.parameter("per_frame", flag(true), "new random numbers every frame; false: the same ones");
    d.parameter("second_view", text("right"),
                "view of `gbuffer2`: where its eye gazes; a missing view: as the first eye");
    d.counter("rays", "bounces traced");
    d.counter("candidates", "attempts that found a voxel");
    d.counter("escaped", "bounces that left the scene");
    d.counter("background", "attempts whose pixel shows no surface");
    d.counter("attempts", "as many as `count`");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    kernel_ = ctx.compute("candidates/candidates.comp", {{"TWO_EYES", ctx.has("gbuffer2") ? "1" : "0"},
                                                         {"HAS_RADIANCE", ctx.has("radiance") ? "1" : "0"}});
  }

  void record(RecordContext& ctx) override {
    const Parameters& p = ctx.parameters();
    const scene::View* second = ctx.frame().findView(p.text("second_view"));
    ctx.use(kernel_)
        .constant("imageShare64ths", scene::imageShare64ths(p.real("image_share")))
        .constant("secondGaze", (second ? *second : ctx.view()).gaze)
        .constant("streamFrame", p.flag("per_frame") ? uint32_t(ctx.frame().index) : 0u)
        .dispatchThreads(uint32_t(p.integer("count")));
    ctx.counter("attempts", double(p.integer("count")));
  }

 private:
  Kernel kernel_;
};

FOVEA_PASS(Candidates);

}  // namespace
}  // namespace fovea::passes
