// Light of VPLs where surfaces meet, by rays.
#include "fovea/pass.h"
#include "passes/acuity.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/sizes.h"
#include "shaders/records/contact.h"

namespace fovea::passes {
namespace {

using namespace graph;

// Bytes of the records in contact_sources.glsl.
constexpr uint32_t kSourcesBytes = 128, kTallyBytes = 8, kCountBytes = 8;

void declarePorts(PassDeclaration& d) {
  constexpr Usage read = Usage::StorageRead, write = Usage::StorageWrite;
  d.input(
      "contacts", image2D(VK_FORMAT_R32G32_UINT), read,
      "x: bits of the distance from the eye, m; y: octahedral normal; 0 elsewhere (pass contacts). Pixels "
      "outside the fovea are ignored");
  d.input("vpls", vplBuffer(), read, "light sources; empty slots have zero intensity");
  d.input("history", buffer("VplTally", kTallyBytes), read, "`tallies` of the previous frame");
  d.input("origin", image2D(VK_FORMAT_R32_UINT), read,
          "0xffffffff where a surface has come into view and has no history (pass motion-vectors)")
      .makeOptional();
  d.output("light",
           ofLight(image2D(VK_FORMAT_R16G16B16A16_SFLOAT, widthOf("contacts"), heightOf("contacts"))),
           write | Usage::TransferWrite,
           "rgb: irradiance / pi from VPLs, W/(sr m^2); a: `longer` where surfaces meet, else all 0");
  d.output("tallies", buffer("VplTally", kTallyBytes, countOf("vpls")), write,
           "x: rays to the VPL in a slot, y: those that reached it; a quarter is forgotten in each frame");
  requireSize(d, "contacts", viewWidth(), viewHeight(), "its view",
              "wire contacts of the view that the pass looks through");
  requireSameSize(d, "origin", "contacts");
}

void declareParameters(PassDeclaration& d) {
  d.parameter("rays", integer(8, 1, 1024), "rays per pixel");
  d.parameter("first_samples", integer(4, 1, 1024),
              "factor on the number of rays where `origin`, if wired, says that there is no history; with 4 "
              "they choose among all VPLs instead of a quarter");
  d.parameter("filter", flag(true),
              "whether the light of a pixel is averaged with that of the eight around it, as far as they are "
              "in contact and on the same plane");
  d.parameter("longer", real(4, 1, 1000),
              "length of a running mean of `light`, in lengths of that elsewhere, for pass "
              "temporal-accumulation");
}

class ContactRays : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "contact-rays",
        "the light of VPLs by rays where surfaces meet in the fovea, in grooves and at the feet "
        "of objects: shadow maps are too coarse for the occlusion there, and the filter of pass "
        "deferred spreads light across edges");
    d.view().rays().recorded();
    declarePorts(d);
    declareParameters(d);
    constexpr Usage readWrite = Usage::StorageRead | Usage::StorageWrite;
    const SizeExpr fours = ceilDiv(countOf("vpls"), 4 * int(kContactSubsets)) * int(kContactSubsets);
    d.scratch("sources", buffer("ContactSources", kSourcesBytes, fours), readWrite,
              "the VPLs by their weights, four of a subset together");
    d.scratch("counts", buffer("Count", kCountBytes, int(kTallySums) * countOf("vpls")),
              readWrite | Usage::TransferWrite,
              "rays of this frame to each VPL, and those that reached it, as several partial sums");
    d.scratch("unfiltered", image2D(VK_FORMAT_R32G32B32A32_SFLOAT, viewWidth(), viewHeight()), readWrite,
              "light at each pixel in contact");
    d.counter("pixels", "pixels where surfaces meet");
    d.counter("rays", "rays traced towards VPLs");
    d.step("contact-rays/sources.comp").threads(countOf("sources"));
    d.step("contact-rays/trace.comp")
        .define("RAY_PASSAGE", fullMaterials())
        .define("HISTORY", wired("origin"));
    d.step("contact-rays/filter.comp").define("FILTER", parameter("filter"));
    d.step("contact-rays/tallies.comp").threads(countOf("vpls"));
    return d;
  }

  void record(RecordContext& ctx) override {
    const Square fovea = foveaSquare(ctx.view()).within(ctx.extent("contacts"));
    const auto overFovea = [&](const char* step) {
      const glm::uvec2 size(fovea.high - fovea.low);
      if (size.x > 0 && size.y > 0)
        ctx.step(step).constant("fovea", fovea.corners()).dispatchThreads(size.x, size.y);
    };
    ctx.fill("counts", 0);
    ctx.clear("light", {});
    ctx.run("sources");
    overFovea("trace");
    overFovea("filter");
    ctx.run("tallies");
  }
};

FOVEA_PASS(ContactRays);

}  // namespace
}  // namespace fovea::passes
