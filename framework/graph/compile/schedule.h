// Scheduling: which passes run, in which level, and how long each resource lives.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "framework/graph/compile/bound.h"

namespace fovea::graph {

// What is needed, directly or by others.
struct Live {
  std::vector<uint8_t> passLive, resourceLive;
};
// Culls backwards from the graph's outputs, from passes with side effects and from writes to the caller's memory,
// also through history edges. If a kept resource is used, all its writers are kept, because the next frame sees what
// they leave. makers: makersOfVersions().
Live cull(const BoundGraph& graph, const std::vector<uint32_t>& makers);

struct Schedule : Live {
  std::vector<uint32_t> level;       // per pass; kNone when culled
  std::vector<uint32_t> order;       // live passes by level, in declaration order within a level
  std::vector<uint32_t> levelFirst;  // index into `order` per level, and the end of the last one
  uint32_t levels() const { return static_cast<uint32_t>(levelFirst.size()) - 1; }
  std::span<const uint32_t> passes(uint32_t inLevel) const {
    return std::span(order).subspan(levelFirst[inLevel], levelFirst[inLevel + 1] - levelFirst[inLevel]);
  }
};

// Of the passes that cull() leaves, each takes the earliest level after the producers of what it reads and after all
// readers of what it overwrites. With `randomOrder` the levels are chosen at random among the legal ones, with this seed.
Schedule schedule(const BoundGraph& graph, std::optional<uint32_t> randomOrder = std::nullopt);

// First and last level that uses each live resource; outputs live until the end of the frame (levels()).
struct Interval {
  uint32_t first = kNone, last = 0;
};
std::vector<Interval> lifetimes(const BoundGraph& graph, const Schedule& schedule);

// Transient resources share memory; kept, history and external resources never do.
inline bool isTransient(const BoundResource& r) {
  return r.lifetime == Lifetime::Transient && !r.external && !r.history;
}

// Which passes have to run before which others.
class Precedence {
 public:
  using Edge = std::pair<uint32_t, uint32_t>;  // the first before the second
  Precedence(size_t passes, std::span<const Edge> edges);
  std::span<const uint32_t> after(uint32_t pass) const {
    return std::span(after_).subspan(first_[pass], first_[pass + 1] - first_[pass]);
  }
  const std::vector<uint32_t>& waits() const { return waits_; }  // per pass, for how many others it waits
  // Every pass after all that it waits for. Passes that wait for each other, and those that wait for them, are missing.
  std::vector<uint32_t> sorted() const;

 private:
  std::vector<uint32_t> first_, after_, waits_;
};

// The pass that makes each version of each resource, by Access::slot. Nobody makes version 0 and last frame's copy.
std::vector<uint32_t> makersOfVersions(const BoundGraph& graph);
// A version is made after the one before it and after all readers of that one, and read after it is made. Only passes
// that are live count.
Precedence precedence(const BoundGraph& graph, std::span<const uint32_t> makers,
                      std::span<const uint8_t> live);

}  // namespace fovea::graph
