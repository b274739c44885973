// Foveated importance of VPLs: how much of the surface near the gaze a VPL can light (passes/vpls.md, importance).
#include <string>

#include "fovea/pass.h"
#include "framework/gpu/resources.h"
#include "passes/bundles.h"
#include "shaders/records/hemisphere_rays.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kGroupVpls = 16;  // VPLs per work group

class Importance : public Pass {
 public:
  static PassDeclaration declaration();
};

PassDeclaration Importance::declaration() {
  PassDeclaration d("importance",
                    "foveated importance of VPLs: the mean foveated weight of the surfaces in six directions "
                    "from each VPL");
  d.input("voxels", "voxels", voxelMembers({"index", "occupied", "surface"}),
          "voxel grid through which the rays or cones are traced");
  d.input("weights", voxelWeightBuffer(), Usage::TexelRead, "foveated weight of each voxel side, in [0, 1]");
  d.input("candidates", candidateBuffer(), Usage::TexelRead, "candidate VPLs");
  d.input("vpls", vplStateBuffer(), Usage::TexelRead,
          "VPLs of the previous frame, at their positions in this frame");
  d.input("radiance", voxelRadianceBuffer(), Usage::TexelRead,
          "radiance of each voxel side; w: luminance; needed for the parameter `luminance`")
      .makeOptional();
  d.input("mips", "voxel-mips", voxelMipMembers({"color", "weight"}),
          "mip hierarchy of opacity and weight; needed for method `cones`")
      .makeOptional();
  d.output("candidate_importance", buffer("float", 4, countOf("candidates")),
           Usage::StorageWrite | Usage::TransferWrite,
           "I of each candidate, in [0, 1]; 0 for an attempt that hit nothing");
  d.output("vpl_importance", buffer("float", 4, countOf("vpls")), Usage::StorageWrite,
           "I of each VPL, in [0, 1]; 0 for an empty slot");
  d.parameter("method", choice("rays", {"rays", "cones"}),
              "weight in one direction: `rays` takes the weight of the first side hit (the paper), `cones` "
              "the mean weight in a cone");
  d.parameter("luminance", flag(false),
              "multiplies the importance by min(1, exposure * luminance of the VPL's side), so that it also "
              "reflects how bright the VPL is");
  d.parameter("luminance_floor", real(0, 0, 1),
              "with `luminance`, the factor of a dark VPL; that of a bright one remains 1, between them it "
              "is linear");
  d.parameter("rate_candidates", flag(true),
              "if false, the importance of all candidates is 0, for a pass manage with a `placement` that "
              "does not need it; Eq. 1 then keeps new VPLs in their second frame");
  d.counter("rays", "rays or cones traced");
  d.fill("candidate_importance", 0).when(!parameter("rate_candidates"));
  const auto estimate = [&](const char* name, bool candidates, const char* port) -> StepSpec& {
    return d.step("importance/estimate.comp")
        .called(name)
        .define("CONES", is("method", "cones"))
        .define("LUMINANCE", parameter("luminance"))
        .define("CANDIDATES", candidates)
        .define("VPLS", kGroupVpls)
        .constant("count", countOf(port))
        .groups(1, ceilDiv(countOf(port), kGroupVpls));
  };
  estimate("rate candidates", true, "candidates").when(parameter("rate_candidates"));
  estimate("rate VPLs", false, "vpls");
  d.require(!parameter("luminance") || wired("radiance"), "`luminance` needs the input `radiance`",
            "wire `radiance` to light-inject, or set luminance to false");
  d.require(!is("method", "cones") || wired("mips"), "method `cones` needs the input `mips`",
            "wire `mips` to mipmap, or set method to `rays`");
  return d;
}

FOVEA_PASS(Importance);

}  // namespace
}  // namespace fovea::passes
