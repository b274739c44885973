// Where each visible surface point was in the previous frame, for all means over frames.
#include <cmath>
#include <glm/trigonometric.hpp>

#include "fovea/pass.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

class MotionVectors : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("motion-vectors",
                      "for every pixel, the pixel of the previous frame that showed the same surface",
                      PassKind::Graphics);
    d.view();
    d.input("gbuffer", "gbuffer",
            gbufferMembers(Usage::StorageRead, {"distance", "normal", "id", "triangle"}),
            "surfaces seen by the eye");
    d.input("previous", "gbuffer", gbufferMembers(Usage::StorageRead, {"distance", "normal"}),
            "surfaces seen by the eye in the previous frame");
    d.output("origin", image2D(VK_FORMAT_R32_UINT, widthOf("gbuffer.distance"), heightOf("gbuffer.distance")),
             Usage::ColorAttachment,
             "x | y << 16: one of the four pixels around the previous position, chosen at random with "
             "bilinear probabilities, or of the 5 x 5 around it at transparent surfaces; 0xffffffff if none "
             "of them showed the surface");
    d.parameter("plane_tolerance", real(0.005, 1e-6, 1),
                "largest distance from a pixel's tangent plane that counts as the same surface, relative to "
                "the pixel's distance from the eye");
    d.parameter("normal_angle", real(25, 1, 90, "degrees"),
                "least angle between normals of different surfaces");
    d.fullscreen("motion-vectors/motion_vectors.frag", {"origin"})
        .constant("leastCos", [](const RecordContext& ctx) {
          return std::cos(glm::radians(float(ctx.parameters().real("normal_angle"))));
        });
    return d;
  }
};

FOVEA_PASS(MotionVectors);

}  // namespace
}  // namespace fovea::passes
