#include "framework/graph/compile/barriers.h"

#include <algorithm>
#include <span>
#include <utility>

#include "framework/graph/compile/hazards.h"

namespace fovea::graph {
namespace {

// One pass accessing one copy of one resource through all its ports together.
struct Touch {
  uint32_t resource;
  uint32_t slot;  // of the version read or made
  AccessScope scope;
  bool reads, writes, previous;
  bool image, transient;  // what kind of resource it is
};

// What the frames have in common.
struct Frame {
  const BoundGraph& graph;
  const Schedule& schedule;
  const std::vector<Interval>& intervals;
  std::vector<Touch> touches = {};        // in the order of the schedule
  std::vector<uint32_t> touchFirst = {};  // per level, and the end of the last one
  std::vector<AccessScope> readers =
      {};  // by slot: all readers of a version together, whose layout is not used
};

// One copy of a resource at some point of the frame.
struct Copy {
  AccessHistory history;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

// A piece of a heap that no placement splits, and what its next occupant has to wait for.
struct Segment {
  VkPipelineStageFlags2 stage = 0;
  VkAccessFlags2 access = 0;
};

// Everything that changes from access to access, and lasts from one frame to the next.
struct State {
  std::vector<Copy> current, previous;         // by resource
  std::vector<Segment> segments;               // of all heaps, ascending
  std::vector<std::span<Segment>> segmentsOf;  // by resource; empty where memory is not shared
  std::vector<uint8_t> served;                 // by slot: a barrier for its readers was placed in this frame
};

void collectTouches(Frame& frame) {
  const BoundGraph& graph = frame.graph;
  frame.readers.resize(graph.slots);
  frame.touches.reserve(2 * frame.schedule.order.size());
  struct Latest {
    uint32_t pass = kNone, touch = 0;
  };
  std::vector<Latest> latest(graph.resources.size() * 2);  // per copy
  for (uint32_t level = 0; level < frame.schedule.levels(); ++level) {
    frame.touchFirst.push_back(static_cast<uint32_t>(frame.touches.size()));
    for (const uint32_t pass : frame.schedule.passes(level)) {
      for (const Access& a : graph.passes[pass].accesses) {
        const AccessScope scope =
            accessScope(graph.passes[pass].declaration->kind, a.usage, a.reads, a.writes);
        if (!a.writes) {
          frame.readers[a.slot].stage |= scope.stage;
          frame.readers[a.slot].access |= scope.access;
        }
        Latest& before = latest[a.resource * 2 + a.previous];
        if (before.pass == pass) {
          Touch& touch = frame.touches[before.touch];
          touch.scope.stage |= scope.stage;
          touch.scope.access |= scope.access;
          touch.reads |= a.reads;
          touch.writes |= a.writes;
        } else {
          before = {pass, static_cast<uint32_t>(frame.touches.size())};
          const BoundResource& resource = graph.resources[a.resource];
          const bool image = resource.desc.kind == ResourceKind::Image;
          frame.touches.push_back({a.resource,
                                   a.slot,
                                   {scope.stage, scope.access, a.layout},
                                   a.reads,
                                   a.writes,
                                   a.previous,
                                   image,
                                   isTransient(resource)});
        }
      }
    }
  }
  frame.touchFirst.push_back(static_cast<uint32_t>(frame.touches.size()));
}

void makeSegments(State& state, const std::vector<Placement>& placements, size_t resources) {
  const auto begin = [](const Placement& p) { return uint64_t(p.heap) << 56 | p.offset; };
  std::vector<uint64_t> bounds;
  bounds.reserve(2 * placements.size());
  for (const Placement& p : placements) {
    bounds.push_back(begin(p));
    bounds.push_back(begin(p) + p.bytes);
  }
  std::sort(bounds.begin(), bounds.end());
  bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
  state.segments.resize(bounds.size());
  state.segmentsOf.resize(resources);
  for (const Placement& p : placements) {
    const auto first = std::lower_bound(bounds.begin(), bounds.end(), begin(p));
    const auto last = std::lower_bound(first, bounds.end(), begin(p) + p.bytes);
    state.segmentsOf[p.resource] = std::span(state.segments).subspan(first - bounds.begin(), last - first);
  }
}

// Without a batch, this and the functions below only follow the state.
void read(const Touch& touch, const AccessScope& readers, Copy& copy, BarrierBatch* batch) {
  AccessHistory& history = copy.history;
  if (touch.image && copy.layout != touch.scope.layout) {
    if (batch)
      batch->images.push_back({touch.resource, touch.previous, history.writeStage | history.readStage,
                               readers.stage, history.writeAccess, readers.access, copy.layout,
                               touch.scope.layout});
    // The layout change is itself a write, for which only the second scope of this barrier has waited. Later accesses
    // wait for that scope and for the write before it.
    history.writeStage |= readers.stage;
    history.seenStage = readers.stage;
    history.seenAccess = readers.access;
    history.readStage = 0;
    copy.layout = touch.scope.layout;
  }
  const Dependency wait = beforeRead(history, readers);
  if (batch) *batch |= wait;
}

void write(const Touch& touch, std::span<const Segment> memory, Copy& copy, BarrierBatch* batch) {
  const bool first = !touch.reads && touch.transient;
  if (first) {  // waits for the last occupants of the memory, as if they had written here
    copy = {};
    for (const Segment& segment : memory) {
      copy.history.pendingStage |= segment.stage;
      copy.history.pendingAccess |= segment.access;
    }
  }
  const Dependency wait = beforeWrite(copy.history, touch.scope, touch.reads);
  const bool change = touch.image && copy.layout != touch.scope.layout;
  // An image barrier covers that image only, so writes of other occupants of its memory need the global barrier.
  if (batch && (!change || (first && wait.srcAccess))) *batch |= wait;
  if (batch && change)
    batch->images.push_back({touch.resource, touch.previous, wait.srcStage, touch.scope.stage, wait.srcAccess,
                             touch.scope.access, copy.layout, touch.scope.layout});
  copy.layout = touch.scope.layout;
}

void access(const Touch& touch, const Frame& frame, State& state, BarrierBatch* batch) {
  if (touch.scope.stage == 0) return;  // only its size is used
  Copy& copy = (touch.previous ? state.previous : state.current)[touch.resource];
  if (touch.writes)
    write(touch, state.segmentsOf[touch.resource], copy, batch);
  else if (!std::exchange(state.served[touch.slot], 1))
    read(touch, frame.readers[touch.slot], copy, batch);
}

// The next occupant of the memory waits for this one, which itself waited for the one before.
void leaveMemory(uint32_t resource, State& state) {
  const AccessHistory& left = state.current[resource].history;
  for (Segment& segment : state.segmentsOf[resource])
    segment = {left.pendingStage | left.readStage, left.pendingAccess};
}

// Outputs are read by a transfer after the last level.
void readOutputs(const BoundGraph& graph, State& state, BarrierBatch* batch) {
  const AccessScope transfer{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                             VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
  std::vector<uint8_t> done(graph.resources.size());
  for (const BoundOutput& output : graph.outputs) {
    const uint32_t r = output.resource;
    if (std::exchange(done[r], 1)) continue;
    const bool image = graph.resources[r].desc.kind == ResourceKind::Image;
    read({r, 0, transfer, true, false, false, image, false}, transfer, state.current[r], batch);
    leaveMemory(r, state);
  }
}

// Goes through one frame, and writes its barriers if `barriers` is given.
void play(const Frame& frame, State& state, Barriers* barriers) {
  std::fill(state.served.begin(), state.served.end(), uint8_t(0));
  for (uint32_t level = 0; level < frame.schedule.levels(); ++level) {
    const uint32_t first = frame.touchFirst[level], end = frame.touchFirst[level + 1];
    BarrierBatch* batch = barriers ? &barriers->levels[level].before : nullptr;
    if (batch) batch->images.reserve(end - first);
    for (uint32_t t = first; t < end; ++t) access(frame.touches[t], frame, state, batch);
    for (uint32_t t = first; t < end; ++t) {
      const uint32_t resource = frame.touches[t].resource;
      if (frame.intervals[resource].last == level) leaveMemory(resource, state);
    }
  }
  readOutputs(frame.graph, state, barriers ? &barriers->end : nullptr);
}

// The copies of history resources swap at the end of a frame.
void swapHistory(const BoundGraph& graph, State& state) {
  for (size_t r = 0; r < graph.resources.size(); ++r)
    if (graph.resources[r].history) std::swap(state.current[r], state.previous[r]);
}

}  // namespace

Barriers placeBarriers(const BoundGraph& graph, const Schedule& schedule,
                       const std::vector<Interval>& intervals, const std::vector<Placement>& placements) {
  Frame frame{graph, schedule, intervals};
  collectTouches(frame);
  const size_t resources = graph.resources.size();
  const bool history = std::any_of(graph.resources.begin(), graph.resources.end(),
                                   [](const BoundResource& r) { return r.history; });
  State state;
  state.current.resize(resources);
  state.previous.resize(history ? resources : 0);
  state.served.resize(graph.slots);
  makeSegments(state, placements, resources);
  // Copies that swap need two rounds until both carry the state of a whole frame.
  for (int warmUp = history ? 3 : 1; warmUp > 0; --warmUp) {
    play(frame, state, nullptr);
    swapHistory(graph, state);
  }
  Barriers result;
  result.startLayout.resize(resources, {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_UNDEFINED});
  for (size_t r = 0; r < resources; ++r) {
    if (isTransient(graph.resources[r])) continue;
    result.startLayout[r][0] = state.current[r].layout;
    if (graph.resources[r].history) result.startLayout[r][1] = state.previous[r].layout;
  }
  result.levels.resize(schedule.levels());
  for (uint32_t level = 0; level < schedule.levels(); ++level) {
    const auto passes = schedule.passes(level);
    result.levels[level].passes.assign(passes.begin(), passes.end());
  }
  play(frame, state, &result);
  result.endLayout.reserve(resources);
  for (const Copy& copy : state.current) result.endLayout.push_back(copy.layout);
  return result;
}

}  // namespace fovea::graph
