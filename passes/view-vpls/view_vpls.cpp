// Debug view: where the VPLs are, and what is known of them.
#include <algorithm>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/shader_twins/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint64_t kMostSlots = 1 << 16;  // the number of a slot is half of a pixel's key

class ViewVpls : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "view-vpls",
        "debug view: every VPL that the eye sees, as a disc coloured by importance, age or luminance");
    d.view();
    d.input("state", buffer("VplState", sizeof(scene::VplState)), Usage::TexelRead,
            "VPLs; empty slots are not drawn");
    d.input("vpls", buffer("Vpl", sizeof(scene::Vpl)), Usage::TexelRead,
            "the same slots; for show `luminance`")
        .makeOptional();
    d.input("gbuffer", "gbuffer",
            {member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::Sampled)},
            "surfaces that hide VPLs; without it all are drawn")
        .makeOptional();
    d.input("picture", image2D(), Usage::Sampled, "rgb: radiance to draw over; black without it")
        .makeOptional();
    d.output("image", image2D(VK_FORMAT_R16G16B16A16_SFLOAT, viewWidth(), viewHeight()), Usage::StorageWrite,
             "rgb: for the pass `tonemap` at the scene's exposure; a: 1");
    d.scratch("keys", buffer("uint", 4, viewWidth() * viewHeight()),
              Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite, "nearest VPL of each pixel");
    d.parameter("show", choice("importance", {"importance", "age", "luminance"}),
                "what colours stand for, from violet (0) to yellow: importance, frames shown, or luminance "
                "of the intensity");
    d.parameter("range", real(0, 0, 1e9), "value of the last colour; 0: importance 1, 60 frames, 1 W/sr");
    d.parameter("radius", real(3, 0.5, 64, "px"), "of a disc");
    return d;
  }

  void prepare(PrepareContext& ctx) override {
    const std::string& show = ctx.parameters().text("show");
    if (show == "luminance" && !ctx.has("vpls"))
      throw Error(ExitCode::BadInput, "pass `view-vpls`: show `luminance` needs the input `vpls`",
                  "wire the VPLs that the shading reads, or show something else");
    if (ctx.count("state") > kMostSlots)
      throw Error(
          ExitCode::BadInput,
          "pass `view-vpls`: " + std::to_string(ctx.count("state")) + " VPLs; at most 65536 can be drawn",
          "use fewer");
    Defines depth, defines;
    if (ctx.has("gbuffer")) depth["DEPTH_TEST"] = "1";
    if (ctx.has("picture")) defines["PICTURE"] = "1";
    if (show == "age") defines["AGE"] = "1";
    if (show == "luminance") defines["LUMINANCE"] = "1";
    splat_ = ctx.compute("view-vpls/splat.comp", depth);
    view_ = ctx.compute("view-vpls/view_vpls.comp", defines);
  }

  void record(RecordContext& ctx) override {
    const VkExtent3D size = ctx.extent("image");
    ctx.fill("keys", 0xffffffffu);
    ctx.barrier();
    const uint32_t slots = uint32_t(ctx.count("state")), row = std::min(slots, 1024u);
    ctx.use(splat_)
        .constant("size", glm::ivec2(size.width, size.height))
        .dispatch(row, (slots + row - 1) / row);
    ctx.barrier();
    const Parameters& p = ctx.parameters();
    const double range = p.real("range") > 0 ? p.real("range") : p.text("show") == "age" ? 60.0 : 1.0;
    ctx.use(view_).constant("scale", float(1.0 / range)).dispatchOver("image");
  }

 private:
  Kernel splat_, view_;
};

FOVEA_PASS(ViewVpls);

}  // namespace
}  // namespace fovea::passes
