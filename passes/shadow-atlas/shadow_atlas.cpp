// Paraboloid shadow maps of all VPLs: an r32ui image array with one map per slot, in which every texel holds the
// distance from the VPL to the nearest surface along the texel's direction. A compute rasteriser tests the texels
// against the planes through the VPL and the triangle's edges. The test is exact, unlike rasterising straight edges
// between projected vertices, as edges are arcs. draw.comp finds the (VPL, triangle) pairs that may cover a texel's
// centre and draws those of few texels; large.comp draws the others. An integer atomic keeps the smallest distance, so
// the result does not depend on the order.
//
// Where a VPL is static and something moves in front of it, the map of static geometry can be kept (parameter
// `static_maps`): it is copied, and only moving geometry is drawn over it.
//
// The technique `simplified` runs the same rasteriser over a coarser mesh. The hardware rasteriser would be limited
// by its front end (one image layer per VPL, with the whole mesh each) and would distort the edges of exactly those
// triangles that simplification makes large.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

#include "fovea/pass.h"
#include "framework/gpu/device.h"
#include "framework/gpu/resources.h"
#include "framework/scene/device/simplify.h"
#include "framework/scene/frame.h"
#include "framework/scene/motion/motion.h"
#include "framework/scene/motion/movers.h"
#include "passes/bundles.h"
#include "passes/shadow-atlas/records.h"
#include "shaders/records/paraboloid.h"

namespace fovea::passes {
namespace {

using namespace graph;

using namespace atlas;

constexpr uint32_t kRangeTriangles = 1 << 19;  // per step: bounds the lists to 128 MiB
// Texels of a map in one slice of the work of large.comp. Eight invocations draw a slice in up to kBatch maps, which are
// 4,096 blocks of about 10 turns of a loop each. Some devices allow no more than 65,535 turns.
constexpr uint32_t kSliceTexels = (1 << 18) / kBatch;

class ShadowAtlas : public Pass {
 public:
  static PassDeclaration declaration();
  void prepare(PrepareContext& ctx) override;
  void record(RecordContext& ctx) override;

 private:
  struct Kernels {
    // The masked kernels exist only with the parameter `alpha_mask`.
    Kernel draw, large, maskedSmall, maskedLarge;
  };
  struct Range {  // triangles of one step
    const Kernels* kernels;
    uint32_t first, count;
    float planeEpsilon;  // m
  };
  struct Ranges {
    std::vector<Range> all;      // for maps that are drawn from scratch
    std::vector<Range> overlay;  // over static geometry, for every map
  };
  static Kernels makeKernels(PrepareContext& ctx, bool simplified, bool toStaticMaps);
  Ranges ranges(RecordContext& ctx);
  static uint32_t groups(const std::vector<Range>& list);
  static uint32_t rounds(uint32_t slots) { return (slots + kRound - 1) / kRound; }
  struct Simplified {
    bool uploaded = false;
    uint32_t triangles = 0;
    float error = 0;
  };
  Simplified simplifyScene(RecordContext& ctx);
  void chooseSlots(RecordContext& ctx, const Ranges& triangles);
  void recordStep(RecordContext& ctx, uint32_t round, uint32_t step, const Range& range);

  Kernel changed_, choose_, clear_, compose_;
  bool hasState_ = false, staticMaps_ = false, simplify_ = false;
  // `still_` is the part of exact_ for static geometry, where that has maps of its own.
  Kernels exact_, still_, simplified_;
  gpu::Buffer staging_;  // holds the simplified mesh until its copy has run
};

PassDeclaration ShadowAtlas::declaration() {
  PassDeclaration d("shadow-atlas", "paraboloid shadow map of every VPL");
  d.input("vpls", vplBuffer(), Usage::StorageRead, "VPLs; a slot with zero intensity keeps an empty map");
  d.input("state", vplStateBuffer(), Usage::StorageRead,
          "state of the VPLs: which are new, and how important each one is; if not wired, every map is "
          "drawn in every frame")
      .makeOptional();
  d.input("change", changeBuffer(), Usage::TexelRead,
          "z: share of the known light that is outdated, from 0 to 1 (pass eye-paths); if it is more than "
          "`refresh_share`, this share of the kept VPLs' maps is redrawn")
      .makeOptional();
  // `layout` counts as its index: 0 layers, 1 tiled.
  const SizeExpr tiles = SizeExpr(1) + SizeExpr(scene::kAtlasTiles - 1) * parameter("layout");
  d.output("atlas",
           image2DArray(VK_FORMAT_R32_UINT, parameter("size") * tiles, parameter("size"),
                        ceilDiv(countOf("vpls"), tiles)),
           Usage::StorageRead | Usage::StorageWrite | Usage::TransferWrite,
           "bits of a float: distance in m to the nearest surface in the direction of the texel's centre, "
           "infinity if there is none (shaders/vpls/paraboloid.glsl)")
      .keep(Lifetime::View);
  const SizeExpr rounds = ceilDiv(countOf("vpls"), kRound), triangles = environment("scene.triangles");
  d.scratch("refreshed", buffer("uint", 4, countOf("vpls")), Usage::StorageRead | Usage::StorageWrite,
            "frame in which each map was drawn")
      .keep(Lifetime::View);
  d.scratch("chosen", buffer("uint", 4, countOf("vpls")), Usage::StorageRead | Usage::StorageWrite,
            "what is done with each slot in this frame");
  d.scratch("drawn", buffer("DrawnMap", sizeof(DrawnMap), countOf("vpls")),
            Usage::StorageRead | Usage::StorageWrite, "positions and poses with which each map was drawn")
      .keep(Lifetime::View);
  d.scratch("changes", buffer("uint", 4, countOf("vpls")), Usage::StorageRead | Usage::StorageWrite,
            "what would change in each map if it were drawn again");
  // There are none if nothing moves.
  const SizeExpr keeps =
      parameter("static_maps") * min(1, max(0, triangles - environment("scene.static_triangles")));
  d.scratch("static_maps",
            image2DArray(VK_FORMAT_R32_UINT, max(1, parameter("size") * tiles * keeps),
                         max(1, parameter("size") * keeps), max(1, ceilDiv(countOf("vpls"), tiles) * keeps)),
            Usage::StorageRead | Usage::StorageWrite, "the same as the atlas, with static geometry only")
      .keep(Lifetime::View);
  d.scratch("views", buffer("VplView", sizeof(VplView), rounds * kRound),
            Usage::StorageWrite | Usage::Uniform, "VPLs whose maps are drawn, packed");
  d.scratch("steps", buffer("AtlasStep", sizeof(Step), rounds * (ceilDiv(triangles, kRangeTriangles) + 2)),
            Usage::StorageRead | Usage::StorageWrite | Usage::Indirect,
            "indirect dispatches, and how much each works on");
  d.scratch("listed",
            buffer("VplSet", sizeof(VplSet), min(triangles, kRangeTriangles) * (2 * kRound / kBatch)),
            Usage::StorageRead | Usage::StorageWrite,
            "triangles to draw in the second step, with room for every triangle in every map");
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
              "layers: one layer of the image for each map; tiled: 16 maps per layer, for more VPLs than the "
              "device has layers");
  d.parameter("alpha_mask", flag(true), "whether light passes through the holes of alpha-masked materials");
  d.parameter("self_shadow_distance", real(1e-5, 0, 1, "scene diagonals"),
              "a triangle whose plane is closer to a VPL than this counts as the VPL's own surface and "
              "occludes nothing");
  d.parameter(
      "refresh", choice("top", {"all", "top", "split", "stale"}),
      "which maps of kept VPLs are redrawn (needs `state`): `all`; `top` those of the most important VPLs "
      "(the paper); `split` half of the number for these and half for the oldest maps, first where something "
      "moves; `stale` those that would change, by importance times the frames since they were drawn");
  d.parameter("refresh_share", real(0.05, 0, 1),
              "share of the kept VPLs whose maps are redrawn in a frame, unless `refresh` is `all`; maps "
              "among them that would not change are not redrawn");
  d.parameter("static_maps", flag(false),
              "whether a map of static geometry is kept for each VPL, which takes as much memory again; "
              "while the VPL does not move, only moving geometry is drawn over that map (needs `state`)");
  d.parameter("mover_slack", real(0, 0, 100, "frames"),
              "moving geometry is drawn farther from the VPL by the distance that it moves in this many "
              "frames, at most a quarter of the distance to the VPL, so that it casts no shadow on itself "
              "from maps that are some frames old; 0 draws it in place");
  d.counter("maps", "maps drawn");
  d.counter("small_pairs", "pairs of a VPL and a triangle in a box of at most 64 texels");
  d.counter("large_pairs", "pairs of a VPL and a triangle in a larger box, or cut by the horizon");
  d.counter("masked_pairs", "pairs of a VPL and a triangle with an alpha mask");
  d.counter("new_maps", "maps drawn because the VPL had none");
  d.counter("refreshed_maps", "maps drawn again");
  d.counter("texels", "texels of the maps drawn");
  d.counter("unchanged_maps", "maps that were due but would not have changed");
  d.counter("overlaid_maps", "maps drawn again over the kept map of static geometry");
  return d;
}

ShadowAtlas::Kernels ShadowAtlas::makeKernels(PrepareContext& ctx, bool simplified, bool toStaticMaps) {
  Defines defines;
  if (simplified) defines["SIMPLIFIED"] = "1";
  if (toStaticMaps) defines["STATIC_MAPS"] = "1";
  if (!simplified && !toStaticMaps && ctx.parameters().real("mover_slack") > 0) defines["MOVER_SLACK"] = "1";
  const auto kernel = [&](const char* shader) { return ctx.compute(shader, defines).called("draw"); };
  Kernels k;
  k.draw = kernel("shadow-atlas/draw.comp");
  k.large = kernel("shadow-atlas/large.comp");
  if (!ctx.parameters().flag("alpha_mask")) return k;
  defines["MASKED"] = "1";
  k.maskedSmall = kernel("shadow-atlas/masked.comp");
  k.maskedLarge = kernel("shadow-atlas/large.comp");
  return k;
}

void ShadowAtlas::prepare(PrepareContext& ctx) {
  simplify_ = ctx.parameters().text("technique") == "simplified";
  const std::string& refresh = ctx.parameters().text("refresh");
  hasState_ = ctx.has("state") && refresh != "all";
  // The maps have the least possible size if nothing moves.
  const VkExtent3D still = ctx.extent("static_maps"), all = ctx.extent("atlas");
  staticMaps_ = hasState_ && still.width == all.width && still.height == all.height;
  Defines defines;
  if (hasState_) changed_ = ctx.compute("shadow-atlas/changed.comp", defines);
  defines["HAS_STATE"] = hasState_ ? "1" : "0";
  defines["STATIC_MAPS"] = staticMaps_ ? "1" : "0";
  clear_ = ctx.compute("shadow-atlas/clear.comp", defines);
  defines["REFRESH"] = refresh == "split" ? "2" : refresh == "stale" ? "3" : "1";
  defines["CHANGE"] = hasState_ && ctx.has("change") ? "1" : "0";
  choose_ = ctx.compute("shadow-atlas/choose.comp", defines);
  exact_ = makeKernels(ctx, false, false);
  if (staticMaps_) compose_ = ctx.compute("shadow-atlas/compose.comp", Defines{});
  if (staticMaps_ && !simplify_) still_ = makeKernels(ctx, false, true);
  if (simplify_) simplified_ = makeKernels(ctx, true, staticMaps_);
}

// Runs once per scene; the copy is part of the first frame's commands.
ShadowAtlas::Simplified ShadowAtlas::simplifyScene(RecordContext& ctx) {
  const scene::SimplifiedMesh mesh = scene::simplify(*ctx.frame().scene, *ctx.frame().geometry,
                                                     float(ctx.parameters().real("simplify_ratio")));
  const Simplified simplified{true, mesh.triangles(), mesh.error};
  if (mesh.corners.empty()) return simplified;
  const uint64_t bytes = mesh.corners.size() * sizeof(glm::vec4);
  staging_ = gpu::Buffer(
      ctx.device(), {"simplified mesh", bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryKind::Upload});
  std::memcpy(staging_.mapped(), mesh.corners.data(), bytes);
  const VkBufferCopy copy{0, 0, bytes};
  vkCmdCopyBuffer(ctx.cmd(), staging_.handle(), ctx.buffer("simplified").handle(), 1, &copy);
  ctx.barrier();  // this copy is no command that the framework knows
  return simplified;
}

ShadowAtlas::Ranges ShadowAtlas::ranges(RecordContext& ctx) {
  const scene::Geometry& geometry = *ctx.frame().geometry;
  const float diagonal = geometry.empty() ? 0.0f : glm::length(geometry.boundsMax - geometry.boundsMin);
  const float own = float(ctx.parameters().real("self_shadow_distance")) * diagonal;
  Ranges list;
  auto add = [](std::vector<Range>& to, const Kernels& kernels, uint32_t first, uint32_t end, float epsilon) {
    for (; first < end; first += kRangeTriangles)
      to.push_back({&kernels, first, std::min(end - first, kRangeTriangles), epsilon});
  };
  const scene::Geometry::LightTriangles light = geometry.light();
  const auto& mesh = ctx.memory<Simplified>();
  if (simplify_)
    add(list.all, simplified_, 0, mesh.triangles, own + mesh.error);
  else if (staticMaps_)
    add(list.all, still_, light.first, light.firstMoving, own);
  add(staticMaps_ ? list.overlay : list.all, exact_,
      simplify_ || staticMaps_ ? light.firstMoving : light.first, light.end, own);
  return list;
}

void ShadowAtlas::recordStep(RecordContext& ctx, uint32_t round, uint32_t step, const Range& range) {
  auto use = [&](Kernel kernel) {
    Commands commands = ctx.use(kernel);
    commands.range("views", uint64_t(round) * kRound * sizeof(VplView), kRound * sizeof(VplView))
        .constant("step_", step)
        .constant("capacity", uint32_t(ctx.count("listed") / 2))
        .constant("planeEpsilon", range.planeEpsilon);
    return commands;
  };
  auto dispatch = [&](Commands& commands, size_t list) {
    commands.dispatchIndirect("steps", uint64_t(step) * sizeof(Step) + list);
  };
  const Kernels& kernels = *range.kernels;
  Commands draw = use(kernels.draw);
  draw.constant("firstTriangle", range.first).constant("triangleCount", range.count);
  dispatch(draw, offsetof(Step, draw));
  Commands large = use(kernels.large);
  dispatch(large, offsetof(Step, large));
  if (!kernels.maskedSmall) return;
  // Each keeps the smallest distances by integer atomics, so they may run in any order.
  Commands maskedSmall = use(kernels.maskedSmall), maskedLarge = use(kernels.maskedLarge);
  dispatch(maskedSmall.together(), offsetof(Step, maskedSmall));
  dispatch(maskedLarge.together(), offsetof(Step, maskedLarge));
}

// A sphere around everything that moves; its radius is negative if nothing does.
glm::vec4 moversOf(const scene::Frame& frame) {
  const scene::Bounds box = scene::moverBoxes(frame).all();
  return box.low.x > box.high.x
             ? glm::vec4(0, 0, 0, -1)
             : glm::vec4(0.5f * (box.low + box.high), 0.5f * glm::length(box.high - box.low));
}

// Work groups of draw.comp for the largest of some ranges.
uint32_t ShadowAtlas::groups(const std::vector<Range>& list) {
  constexpr uint32_t kDrawn = kDrawGroup * kTriangles;
  uint32_t largest = 0;
  for (const Range& r : list) largest = std::max(largest, r.count);
  return (largest + kDrawn - 1) / kDrawn;
}

void ShadowAtlas::chooseSlots(RecordContext& ctx, const Ranges& triangles) {
  const uint32_t slots = uint32_t(ctx.count("vpls")), size = uint32_t(ctx.parameters().integer("size"));
  const uint32_t columns = std::min(slots, kGroupsPerRow), rows = (slots + kGroupsPerRow - 1) / kGroupsPerRow;
  const auto movers = scene::moverSpheres<kMovers>(ctx.frame());
  if (hasState_) {
    ctx.use(changed_)
        .constant("slots", slots)
        .constant("movers", movers.spheres)
        .constant("poses", movers.poses)
        .dispatch(columns, rows);
  }
  Commands choose = ctx.use(choose_);
  choose.constant("slots", slots)
      .constant("frameNumber", uint32_t(ctx.frameNumber()))
      .constant("rounds", rounds(slots))
      .constant("ranges", uint32_t(triangles.all.size() + triangles.overlay.size()))
      .constant("allRanges", uint32_t(triangles.all.size()))
      .constant("allGroups", groups(triangles.all))
      .constant("overlayGroups", groups(triangles.overlay))
      .constant("slices", (size * size + kSliceTexels - 1) / kSliceTexels);
  if (hasState_) choose.constant("movers", moversOf(ctx.frame()));
  choose.dispatch(1);
  Commands clear = ctx.use(clear_);
  clear.constant("slots", slots);
  if (hasState_) clear.constant("movers", movers.spheres).constant("poses", movers.poses);
  clear.dispatch(columns, rows);
}

void ShadowAtlas::record(RecordContext& ctx) {
  auto& mesh = ctx.memory<Simplified>();
  if (simplify_ && !mesh.uploaded) mesh = simplifyScene(ctx);
  if (ctx.firstFrame()) {
    VkClearColorValue nothing{};
    nothing.uint32[0] = scene::kParaboloidEmpty;
    ctx.clear("atlas", nothing);
  }
  const Ranges triangles = ranges(ctx);
  chooseSlots(ctx, triangles);
  const uint32_t slots = uint32_t(ctx.count("vpls")), all = uint32_t(triangles.all.size()),
                 steps = all + uint32_t(triangles.overlay.size());
  for (uint32_t round = 0; round < rounds(slots); ++round)
    for (uint32_t i = 0; i < all; ++i) recordStep(ctx, round, round * steps + i, triangles.all[i]);
  if (!staticMaps_) return;
  const uint32_t columns = std::min(slots, kGroupsPerRow), rows = (slots + kGroupsPerRow - 1) / kGroupsPerRow;
  ctx.use(compose_).constant("slots", slots).dispatch(columns, rows);
  for (uint32_t round = 0; round < rounds(slots); ++round)
    for (uint32_t i = all; i < steps; ++i)
      recordStep(ctx, round, round * steps + i, triangles.overlay[i - all]);
}

FOVEA_PASS(ShadowAtlas);

}  // namespace
}  // namespace fovea::passes
