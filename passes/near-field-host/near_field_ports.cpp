#include "passes/near-field-host/near_field_ports.h"

#include <bit>

#include "fovea/error.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/sizes.h"

namespace fovea::passes {

using namespace graph;

void declareNearField(PassDeclaration& d, Usage read, Usage write) {
  d.input("change", changeBuffer(), read,
          "y: s, after which n rays gathered before are worth n / (1 + n s), as light has changed; z: share "
          "of their history that samples have lost (pass eye-paths)")
      .makeOptional();
  d.input("gbuffer", "gbuffer", gbufferMembers(read, {"normal", "specular"}),
          "surfaces seen by the eye, whose lobes `gloss` is for; if not wired, it is the same as `samples`")
      .when(fullMaterials());
  const SizeExpr width = ceilDiv(viewWidth(), 2), height = ceilDiv(viewHeight(), 2);
  d.output("samples", image2D(VK_FORMAT_R16G16B16A16_SFLOAT, width, height), write,
           "rgb: irradiance / pi, W/(sr m^2), at one pixel of each 2 x 2 block, or of each `spacing` x "
           "`spacing` block outside the fovea; a: code of the sampled pixel and of whether it shows a "
           "surface, for pass temporal-accumulation");
  d.output("gloss",
           image2D(VK_FORMAT_R16G16B16A16_SFLOAT, max(fullMaterials() * width, 1),
                   max(fullMaterials() * height, 1)),
           write,
           "with full materials, rgb: at the same pixels, the mean of the same light under the lobe of the "
           "surface, W/(sr m^2); a: as in `samples`; otherwise one undefined texel");
  d.output("spread", spreadBuffer(), write, "x: least area of a VPL's disc, m^2, for pass vpl-intensity");
  d.parameter("spacing", integer(4, 2, 8), "spacing of the rays outside the fovea: 2, as inside it, 4 or 8");
  d.parameter("vpls", integer(1000, 1, 1 << 20), "number of VPLs");
  d.parameter("share", real(50, 0.01, 1e6),
              "total area of all discs, in squares of the mean distance between visible surfaces and the "
              "surfaces seen from them, or of the diagonal of the scene where no surface sees another");
  d.parameter(
      "bounces", integer(2, 1, 64),
      "reflections of the light before it reaches the visible surface; 2 matches a path tracer of depth 4");
  d.parameter("first_samples", integer(16, 1, 1024),
              "rays per sample after a camera cut, when there is no history to build on");
  d.parameter("saccade_samples", integer(1, 1, 16),
              "rays per sample in the fovea for 8 frames after a jump of the gaze, as the history of a new "
              "fovea is that of wide blocks, and up to so many when light changes");
  d.parameter(
      "emitter_points", integer(4, 1, 64),
      "points on surfaces that shine and in an environment map, of which the ray aimed at them chooses "
      "one; for a map there are as many cosine-weighted ones beside them");
  d.parameter("light", choice("all", {"none", "map", "all"}),
              "`map` brings the light of the scene's environment map alone, `none` nothing");
  d.counter("rays", kRaysDoc);
  d.counter("shaded", "rays from visible surfaces at whose ends the light was evaluated");
  d.counter("gathered",
            "those of them at whose ends light of further bounces was gathered rather than known");
}

float nearFieldFovea(const scene::View& view, const Parameters& parameters) {
  constexpr float kEverywhere = 4;
  return parameters.integer("spacing") == 2 ? kEverywhere : view.foveaRadius;
}

void checkNearField(const PassContext& ctx, const std::string& pass) {
  const auto spacing = uint32_t(ctx.parameters().integer("spacing"));
  if (!std::has_single_bit(spacing))
    throw Error(ExitCode::BadInput,
                "pass `" + pass + "`: spacing " + std::to_string(spacing) + " is not a power of two",
                "use 2, 4 or 8");
  if (ctx.has("gbuffer")) checkMaterials(ctx, pass);
}

void checkGBufferSize(const PassContext& ctx, const std::string& pass, glm::uvec2 view) {
  if (ctx.has("gbuffer"))
    checkSize(ctx, pass, "gbuffer.normal", view, "its view",
              "wire the G-buffer of the view that the pass looks through");
}

}  // namespace fovea::passes
