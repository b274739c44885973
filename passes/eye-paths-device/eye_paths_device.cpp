// Eye paths with rays on the device; they measure the light that the VPLs stand for.
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "framework/shader_twins/fovea.h"
#include "passes/bundles.h"
#include "passes/eye-paths-host/eye_path_ports.h"
#include "passes/materials.h"
#include "shaders/records/eye_paths.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr Usage kReadWrite = Usage::StorageRead | Usage::StorageWrite;

// Frames in which all starts are renewed.
uint32_t renewFrames(const RecordContext& ctx) {
  const Parameters& p = ctx.parameters();
  if (ctx.firstFrame()) return 1;
  const bool hurries = ctx.frame().saccade > 0 && p.integer("saccade_renew_frames") > 0;
  return uint32_t(p.integer(hurries ? "saccade_renew_frames" : "renew_frames"));
}

class EyePathsDevice : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("eye-paths-device",
                      "diffuse paths from fixed screen points of the region and the light where they end, as "
                      "`eye-paths-host` finds them, with rays that are traced on the device");
    d.view().rays();
    declareEyePaths(d, kReadWrite, Lifetime::View);
    d.scratch("memory", buffer("EyePathMemory", sizeof(EyePathMemory)), kReadWrite,
              "what light has changed by in the frames so far")
        .keep(Lifetime::View);
    d.scratch("turns", buffer("uint", 4, parameter("points")), kReadWrite,
              "whether the paths of each point have a new start, and whether they wait");
    d.scratch("differences", buffer("EyePathDifference", sizeof(EyePathDifference), parameter("paths")),
              kReadWrite, "between the light that a path finds and what it found before");
    d.counter("rays", kRaysDoc);
    d.counter("ends", "paths that hit a surface");
    d.step("eye-paths-device/points.comp")
        .define("RAY_PASSAGE", fullMaterials())
        .constant("imageShare64ths",
                  [](const RecordContext& ctx) {
                    return scene::imageShare64ths(ctx.parameters().real("image_share"));
                  })
        .constant("renew", renewFrames)
        .constant("strayNow",
                  [](const RecordContext& ctx) {
                    return ctx.firstFrame() ? 0.0f : float(ctx.parameters().real("stray"));
                  })
        .threads(parameter("points"));
    addPaths(d, "paths", 0);
    d.step("eye-paths-device/change.comp").groups(1);
    addPaths(d, "late paths", 1);
    d.step("eye-paths-device/unit.comp").groups(1);
    return d;
  }

 private:
  static void addPaths(PassDeclaration& d, const char* name, int late) {
    d.step("eye-paths-device/paths.comp")
        .called(name)
        .define("RAY_PASSAGE", fullMaterials())
        .define("EMISSION", parameter("emission"))
        .define("LATE", late)
        .threads(parameter("paths"));
  }
};

FOVEA_PASS(EyePathsDevice);

}  // namespace
}  // namespace fovea::passes
