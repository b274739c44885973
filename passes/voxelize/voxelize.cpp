// Surface voxels of the scene. Triangles are clipped to the cells that they overlap by a conservative test. Area,
// position, normal, reflectance and emission are summed in fixed point, so the order of the atomics has no effect. In
// the averages of position and normal, emissive surfaces weigh more (kEmissiveWeight).
// Cells are first marked and then numbered by a prefix sum, since sums for every cell of the grid would not fit.
// Static triangles are voxelised once; those of dynamic objects in every frame, into voxels of their own that hide
// the static voxel of their cell, so the two are never averaged.
#include <algorithm>

#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/voxelize/records.h"

namespace fovea::passes {
namespace {

using namespace graph;

using voxelize::kRow;
using voxelize::kScanBlock;
using voxelize::kSumWords;
using voxelize::State;

constexpr uint64_t kChunkGroupsOffset = offsetof(State, chunkGroups);
constexpr uint64_t kPhaseOffset = offsetof(State, phases), kPhaseBytes = sizeof(voxelize::Phase);

// The sides of this many voxels fill the 128 MiB that a storage buffer is guaranteed to hold.
constexpr int64_t kMostVoxels = 1 << 20;
constexpr int64_t kBatch = 1 << 19;  // voxels whose sums fit, at 224 bytes each

enum Phase : uint32_t { Static = 0, Dynamic = 1 };

class Voxelize : public Pass {
 public:
  static PassDeclaration declaration();
  void record(RecordContext& ctx) override;

 private:
  struct Triangles {
    uint32_t first, count;
  };
  static void addSteps(PassDeclaration& d);
  Commands visit(RecordContext& ctx, const char* step, Triangles triangles);
  void recordMarks(RecordContext& ctx, Triangles triangles);
  void recordAssignment(RecordContext& ctx, Phase phase);
  void recordSums(RecordContext& ctx, Phase phase, Triangles triangles, uint32_t first);
  void recordPhase(RecordContext& ctx, Phase phase, Triangles triangles);
};

PassDeclaration Voxelize::declaration() {
  PassDeclaration d(
      "voxelize",
      "surface voxels of the scene, with averages for both sides of every cell that contains surface");
  d.recorded();
  const SizeExpr r = parameter("resolution");
  const SizeExpr room = min(min(parameter("capacity") * r * r, r * r * r), kMostVoxels);
  d.output("voxels", "voxels", voxelOutput(r, room),
           "voxels of static surfaces, then those of dynamic objects")
      .keep(Lifetime::Scene);
  const SizeExpr words = ceilDiv(r * r * r, 32), triangles = environment("scene.triangles");
  const Usage both = Usage::StorageRead | Usage::StorageWrite;
  d.scratch("marks", buffer("uint", 4, words), both | Usage::TransferWrite,
            "one bit per cell: it contains surface")
      .keep(Lifetime::Scene);
  d.scratch("cells", buffer("VoxelCell", 8, room), both,
            "linear cell index of each voxel, and the index entry that it hides")
      .keep(Lifetime::Scene);
  d.scratch("state", buffer("VoxelizeState", sizeof(State)), both | Usage::Indirect,
            "counts of both phases, and indirect dispatches")
      .keep(Lifetime::Scene);
  d.scratch("chunks", buffer("uint", 4, triangles), both,
            "chunks of each triangle, later of all triangles before it");
  d.scratch("blocks", buffer("uint", 4, max(ceilDiv(words, kScanBlock), ceilDiv(triangles, kScanBlock))),
            both, "prefix sums over blocks");
  d.scratch("sums", buffer("uint", 4, min(room, kBatch) * (2 * kSumWords)), both,
            "sums of both sides of a batch of voxels");

  d.parameter("resolution", integer(128, 8, 512), "cells along the longest axis of the scene's bounds");
  d.parameter("capacity", integer(16, 1, 512),
              "largest number of voxels, in squares of the resolution, but at most 1,048,576; further ones "
              "are counted as overflow and omitted, the last ones in linear order first");
  d.counter("voxels", "voxels in the list");
  d.counter("static_voxels", "voxels of static surfaces");
  d.counter("overflow", "cells with surface for which there was no room");
  addSteps(d);
  return d;
}

void Voxelize::addSteps(PassDeclaration& d) {
  const auto step = [&](const char* shader, const char* name) -> StepSpec& {
    return d.step(shader).called(name);
  };
  step("voxelize/small.comp", "mark small").define("ACCUMULATE", 0);
  step("voxelize/scan_blocks.comp", "chunk blocks").define("MARKS", 0);
  step("voxelize/scan_tops.comp", "chunk tops").define("MARKS", 0).groups(1);
  step("voxelize/scan_chunks.comp", "chunk offsets");
  step("voxelize/large.comp", "mark large").define("ACCUMULATE", 0).indirect("state", kChunkGroupsOffset);
  step("voxelize/scan_blocks.comp", "mark blocks").define("MARKS", 1);
  step("voxelize/scan_tops.comp", "mark tops").define("MARKS", 1).groups(1);
  step("voxelize/assign.comp", "assign");
  step("voxelize/clear.comp", "clear");
  step("voxelize/small.comp", "sum small").define("ACCUMULATE", 1);
  // Sums are added by integer atomics, in any order.
  step("voxelize/large.comp", "sum large")
      .define("ACCUMULATE", 1)
      .indirect("state", kChunkGroupsOffset)
      .runTogether();
  step("voxelize/resolve.comp", "resolve");
  step("voxelize/restore.comp", "restore").indirect("state", kPhaseOffset + Dynamic * kPhaseBytes);
  step("voxelize/count.comp", "count").groups(1);
}

uint32_t blocksOf(uint32_t count, uint32_t size) { return (count + size - 1) / size; }

// Groups that do not fit into one row are split into several; shaders use groupIndex().
void dispatchGroups(Commands commands, uint32_t groups) {
  if (groups > 0) commands.dispatch(std::min(groups, kRow), blocksOf(groups, kRow));
}

Commands Voxelize::visit(RecordContext& ctx, const char* step, Triangles triangles) {
  Commands commands = ctx.step(step);
  commands.constant("firstTriangle", triangles.first).constant("triangleCount", triangles.count);
  return commands;
}

void Voxelize::recordMarks(RecordContext& ctx, Triangles triangles) {
  if (triangles.count == 0) return;
  const uint32_t blocks = blocksOf(triangles.count, kScanBlock);
  dispatchGroups(visit(ctx, "mark small", triangles), blocksOf(triangles.count, 64));
  dispatchGroups(ctx.step("chunk blocks").constant("count", triangles.count), blocks);
  ctx.step("chunk tops").constant("count", blocks).dispatch(1);
  dispatchGroups(ctx.step("chunk offsets").constant("count", triangles.count), blocks);
  visit(ctx, "mark large", triangles).dispatchIndirect("state", kChunkGroupsOffset);
}

void Voxelize::recordAssignment(RecordContext& ctx, Phase phase) {
  const uint32_t words = uint32_t(ctx.count("marks")), blocks = blocksOf(words, kScanBlock);
  dispatchGroups(ctx.step("mark blocks").constant("count", words), blocks);
  ctx.step("mark tops")
      .constant("count", blocks)
      .constant("phase", uint32_t(phase))
      .constant("room", uint32_t(ctx.count("cells")))
      .dispatch(1);
  dispatchGroups(ctx.step("assign")
                     .constant("count", words)
                     .constant("blockCount", blocks)
                     .constant("phase", uint32_t(phase)),
                 blocks);
}

void Voxelize::recordSums(RecordContext& ctx, Phase phase, Triangles triangles, uint32_t first) {
  const uint64_t groups = kPhaseOffset + phase * kPhaseBytes;
  const auto place = [&](Commands commands) {
    commands.constant("phase", uint32_t(phase))
        .constant("base", first)
        .constant("batch", uint32_t(ctx.count("sums") / (2 * kSumWords)));
    return commands;
  };
  place(ctx.step("clear")).dispatchIndirect("state", groups);
  dispatchGroups(place(visit(ctx, "sum small", triangles)), blocksOf(triangles.count, 64));
  place(visit(ctx, "sum large", triangles)).dispatchIndirect("state", kChunkGroupsOffset);
  place(ctx.step("resolve")).dispatchIndirect("state", groups);
}

void Voxelize::recordPhase(RecordContext& ctx, Phase phase, Triangles triangles) {
  recordMarks(ctx, triangles);
  recordAssignment(ctx, phase);
  if (triangles.count == 0) return;
  const uint32_t room = uint32_t(ctx.count("cells"));
  for (uint32_t first = 0; first < room; first += uint32_t(kBatch)) recordSums(ctx, phase, triangles, first);
}

void Voxelize::record(RecordContext& ctx) {
  const scene::Geometry::LightTriangles triangles = ctx.frame().geometry->light();
  const bool dynamic = triangles.firstMoving < triangles.end;
  bool& voxelized = ctx.memory<bool>();  // whether the static scene has been
  if (!voxelized) {
    recordPhase(ctx, Static, {triangles.first, triangles.firstMoving - triangles.first});
    if (dynamic) ctx.fill("marks", 0);
    voxelized = true;
  } else if (dynamic) {
    ctx.run("restore");
  }
  if (dynamic) recordPhase(ctx, Dynamic, {triangles.firstMoving, triangles.end - triangles.firstMoving});
  ctx.run("count");
}

FOVEA_PASS(Voxelize);

}  // namespace
}  // namespace fovea::passes
