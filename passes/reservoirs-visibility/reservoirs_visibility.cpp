// Visibility of shared samples with rays on the device.
#include "fovea/error.h"
#include "fovea/pass.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "shaders/records/reservoir.h"

namespace fovea::passes {
namespace {

using namespace graph;

void declarePorts(PassDeclaration& d) {
  constexpr Usage images = Usage::StorageRead, lists = Usage::TexelRead, write = Usage::StorageWrite;
  d.view();
  d.input("gbuffer", "gbuffer", gbufferMembers(images, {"distance", "face"}), "surfaces seen by the eye");
  d.input(
       "moved", "moved-surfaces",
       {member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), images),
        member("face", image2D(VK_FORMAT_R16G16_SNORM), images)},
       "surfaces of the sources, if those belong to the previous frame (pass reservoirs-motion); otherwise "
       "they are pixels of `gbuffer`")
      .makeOptional();
  const ResourceSpec reservoirs = buffer("Reservoir", sizeof(Reservoir));
  d.input("own", reservoirs, lists, "reservoir of each pixel, row after row");
  d.input("others", reservoirs, lists, "reservoirs of the sources' pixels, row after row");
  d.input("sources", image2D(VK_FORMAT_R32_UINT), images,
          "x | y << 16: pixels of `others` that share their samples, for each pixel one or more side by "
          "side, at most 16; 0xffffffff for none");
  d.output("seen", image2D(VK_FORMAT_R32_UINT, widthOf("gbuffer.distance"), heightOf("gbuffer.distance")),
           write,
           "two bits for each source k; 2 k: the pixel sees the sample of the source, 2 k + 1: the source "
           "sees that of the pixel");
  d.counter("rays", "rays traced towards samples");
  d.counter("hidden", "rays that did not reach their sample");
}

void checkPorts(const PassContext& ctx) {
  const VkExtent3D size = ctx.extent("gbuffer.distance"), sources = ctx.extent("sources"),
                   moved = ctx.has("moved") ? ctx.extent("moved.position") : size;
  const uint64_t pixels = uint64_t(size.width) * size.height;
  if (moved.width == size.width && moved.height == size.height && sources.height == size.height &&
      sources.width % size.width == 0 && sources.width <= kMostSources * size.width &&
      ctx.count("own") == pixels && ctx.count("others") == pixels)
    return;
  const auto text = [](VkExtent3D e) { return std::to_string(e.width) + "x" + std::to_string(e.height); };
  throw Error(ExitCode::BadInput,
              "`gbuffer` has " + text(size) + " pixels, `moved` " + text(moved) + " and `sources` " +
                  text(sources) + ", with " + std::to_string(ctx.count("own")) + " and " +
                  std::to_string(ctx.count("others")) + " reservoirs",
              "wire what belongs to one view, with at most 16 sources for each pixel");
}

class ReservoirsVisibility : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("reservoirs-visibility",
                      "rays to the samples of indirect light that pixels are about to share (ReSTIR GI)");
    d.rays();
    declarePorts(d);
    d.step("reservoirs-visibility/visibility.comp")
        .define("RAY_PASSAGE", fullMaterials())
        .define("MOVED", wired("moved"))
        .over("seen");
    return d;
  }

  void prepare(PrepareContext& ctx) override { checkPorts(ctx); }
};

FOVEA_PASS(ReservoirsVisibility);

}  // namespace
}  // namespace fovea::passes
