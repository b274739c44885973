// How much light a VPL stands for: its radiosity times a piece of surface A_l (passes/README.md, vpl-intensity). Each
// strategy is a way to fill the scratch buffer `areas`; the rest is shared.
#include <algorithm>
#include <string>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/gpu/resources.h"
#include "framework/shader_twins/fovea.h"
#include "framework/shader_twins/voxel_grid.h"
#include "framework/shader_twins/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kGroup = 64;           // threads per work group, except in bricks.comp
constexpr uint32_t kSharedPaths = 8;      // paths per invocation of share.comp, its PATHS
constexpr uint32_t kTallyGroups = 256;    // work groups of tally.comp, which strides over all elements
constexpr uint32_t kEscapePoints = 1024;  // screen points from which the share of escaping paths is estimated
constexpr uint32_t kScreenPoint = 48;     // bytes: position, normal, face
constexpr uint32_t kBrick = 4;            // cells; shaders/vpl-intensity/vpl_intensity.glsl
// VPLs over which bricks.comp loops twice, which stays below the limit of 65,535 turns of a loop.
constexpr uint32_t kMostCompeting = 16384;

uint32_t groups(uint64_t threads, uint32_t size = kGroup) { return uint32_t((threads + size - 1) / size); }

class Weights : public Pass {
 public:
  static PassDeclaration declaration();
  void prepare(PrepareContext& ctx) override;
  void record(RecordContext& ctx) override;

 private:
  static void addScratch(PassDeclaration& d);
  void recordDensities(RecordContext& ctx);
  void recordVoronoi(RecordContext& ctx);

  std::string strategy_;
  uint32_t vplCount_ = 0, sideCapacity_ = 0, bricks_ = 0;
  bool traced_ = false;  // whether the paths come from pass eye-paths
  Kernel tally_, finish_;
  // For `pdf`, and constant_ after it for `constant`; `importance-area` uses only some of them.
  Kernel points_, escapes_, density_, median_, pdf_, constant_;
  Kernel paths_, seen_, share_, discs_;  // `importance-area`
  Kernel brick_, nearest_, sum_;         // `area`
};

PassDeclaration Weights::declaration() {
  PassDeclaration d("vpl-intensity",
                    "intensity of every VPL, B_l A_l / pi, from the area A_l for which it stands");
  d.view();
  d.input("vpls", buffer("VplState", sizeof(scene::VplState)), Usage::TexelRead,
          "VPLs of this frame, one per slot");
  d.input("radiosity", buffer("VplRadiosity", 16), Usage::TexelRead,
          "rgb: B_l, W/m^2; w: its luminance; slots as in `vpls`");
  d.input("voxels", "voxels",
          {member("index", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
           member("occupied", image3D(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead),
           member("surface", buffer("VoxelSide", sizeof(scene::VoxelSide)), Usage::TexelRead),
           member("info", buffer("VoxelInfo", sizeof(scene::VoxelInfo)), Usage::Uniform)},
          "voxelised surfaces, for which the VPLs stand");
  d.input("radiance", buffer("VoxelRadiance", 16), Usage::TexelRead,
          "radiance of each voxel side; w: luminance, above 0 if the side is lit");
  d.input("gbuffer", "gbuffer",
          {member("position", image2D(VK_FORMAT_R32G32B32A32_SFLOAT), Usage::Sampled),
           member("normal", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::Sampled),
           member("face", image2D(), Usage::Sampled)},
          "surfaces seen by the eye, from which the eye paths start");
  d.input("placed", buffer("Vpl", sizeof(scene::Vpl)), Usage::TexelRead,
          "VPLs with which `atlas` was drawn, which gives their positions");
  d.input("atlas", image2DArray(VK_FORMAT_R32_UINT, 1, 1, 1), Usage::StorageRead,
          "shadow maps of the VPLs, by which `importance-area` decides visibility");
  d.input("traced", "eye-paths",
          {member("starts", buffer("ScreenPoint", kScreenPoint), Usage::TexelRead),
           member("ends", buffer("EyePathEnd", 48), Usage::TexelRead)},
          "paths of pass eye-paths, with the same number of points; `importance-area` then assigns these, "
          "with the light they found, in place of its own paths through the voxels and the VPLs' own light")
      .makeOptional();
  d.input("spread", buffer("VplSpread", 16), Usage::TexelRead,
          "x: least area of a disc of `importance-area`, m^2; pass near-field supplies the nearby light that "
          "discs of this area leave out; needs `traced` and kernel `disc`")
      .makeOptional();
  d.output("emitters", buffer("Vpl", sizeof(scene::Vpl), countOf("vpls")), Usage::StorageWrite,
           "VPLs for shading, in their slots; an empty slot is all zeros");
  addScratch(d);
  d.parameter(
      "strategy", choice("pdf", {"constant", "pdf", "area", "importance-area"}),
      "how A_l is found: `constant` the same for all VPLs, set on the first frame (the paper); `pdf` 1 / (N "
      "p) with the density p of eye paths from the region; `area` the surface nearest to the VPL (Voronoi); "
      "`importance-area` n / (M p) for n of M eye paths that end nearest to the VPL, with the light found "
      "there, so that the region receives the light its eye paths find however the VPLs were chosen");
  d.parameter("region", choice("fovea", {"fovea", "image", "mixed"}),
              "region in which the eye paths start, as in pass candidates");
  d.parameter("image_share", real(0.4, 0, 1),
              "share of starts in the whole image for region `mixed`, rounded to 64ths");
  d.parameter("fovea_radius", real(0.25, 0.001, 4, "image widths"), "radius of the fovea");
  d.parameter("points", integer(2048, 64, 4096),
              "screen points over which a density is averaged (all strategies but `area`); rays are traced "
              "to 64 of them, except for `importance-area`");
  d.parameter(
      "area_cap", real(4, 1, 1e6),
      "largest A_l, in medians of 1 / (N p) (all strategies but `area`; `importance-area` assigns paths that "
      "would need more to other VPLs); also the area of VPLs that the region does not see");
  d.parameter("paths", integer(8192, 64, 65536),
              "eye paths that `importance-area` assigns to the VPLs nearest to their ends (M)");
  d.parameter("fade_frames", integer(0, 0, 1000),
              "frames over which the share that `importance-area` assigns to a new VPL grows from nothing to "
              "its own, while its neighbours give it up gradually to avoid popping");
  d.parameter("kernel", choice("disc", {"disc", "clamp"}),
              "kernel with which `importance-area` expects the VPLs to be shaded, as in pass deferred; with "
              "`clamp` the mean over the region regains the light that the clamp removes");
  d.parameter("clamp_distance", real(1.5, 0, 1e6, "m"), "clamp distance of the kernel `clamp`");
  d.parameter("sides", choice("lit", {"lit", "all"}),
              "surface that `area` assigns: `lit` the sides with direct light, among the VPLs on such sides; "
              "`all` every side, among all VPLs");
  d.parameter("normal_weight", real(0.5, 0, 100),
              "weight of normals in the distance d^2 + lambda (1 - n.n') of `area` and `importance-area`; "
              "lambda is in squared mean free paths of the scene");
  d.counter("alive", "slots that hold a VPL");
  d.counter("unseen", "VPLs that no screen point sees (`pdf`)");
  d.counter("capped", "VPLs that are seen so little that the cap applies");
  d.counter("given_sides", "sides assigned to a VPL (`area`)");
  return d;
}

void Weights::addScratch(PassDeclaration& d) {
  const Usage readWrite = Usage::StorageRead | Usage::StorageWrite;
  d.scratch("totals", buffer("WeightTotals", 16), readWrite | Usage::TransferWrite,
            "counts, and surface area of the scene");
  d.scratch("areas", buffer("float", 4, countOf("vpls")), readWrite, "A_l, m^2, as computed by the strategy");
  d.scratch("screen", buffer("ScreenPoint", kScreenPoint, parameter("points")),
            Usage::StorageWrite | Usage::TexelRead,
            "position, shading normal and geometric normal of the surface at each screen point");
  d.scratch("densities", buffer("float", 4, countOf("vpls")), Usage::StorageWrite | Usage::TexelRead,
            "p_A, 1/m^2");
  d.scratch("kept", buffer("WeightsKept", 8), readWrite,
            "total area of `constant`, m^2, 0 if not known yet; latest median of the densities, 1/m^2")
      .keep(Lifetime::View);
  // A choice counts as its index: 0 constant, 1 pdf, 2 area, 3 importance-area.
  const SizeExpr owning = min(max(parameter("strategy") - 1, 0), 1),
                 shared = max(parameter("strategy") - 2, 0), area = owning - shared,
                 side = ceilDiv(widthOf("voxels.index"), kBrick);
  const SizeExpr bricks = side * side * side;
  d.scratch("sites", buffer("VplSite", 32, max(1, countOf("vpls") * owning)), readWrite | Usage::TexelRead,
            "position and normal of the VPLs that compete for surface");
  d.scratch("ends", buffer("PathEnd", 32, max(1, parameter("paths") * shared)),
            Usage::StorageWrite | Usage::TexelRead, "where the eye paths end");
  d.scratch("seen",
            buffer("uint", 4, max(1, countOf("vpls") * shared * ceilDiv(parameter("points"), 2048) * 64)),
            Usage::StorageWrite | Usage::TexelRead, "one bit for each screen point that sees a VPL");
  d.scratch("seen_from", buffer("float", 4, max(1, countOf("vpls") * shared)),
            Usage::StorageWrite | Usage::TexelRead,
            "effective number of screen points in a density: squared sum of their terms divided by the sum "
            "of squares");
  d.scratch("gains", buffer("float", 4, max(1, countOf("vpls") * shared)), readWrite,
            "factor by which a VPL must be brighter to make up for its disc");
  d.scratch("bricks", buffer("uint", 4, bricks), readWrite | Usage::TexelRead | Usage::TransferWrite,
            "1 if the brick contains surface (for `area`: surface to assign)");
  d.scratch("masks", buffer("uint", 4, max(1, bricks * area * ceilDiv(countOf("vpls"), 32))),
            Usage::StorageWrite | Usage::TexelRead,
            "one bit for each VPL that can be the nearest in a brick");
  d.scratch("sums", buffer("Sum", 8, max(1, countOf("vpls") * (owning + shared))),
            readWrite | Usage::TransferWrite,
            "surface, or paths and their light, assigned to each VPL, as whole numbers");
}

void Weights::prepare(PrepareContext& ctx) {
  const Parameters& p = ctx.parameters();
  strategy_ = p.text("strategy");
  vplCount_ = uint32_t(ctx.count("vpls"));
  sideCapacity_ = uint32_t(std::min(ctx.count("voxels.surface"), ctx.count("radiance")));
  bricks_ = (ctx.extent("voxels.index").width + kBrick - 1) / kBrick;
  const bool area = strategy_ == "area";
  const std::string shared = strategy_ == "importance-area" ? "1" : "0";
  traced_ = ctx.has("traced") && shared == "1";
  const std::string traced = traced_ ? "1" : "0";
  const std::string lit = p.text("sides") == "lit" ? "1" : "0";
  if (area && vplCount_ > kMostCompeting)
    throw Error(ExitCode::BadInput,
                "pass `vpl-intensity`: strategy `area` takes at most " + std::to_string(kMostCompeting) +
                    " VPLs, these are " + std::to_string(vplCount_),
                "set vpl-intensity.strategy to `pdf`, or use fewer VPLs");
  const VkExtent3D maps = ctx.extent("atlas");
  const uint64_t mapCount = uint64_t(maps.width / std::max(maps.height, 1u)) * ctx.layers("atlas");
  if (mapCount < vplCount_)
    throw Error(ExitCode::BadInput,
                "pass `vpl-intensity`: the atlas holds " + std::to_string(mapCount) + " maps for " +
                    std::to_string(vplCount_) + " VPLs",
                "wire the same VPLs to the atlas and to this pass");
  if (traced_ && ctx.count("traced.starts") != uint64_t(p.integer("points")))
    throw Error(ExitCode::BadInput,
                "pass `vpl-intensity`: its paths start from " + std::to_string(ctx.count("traced.starts")) +
                    " points, it has " + std::to_string(p.integer("points")),
                "give vpl-intensity.points and eye-paths.points the same number");
  tally_ = ctx.compute("vpl-intensity/tally.comp", {{"AREA", area ? "1" : "0"}, {"LIT_ONLY", lit}});
  const bool discs = shared == "1" && p.text("kernel") == "disc";
  const std::string near = ctx.has("spread") ? "1" : "0";
  if (ctx.has("spread") && !(traced_ && discs))
    throw Error(
        ExitCode::BadInput,
        "pass `vpl-intensity`: input `spread` says that other rays bring the light of what is near, but "
        "nothing "
        "takes it from these VPLs' light",
        "wire `traced` and choose strategy `importance-area` and kernel `disc`, or leave out `spread` and "
        "pass near-field, as graphs/foveal_no_near_field.json does");
  finish_ =
      ctx.compute("vpl-intensity/finish.comp",
                  {{"SHARED", shared}, {"TRACED", traced}, {"GAINS", discs ? "1" : "0"}, {"NEAR", near}});
  if (area) {
    brick_ = ctx.compute("vpl-intensity/bricks.comp");
    nearest_ = ctx.compute("vpl-intensity/nearest.comp", {{"LIT_ONLY", lit}});
    sum_ = ctx.compute("vpl-intensity/sum.comp");
    return;
  }
  points_ = ctx.compute("vpl-intensity/points.comp", {{"TRACED", traced}});
  if (shared == "1")
    seen_ = ctx.compute("vpl-intensity/seen.comp");
  else
    density_ = ctx.compute("vpl-intensity/density.comp", {{"ONCE", strategy_ == "constant" ? "1" : "0"}});
  median_ = ctx.compute("vpl-intensity/median.comp", {{"SHARED", shared}});
  pdf_ = ctx.compute("vpl-intensity/pdf.comp", {{"SHARED", shared}});
  if (strategy_ == "importance-area") {
    if (!traced_) paths_ = ctx.compute("vpl-intensity/paths.comp");
    share_ = ctx.compute("vpl-intensity/share.comp",
                         {{"TRACED", traced}, {"NEAR", near}, {"PATHS", std::to_string(kSharedPaths)}});
    if (discs) discs_ = ctx.compute("vpl-intensity/discs.comp", {{"NEAR", near}});
  } else {
    escapes_ = ctx.compute("vpl-intensity/escapes.comp");
  }
  if (strategy_ == "constant") constant_ = ctx.compute("vpl-intensity/constant.comp");
}

void Weights::recordDensities(RecordContext& ctx) {
  const Parameters& p = ctx.parameters();
  const bool shared = strategy_ == "importance-area";
  const uint32_t points = uint32_t(p.integer("points"));
  const uint32_t tried = traced_  ? uint32_t(ctx.count("traced.ends"))
                         : shared ? uint32_t(p.integer("paths"))
                                  : std::min(points, kEscapePoints);
  Commands start = ctx.use(points_);
  if (!traced_) start.constant("imageShare64ths", scene::imageShare64ths(p.real("image_share")));
  start.dispatchThreads(points);
  ctx.barrier();
  if (shared && !traced_) ctx.use(paths_).dispatchThreads(tried);
  if (!shared) ctx.use(escapes_).constant("escapePoints", tried).dispatchThreads(tried);
  const bool clamped = shared && p.text("kernel") == "clamp";
  const uint32_t row = std::min(vplCount_, 32768u);
  Commands density = ctx.use(shared ? seen_ : density_);
  density.constant("vplCount", vplCount_);
  if (shared) density.constant("nearest", clamped ? float(p.real("clamp_distance")) : 0.0f);
  density.dispatch(row, (vplCount_ + row - 1) / row);
  ctx.barrier();
  ctx.use(median_).constant("vplCount", vplCount_).dispatch(1);
  ctx.barrier();
  if (shared) {
    ctx.use(share_)
        .constant("vplCount", vplCount_)
        .constant("tried", tried)
        .constant("normalShare", float(p.real("normal_weight")))
        .dispatchThreads((tried + kSharedPaths - 1) / kSharedPaths);
    ctx.barrier();
  }
  ctx.use(pdf_).constant("vplCount", vplCount_).constant("tried", tried).dispatchThreads(vplCount_);
  ctx.barrier();
  if (shared && !clamped) {
    ctx.use(discs_).constant("vplCount", vplCount_).dispatch(row, (vplCount_ + row - 1) / row);
    ctx.barrier();
  }
  if (strategy_ != "constant") return;
  ctx.use(constant_).constant("vplCount", vplCount_).dispatch(1);
  ctx.barrier();
}

void Weights::recordVoronoi(RecordContext& ctx) {
  const float share = float(ctx.parameters().real("normal_weight"));
  ctx.use(brick_)
      .constant("vplCount", vplCount_)
      .constant("normalShare", share)
      .dispatchThreads(bricks_, bricks_, bricks_);
  ctx.barrier();
  const uint32_t all = groups(sideCapacity_), row = std::min(all, 32768u);
  ctx.use(nearest_)
      .constant("vplCount", vplCount_)
      .constant("sideCapacity", sideCapacity_)
      .constant("normalShare", share)
      .dispatch(row, (all + row - 1) / row);
  ctx.barrier();
  ctx.use(sum_).constant("vplCount", vplCount_).dispatchThreads(vplCount_);
  ctx.barrier();
}

void Weights::record(RecordContext& ctx) {
  const bool area = strategy_ == "area";
  ctx.fill("totals", 0);
  ctx.fill("bricks", 0);
  if (area || strategy_ == "importance-area") ctx.fill("sums", 0);
  ctx.barrier();
  ctx.use(tally_)
      .constant("vplCount", vplCount_)
      .constant("sideCapacity", sideCapacity_)
      .dispatch(kTallyGroups);
  ctx.barrier();
  if (area)
    recordVoronoi(ctx);
  else
    recordDensities(ctx);
  ctx.use(finish_).constant("vplCount", vplCount_).dispatchThreads(vplCount_);
}

FOVEA_PASS(Weights);

}  // namespace
}  // namespace fovea::passes
