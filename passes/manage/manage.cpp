// The list of VPLs from frame to frame: which ones are reused (Eq. 1), which candidates are added (Algorithm 2), and
// in which slots. A VPL keeps its slot for its whole life. Every decision is made in integers and every sort is
// stable, so the list equals that of the serial algorithm bit for bit (tests/passes/manage_reference.h).
#include <algorithm>
#include <cmath>
#include <string>

#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/manage/records.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kMost = 65536;  // limit of slots and of candidates; keeps sums of importance below 2^57

class Manage : public Pass {
 public:
  static PassDeclaration declaration();
};

void addRequirements(PassDeclaration& d) {
  d.require(atMost(countOf("candidates"), int(kMost)), "there are more than 65536 candidates",
            "lower the `count` of the pass that finds them");
  d.require(same(countOf("vpls"), parameter("count")), "`vpls` has another number of slots than `count`",
            "set `count` to the slots of the list that comes in");
  d.require(same(countOf("vpl_importance"), parameter("count")),
            "`vpl_importance` has another number of elements than there are slots",
            "wire the importances of `vpls`");
  d.require(same(countOf("candidate_importance"), countOf("candidates")),
            "`candidate_importance` has another number of elements than there are candidates",
            "wire the importances of `candidates`");
  d.require(wired("candidate_importance") || is("placement", "light"),
            "candidates compete by importance, and theirs is not known",
            "wire `candidate_importance`, or set placement to `light`");
  d.require(wired("change") || atMost(parameter("change_turnover"), 0),
            "parameter `change_turnover` needs the input `change`",
            "wire `change` to eye-paths, or set change_turnover to 0");
}

void addScratch(PassDeclaration& d) {
  const Usage both = Usage::StorageRead | Usage::StorageWrite;
  const SizeExpr slots = parameter("count"), candidates = countOf("candidates"),
                 more = max(slots, candidates);
  d.scratch("state", buffer("ManageState", sizeof(manage::ManageState)), both | Usage::TransferWrite,
            "lengths of the lists");
  d.scratch("slot_records", buffer("SlotRecord", sizeof(manage::SlotRecord), slots), both,
            "importance, flags, cell and sort key of each slot");
  d.scratch("candidate_records", buffer("uvec2", 8, candidates), both,
            "importance and cell of each candidate");
  d.scratch("sources", buffer("uint", 4, slots), both, "source of the new content of each slot");
  d.scratch("lists", buffer("uvec2", 8, SizeExpr(2) * (slots + candidates + more)), both, "lists to sort");
  d.scratch("attempts", buffer("uint", 4, more), both, "entries that Algorithm 2 tries to add, in order");
  d.scratch("added", buffer("uint", 4, candidates), both, "candidates added, in order");
  d.scratch("density", buffer("uint", 4, manage::kCells), both | Usage::TransferWrite,
            "number of reused VPLs in each cell");
  d.scratch("segments", buffer("uint", 4, manage::kCells), both, "first of the sorted attempts in each cell");
}

// Parameters as the shaders want them.
void setConstants(const RecordContext& ctx, Commands& commands) {
  const Parameters& p = ctx.parameters();
  const scene::Geometry& geometry = *ctx.frame().geometry;
  const bool empty = geometry.empty();
  const glm::vec3 origin = empty ? glm::vec3(0.0f) : geometry.boundsMin;
  const float diagonal = empty ? 1.0f : std::max(glm::length(geometry.boundsMax - geometry.boundsMin), 1e-3f);
  const uint32_t slots = uint32_t(ctx.count("list"));
  const uint32_t limit = p.integer("limit") > 0 ? std::min(uint32_t(p.integer("limit")), slots) : slots;
  const bool light = p.text("placement") == "light";
  const uint32_t keep = p.integer("keep") > 0 ? uint32_t(p.integer("keep")) : light ? 0u : limit;
  commands.constant("gridOrigin", origin)
      .constant("cellsPerMetre", 1.0f / (float(p.real("cell")) * diagonal))
      .constant("slots", slots)
      .constant("candidateCount", uint32_t(ctx.count("candidates")))
      .constant("listLimit", limit)
      .constant("keepCount", keep)
      .constant("mostRejected", uint32_t(std::ceil(p.real("turnover") * slots)))
      .constant("changeTurnover", float(p.real("change_turnover")))
      .constant("contested", uint32_t(std::ceil(p.real("saccade_turnover") * ctx.frame().saccade * slots)))
      .constant("randomShare1024ths", uint32_t(std::lround(1024.0 * p.real("random_share"))))
      .constant("lightFloor64ths", uint32_t(std::lround(64.0 * p.real("light_floor"))))
      .constant("densityConstant64ths", uint32_t(std::lround(64.0 * p.real("density_constant"))));
}

void addSteps(PassDeclaration& d) {
  const auto step = [&](const char* shader) -> StepSpec& {
    StepSpec& added = d.step(shader);
    added.frameConstants.emplace_back(setConstants);
    return added;
  };
  d.fill("state", 0);
  d.fill("density", 0);
  step("manage/accept.comp")
      .define("RATED", wired("candidate_importance"))
      .define("CHANGE", wired("change"))
      .threads(max(countOf("list"), countOf("candidates")));
  step("manage/reuse.comp").define("CHANGE", wired("change")).groups(1);
  step("manage/thin.comp").groups(1);
  step("manage/order.comp").groups(2);
  step("manage/choose.comp").groups(1);
  step("manage/write.comp")
      .define("RATED", wired("candidate_importance"))
      .define("CHANGE", wired("change"))
      .threads(countOf("list"));
}

PassDeclaration Manage::declaration() {
  PassDeclaration d("manage",
                    "VPL management: which VPLs are kept, which candidates become VPLs, and in which slots");
  d.input("candidates", candidateBuffer(), Usage::TexelRead,
          "candidate VPLs; attempts that hit nothing are skipped");
  d.input(
       "candidate_importance", buffer("float", 4), Usage::TexelRead,
       "I of each candidate, in [0, 1]; not needed for `placement` `light`, and without it Eq. 1 keeps new "
       "VPLs in their second frame")
      .makeOptional();
  d.input("vpl_importance", buffer("float", 4), Usage::TexelRead,
          "I of the VPL in each slot in this frame, in [0, 1]");
  d.input("vpls", vplStateBuffer(), Usage::TexelRead,
          "VPL list of the previous frame, updated for motion; it must have `count` slots");
  d.input("change", changeBuffer(), Usage::TexelRead,
          "z: share of the known light that is outdated, from 0 to 1 (pass eye-paths)")
      .makeOptional();
  d.output("list", vplStateBuffer(parameter("count")), Usage::StorageWrite,
           "VPL list of this frame; a VPL that is kept stays in its slot and takes its new importance, a new "
           "one has life 1 and its importance also as its previous importance");
  addScratch(d);

  // The list returns through the pass that updates it, so its length is a parameter and is not taken from the input.
  d.parameter("count", integer(1000, 1, kMost), "number of slots, the most VPLs in the list (N)");
  d.parameter(
      "reuse", choice("linear", {"linear", "cosine", "random"}),
      "which VPLs are reused without competing (Eq. 1), where C is the ratio of the new importance to "
      "the previous one; linear: with probability min(C, 1); cosine: with probability 1 - cos(pi/2 "
      "min(C, 1)); random: the share `random_share`, or as many as linear, chosen at random");
  d.parameter("random_share", real(0, 0, 1, "VPLs' share"),
              "for `reuse` `random`, share of the VPLs that is reused, rounded to 1/1024; 0 means as many as "
              "`linear` would reuse");
  d.parameter("keep", integer(0, 0, kMost),
              "candidates left after thinning (K), each kept with probability min(1, K I / sum I); 0 means "
              "the number `limit`, or for `placement` `light` the number of free slots");
  d.parameter("placement", choice("importance", {"importance", "light"}),
              "how candidates are chosen; importance: by Algorithm 2; light: as many as there are free "
              "slots, in proportion to their direct light (systematic resampling), since eye paths already "
              "find them in proportion to importance; `order` and thinning by importance then do not apply, "
              "and VPLs that failed Eq. 1 are not reconsidered");
  d.parameter(
      "light_floor", real(0.25, 0, 16, "means of the candidates' light"),
      "for `placement` `light`, light added to that of every candidate to account for further bounces");
  d.parameter("turnover", real(1, 0, 1, "slots' share"),
              "most VPLs deleted per frame for failing Eq. 1 (rounded up); if more fail, the least important "
              "are deleted and the others are tested against their former importance again");
  d.parameter("change_turnover", real(0, 0, 1, "slots' share"),
              "times the square of the outdated share that `change` reports: at least this many of the least "
              "important VPLs lose their place as if they had failed Eq. 1, since they were chosen by other "
              "light; may be more than `turnover`");
  d.parameter("saccade_turnover", real(0, 0, 1, "slots' share"),
              "least important VPLs that lose their place in the frame in which the gaze has jumped, as if "
              "they had failed Eq. 1; their number falls to 0 over the next 8 frames");
  d.parameter("order", choice("literal", {"literal", "fixed"}),
              "variant of Algorithm 2; literal: as printed; fixed: when more old VPLs failed Eq. 1 than "
              "there are candidates, the best of those that the loop never reaches are tried as well");
  d.parameter("limit", integer(0, 0, kMost),
              "most VPLs in the list (N_MAX), no more than the slots; 0 means all slots");
  d.parameter("max_density", integer(0, 0, kMost),
              "a cell with this many VPLs accepts no more (D_MAX); 0 means max(2, 3 N_MAX / number of "
              "cells that hold a VPL or candidate)");
  d.parameter(
      "density_constant", real(1, 0.5, 1024),
      "CONST in the weight I + 1 / (density + CONST), rounded to 1/64; smaller values spread the VPLs more");
  d.parameter("cell", real(1.0 / 48, 1.0 / 64, 1, "scene diagonals"),
              "edge length of a cell of the density grid");

  addRequirements(d);
  d.counter("kept", "old VPLs kept");
  d.counter("deleted", "old VPLs deleted");
  d.counter("added", "candidates that become VPLs");
  d.counter("candidates", "candidates before thinning");
  d.counter("rejected", "old VPLs that failed the test of Eq. 1");
  d.counter("alive", "VPLs in the list");
  d.counter("dense", "old VPLs and candidates refused because their cell was full");
  addSteps(d);
  return d;
}

FOVEA_PASS(Manage);

}  // namespace
}  // namespace fovea::passes
