// Running mean over frames, so that many frames of N virtual lights stand for one frame of many more.
#include "fovea/pass.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Accumulate : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("accumulate",
                      "running mean of an image over the frames since the last reset, in 32-bit floats");
    d.input("value", image2D(), Usage::Sampled, "rgb: image to average, in any float format");
    d.output("mean", image2D(VK_FORMAT_R32G32B32A32_SFLOAT, widthOf("value"), heightOf("value")),
             Usage::StorageRead | Usage::StorageWrite,
             "rgb: the mean, in the unit of `value`; a: number of frames averaged (restarts after a camera "
             "cut or a resize)")
        .keep(Lifetime::View);
    d.parameter("alpha", real(0, 0, 1),
                "least weight of the newest frame: 0 gives the true mean, larger values give an exponential "
                "mean that follows changes");
    d.counter("non_finite", "pixels left out of the mean because they hold a NaN or an infinity");
    return d;
  }

  void prepare(PrepareContext& ctx) override { kernel_ = ctx.compute("accumulate/accumulate.comp"); }
  void record(RecordContext& ctx) override { ctx.use(kernel_).dispatchOver("mean"); }

 private:
  Kernel kernel_;
};

FOVEA_PASS(Accumulate);

}  // namespace
}  // namespace fovea::passes
