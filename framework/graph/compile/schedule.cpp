#include "framework/graph/compile/schedule.h"

#include <algorithm>
#include <span>
#include <utility>

#include "framework/base/random.h"
#include "framework/graph/compile/scratch.h"

namespace fovea::graph {
namespace {

class Scheduler {
 public:
  explicit Scheduler(const BoundGraph& graph)
      : graph_(graph), passCount_(static_cast<uint32_t>(graph.passes.size())) {}

  Schedule run(std::optional<uint32_t> seed) {
    result_.passLive.assign(passCount_, 0);
    work_.reserve(passCount_);
    findWriters();
    cull();
    if (seed || !levelsAsDeclared()) {
      makeEdges();
      result_.level.assign(passCount_, kNone);
      seed ? randomLevels(*seed) : earliestLevels();
    }
    sortByLevel();
    return std::move(result_);
  }

 private:
  void findWriters() {
    writers_ = scratch_.array(graph_.slots, kNone);
    for (uint32_t p = 0; p < passCount_; ++p) {
      if (graph_.passes[p].declaration->sideEffects) need(p);
      for (const Access& a : graph_.passes[p].accesses) {
        if (!a.writes) continue;
        writers_[a.slot] = p;
        const bool external = graph_.resources[a.resource].external;
        if (external) need(p);
        updates_ |= external || a.version > 1;
      }
    }
  }

  void need(uint32_t pass) {
    if (pass == kNone || result_.passLive[pass]) return;
    result_.passLive[pass] = 1;
    work_.push_back(pass);
  }

  void needAllWriters(uint32_t resource) {
    if (std::exchange(allWriters_[resource], 1)) return;
    const BoundResource& r = graph_.resources[resource];
    for (uint32_t version = 1; version <= r.versions; ++version) need(writers_[r.firstSlot + version]);
  }

  void cull() {
    result_.resourceLive.assign(graph_.resources.size(), 0);
    allWriters_ = scratch_.array<uint8_t>(graph_.resources.size());
    for (const BoundOutput& output : graph_.outputs)
      need(writers_[graph_.resources[output.resource].firstSlot + output.version]);
    while (!work_.empty()) {
      const uint32_t p = work_.back();
      work_.pop_back();
      for (const Access& a : graph_.passes[p].accesses) {
        result_.resourceLive[a.resource] = 1;
        if (a.previous || graph_.resources[a.resource].lifetime != Lifetime::Transient)
          needAllWriters(a.resource);
        else if (a.reads)
          need(writers_[a.writes ? a.slot - 1 : a.slot]);
      }
    }
  }

  bool live(uint32_t pass) const { return pass != kNone && result_.passLive[pass]; }

  // In most graphs each pass is declared after those it waits for, and one walk finds the levels. Otherwise false.
  bool levelsAsDeclared() {
    std::vector<uint32_t>& level = result_.level;
    level.assign(passCount_, kNone);
    for (uint32_t p = 0; p < passCount_; ++p) {
      if (!result_.passLive[p]) continue;
      uint32_t own = level[p] == kNone ? 0 : level[p];  // required by readers of what it overwrites
      for (const Access& a : graph_.passes[p].accesses) {
        const uint32_t before = a.previous ? kNone : writers_[a.writes ? a.slot - 1 : a.slot];
        if (!live(before)) continue;
        if (before > p) return false;
        own = std::max(own, level[before] + 1);
      }
      level[p] = own;
      if (!updates_) continue;  // nobody waits for readers
      for (const Access& a : graph_.passes[p].accesses) {
        const uint32_t next = a.previous || a.writes ? kNone : writers_[a.slot + 1];
        if (!live(next)) continue;
        if (next < p) return false;
        level[next] = level[next] == kNone ? own + 1 : std::max(level[next], own + 1);
      }
    }
    return true;
  }

  template <class Edge>
  void forEachEdge(const Edge& edge) {
    for (uint32_t p = 0; p < passCount_; ++p) {
      if (!result_.passLive[p]) continue;
      for (const Access& a : graph_.passes[p].accesses) {
        if (a.previous) continue;
        if (a.writes) {
          const uint32_t before = writers_[a.slot - 1];
          if (live(before)) edge(before, p);
        } else {
          const uint32_t made = writers_[a.slot], next = writers_[a.slot + 1];
          if (made != kNone) edge(made, p);
          if (live(next)) edge(p, next);
        }
      }
    }
  }

  void makeEdges() {
    edgeFirst_ = scratch_.array<uint32_t>(passCount_ + 2);
    waits_ = scratch_.array<uint32_t>(passCount_);
    forEachEdge([&](uint32_t from, uint32_t to) {
      ++edgeFirst_[from + 2];
      ++waits_[to];
    });
    for (uint32_t p = 2; p < passCount_ + 2; ++p) edgeFirst_[p] += edgeFirst_[p - 1];
    edges_ = scratch_.array<uint32_t>(edgeFirst_[passCount_ + 1]);
    forEachEdge([&](uint32_t from, uint32_t to) { edges_[edgeFirst_[from + 1]++] = to; });
  }

  void earliestLevels() {
    detail::ScratchVector<uint32_t>& queue = work_;
    queue.clear();
    for (uint32_t p = 0; p < passCount_; ++p) {
      if (!result_.passLive[p] || waits_[p] != 0) continue;
      result_.level[p] = 0;
      queue.push_back(p);
    }
    for (size_t i = 0; i < queue.size(); ++i) {
      const uint32_t from = queue[i], next = result_.level[from] + 1;
      for (uint32_t e = edgeFirst_[from]; e < edgeFirst_[from + 1]; ++e) {
        uint32_t& level = result_.level[edges_[e]];
        level = level == kNone ? next : std::max(level, next);
        if (--waits_[edges_[e]] == 0) queue.push_back(edges_[e]);
      }
    }
  }

  void randomLevels(uint32_t seed) {
    std::vector<uint32_t> ready, least(passCount_, 0);
    for (uint32_t p = 0; p < passCount_; ++p)
      if (result_.passLive[p] && waits_[p] == 0) ready.push_back(p);
    uint32_t level = 0, draw = 0;
    while (!ready.empty()) {
      const uint32_t pick = hashCombine(seed, draw++) % static_cast<uint32_t>(ready.size());
      const uint32_t p = ready[pick];
      ready.erase(ready.begin() + pick);
      if (draw > 1 && hashCombine(seed, draw++) % 3 == 0) ++level;
      level = std::max(level, least[p]);
      result_.level[p] = level;
      for (uint32_t e = edgeFirst_[p]; e < edgeFirst_[p + 1]; ++e) {
        least[edges_[e]] = level + 1;
        if (--waits_[edges_[e]] == 0) ready.push_back(edges_[e]);
      }
    }
    // Levels that the random draw skipped would be empty, so they are removed.
    std::vector<uint32_t> used;
    for (const uint32_t l : result_.level)
      if (l != kNone) used.push_back(l);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (uint32_t& l : result_.level)
      if (l != kNone) l = static_cast<uint32_t>(std::lower_bound(used.begin(), used.end(), l) - used.begin());
  }

  void sortByLevel() {
    uint32_t levels = 0, live = 0;
    for (uint32_t p = 0; p < passCount_; ++p) {
      if (result_.level[p] == kNone) continue;
      levels = std::max(levels, result_.level[p] + 1);
      ++live;
    }
    std::vector<uint32_t>& first = result_.levelFirst;
    first.assign(levels + 2, 0);
    for (const uint32_t l : result_.level)
      if (l != kNone) ++first[l + 2];
    for (uint32_t l = 2; l <= levels; ++l) first[l] += first[l - 1];
    result_.order.resize(live);
    for (uint32_t p = 0; p < passCount_; ++p)
      if (result_.level[p] != kNone) result_.order[first[result_.level[p] + 1]++] = p;
    first.pop_back();
  }

  const BoundGraph& graph_;
  const uint32_t passCount_;
  Schedule result_;
  detail::Scratch scratch_;
  std::span<uint32_t> writers_;  // by slot
  std::span<uint32_t> edgeFirst_, edges_, waits_;
  std::span<uint8_t> allWriters_;
  detail::ScratchVector<uint32_t> work_{scratch_};
  bool updates_ = false;  // a resource is written more than once, or over the caller's contents
};

}  // namespace

Schedule schedule(const BoundGraph& graph, std::optional<uint32_t> randomOrder) {
  return Scheduler(graph).run(randomOrder);
}

std::vector<Interval> lifetimes(const BoundGraph& graph, const Schedule& schedule) {
  std::vector<Interval> intervals(graph.resources.size());
  const uint32_t levels = schedule.levels();
  for (uint32_t l = 0; l < levels; ++l) {
    for (uint32_t i = schedule.levelFirst[l]; i < schedule.levelFirst[l + 1]; ++i) {
      for (const Access& a : graph.passes[schedule.order[i]].accesses) {
        Interval& interval = intervals[a.resource];
        if (interval.first == kNone) interval.first = l;
        interval.last = l;
      }
    }
  }
  for (const BoundOutput& output : graph.outputs) intervals[output.resource].last = levels;
  return intervals;
}

}  // namespace fovea::graph
