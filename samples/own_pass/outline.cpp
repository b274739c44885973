// A pass of your own: dark lines at creases and silhouettes.
#include <fovea/pass.h>

using namespace fovea::graph;

struct Outline : Pass {
  static PassDeclaration declaration() {
    PassDeclaration d("outline", "Draws dark lines at creases and silhouettes.");
    d.input("picture", image2D(), Usage::Sampled, "the picture to draw on");
    d.input("gbuffer", "gbuffer",
            {member("distance", image2D(), Usage::Sampled), member("normal", image2D(), Usage::Sampled)},
            "the surfaces that the eye sees");
    d.output("image", image2D(VK_FORMAT_R8G8B8A8_UNORM), Usage::StorageWrite, "the picture with lines");
    d.parameter("strength", real(0.8, 0, 1), "0 draws no lines, 1 draws black ones");
    d.step("outline/outline.comp").over("image");
    return d;
  }
};

FOVEA_PASS(Outline);
