// Exposure that adapts to the brightness of the image, for viewing scenes whose files give none.
#include "fovea/pass.h"
#include "framework/scene/frame.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr int64_t kTiles = 32;  // along each axis of the picture

class Adaptation : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("adaptation",
                      "exposure that adapts to the brightness of the picture as an eye does, unless the "
                      "scene file gives one");
    d.view();
    d.input("radiance", image2D(), Usage::Sampled, "rgb: linear radiance, W/(sr m^2), any float format");
    d.output(
         "exposure", image2D(VK_FORMAT_R32_SFLOAT, 1, 1), Usage::StorageRead | Usage::StorageWrite,
         "factor from light as passes store it to display intensity; that of the scene's own exposure if its "
         "file gives one")
        .keep(Lifetime::View);
    d.scratch("tiles", image2D(VK_FORMAT_R32_SFLOAT, kTiles, kTiles),
              Usage::StorageRead | Usage::StorageWrite,
              "mean over the pixels that are looked at in each tile: log2 of their display intensity");
    d.parameter("key", real(0.18, 0.001, 1),
                "display intensity of the mean brightness, which is the geometric mean of the luminance");
    d.parameter("range", real(4, 0, 20, "stops"), "how far the exposure may lie from the scene's own");
    d.parameter("frames", real(25, 0.1, 10000),
                "time constant: after this many frames, 63% of a change has been followed");
    const auto sceneExposure = [](const RecordContext& ctx) { return ctx.frame().storedExposure(); };
    d.step("adaptation/measure.comp").constant("sceneExposure", sceneExposure).over("tiles");
    d.step("adaptation/adapt.comp")
        .constant("sceneExposure", sceneExposure)
        .constant("adapts",
                  [](const RecordContext& ctx) {
                    const scene::Scene* scene = ctx.frame().scene;
                    return uint32_t(scene != nullptr && scene->assumed);
                  })
        .groups(1);
    return d;
  }
};

FOVEA_PASS(Adaptation);

}  // namespace
}  // namespace fovea::passes
