// VPLs by light tracing (Keller, "Instant Radiosity", 1997): the baseline for foveated placement.
#include "fovea/pass.h"
#include "passes/bundles.h"
#include "shaders/records/light_paths.h"
#include "shaders/records/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr Usage kReadWrite = Usage::StorageRead | Usage::StorageWrite;

// The first round has as many paths as there are slots, the later ones as many as probably fill the list; what they
// leave free is left to the last one.
constexpr int kRounds = 3;

void declarePorts(PassDeclaration& d) {
  const SizeExpr count = parameter("count");
  d.output("vpls", vplBuffer(count), Usage::StorageWrite,
           "VPLs that together carry the lights' reflected flux, ordered along a space-filling curve; "
           "unused slots (no light, or none that reaches the scene) have zero intensity");
  d.scratch("progress", buffer("LightPaths", sizeof(LightPaths)), kReadWrite | Usage::Indirect,
            "how far the paths have come");
  d.scratch("shares", buffer("float", 4, environment("scene.lights")), kReadWrite,
            "power of each light and those before it, W");
  d.scratch("lengths", buffer("uint", 4, count * kPathsPerVpl + kPathsBeside), kReadWrite,
            "VPLs of each path of a round");
  d.scratch("starts", buffer("uint", 4, count), kReadWrite | Usage::TransferWrite,
            "number of the path whose first VPL has this slot, plus 1; 0 if there is none");
  d.scratch("found", vplBuffer(count), kReadWrite, "VPLs in the order of their paths");
  d.scratch("keys", buffer("uint", 4, count), kReadWrite, "place of each VPL along the curve");
}

void declareParameters(PassDeclaration& d) {
  d.parameter("count", integer(1000, 1, 65536), "VPLs to store");
  d.parameter("bounces", integer(2, 0, 64),
              "most VPLs along one light path; 2 matches a path tracer of depth 4");
  d.parameter(
      "per_frame", flag(true),
      "whether each frame traces new light paths; if false, a fixed seed gives the same ones every frame");
  d.parameter(
      "emissive", flag(true),
      "whether emissive triangles are light sources too: they get VPLs of their own and start light paths");
  d.parameter("neighbours", integer(8, 1, 64),
              "number of neighbouring VPLs from which the area of a VPL is estimated");
  d.parameter("averaged_frames", integer(1, 1, 65536),
              "number of frames averaged into the final image; each VPL's area (kernel `disc`) is divided "
              "by it, as if all VPLs were in one frame");
}

class Emit : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("emit", "VPLs where light paths traced from the lights hit the scene");
    d.rays();
    declarePorts(d);
    declareParameters(d);
    d.counter("paths", "light paths that contribute");
    d.counter("rays", "rays traced");
    d.counter("vpls", "slots filled");
    d.counter("escaped", "rays that left the scene");
    d.fill("starts", 0);
    d.step("emit/begin.comp").define("RAY_PASSAGE", 0).groups(1);
    for (int round = 1; round <= kRounds; ++round) {
      const std::string number = std::to_string(round);
      paths(d, "trace " + number, 0).indirect("progress");
      d.step("emit/accept.comp").called("accept " + number).define("LAST", round + 1 == kRounds).groups(1);
    }
    paths(d, "store", 1).threads(parameter("count"));
    d.step("emit/areas.comp").define("NEIGHBOURS", parameter("neighbours")).threads(parameter("count"));
    d.step("emit/fill.comp").groups(1);
    d.step("emit/sort.comp").threads(parameter("count"));
    return d;
  }

 private:
  static StepSpec& paths(PassDeclaration& d, const std::string& name, int stores) {
    return d.step("emit/paths.comp").called(name).define("RAY_PASSAGE", 0).constant("stores", stores);
  }
};

FOVEA_PASS(Emit);

}  // namespace
}  // namespace fovea::passes
