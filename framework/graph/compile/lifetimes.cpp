#include "framework/graph/compile/schedule.h"

namespace fovea::graph {

std::vector<Interval> lifetimes(const BoundGraph& graph, const Schedule& schedule) {
  std::vector<Interval> intervals(graph.resources.size());
  for (uint32_t level = 0; level < schedule.levels(); ++level) {
    for (const uint32_t pass : schedule.passes(level)) {
      for (const Access& a : graph.passes[pass].accesses) {
        Interval& interval = intervals[a.resource];
        if (interval.first == kNone) interval.first = level;
        interval.last = level;
      }
    }
  }
  for (const BoundOutput& output : graph.outputs) intervals[output.resource].last = schedule.levels();
  return intervals;
}

}  // namespace fovea::graph
