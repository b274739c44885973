// Fills its image with one level, which the build sets: two builds of it are two states of a plug-in that is edited.
#include <fovea/pass.h>

#include <algorithm>

namespace {

using namespace fovea::graph;

class Grey : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("grey", "One level of grey.", PassKind::Host);
    d.output("image", image2D(VK_FORMAT_R8G8B8A8_UNORM, viewWidth(), viewHeight()), Usage::HostWrite,
             "the level");
    d.parameter("share", real(1, 0, 1), "of the level");
    return d;
  }
  void execute(HostContext& ctx) override {
    const auto image = ctx.outputAs<uint8_t>("image");
    std::fill(image.begin(), image.end(), uint8_t(LEVEL * ctx.parameters().real("share")));
  }
};
FOVEA_PASS(Grey);

}  // namespace
