#include "framework/graph/schedule.h"

#include <algorithm>
#include <utility>

#include "framework/base/random.h"
#include "framework/graph/scratch.h"

namespace fovea::graph {
namespace {

class Scheduler {
 public:
  explicit Scheduler(const BoundGraph& graph)
      : graph_(graph), passCount_(static_cast<uint32_t>(graph.passes.size())) {}

  Schedule run(std::optional<uint32_t> seed) {
    findWriters();
    cull();
    makeEdges();
    result_.level.assign(passCount_, kNone);
    if (seed)
      randomLevels(*seed);
    else
      earliestLevels();
    sortByLevel();
    return std::move(result_);
  }

 private:
  uint32_t& writer(uint32_t resource, uint32_t version) {
    return writers_[firstVersion_[resource] + version];
  }

  void findWriters() {
    const size_t resources = graph_.resources.size();
    firstVersion_.assign(resources + 1, 2);  // version 0 and one past the last
    for (const BoundPass& pass : graph_.passes)
      for (const Access& a : pass.accesses)
        if (a.writes) firstVersion_[a.resource] = std::max(firstVersion_[a.resource], a.version + 2);
    uint32_t sum = 0;
    for (uint32_t& first : firstVersion_) sum += std::exchange(first, sum);
    writers_.assign(sum, kNone);
    for (uint32_t p = 0; p < passCount_; ++p)
      for (const Access& a : graph_.passes[p].accesses)
        if (a.writes) writer(a.resource, a.version) = p;
  }

  void need(uint32_t pass) {
    if (pass == kNone || result_.passLive[pass]) return;
    result_.passLive[pass] = 1;
    work_.push_back(pass);
  }

  void needAllWriters(uint32_t resource) {
    if (std::exchange(allWriters_[resource], 1)) return;
    for (uint32_t w = firstVersion_[resource]; w < firstVersion_[resource + 1]; ++w) need(writers_[w]);
  }

  void cull() {
    result_.passLive.assign(passCount_, 0);
    result_.resourceLive.assign(graph_.resources.size(), 0);
    allWriters_.assign(graph_.resources.size(), 0);
    work_.reserve(passCount_);
    for (const BoundOutput& output : graph_.outputs) need(writer(output.resource, output.version));
    for (uint32_t p = 0; p < passCount_; ++p) {
      if (graph_.passes[p].declaration->sideEffects) need(p);
      for (const Access& a : graph_.passes[p].accesses)
        if (a.writes && graph_.resources[a.resource].external) need(p);
    }
    while (!work_.empty()) {
      const uint32_t p = work_.back();
      work_.pop_back();
      for (const Access& a : graph_.passes[p].accesses) {
        result_.resourceLive[a.resource] = 1;
        if (a.previous || graph_.resources[a.resource].lifetime != Lifetime::Transient)
          needAllWriters(a.resource);
        else if (a.reads)
          need(writer(a.resource, a.writes ? a.version - 1 : a.version));
      }
    }
  }

  template <class Edge>
  void forEachEdge(const Edge& edge) {
    for (uint32_t p = 0; p < passCount_; ++p) {
      if (!result_.passLive[p]) continue;
      for (const Access& a : graph_.passes[p].accesses) {
        if (a.previous) continue;
        if (a.writes) {
          const uint32_t before = writer(a.resource, a.version - 1);
          if (before != kNone && result_.passLive[before]) edge(before, p);
        } else {
          const uint32_t made = writer(a.resource, a.version), next = writer(a.resource, a.version + 1);
          if (made != kNone) edge(made, p);
          if (next != kNone && result_.passLive[next]) edge(p, next);
        }
      }
    }
  }

  void makeEdges() {
    edgeFirst_.assign(passCount_ + 2, 0);
    waits_.assign(passCount_, 0);
    forEachEdge([&](uint32_t from, uint32_t to) {
      ++edgeFirst_[from + 2];
      ++waits_[to];
    });
    for (uint32_t p = 2; p < passCount_ + 2; ++p) edgeFirst_[p] += edgeFirst_[p - 1];
    edges_.resize(edgeFirst_[passCount_ + 1]);
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
    // A level skipped by the draw would be an empty one.
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
    first.assign(levels + 1, 0);
    for (const uint32_t l : result_.level)
      if (l != kNone) ++first[l + 1];
    for (uint32_t l = 1; l <= levels; ++l) first[l] += first[l - 1];
    detail::ScratchVector<uint32_t> at(first.begin(), first.end(), scratch_);
    result_.order.resize(live);
    for (uint32_t p = 0; p < passCount_; ++p)
      if (result_.level[p] != kNone) result_.order[at[result_.level[p]]++] = p;
  }

  const BoundGraph& graph_;
  const uint32_t passCount_;
  Schedule result_;
  detail::Scratch scratch_;
  detail::ScratchVector<uint32_t> firstVersion_{scratch_}, writers_{scratch_}, work_{scratch_},
      edgeFirst_{scratch_}, edges_{scratch_}, waits_{scratch_};
  detail::ScratchVector<uint8_t> allWriters_{scratch_};
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
