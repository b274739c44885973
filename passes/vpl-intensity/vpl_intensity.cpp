// How much light a VPL stands for: its radiosity times a piece of surface A_l (passes/vpls.md, vpl-intensity). Each
// strategy is a pass type of its own, a way to fill the scratch buffer `areas`; the first and the last step are shared.
#include <algorithm>
#include <string>

#include "fovea/pass.h"
#include "passes/bundles.h"
#include "passes/clamp.h"
#include "passes/regions.h"
#include "passes/sizes.h"
#include "passes/vpl-intensity/records.h"
#include "shaders/records/eye_paths.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kGroup = 64;           // threads per work group, except in bricks.comp
constexpr uint32_t kSharedPaths = 8;      // paths per invocation of share.comp, its PATHS
constexpr uint32_t kTallyGroups = 256;    // work groups of tally.comp, which strides over all elements
constexpr uint32_t kEscapePoints = 1024;  // screen points from which the share of escaping paths is estimated
constexpr uint32_t kMostInRow = 32768;    // work groups in a row of a dispatch
// VPLs over which bricks.comp loops twice, which stays below the limit of 65,535 iterations of a loop.
constexpr uint32_t kMostCompeting = 16384;

constexpr Usage kReadWrite = Usage::StorageRead | Usage::StorageWrite;
constexpr Usage kWriteThenTexels = Usage::StorageWrite | Usage::TexelRead;

// A dispatch of this many work groups, in several rows if they are many.
StepSpec& inRows(StepSpec& step, const SizeExpr& groups) {
  const SizeExpr row = min(groups, kMostInRow);
  return step.groups(row, ceilDiv(groups, row));
}

SizeExpr bricksAlong() { return ceilDiv(widthOf("voxels.index"), intensity::kBrick); }

StepSpec& stepOverVpls(PassDeclaration& d, const char* shader) {
  return d.step(shader).constant("vplCount", countOf("vpls"));
}

// What all strategies have in common, so that a graph can swap one for another by its name.
PassDeclaration declareIntensity(const char* type, const char* doc) {
  PassDeclaration d(type, doc);
  d.view();
  d.input("vpls", vplStateBuffer(), Usage::TexelRead, "VPLs of this frame, one per slot");
  d.input("radiosity", radiosityBuffer(), Usage::TexelRead,
          "rgb: B_l, W/m^2; w: its luminance; slots as in `vpls`");
  d.input("voxels", "voxels", voxelMembers({"index", "occupied", "surface", "info"}),
          "voxelised surfaces, for which the VPLs stand");
  d.input("radiance", voxelRadianceBuffer(), Usage::TexelRead,
          "radiance of each voxel side; w: luminance, above 0 if the side is lit");
  d.input("gbuffer", "gbuffer", gbufferMembers(Usage::Sampled, {"distance", "normal", "face"}),
          "surfaces seen by the eye, from which the eye paths start");
  d.input("placed", vplBuffer(), Usage::TexelRead,
          "VPLs with which `atlas` was drawn, which gives their positions");
  d.input("atlas", image2DArray(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead,
          "shadow maps of the VPLs, by which `importance-area` decides visibility");
  d.output("emitters", vplBuffer(countOf("vpls")), Usage::StorageWrite,
           "VPLs for shading, in their slots; an empty slot is all zeros");
  d.scratch("totals", buffer("WeightTotals", sizeof(intensity::Totals)), kReadWrite | Usage::TransferWrite,
            "counts, and surface area of the scene");
  d.scratch("areas", buffer("float", 4, countOf("vpls")), kReadWrite,
            "A_l, m^2, as computed by the strategy");
  d.scratch("bricks", buffer("uint", 4, bricksAlong() * bricksAlong() * bricksAlong()),
            kReadWrite | Usage::TexelRead | Usage::TransferWrite,
            "1 if the brick contains surface (for `area`: surface to assign)");
  d.parameter("region", choice("fovea", {"fovea", "image", "mixed"}),
              "region in which the eye paths start, as in pass candidates; `area` starts none");
  d.parameter("points", integer(2048, 64, 4096),
              "screen points over which a density is averaged; `area` needs none");
  d.parameter(
      "kernel", choice("disc", {"disc", "clamp"}),
      "kernel with which the VPLs will be shaded, as in pass deferred; with `clamp`, `importance-area` "
      "returns to the mean over the region the light that the clamp takes, though no VPL becomes more than "
      "twice as bright for it; the other strategies do not depend on the kernel");
  declareClamp(d, "clamp distance of the kernel `clamp`");
  d.counter("alive", "slots that hold a VPL");
  return d;
}

void addTally(PassDeclaration& d, bool area) {
  d.fill("totals", 0);
  d.fill("bricks", 0);
  StepSpec& tally = stepOverVpls(d, "vpl-intensity/tally.comp")
                        .define("AREA", area)
                        .constant("sideCapacity", min(countOf("voxels.surface"), countOf("radiance")))
                        .groups(kTallyGroups);
  if (area) tally.define("LIT_ONLY", is("sides", "lit"));
}

// ---- Densities of eye paths: constant, pdf, importance-area ----------------------------------------------------

void declareDensities(PassDeclaration& d) {
  d.parameter("image_share", real(0.4, 0, 1),
              "share of starts in the whole image for region `mixed`, rounded to 64ths");
  d.parameter(
      "area_cap", real(4, 1, 1e6),
      "largest A_l, in medians of 1 / (N p) (`importance-area` assigns paths that would need more to other "
      "VPLs); also the area of VPLs that the region does not see");
  d.scratch("screen", buffer("ScreenPoint", sizeof(EyePathStart), parameter("points")), kWriteThenTexels,
            "position, shading normal and geometric normal of the surface at each screen point");
  d.scratch("densities", buffer("float", 4, countOf("vpls")), kWriteThenTexels, "p_A, 1/m^2");
  d.scratch("kept", buffer("WeightsKept", sizeof(intensity::Kept)), kReadWrite,
            "total area of `constant`, m^2, 0 if not known yet; latest median of the densities, 1/m^2")
      .keep(Lifetime::View);
  d.counter("unseen", "VPLs that no screen point sees");
  d.counter("capped", "VPLs that are seen so little that the cap applies");
}

StepSpec& addPoints(PassDeclaration& d) {
  return d.step("vpl-intensity/points.comp")
      .define("TRACED", 0)
      .constant(
          "imageShare64ths",
          [](const RecordContext& ctx) { return imageShare64ths(ctx.parameters().real("image_share")); })
      .threads(parameter("points"));
}

StepSpec& addPdf(PassDeclaration& d, const SizeExpr& tried, bool shared) {
  return stepOverVpls(d, "vpl-intensity/pdf.comp")
      .define("SHARED", shared)
      .constant("tried", tried)
      .threads(countOf("vpls"));
}

StepSpec& addFinish(PassDeclaration& d, bool shared = false, const SizeExpr& traced = 0,
                    const SizeExpr& gains = 0) {
  return stepOverVpls(d, "vpl-intensity/finish.comp")
      .define("SHARED", shared)
      .define("TRACED", traced)
      .define("GAINS", gains)
      .define("NEAR", shared ? wired("spread") : SizeExpr(0))
      .threads(countOf("vpls"));
}

// The steps of `pdf`, after which `constant` goes on; `once` is 1 if the density is needed in the first frame only.
void addDensities(PassDeclaration& d, bool once) {
  const SizeExpr escapePoints = min(parameter("points"), kEscapePoints);
  addTally(d, false);
  addPoints(d);
  d.step("vpl-intensity/escapes.comp").constant("escapePoints", escapePoints).threads(escapePoints);
  inRows(stepOverVpls(d, "vpl-intensity/density.comp").define("ONCE", once), countOf("vpls"));
  stepOverVpls(d, "vpl-intensity/median.comp").define("SHARED", 0).groups(1);
  addPdf(d, escapePoints, false);
}

class IntensityPdf : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d =
        declareIntensity("vpl-intensity-pdf",
                         "intensity of every VPL, B_l A_l / pi, with A_l = 1 / (N p) from the density "
                         "p of eye paths from the region");
    declareDensities(d);
    addDensities(d, false);
    addFinish(d);
    return d;
  }
};

class IntensityConstant : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d =
        declareIntensity("vpl-intensity-constant",
                         "intensity of every VPL, B_l A_l / pi, with the same A_l for all VPLs, set on "
                         "the first frame (the paper)");
    declareDensities(d);
    addDensities(d, true);
    stepOverVpls(d, "vpl-intensity/constant.comp").groups(1);
    addFinish(d);
    return d;
  }
};

// ---- Surface nearest to the VPL --------------------------------------------------------------------------------

class IntensityArea : public Pass {
 public:
  static PassDeclaration declaration();
};

const char* const kNormalWeight =
    "weight of normals in the distance d^2 + lambda (1 - n.n'); lambda is in squared mean free paths of the "
    "scene";

float normalShare(const RecordContext& ctx) { return float(ctx.parameters().real("normal_weight")); }

PassDeclaration IntensityArea::declaration() {
  PassDeclaration d =
      declareIntensity("vpl-intensity-area",
                       "intensity of every VPL, B_l A_l / pi, with the surface nearest to the VPL as A_l "
                       "(Voronoi)");
  d.parameter(
      "sides", choice("lit", {"lit", "all"}),
      "surface to assign: `lit` the sides with direct light, among the VPLs on such sides; `all` every side, "
      "among all VPLs");
  d.parameter("normal_weight", real(0.5, 0, 100), kNormalWeight);
  d.counter("given_sides", "sides assigned to a VPL");
  d.require(atMost(countOf("vpls"), int(kMostCompeting)),
            "it takes at most " + std::to_string(kMostCompeting) + " VPLs, and there are more",
            "use `vpl-intensity-pdf`, or fewer VPLs");
  d.scratch("sites", buffer("VplSite", sizeof(intensity::VplSite), countOf("vpls")), kWriteThenTexels,
            "position and normal of the VPLs that compete for surface");
  const SizeExpr bricks = bricksAlong() * bricksAlong() * bricksAlong(),
                 sides = min(countOf("voxels.surface"), countOf("radiance"));
  d.scratch("masks", buffer("uint", 4, bricks * ceilDiv(countOf("vpls"), 32)), kWriteThenTexels,
            "one bit for each VPL that can be the nearest in a brick");
  d.scratch("sums", buffer("Sum", 8, countOf("vpls")), kReadWrite | Usage::TransferWrite,
            "surface assigned to each VPL, as whole numbers");
  d.fill("sums", 0);
  addTally(d, true);
  stepOverVpls(d, "vpl-intensity/bricks.comp")
      .constant("normalShare", normalShare)
      .threads(bricksAlong(), bricksAlong(), bricksAlong());
  inRows(stepOverVpls(d, "vpl-intensity/nearest.comp")
             .define("LIT_ONLY", is("sides", "lit"))
             .constant("sideCapacity", sides)
             .constant("normalShare", normalShare),
         ceilDiv(sides, kGroup));
  stepOverVpls(d, "vpl-intensity/sum.comp").threads(countOf("vpls"));
  addFinish(d);
  return d;
}

// ---- Paths assigned to the VPLs nearest to their ends ----------------------------------------------------------

class IntensityImportanceArea : public Pass {
 public:
  static PassDeclaration declaration();

 private:
  static void addSteps(PassDeclaration& d);
};

PassDeclaration IntensityImportanceArea::declaration() {
  PassDeclaration d = declareIntensity(
      "vpl-intensity-importance-area",
      "intensity of every VPL from n of M eye paths that end nearest to it: A_l = n / (M p), with the "
      "light found there, so that the region receives the light its eye paths find however the VPLs "
      "were chosen");
  declareDensities(d);
  d.input("traced", "eye-paths", eyePathMembers(),
          "paths of pass eye-paths, with the same number of points; this pass then assigns these, "
          "with the light they found, in place of its own paths through the voxels and the VPLs' own light")
      .makeOptional();
  d.input("spread", spreadBuffer(), Usage::TexelRead,
          "x: least area of a disc of `importance-area`, m^2; pass near-field supplies the nearby light that "
          "discs of this area leave out, and the intensity of a VPL is at most doubled to compensate for its "
          "disc; needs `traced` and kernel `disc`")
      .makeOptional();
  d.input("change", changeBuffer(), Usage::TexelRead,
          "z: share of the known light that is outdated, from 0 to 1 (pass eye-paths); the fade-in of new "
          "VPLs is reduced by this share")
      .makeOptional();
  d.parameter("paths", integer(8192, 64, 65536),
              "eye paths through the voxels to assign (M), without `traced`");
  d.parameter(
      "fade_frames", integer(0, 0, 1000),
      "frames over which the share assigned to a new VPL grows from nothing to its own, while its neighbours "
      "give it up gradually to avoid popping");
  d.parameter("normal_weight", real(0.5, 0, 100), kNormalWeight);
  d.output("worth", buffer("float", 4, countOf("vpls")), Usage::StorageWrite,
           "how much each VPL matters, in [0, 1), for pass manage of the next frame");
  d.scratch("sites", buffer("VplSite", sizeof(intensity::VplSite), countOf("vpls")),
            kReadWrite | Usage::TexelRead, "position and normal of the VPLs that compete for paths");
  d.scratch("ends", buffer("PathEnd", sizeof(intensity::PathEnd), parameter("paths")), kWriteThenTexels,
            "where the eye paths end");
  d.scratch("seen", buffer("uint", 4, countOf("vpls") * ceilDiv(parameter("points"), 2048) * 64),
            kWriteThenTexels, "one bit for each screen point that sees a VPL");
  d.scratch("seen_from", buffer("float", 4, countOf("vpls")), kWriteThenTexels,
            "effective number of screen points in a density: squared sum of their terms divided by the sum "
            "of squares");
  d.scratch("gains", buffer("float", 4, countOf("vpls")), kReadWrite,
            "factor by which a VPL is brighter to make up for its disc; with `spread` at most 2");
  d.scratch("sums", buffer("PathSum", sizeof(intensity::PathSum), countOf("vpls")),
            kReadWrite | Usage::TransferWrite,
            "paths and their light assigned to each VPL, as whole numbers");
  requireMaps(d, "atlas", "vpls");
  d.require(same(countOf("traced.starts"), parameter("points")),
            "the paths that are wired to `traced` start from another number of points",
            "give this pass and eye-paths the same number of `points`");
  d.require(
      !wired("spread") || (wired("traced") && is("kernel", "disc")),
      "input `spread` says that other rays bring the light of what is near, but nothing takes it from these "
      "VPLs' light",
      "wire `traced` and choose kernel `disc`, or leave out `spread` and pass near-field, as "
      "graphs/foveal_no_near_field.json does");
  addSteps(d);
  return d;
}

void IntensityImportanceArea::addSteps(PassDeclaration& d) {
  const SizeExpr traced = wired("traced"), discs = is("kernel", "disc"),
                 tried = traced * countOf("traced.ends") + !traced * parameter("paths");
  d.fill("sums", 0);
  addTally(d, false);
  addPoints(d).when(!traced);
  d.step("vpl-intensity/points.comp")
      .called("traced points")
      .when(traced)
      .define("TRACED", 1)
      .threads(parameter("points"));
  d.step("vpl-intensity/paths.comp").when(!traced).threads(parameter("paths"));
  inRows(stepOverVpls(d, "vpl-intensity/seen.comp")
             .define("CHANGE", wired("change"))
             .constant("nearest",
                       [](const RecordContext& ctx) {
                         return ctx.parameters().text("kernel") == "clamp" ? clampDistance(ctx) : 0.0f;
                       }),
         countOf("vpls"));
  stepOverVpls(d, "vpl-intensity/median.comp").define("SHARED", 1).groups(1);
  stepOverVpls(d, "vpl-intensity/share.comp")
      .define("TRACED", traced)
      .define("NEAR", wired("spread"))
      .define("PATHS", kSharedPaths)
      .constant("tried", tried)
      .constant("normalShare", normalShare)
      .threads(ceilDiv(tried, kSharedPaths * parameter("points")) * parameter("points"));
  addPdf(d, tried, true);
  stepOverVpls(d, "vpl-intensity/worth.comp").define("TRACED", traced).groups(1);
  inRows(stepOverVpls(d, "vpl-intensity/discs.comp").when(discs).define("NEAR", wired("spread")),
         countOf("vpls"));
  addFinish(d, true, traced, discs);
}

FOVEA_PASS(IntensityPdf);
FOVEA_PASS(IntensityConstant);
FOVEA_PASS(IntensityArea);
FOVEA_PASS(IntensityImportanceArea);

}  // namespace
}  // namespace fovea::passes
