#include "framework/graph/compile/barriers.h"

#include <algorithm>
#include <span>
#include <utility>

#include "framework/graph/compile/scratch.h"

namespace fovea::graph {
namespace {

constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT;

// One pass accessing one copy of one resource through all its ports together.
struct Touch {
  uint32_t resource;
  uint32_t slot;  // of the version read or made
  AccessScope scope;
  bool reads, writes, previous;
};

// What is known about one copy of a resource at some point of the frame.
struct State {
  VkPipelineStageFlags2 pendingStage = 0;  // a write that nothing has waited for yet
  VkAccessFlags2 pendingAccess = 0;
  VkPipelineStageFlags2 writeStage = 0;  // the last write, waited for or not
  VkAccessFlags2 writeAccess = 0;
  VkPipelineStageFlags2 readStage = 0;  // readers since then, and layout changes made for them
  VkPipelineStageFlags2 seenStage = 0;  // where the contents are visible
  VkAccessFlags2 seenAccess = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

// All readers of one version.
struct ReadGroup {
  VkPipelineStageFlags2 stage = 0;
  VkAccessFlags2 access = 0;
  uint32_t served = 0;  // the last round in which a barrier was placed for them
};

// A piece of a heap that no placement splits, and the state in which its last occupant left it.
struct Segment {
  VkPipelineStageFlags2 stage = 0;
  VkAccessFlags2 access = 0;
};

struct SegmentRange {
  uint32_t first = 0, end = 0;
};

class Planner {
 public:
  Planner(const BoundGraph& graph, const Schedule& schedule, const std::vector<Interval>& intervals,
          Plan& plan)
      : graph_(graph), schedule_(schedule), intervals_(intervals), plan_(plan), levels_(schedule.levels()) {}

  void run() {
    collectTouches();
    makeSegments();
    markLasting();
    current_ = scratch_.array<State>(graph_.resources.size());
    if (history_) previous_ = scratch_.array<State>(graph_.resources.size());
    // Copies that swap need two rounds until both carry the state of a whole frame.
    for (int warmUp = history_ ? 3 : 1; warmUp > 0; --warmUp) settle();
    plan_.startLayout.assign(graph_.resources.size(), {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_UNDEFINED});
    for (const uint32_t r : kept_) {
      plan_.startLayout[r][0] = current_[r].layout;
      if (graph_.resources[r].history) plan_.startLayout[r][1] = previous_[r].layout;
    }
    record();
    plan_.endLayout.reserve(graph_.resources.size());
    for (const State& state : current_) plan_.endLayout.push_back(state.layout);
    for (const uint32_t r : kept_)
      if (graph_.resources[r].history) plan_.endLayout[r] = previous_[r].layout;
  }

 private:
  void collectTouches();
  void makeSegments();
  void markLasting();
  void settle();
  void record();
  void endFrame();
  // Without a batch, these only follow states.
  void readOutputs(BarrierBatch* batch);
  void touch(const Touch& t, BarrierBatch* batch);
  void read(const Touch& t, State& state, const ReadGroup& group, BarrierBatch* batch);
  void write(const Touch& t, State& state, BarrierBatch* batch);
  void occupy(uint32_t resource, VkPipelineStageFlags2& stage, VkAccessFlags2& access) const;
  Segment leftBy(uint32_t resource) const;
  void leave(uint32_t resource, uint32_t level) {
    if (intervals_[resource].last != level) return;
    const auto [first, end] = segmentsOf_[resource];
    for (uint32_t s = first; s < end; ++s) segments_[s] = leftBy(resource);
  }

  static void global(BarrierBatch& batch, VkPipelineStageFlags2 srcStage, VkAccessFlags2 srcAccess,
                     VkPipelineStageFlags2 dstStage, VkAccessFlags2 dstAccess) {
    batch.srcStage |= srcStage;
    batch.srcAccess |= srcAccess;
    batch.dstStage |= dstStage;
    batch.dstAccess |=
        srcAccess ? dstAccess : 0;  // without a write to wait for, there is nothing to make visible
  }

  const BoundGraph& graph_;
  const Schedule& schedule_;
  const std::vector<Interval>& intervals_;
  Plan& plan_;
  const uint32_t levels_;
  uint32_t round_ = 0;  // frames followed so far
  detail::Scratch scratch_;
  detail::ScratchVector<Touch> touches_{scratch_};
  std::span<uint32_t> touchFirst_;  // per level
  std::span<ReadGroup> groups_;     // by slot
  std::span<State> current_, previous_;
  std::span<SegmentRange> segmentsOf_;  // per resource; empty where nothing is shared
  std::span<Segment> segments_;
  std::span<uint32_t> latest_;                      // per segment: its occupant at the end of a frame
  detail::ScratchVector<uint32_t> kept_{scratch_};  // resources that are not transient
  std::span<uint8_t> lasting_;                      // per resource
  bool history_ = false;                            // a resource has two copies
};

void Planner::collectTouches() {
  groups_ = scratch_.array<ReadGroup>(graph_.slots);
  struct Seen {
    uint32_t pass = kNone, touch = 0;
  };
  const std::span<Seen> seen = scratch_.array<Seen>(graph_.resources.size() * 2);
  struct Known {
    uint32_t key = kNone;
    AccessScope scope;
  };
  Known knownScopes[2];  // of the latest reader and the latest writer, since most passes are alike
  touchFirst_ = scratch_.array<uint32_t>(levels_ + 1);
  touches_.reserve(schedule_.order.size() * 2);
  uint32_t count = 0;  // number of touches
  for (uint32_t l = 0; l < levels_; ++l) {
    touchFirst_[l] = count;
    for (uint32_t i = schedule_.levelFirst[l]; i < schedule_.levelFirst[l + 1]; ++i) {
      const uint32_t p = schedule_.order[i];
      const PassKind kind = graph_.passes[p].declaration->kind;
      for (const Access& a : graph_.passes[p].accesses) {
        Known& known = knownScopes[a.writes];
        const uint32_t key = uint32_t(a.usage) << 8 | uint32_t(kind) << 1 | uint32_t(a.reads);
        if (known.key != key) known = {key, accessScope(kind, a.usage, a.reads, a.writes)};
        const AccessScope& scope = known.scope;
        if (!a.writes) {
          groups_[a.slot].stage |= scope.stage;
          groups_[a.slot].access |= scope.access;
        }
        Seen& s = seen[a.resource * 2 + a.previous];
        if (s.pass != p) {
          s.pass = p;
          s.touch = count++;
          touches_.push_back({a.resource, a.slot, AccessScope{scope.stage, scope.access, a.layout}, a.reads,
                              a.writes, a.previous});
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
  touchFirst_[levels_] = count;
}

void Planner::makeSegments() {
  // Few boundaries are distinct where memory is shared, and neighbouring placements share one.
  detail::ScratchVector<uint64_t> bounds(scratch_);  // heap and offset, ascending
  // Placements often follow each other in pieces that nothing splits; `guess` is where to look first.
  const auto find = [&](uint64_t bound, uint32_t guess) {
    if (guess < bounds.size() && bounds[guess] == bound) return guess;
    return static_cast<uint32_t>(std::lower_bound(bounds.begin(), bounds.end(), bound) - bounds.begin());
  };
  bool moved = false;  // a bound was shifted by one inserted before it
  const auto add = [&](uint64_t bound, uint32_t guess) {
    const uint32_t at = find(bound, guess);
    if (at == bounds.size()) {
      bounds.push_back(bound);
    } else if (bounds[at] != bound) {
      bounds.insert(bounds.begin() + at, bound);
      moved = true;
    }
    return at;
  };
  segmentsOf_ = scratch_.array<SegmentRange>(graph_.resources.size());
  const auto number = [&](const auto& numberOf) {
    uint32_t next = 0;
    for (const Placement& p : plan_.placements) {
      const uint32_t first = numberOf(uint64_t(p.heap) << 56 | p.offset, next);
      next = numberOf(uint64_t(p.heap) << 56 | (p.offset + p.bytes), first + 1);
      segmentsOf_[p.resource] = {first, next};
    }
  };
  number(add);
  if (moved) number(find);
  segments_ = scratch_.array<Segment>(bounds.size());
}

// The state in which a frame leaves a resource matters to the next frame if the contents stay or if the resource is
// the last occupant of some piece of memory.
void Planner::markLasting() {
  lasting_ = scratch_.array<uint8_t>(graph_.resources.size());
  for (uint32_t r = 0; r < graph_.resources.size(); ++r) {
    if (isTransient(graph_.resources[r])) continue;
    history_ |= graph_.resources[r].history;
    kept_.push_back(r);
    lasting_[r] = 1;
  }
  latest_ = scratch_.array(segments_.size(), kNone);
  for (const Placement& p : plan_.placements) {
    const auto [first, end] = segmentsOf_[p.resource];
    for (uint32_t s = first; s < end; ++s) {
      uint32_t& latest = latest_[s];
      if (latest == kNone || intervals_[latest].last < intervals_[p.resource].last) latest = p.resource;
    }
  }
  for (const uint32_t r : latest_)
    if (r != kNone) lasting_[r] = 1;
}

void Planner::occupy(uint32_t resource, VkPipelineStageFlags2& stage, VkAccessFlags2& access) const {
  const auto [first, end] = segmentsOf_[resource];
  for (uint32_t s = first; s < end; ++s) {
    stage |= segments_[s].stage;
    access |= segments_[s].access;
  }
}

// The next occupant waits for this one, which itself waited for the one before.
Segment Planner::leftBy(uint32_t resource) const {
  const State& state = current_[resource];
  return {state.pendingStage | state.readStage, state.pendingAccess};
}

// Follows a frame without writing barriers, and only states that last beyond it. What a resource finds in its memory
// matters to barriers alone, so all resources may leave at the end.
void Planner::settle() {
  ++round_;
  for (const Touch& t : touches_)
    if (lasting_[t.resource]) touch(t, nullptr);
  readOutputs(nullptr);
  for (uint32_t s = 0; s < segments_.size(); ++s)
    if (latest_[s] != kNone) segments_[s] = leftBy(latest_[s]);
  endFrame();
}

void Planner::record() {
  ++round_;
  plan_.levels.reserve(levels_);
  for (uint32_t l = 0; l < levels_; ++l) {
    Level& level = plan_.levels.emplace_back();
    level.before.images.reserve(touchFirst_[l + 1] - touchFirst_[l]);
    for (uint32_t i = touchFirst_[l]; i < touchFirst_[l + 1]; ++i) touch(touches_[i], &level.before);
    for (uint32_t i = touchFirst_[l]; i < touchFirst_[l + 1]; ++i) leave(touches_[i].resource, l);
    const uint32_t first = schedule_.levelFirst[l], end = schedule_.levelFirst[l + 1];
    level.passes.reserve(end - first);
    for (uint32_t i = first; i < end; ++i) level.passes.push_back(schedule_.order[i]);
  }
  readOutputs(&plan_.end);
  endFrame();
}

// The copies of history resources swap.
void Planner::endFrame() {
  for (size_t r = 0; r < previous_.size(); ++r)
    if (graph_.resources[r].history) std::swap(current_[r], previous_[r]);
}

void Planner::readOutputs(BarrierBatch* batch) {
  const ReadGroup transfer{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
  const std::span<uint8_t> done = scratch_.array<uint8_t>(graph_.resources.size());
  for (const BoundOutput& output : graph_.outputs) {
    if (std::exchange(done[output.resource], 1)) continue;
    Touch t{output.resource, 0, {}, true, false, false};
    t.scope.layout = graph_.resources[output.resource].desc.kind == ResourceKind::Image
                         ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
                         : VK_IMAGE_LAYOUT_UNDEFINED;
    read(t, current_[output.resource], transfer, batch);
  }
}

void Planner::touch(const Touch& t, BarrierBatch* batch) {
  if (t.scope.stage == 0) return;  // only its size is used
  State& state = t.previous ? previous_[t.resource] : current_[t.resource];
  if (t.writes) return write(t, state, batch);
  ReadGroup& group = groups_[t.slot];
  if (std::exchange(group.served, round_) != round_) read(t, state, group, batch);
}

void Planner::read(const Touch& t, State& state, const ReadGroup& group, BarrierBatch* batch) {
  const bool image = graph_.resources[t.resource].desc.kind == ResourceKind::Image;
  if (image && state.layout != t.scope.layout) {
    if (batch)
      batch->images.emplace_back(t.resource, t.previous, state.writeStage | state.readStage, group.stage,
                                 state.writeAccess, group.access, state.layout, t.scope.layout);
    // The layout change is itself a write, for which only the second scope of this barrier has waited. Later accesses
    // wait for that scope and for the write before it.
    state.writeStage |= group.stage;
    state.seenStage = group.stage;
    state.seenAccess = group.access;
    state.readStage = 0;
    state.layout = t.scope.layout;
  } else if (group.stage & ~state.seenStage || group.access & ~state.seenAccess) {
    // Readers of another group may have waited for the write, but these have not.
    if (batch && state.writeStage)
      global(*batch, state.writeStage, state.writeAccess, group.stage, group.access);
    state.seenStage |= group.stage;
    state.seenAccess |= group.access;
  }
  state.pendingStage = 0;
  state.pendingAccess = 0;
  state.readStage |= group.stage;
}

void Planner::write(const Touch& t, State& state, BarrierBatch* batch) {
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
  // An image barrier covers that image only, so writes of other occupants of its memory need the global barrier.
  if (batch && source && (!change || (first && sourceAccess)))
    global(*batch, source, sourceAccess, t.scope.stage, t.scope.access);
  if (batch && change)
    batch->images.emplace_back(t.resource, t.previous, source, t.scope.stage, sourceAccess, t.scope.access,
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
