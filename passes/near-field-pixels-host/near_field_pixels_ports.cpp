#include "passes/near-field-pixels-host/near_field_pixels_ports.h"

#include <utility>

#include "fovea/error.h"
#include "passes/bundles.h"

namespace fovea::passes {

using namespace graph;

void declareNearFieldPixels(PassDeclaration& d, std::vector<MemberSpec> mask, Usage read, Usage change) {
  d.view();
  d.input("shade", "shade-mask", std::move(mask), "pixels whose light must be known");
  d.input("spread", spreadBuffer(), read, "x: least area of a VPL's disc, m^2, from pass near-field");
  d.inout(
      "near_field", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), change,
      "rgb: irradiance / pi, W/(sr m^2); a: 0 where it is not known; becomes 1 where a pixel of `shade` got "
      "rays");
  d.parameter("samples", integer(1, 1, 1024), "rays per pixel; 4 x 4 pixels distribute theirs evenly");
  d.parameter(
      "bounces", integer(2, 1, 64),
      "reflections of the light before it reaches the visible surface; 2 matches a path tracer of depth 4");
  d.counter("rays", kRaysDoc);
  d.counter("pixels", "pixels that got rays");
}

void checkNearFieldPixels(const PassContext& ctx, const std::string& pass, glm::uvec2 size) {
  const auto text = [](uint32_t width, uint32_t height) {
    return std::to_string(width) + "x" + std::to_string(height);
  };
  for (const char* port : {"shade.mask", "near_field"}) {
    const VkExtent3D extent = ctx.extent(port);
    if (size == glm::uvec2(extent.width, extent.height)) continue;
    throw Error(ExitCode::BadInput,
                "pass `" + pass + "`: `" + port + "` has " + text(extent.width, extent.height) +
                    " pixels, its view " + text(size.x, size.y),
                "wire images of the view that the pass looks through");
  }
}

}  // namespace fovea::passes
