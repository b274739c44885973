#include "framework/graph/compile/schedule.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "framework/base/random.h"

namespace fovea::graph {

Precedence::Precedence(size_t passes, std::span<const Edge> edges)
    : first_(passes + 2), after_(edges.size()), waits_(passes) {
  for (const auto& [before, after] : edges) {
    ++first_[before + 2];
    ++waits_[after];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  for (const auto& [before, after] : edges) after_[first_[before + 1]++] = after;
}

std::vector<uint32_t> Precedence::sorted() const {
  std::vector<uint32_t> order, waits = waits_;
  order.reserve(waits.size());
  for (uint32_t p = 0; p < waits.size(); ++p)
    if (waits[p] == 0) order.push_back(p);
  for (size_t i = 0; i < order.size(); ++i)
    for (const uint32_t next : after(order[i]))
      if (--waits[next] == 0) order.push_back(next);
  return order;
}

std::vector<uint32_t> makersOfVersions(const BoundGraph& graph) {
  std::vector<uint32_t> makers(graph.slots, kNone);
  for (uint32_t p = 0; p < graph.passes.size(); ++p)
    for (const Access& a : graph.passes[p].accesses)
      if (a.writes) makers[a.slot] = p;
  return makers;
}

Precedence precedence(const BoundGraph& graph, std::span<const uint32_t> makers,
                      std::span<const uint8_t> live) {
  std::vector<Precedence::Edge> edges;
  edges.reserve(2 * graph.passes.size());
  const auto add = [&](uint32_t before, uint32_t after) {
    if (before != kNone && after != kNone && live[before] && live[after]) edges.emplace_back(before, after);
  };
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    for (const Access& a : graph.passes[p].accesses) {
      if (a.previous || !live[p]) continue;
      add(makers[a.writes ? a.slot - 1 : a.slot], p);
      if (!a.writes) add(p, makers[a.slot + 1]);
    }
  }
  return Precedence(graph.passes.size(), edges);
}

Live cull(const BoundGraph& graph, const std::vector<uint32_t>& makers) {
  Live live{std::vector<uint8_t>(graph.passes.size()), std::vector<uint8_t>(graph.resources.size())};
  std::vector<uint32_t> work;
  work.reserve(graph.passes.size());
  const auto need = [&](uint32_t pass) {
    if (pass != kNone && !std::exchange(live.passLive[pass], 1)) work.push_back(pass);
  };
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    if (graph.passes[p].declaration->sideEffects) need(p);
    for (const Access& a : graph.passes[p].accesses)
      if (a.writes && graph.resources[a.resource].external) need(p);
  }
  for (const BoundOutput& output : graph.outputs)
    need(makers[graph.resources[output.resource].firstSlot + output.version]);
  std::vector<uint8_t> allMakers(graph.resources.size());
  while (!work.empty()) {
    const uint32_t p = work.back();
    work.pop_back();
    for (const Access& a : graph.passes[p].accesses) {
      const BoundResource& resource = graph.resources[a.resource];
      live.resourceLive[a.resource] = 1;
      if (!a.previous && resource.lifetime == Lifetime::Transient) {
        if (a.reads) need(makers[a.writes ? a.slot - 1 : a.slot]);
      } else if (!std::exchange(allMakers[a.resource], 1)) {
        for (uint32_t v = 1; v <= resource.versions; ++v) need(makers[resource.firstSlot + v]);
      }
    }
  }
  return live;
}

namespace {

std::vector<uint32_t> earliestLevels(const Precedence& order, const std::vector<uint8_t>& live) {
  std::vector<uint32_t> level(live.size(), 0);
  for (const uint32_t p : order.sorted())
    for (const uint32_t next : order.after(p)) level[next] = std::max(level[next], level[p] + 1);
  for (uint32_t p = 0; p < live.size(); ++p)
    if (!live[p]) level[p] = kNone;
  return level;
}

std::vector<uint32_t> randomLevels(const Precedence& order, const std::vector<uint8_t>& live, uint32_t seed) {
  std::vector<uint32_t> level(live.size(), kNone), least(live.size(), 0), waits = order.waits(), ready, used;
  for (uint32_t p = 0; p < live.size(); ++p)
    if (live[p] && waits[p] == 0) ready.push_back(p);
  uint32_t latest = 0, draw = 0;
  while (!ready.empty()) {
    const uint32_t pick = hashCombine(seed, draw++) % static_cast<uint32_t>(ready.size());
    const uint32_t p = ready[pick];
    ready.erase(ready.begin() + pick);
    if (draw > 1 && hashCombine(seed, draw++) % 3 == 0) ++latest;
    level[p] = latest = std::max(latest, least[p]);
    used.push_back(latest);
    for (const uint32_t next : order.after(p)) {
      least[next] = latest + 1;
      if (--waits[next] == 0) ready.push_back(next);
    }
  }
  // Levels that the random draw skipped would be empty, so they are removed. `used` ascends.
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (uint32_t& l : level)
    if (l != kNone) l = static_cast<uint32_t>(std::lower_bound(used.begin(), used.end(), l) - used.begin());
  return level;
}

// Fills in `order` and `levelFirst`.
void sortByLevel(Schedule& schedule) {
  uint32_t levels = 0;
  for (const uint32_t l : schedule.level)
    if (l != kNone) levels = std::max(levels, l + 1);
  std::vector<uint32_t>& first = schedule.levelFirst;
  first.assign(levels + 2, 0);
  for (const uint32_t l : schedule.level)
    if (l != kNone) ++first[l + 2];
  std::partial_sum(first.begin(), first.end(), first.begin());
  schedule.order.resize(first.back());
  for (uint32_t p = 0; p < schedule.level.size(); ++p)
    if (schedule.level[p] != kNone) schedule.order[first[schedule.level[p] + 1]++] = p;
  first.pop_back();
}

}  // namespace

Schedule schedule(const BoundGraph& graph, std::optional<uint32_t> randomOrder) {
  const std::vector<uint32_t> makers = makersOfVersions(graph);
  Schedule result{cull(graph, makers)};
  const Precedence order = precedence(graph, makers, result.passLive);
  result.level = randomOrder ? randomLevels(order, result.passLive, *randomOrder)
                             : earliestLevels(order, result.passLive);
  sortByLevel(result);
  return result;
}

}  // namespace fovea::graph
