// Scheduling: which passes run, and in which level.
#pragma once

#include <optional>
#include <vector>

#include "framework/graph/compile/plan.h"

namespace fovea::graph {

struct Schedule {
  std::vector<uint8_t> passLive, resourceLive;
  std::vector<uint32_t> level;       // per pass; kNone when culled
  std::vector<uint32_t> order;       // live passes by level, in declaration order within a level
  std::vector<uint32_t> levelFirst;  // index into `order` per level, and the end of the last one
  uint32_t levels() const { return static_cast<uint32_t>(levelFirst.size()) - 1; }
};

// Culls backwards from the graph's outputs, from passes with side effects and from writes to the caller's memory,
// also through history edges. If a kept resource is used, all its writers are kept, because the next frame sees what
// they leave. Each pass then takes the earliest level after the producers of what it reads and after all readers of
// what it overwrites. With `randomOrder` the levels are chosen at random among the legal ones, with this seed.
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

}  // namespace fovea::graph
