// VPLs of the previous frame, updated for the motion of their objects (passes/vpls.md, vpl-motion).
#include <cmath>
#include <glm/trigonometric.hpp>

#include "fovea/pass.h"
#include "passes/bundles.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Update : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("vpl-motion",
                      "VPLs of the previous frame moved with their objects; those whose surface has "
                      "disappeared or turned away are dropped");
    d.input("previous", vplStateBuffer(), Usage::StorageRead, "VPLs of the previous frame");
    d.input("voxels", "voxels", voxelMembers({"index", "surface"}), "surfaces of this frame");
    d.output("vpls", vplStateBuffer(countOf("previous")), Usage::StorageWrite,
             "VPLs in their slots, one frame older, still with the importance of the previous frame; dropped "
             "ones become empty slots");
    d.parameter("max_turn", real(30, 0, 180, "degrees"),
                "largest angle between the VPL's original normal, moved with its object, and that of its "
                "voxel; beyond it the VPL is dropped");
    d.counter("alive", "VPLs kept");
    d.counter("deleted", "VPLs dropped");
    // Slightly more than the angle, so that 0 keeps VPLs that have not turned.
    d.step("vpl-motion/vpl_motion.comp")
        .constant("turnCos",
                  [](const RecordContext& ctx) {
                    return std::cos(glm::radians(float(ctx.parameters().real("max_turn")))) - 1e-5f;
                  })
        .over("previous");
    return d;
  }
};

FOVEA_PASS(Update);

}  // namespace
}  // namespace fovea::passes
