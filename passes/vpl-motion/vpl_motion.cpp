// VPLs of the frame before, brought to this one (METHOD: manage, step 1).
#include <cmath>
#include <glm/trigonometric.hpp>

#include "fovea/pass.h"
#include "framework/shader_twins/voxel_grid.h"
#include "framework/shader_twins/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

class Update : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "vpl-motion",
        "last frame's VPLs moved with their objects; those whose surface is gone or turned are dropped");
    d.input("previous", buffer("VplState", sizeof(scene::VplState)), Usage::StorageRead,
            "VPLs of the frame before");
    d.input("voxels", "voxels",
            {member("index", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
             member("surface", buffer("VoxelSide", sizeof(scene::VoxelSide)), Usage::TexelRead)},
            "surfaces of this frame");
    d.output("vpls", buffer("VplState", sizeof(scene::VplState), countOf("previous")), Usage::StorageWrite,
             "in their slots, one frame older, their importance still that of the frame before; dropped "
             "ones: empty slots");
    d.parameter(
        "max_turn", real(30, 0, 180, "degrees"),
        "between a VPL's normal as found (moved with its object) and its voxel's; more: it is dropped");
    d.counter("alive", "VPLs that stay");
    d.counter("deleted", "VPLs dropped");
    return d;
  }

  void prepare(PrepareContext& ctx) override { kernel_ = ctx.compute("vpl-motion/vpl_motion.comp"); }

  void record(RecordContext& ctx) override {
    // A hair more than the angle, so that 0 keeps what has not turned.
    const float turnCos = std::cos(glm::radians(float(ctx.parameters().real("max_turn")))) - 1e-5f;
    ctx.use(kernel_).constant("turnCos", turnCos).dispatchThreads(uint32_t(ctx.count("previous")));
  }

 private:
  Kernel kernel_;
};

FOVEA_PASS(Update);

}  // namespace
}  // namespace fovea::passes
