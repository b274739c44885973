// Paraboloid shadow maps of all VPLs: an r32ui image array, one map a slot, every texel the distance from the
// VPL to the nearest surface along the texel's direction. A compute rasteriser in two passes over batches of
// VPLs: cull.comp lists the (VPL, triangle) pairs that may cover a texel's centre, small.comp and large.comp
// test the texels against the planes through the VPL and the triangle's edges, which is exact where
// rasterising straight edges between projected vertices is not (edges are arcs), and keep the smallest
// distance with an integer atomic, whose result no order can change.
//
// The technique `simplified` runs the same rasteriser over a coarser mesh: the hardware rasteriser would be
// bound by its front end (one layer of the image a VPL, the whole mesh each) and would bend the edges of just
// the triangles that simplification makes large.
#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "framework/gpu/device.h"
#include "framework/gpu/resources.h"
#include "framework/graph/registry.h"
#include "framework/scene/frame.h"
#include "framework/scene/motion.h"
#include "framework/scene/movers.h"
#include "framework/scene/paraboloid.h"
#include "framework/scene/simplify.h"
#include "framework/scene/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kBatch = 16;                  // VPLs that share one reading of the triangles
constexpr uint32_t kViewBytes = 64;              // VplView in shaders/shadow-atlas/step.glsl
constexpr uint32_t kListBytes = 16;              // WorkList, likewise
constexpr uint32_t kStepBytes = 5 * kListBytes;  // Step: cull, small, large, maskedSmall, maskedLarge
constexpr uint32_t kRangeTriangles = 1 << 19;    // per step: bounds the lists of pairs to 64 MiB
constexpr uint32_t kCullGroup = 128;             // triangles a work group of cull.comp
constexpr uint32_t kGroupsPerRow = 4096;         // likewise
constexpr uint32_t kMovers = 4;  // spheres around what may have changed a map (unchanged.comp)
constexpr uint32_t kDrawnBytes = 32 + 16 * kMovers;  // DrawnMap, likewise
constexpr uint32_t kSliceTexels =
    1 << 18;  // 4,096 blocks of about 10 turns each: below the 65,535 turns of a loop

class ShadowAtlas : public Pass {
 public:
  static PassDeclaration declaration();
  void prepare(PrepareContext& ctx) override;
  void record(RecordContext& ctx) override;

 private:
  struct Kernels {
    Kernel cull, small, large, maskedSmall,
        maskedLarge;  // the masked ones only with the parameter `alpha_mask`
  };
  struct Range {  // triangles of one step
    const Kernels* kernels;
    uint32_t first, count;
    float planeEpsilon;  // m
  };
  static Kernels makeKernels(PrepareContext& ctx, bool simplified);
  std::vector<Range> ranges(RecordContext& ctx);
  void simplifyScene(RecordContext& ctx);
  void chooseSlots(RecordContext& ctx);
  void recordStep(RecordContext& ctx, uint32_t batch, uint32_t step, const Range& range);

  Kernel choose_, unchanged_, clear_, setup_;
  bool hasState_ = false;
  Kernels exact_, simplified_;
  bool simplify_ = false, uploaded_ = false;
  uint32_t simplifiedTriangles_ = 0;
  float simplifiedError_ = 0;
  gpu::Buffer staging_;  // holds the simplified mesh until its copy has run
};

PassDeclaration ShadowAtlas::declaration() {
  PassDeclaration d("shadow-atlas", "paraboloid shadow map of every VPL");
  d.input("vpls", buffer("Vpl", sizeof(scene::Vpl)), Usage::StorageRead,
          "lights; a slot whose intensity is 0 keeps an empty map");
  d.input("state", buffer("VplState", sizeof(scene::VplState)), Usage::StorageRead,
          "which of them are new and how important each is; without it every map is drawn every frame")
      .makeOptional();
  // `layout` counts as its index: 0 layers, 1 tiled.
  const SizeExpr tiles = SizeExpr(1) + SizeExpr(scene::kAtlasTiles - 1) * parameter("layout");
  d.output("atlas",
           image2DArray(VK_FORMAT_R32_UINT, parameter("size") * tiles, parameter("size"),
                        ceilDiv(countOf("vpls"), tiles)),
           Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite,
           "bits of the distance in m, as float, to the nearest surface in the direction of the texel's "
           "centre; inf: none "
           "(shaders/common/paraboloid.glsl)")
      .keep(Lifetime::View);
  const SizeExpr batches = ceilDiv(countOf("vpls"), kBatch), triangles = environment("scene.triangles");
  d.scratch("refreshed", buffer("uint", 4, countOf("vpls")), Usage::StorageRead | Usage::StorageWrite,
            "frame in which each map was drawn")
      .keep(Lifetime::View);
  d.scratch("chosen", buffer("uint", 4, countOf("vpls")), Usage::StorageRead | Usage::StorageWrite,
            "what happens to each slot in this frame");
  d.scratch("drawn", buffer("DrawnMap", kDrawnBytes, countOf("vpls")),
            Usage::StorageRead | Usage::StorageWrite, "what each map was drawn with")
      .keep(Lifetime::View);
  d.scratch("batch", buffer("VplView", kViewBytes, batches * kBatch), Usage::StorageWrite | Usage::Uniform,
            "VPLs whose maps are drawn, packed");
  d.scratch("steps", buffer("AtlasStep", kStepBytes, batches * (ceilDiv(triangles, kRangeTriangles) + 2)),
            Usage::StorageRead | Usage::StorageWrite | Usage::Indirect, "dispatches and lengths of lists");
  d.scratch("pairs", buffer("uint", 4, min(triangles, kRangeTriangles) * (2 * kBatch)),
            Usage::StorageRead | Usage::StorageWrite, "pairs to rasterise; as long as every pair of a step");
  d.scratch("simplified", buffer("SimplifiedTriangle", 48, max(1, triangles * parameter("technique"))),
            Usage::TexelRead | Usage::TransferWrite, "simplified mesh")
      .keep(Lifetime::Scene);

  ParameterSpec size = integer(128, 4, 1024);
  size.unit = "texels";
  d.parameter("size", size, "width and height of a map");
  d.parameter("technique", choice("exact", {"exact", "simplified"}),
              "exact: every triangle; simplified: a coarser mesh, several times faster");
  d.parameter("simplify_ratio", real(0.1, 0, 1),
              "share of the opaque static triangles that `simplified` keeps");
  d.parameter("layout", choice("layers", {"layers", "tiled"}),
              "layers: a layer of the image for each map; tiled: 16 maps a layer, for more VPLs than the "
              "device has layers");
  d.parameter("alpha_mask", flag(true), "holes of alpha-masked materials let light through");
  d.parameter("self_shadow_distance", real(1e-5, 0, 1, "scene diagonals"),
              "a triangle whose plane passes a VPL closer than this is the surface the VPL lies on and "
              "blocks nothing");
  d.parameter(
      "refresh", choice("top", {"all", "top", "split"}),
      "maps of kept VPLs that are drawn again (needs `state`): all; the most important ones; or half of "
      "the same number for those and half for the longest unchanged, first where something moves");
  d.parameter(
      "refresh_share", real(0.05, 0, 1),
      "how many of the kept VPLs' maps `top` and `split` draw again; those among them that would not change "
      "are left as they are");
  d.counter("maps", "maps drawn");
  d.counter("small_pairs", "pairs of a VPL and a triangle in a box of at most 64 texels");
  d.counter("large_pairs", "pairs of a VPL and a triangle in a larger box, or cut by the horizon");
  d.counter("masked_pairs", "pairs of a VPL and a triangle with an alpha mask");
  d.counter("new_maps", "maps drawn because there was none of that VPL");
  d.counter("refreshed_maps", "maps drawn again");
  d.counter("texels", "texels of the maps drawn");
  d.counter("unchanged_maps", "maps that were due, but see nothing else than when they were drawn");
  return d;
}

ShadowAtlas::Kernels ShadowAtlas::makeKernels(PrepareContext& ctx, bool simplified) {
  gpu::Defines defines{{"BATCH", std::to_string(kBatch) + "u"}};
  if (simplified) defines["SIMPLIFIED"] = "1";
  Kernels k;
  k.cull = ctx.compute("shadow-atlas/cull.comp", defines);
  k.small = ctx.compute("shadow-atlas/small.comp", defines);
  k.large = ctx.compute("shadow-atlas/large.comp", defines);
  if (!ctx.parameters().flag("alpha_mask")) return k;
  defines["MASKED"] = "1";
  k.maskedSmall = ctx.compute("shadow-atlas/small.comp", defines);
  k.maskedLarge = ctx.compute("shadow-atlas/large.comp", defines);
  return k;
}

void ShadowAtlas::prepare(PrepareContext& ctx) {
  simplify_ = ctx.parameters().text("technique") == "simplified";
  const gpu::Defines batch{{"BATCH", std::to_string(kBatch) + "u"}};
  const std::string& refresh = ctx.parameters().text("refresh");
  hasState_ = ctx.has("state") && refresh != "all";
  gpu::Defines choose = batch;
  choose["HAS_STATE"] = hasState_ ? "1" : "0";
  choose["REFRESH_SPLIT"] = refresh == "split" ? "1" : "0";
  choose_ = ctx.compute("shadow-atlas/choose.comp", choose);
  if (hasState_)
    unchanged_ = ctx.compute("shadow-atlas/unchanged.comp",
                             {{"BATCH", std::to_string(kBatch) + "u"}, {"MOVERS", std::to_string(kMovers)}});
  clear_ = ctx.compute("shadow-atlas/clear.comp", batch);
  setup_ = ctx.compute("shadow-atlas/setup.comp", batch);
  exact_ = makeKernels(ctx, false);
  if (simplify_) simplified_ = makeKernels(ctx, true);
}

// Once a scene: the copy is part of the first frame's commands.
void ShadowAtlas::simplifyScene(RecordContext& ctx) {
  const scene::SimplifiedMesh mesh = scene::simplify(*ctx.frame().scene, *ctx.frame().geometry,
                                                     float(ctx.parameters().real("simplify_ratio")));
  simplifiedTriangles_ = mesh.triangles();
  simplifiedError_ = mesh.error;
  uploaded_ = true;
  if (mesh.corners.empty()) return;
  const uint64_t bytes = mesh.corners.size() * sizeof(glm::vec4);
  staging_ = gpu::Buffer(
      ctx.device(), {"simplified mesh", bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryKind::Upload});
  std::memcpy(staging_.mapped(), mesh.corners.data(), bytes);
  const VkBufferCopy copy{0, 0, bytes};
  vkCmdCopyBuffer(ctx.cmd(), staging_.handle(), ctx.buffer("simplified").handle(), 1, &copy);
  ctx.barrier();
}

std::vector<ShadowAtlas::Range> ShadowAtlas::ranges(RecordContext& ctx) {
  const scene::Geometry& geometry = *ctx.frame().geometry;
  const float diagonal = geometry.empty() ? 0.0f : glm::length(geometry.boundsMax - geometry.boundsMin);
  const float own = float(ctx.parameters().real("self_shadow_distance")) * diagonal;
  std::vector<Range> list;
  auto add = [&](const Kernels& kernels, uint32_t first, uint32_t end, float epsilon) {
    for (; first < end; first += kRangeTriangles)
      list.push_back({&kernels, first, std::min(end - first, kRangeTriangles), epsilon});
  };
  const uint32_t all = uint32_t(geometry.triangles.size());
  if (simplify_) add(simplified_, 0, simplifiedTriangles_, own + simplifiedError_);
  add(exact_, simplify_ ? std::min(geometry.staticTriangles, all) : 0, all, own);
  return list;
}

void ShadowAtlas::recordStep(RecordContext& ctx, uint32_t batch, uint32_t step, const Range& range) {
  const uint64_t viewOffset = uint64_t(batch) * kBatch * kViewBytes;
  const uint32_t capacity = uint32_t(ctx.count("pairs") / 2),
                 size = uint32_t(ctx.parameters().integer("size"));
  auto use = [&](Kernel kernel) {
    Commands commands = ctx.use(kernel);
    commands.range("batch", viewOffset, kBatch * kViewBytes)
        .constant("step_", step)
        .constant("capacity", capacity);
    return commands;
  };
  auto dispatch = [&](Commands& commands, uint32_t list) {
    commands.dispatchIndirect("steps", uint64_t(step) * kStepBytes + list * kListBytes);
  };
  Commands cull = use(range.kernels->cull);
  cull.constant("firstTriangle", range.first).constant("triangleCount", range.count);
  dispatch(cull, 0);
  ctx.barrier();

  const Kernel lists[] = {range.kernels->small, range.kernels->large, range.kernels->maskedSmall,
                          range.kernels->maskedLarge};
  for (uint32_t list = 0; list < 4 && lists[list]; ++list) {
    const bool large = list % 2 == 1;
    const uint32_t slices = large ? (size * size + kSliceTexels - 1) / kSliceTexels : 1;
    for (uint32_t slice = 0; slice < slices; ++slice) {
      Commands raster = use(lists[list]);
      raster.constant("planeEpsilon", range.planeEpsilon);
      if (large) raster.constant("slice", slice).constant("slices", slices);
      dispatch(raster, 1 + list);
    }
  }
  ctx.barrier();
}

// A sphere around everything that moves; radius below 0: nothing does.
glm::vec4 moversOf(const scene::Frame& frame) {
  const scene::Bounds box = scene::movingBounds(*frame.geometry, frame);
  return box.low.x > box.high.x
             ? glm::vec4(0, 0, 0, -1)
             : glm::vec4(0.5f * (box.low + box.high), 0.5f * glm::length(box.high - box.low));
}

void ShadowAtlas::chooseSlots(RecordContext& ctx) {
  const uint32_t slots = uint32_t(ctx.count("vpls"));
  Commands choose = ctx.use(choose_);
  choose.constant("slots", slots).constant("frameNumber", uint32_t(ctx.frameNumber()));
  if (hasState_) choose.constant("movers", moversOf(ctx.frame()));
  choose.dispatch(1);
  ctx.barrier();
  const uint32_t columns = std::min(slots, kGroupsPerRow), rows = (slots + kGroupsPerRow - 1) / kGroupsPerRow;
  if (hasState_) {
    ctx.use(unchanged_)
        .constant("slots", slots)
        .constant("movers", scene::moverSpheres<kMovers>(ctx.frame()))
        .dispatch(columns, rows);
    ctx.barrier();
  }
  ctx.use(clear_).constant("slots", slots).dispatch(columns, rows);
}

void ShadowAtlas::record(RecordContext& ctx) {
  if (simplify_ && !uploaded_) simplifyScene(ctx);
  if (ctx.firstFrame()) {
    VkClearColorValue nothing{};
    nothing.uint32[0] = scene::kParaboloidEmpty;
    ctx.clear("atlas", nothing);
    ctx.barrier();
  }
  chooseSlots(ctx);

  const std::vector<Range> steps = ranges(ctx);
  uint32_t largest = 0;
  for (const Range& r : steps) largest = std::max(largest, r.count);
  const uint32_t slots = uint32_t(ctx.count("vpls"));
  ctx.use(setup_)
      .constant("slots", slots)
      .constant("ranges", uint32_t(steps.size()))
      .constant("cullGroups", (largest + kCullGroup - 1) / kCullGroup)
      .dispatch(1);
  ctx.barrier();
  for (uint32_t batch = 0; batch * kBatch < slots; ++batch)
    for (uint32_t i = 0; i < steps.size(); ++i)
      recordStep(ctx, batch, batch * uint32_t(steps.size()) + i, steps[i]);
}

FOVEA_PASS(ShadowAtlas);

}  // namespace
}  // namespace fovea::passes
