// Both eyes in one image, the left one on the left, for viewers and for parallel viewing.
#include "fovea/pass.h"

namespace fovea::passes {
namespace {

using namespace graph;

class SideBySide : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("side-by-side", "two images side by side in one");
    d.input("left", image2D(VK_FORMAT_R8G8B8A8_UNORM), Usage::Sampled, "left half");
    d.input("right", image2D(VK_FORMAT_R8G8B8A8_UNORM), Usage::Sampled, "right half");
    d.output("image",
             image2D(VK_FORMAT_R8G8B8A8_UNORM, widthOf("left") + widthOf("right"),
                     max(heightOf("left"), heightOf("right"))),
             Usage::StorageWrite, "both images, aligned at the top; black below the shorter one");
    return d;
  }
  void prepare(PrepareContext& ctx) override { kernel_ = ctx.compute("side-by-side/side_by_side.comp"); }
  void record(RecordContext& ctx) override { ctx.use(kernel_).dispatchOver("image"); }

 private:
  Kernel kernel_;
};

FOVEA_PASS(SideBySide);

}  // namespace
}  // namespace fovea::passes
