#include "framework/graph/barriers.h"

#include <algorithm>
#include <utility>

#include "framework/graph/scratch.h"
#include "framework/graph/validate.h"

namespace fovea::graph {
namespace {

constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT;

// One pass touching one copy of one resource, all its ports taken together.
struct Touch {
  uint32_t resource;
  uint32_t slot;  // of the version read or made
  AccessScope scope;
  bool reads, writes, previous;
};

// What is known about one copy of a resource at a point of the frame.
struct State {
  VkPipelineStageFlags2 pendingStage = 0;  // a write that nothing has waited for yet
  VkAccessFlags2 pendingAccess = 0;
  VkPipelineStageFlags2 writeStage = 0;  // the last write, waited for or not
  VkAccessFlags2 writeAccess = 0;
  VkPipelineStageFlags2 readStage = 0;  // readers since, and layout changes made for them
  VkPipelineStageFlags2 seenStage = 0;  // where the contents are visible
  VkAccessFlags2 seenAccess = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

// All readers of one version.
struct ReadGroup {
  VkPipelineStageFlags2 stage = 0;
  VkAccessFlags2 access = 0;
  uint32_t served = 0;  // the last round in which a barrier has been placed for them
};

// Piece of a heap that no placement splits, and how its last occupant left it.
struct Segment {
  VkPipelineStageFlags2 stage = 0;
  VkAccessFlags2 access = 0;
};

class Planner {
 public:
  Planner(const BoundGraph& graph, const Schedule& schedule, const std::vector<Interval>& intervals,
          Plan& plan)
      : graph_(graph), schedule_(schedule), intervals_(intervals), plan_(plan), levels_(schedule.levels()) {}

  void run() {
    collectTouches();
    makeSegments();
    current_.assign(graph_.resources.size(), {});
    bool history = false;
    for (const BoundResource& r : graph_.resources) history |= r.history;
    if (history) previous_.assign(graph_.resources.size(), {});
    markLasting();
    // Copies that change places need two rounds until both carry the state of a whole frame.
    for (int warmUp = history ? 3 : 1; warmUp > 0; --warmUp) settle();
    plan_.startLayout.assign(graph_.resources.size(), {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_UNDEFINED});
    plan_.endLayout.assign(graph_.resources.size(), VK_IMAGE_LAYOUT_UNDEFINED);
    for (size_t r = 0; r < graph_.resources.size(); ++r) {
      if (isTransient(graph_.resources[r])) continue;
      plan_.startLayout[r][0] = current_[r].layout;
      if (graph_.resources[r].history) plan_.startLayout[r][1] = previous_[r].layout;
    }
    record();
    for (size_t r = 0; r < graph_.resources.size(); ++r) {
      const bool swapped = graph_.resources[r].history;
      plan_.endLayout[r] = swapped ? previous_[r].layout : current_[r].layout;
    }
  }

 private:
  void collectTouches();
  void makeSegments();
  void markLasting();
  void settle();
  void record();
  void endFrame();
  template <bool record>
  BarrierBatch readOutputs();
  template <bool record>
  void touch(const Touch& t, BarrierBatch& batch);
  template <bool record>
  void read(const Touch& t, State& state, const ReadGroup& group, BarrierBatch& batch);
  template <bool record>
  void write(const Touch& t, State& state, BarrierBatch& batch);
  void occupy(uint32_t resource, VkPipelineStageFlags2& stage, VkAccessFlags2& access) const;
  void leave(uint32_t resource);

  static void global(BarrierBatch& batch, VkPipelineStageFlags2 srcStage, VkAccessFlags2 srcAccess,
                     VkPipelineStageFlags2 dstStage, VkAccessFlags2 dstAccess) {
    batch.srcStage |= srcStage;
    batch.srcAccess |= srcAccess;
    batch.dstStage |= dstStage;
    batch.dstAccess |=
        srcAccess ? dstAccess : 0;  // without a write to wait for there is nothing to make visible
  }

  const BoundGraph& graph_;
  const Schedule& schedule_;
  const std::vector<Interval>& intervals_;
  Plan& plan_;
  const uint32_t levels_;
  uint32_t round_ = 0;  // frames followed so far
  detail::Scratch scratch_;
  detail::ScratchVector<Touch> touches_{scratch_};
  detail::ScratchVector<uint32_t> touchFirst_{scratch_};  // per level
  detail::ScratchVector<ReadGroup> groups_{scratch_};     // by slot
  detail::ScratchVector<State> current_{scratch_}, previous_{scratch_};
  detail::ScratchVector<uint32_t> placementOf_{scratch_};  // per resource, kNone
  detail::ScratchVector<std::pair<uint32_t, uint32_t>> placementSegments_{
      scratch_};  // per placement: [first, last)
  detail::ScratchVector<Segment> segments_{scratch_};
  detail::ScratchVector<uint32_t> leaving_{scratch_},
      leavingFirst_{scratch_};                        // resources by the last level of their life
  detail::ScratchVector<uint8_t> lasting_{scratch_};  // per resource
};

void Planner::collectTouches() {
  groups_.assign(graph_.slots, {});
  struct Seen {
    uint32_t pass = kNone, touch = 0;
  };
  detail::ScratchVector<Seen> seen(graph_.resources.size() * 2, scratch_);
  struct Known {
    PassKind kind = PassKind::Host;
    Usage usage = Usage::None;
    bool reads = false;
    AccessScope scope;
  };
  Known knownScopes[2];  // the latest reader's and the latest writer's: most passes are alike
  touchFirst_.assign(levels_ + 1, 0);
  touches_.reserve(schedule_.order.size() * 2);
  for (uint32_t l = 0; l < levels_; ++l) {
    touchFirst_[l] = static_cast<uint32_t>(touches_.size());
    for (uint32_t i = schedule_.levelFirst[l]; i < schedule_.levelFirst[l + 1]; ++i) {
      const uint32_t p = schedule_.order[i];
      const PassKind kind = graph_.passes[p].declaration->kind;
      for (const Access& a : graph_.passes[p].accesses) {
        Known& known = knownScopes[a.writes];
        if (known.kind != kind || known.usage != a.usage || known.reads != a.reads)
          known = {kind, a.usage, a.reads,
                   accessScope(kind, a.usage, a.reads, a.writes,
                               isDepthFormat(graph_.resources[a.resource].desc.format))};
        const AccessScope& scope = known.scope;
        if (!a.writes) {
          groups_[a.slot].stage |= scope.stage;
          groups_[a.slot].access |= scope.access;
        }
        Seen& s = seen[a.resource * 2 + a.previous];
        if (s.pass != p) {
          s = {p, static_cast<uint32_t>(touches_.size())};
          touches_.emplace_back(a.resource, a.slot, AccessScope{scope.stage, scope.access, a.layout}, a.reads,
                                a.writes, a.previous);
          continue;
        }
        Touch& t = touches_[s.touch];
        t.scope.stage |= scope.stage;
        t.scope.access |= scope.access;
        t.reads |= a.reads;
        t.writes |= a.writes;
      }
    }
  }
  touchFirst_[levels_] = static_cast<uint32_t>(touches_.size());
}

void Planner::makeSegments() {
  placementOf_.assign(graph_.resources.size(), kNone);
  // Few boundaries are distinct where memory is shared, and neighbours meet in one.
  detail::ScratchVector<uint64_t> bounds(scratch_);  // heap and offset, ascending
  const auto add = [&](uint64_t bound) {
    if (bounds.empty() || bound > bounds.back()) return bounds.push_back(bound);
    const auto at = std::lower_bound(bounds.begin(), bounds.end(), bound);
    if (*at != bound) bounds.insert(at, bound);
  };
  for (uint32_t i = 0; i < plan_.placements.size(); ++i) {
    const Placement& p = plan_.placements[i];
    placementOf_[p.resource] = i;
    add(uint64_t(p.heap) << 56 | p.offset);
    add(uint64_t(p.heap) << 56 | (p.offset + p.bytes));
  }
  const auto segmentAt = [&](uint64_t bound, uint32_t guess) {
    if (guess < bounds.size() && bounds[guess] == bound) return guess;
    return static_cast<uint32_t>(std::lower_bound(bounds.begin(), bounds.end(), bound) - bounds.begin());
  };
  placementSegments_.reserve(plan_.placements.size());
  uint32_t next = 0;  // placements often lie one behind the other, in pieces that nothing splits
  for (const Placement& p : plan_.placements) {
    const uint32_t first = segmentAt(uint64_t(p.heap) << 56 | p.offset, next);
    next = segmentAt(uint64_t(p.heap) << 56 | (p.offset + p.bytes), first + 1);
    placementSegments_.emplace_back(first, next);
  }
  segments_.assign(bounds.size(), {});
  // Resources by the last level of their life; outputs leave after the end of the frame.
  leavingFirst_.assign(levels_ + 2, 0);
  for (const Placement& p : plan_.placements) ++leavingFirst_[intervals_[p.resource].last + 1];
  for (uint32_t l = 1; l < levels_ + 2; ++l) leavingFirst_[l] += leavingFirst_[l - 1];
  detail::ScratchVector<uint32_t> at(leavingFirst_.begin(), leavingFirst_.end(), scratch_);
  leaving_.resize(plan_.placements.size());
  for (const Placement& p : plan_.placements) leaving_[at[intervals_[p.resource].last]++] = p.resource;
}

// How a frame leaves a resource matters to the next one when its contents stay, or when it is the last to
// lie in some piece of memory.
void Planner::markLasting() {
  lasting_.assign(graph_.resources.size(), 0);
  detail::ScratchVector<uint32_t> last(segments_.size(), kNone, scratch_);
  for (const uint32_t r : leaving_) {
    const auto [first, end] = placementSegments_[placementOf_[r]];
    for (uint32_t s = first; s < end; ++s) last[s] = r;
  }
  for (const uint32_t r : last)
    if (r != kNone) lasting_[r] = 1;
  for (size_t r = 0; r < graph_.resources.size(); ++r)
    if (!isTransient(graph_.resources[r])) lasting_[r] = 1;
}

void Planner::occupy(uint32_t resource, VkPipelineStageFlags2& stage, VkAccessFlags2& access) const {
  const auto [first, last] = placementSegments_[placementOf_[resource]];
  for (uint32_t s = first; s < last; ++s) {
    stage |= segments_[s].stage;
    access |= segments_[s].access;
  }
}

// Whoever comes next waits for this occupant, which itself waited for the one before.
void Planner::leave(uint32_t resource) {
  const auto [first, last] = placementSegments_[placementOf_[resource]];
  const State& state = current_[resource];
  const Segment left{state.pendingStage | state.readStage, state.pendingAccess};
  for (uint32_t s = first; s < last; ++s) segments_[s] = left;
}

// A frame without writing barriers: only states that last beyond it are followed. What a resource finds in
// its memory matters to barriers alone, so all may leave at the end.
void Planner::settle() {
  ++round_;
  BarrierBatch unrecorded;
  for (const Touch& t : touches_)
    if (lasting_[t.resource]) touch<false>(t, unrecorded);
  readOutputs<false>();
  for (const uint32_t r : leaving_)
    if (lasting_[r]) leave(r);
  endFrame();
}

void Planner::record() {
  ++round_;
  plan_.levels.reserve(levels_);
  for (uint32_t l = 0; l < levels_; ++l) {
    Level& level = plan_.levels.emplace_back();
    level.before.images.reserve(touchFirst_[l + 1] - touchFirst_[l]);
    for (uint32_t i = touchFirst_[l]; i < touchFirst_[l + 1]; ++i) touch<true>(touches_[i], level.before);
    for (uint32_t i = leavingFirst_[l]; i < leavingFirst_[l + 1]; ++i) leave(leaving_[i]);
    level.passes.assign(schedule_.order.begin() + schedule_.levelFirst[l],
                        schedule_.order.begin() + schedule_.levelFirst[l + 1]);
  }
  plan_.end = readOutputs<true>();
  endFrame();
}

// History's copies change places.
void Planner::endFrame() {
  for (size_t r = 0; r < previous_.size(); ++r)
    if (graph_.resources[r].history) std::swap(current_[r], previous_[r]);
}

template <bool record>
BarrierBatch Planner::readOutputs() {
  BarrierBatch batch;
  const ReadGroup transfer{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
  detail::ScratchVector<uint8_t> done(graph_.resources.size(), 0, scratch_);
  for (const BoundOutput& output : graph_.outputs) {
    if (std::exchange(done[output.resource], 1)) continue;
    Touch t{output.resource, 0, {}, true, false, false};
    t.scope.layout = graph_.resources[output.resource].desc.kind == ResourceKind::Image
                         ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
                         : VK_IMAGE_LAYOUT_UNDEFINED;
    read<record>(t, current_[output.resource], transfer, batch);
  }
  return batch;
}

template <bool record>
void Planner::touch(const Touch& t, BarrierBatch& batch) {
  if (t.scope.stage == 0) return;  // only its size is used
  State& state = t.previous ? previous_[t.resource] : current_[t.resource];
  if (t.writes) return write<record>(t, state, batch);
  ReadGroup& group = groups_[t.slot];
  if (std::exchange(group.served, round_) != round_) read<record>(t, state, group, batch);
}

template <bool record>
void Planner::read(const Touch& t, State& state, const ReadGroup& group, BarrierBatch& batch) {
  const bool image = graph_.resources[t.resource].desc.kind == ResourceKind::Image;
  if (image && state.layout != t.scope.layout) {
    if (record)
      batch.images.emplace_back(t.resource, t.previous, state.writeStage | state.readStage, group.stage,
                                state.writeAccess, group.access, state.layout, t.scope.layout);
    // The change of layout is itself a write, which only this barrier's second scope has waited for; who
    // comes later waits for that scope and for the write before it.
    state.writeStage |= group.stage;
    state.seenStage = group.stage;
    state.seenAccess = group.access;
    state.readStage = 0;
    state.layout = t.scope.layout;
  } else if (group.stage & ~state.seenStage || group.access & ~state.seenAccess) {
    // Readers of another group may have waited for the write; these have not.
    if (record && state.writeStage)
      global(batch, state.writeStage, state.writeAccess, group.stage, group.access);
    state.seenStage |= group.stage;
    state.seenAccess |= group.access;
  }
  state.pendingStage = 0;
  state.pendingAccess = 0;
  state.readStage |= group.stage;
}

template <bool record>
void Planner::write(const Touch& t, State& state, BarrierBatch& batch) {
  const BoundResource& resource = graph_.resources[t.resource];
  const bool first = !t.reads && isTransient(resource);
  VkPipelineStageFlags2 source = 0;
  VkAccessFlags2 sourceAccess = 0;
  if (first) {
    occupy(t.resource, source, sourceAccess);
    state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  } else {
    source = state.pendingStage | state.readStage;
    sourceAccess = state.pendingAccess;
    if (t.reads) {
      source |= state.writeStage;
      sourceAccess |= state.writeAccess;
    }
  }
  const bool change = resource.desc.kind == ResourceKind::Image && state.layout != t.scope.layout;
  // An image's barrier speaks of that image only, so writes of other occupants of its memory need the global
  // one.
  if (record && source && (!change || (first && sourceAccess)))
    global(batch, source, sourceAccess, t.scope.stage, t.scope.access);
  if (change && record)
    batch.images.emplace_back(t.resource, t.previous, source, t.scope.stage, sourceAccess, t.scope.access,
                              state.layout, t.scope.layout);
  state.pendingStage = state.writeStage = t.scope.stage;
  state.pendingAccess = state.writeAccess = t.scope.access & kWrites;
  state.readStage = state.seenStage = 0;
  state.seenAccess = 0;
  state.layout = t.scope.layout;
}

}  // namespace

void placeBarriers(const BoundGraph& graph, const Schedule& schedule, const std::vector<Interval>& intervals,
                   Plan& plan) {
  Planner(graph, schedule, intervals, plan).run();
}

}  // namespace fovea::graph
