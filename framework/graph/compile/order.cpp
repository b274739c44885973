// Bind, order: cycles, versions of resources that are updated in place, and the layout of each access.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "framework/graph/compile/binder.h"
#include "framework/graph/pass/validate.h"

namespace fovea::graph::detail {

// Uses the order of declaration if it has producers first, as in most graphs, and Kahn's algorithm otherwise.
void Binder::orderPasses() {
  const uint32_t count = static_cast<uint32_t>(graph_.passes.size());
  if (inOrder_) {
    order_.resize(count);
    return std::iota(order_.begin(), order_.end(), 0u);
  }
  const auto first = scratch_.array<uint32_t>(count + 2), waits = scratch_.array<uint32_t>(count);
  for (const PortState& port : ports_) {
    if (port.source == kNone || port.previous) continue;
    ++first[ports_[port.source].pass + 2];
    ++waits[port.pass];
  }
  for (uint32_t p = 2; p < count + 2; ++p) first[p] += first[p - 1];
  const auto readers = scratch_.array<uint32_t>(first[count + 1]);
  for (const PortState& port : ports_)
    if (port.source != kNone && !port.previous) readers[first[ports_[port.source].pass + 1]++] = port.pass;
  order_.reserve(count);
  for (uint32_t p = 0; p < count; ++p)
    if (waits[p] == 0) order_.push_back(p);
  for (size_t i = 0; i < order_.size(); ++i)
    for (uint32_t e = first[order_[i]]; e < first[order_[i] + 1]; ++e)
      if (--waits[readers[e]] == 0) order_.push_back(readers[e]);
  if (order_.size() < count) reportCycle(waits);
}

// Every waiting pass has a waiting producer, so walking up must return to a pass already visited.
void Binder::reportCycle(std::span<const uint32_t> waits) {
  std::vector<uint32_t> producer(graph_.passes.size(), kNone), wire(graph_.passes.size(), kNone);
  for (const PortState& port : ports_) {
    if (port.source == kNone || port.previous || waits[port.pass] == 0) continue;
    const uint32_t from = ports_[port.source].pass;
    if (waits[from] == 0 || producer[port.pass] != kNone) continue;
    producer[port.pass] = from;
    wire[port.pass] = port.wire;
  }
  std::vector<uint8_t> seen(graph_.passes.size(), 0);
  for (uint32_t start = 0; start < producer.size(); ++start) {
    uint32_t at = start;
    std::vector<uint32_t> walk;
    while (at != kNone && seen[at] == 0) {
      seen[at] = 1;
      walk.push_back(at);
      at = producer[at];
    }
    const auto round = std::find(walk.begin(), walk.end(), at);
    if (at == kNone || round == walk.end()) continue;  // leads into a cycle that has been reported
    std::vector<uint32_t> circle(round, walk.end());
    std::rotate(circle.begin(), std::min_element(circle.begin(), circle.end()), circle.end());
    std::string names;
    for (const uint32_t p : circle) names += graph_.passes[p].name + " <- ";
    const WireDescription& w = description_.wires[wire[circle[0]]];
    error(w.place, passPath(circle[0], json::joinPath("inputs", w.target)),
          fmt::format("these passes wait for each other: {}{}", names, graph_.passes[circle[0]].name),
          "one of these wires must read last frame's value: append @previous");
  }
}

// Outputs make version 1, and each update in place makes the next version. Two updates of the same
// version have no defined order.
void Binder::makeVersions() {
  if (inPlace_) updateInPlace();
  for (BoundResource& r : graph_.resources) {
    r.firstSlot = graph_.slots;
    graph_.slots += r.versions + 2;  // version 0 and last frame's copy
  }
}

void Binder::updateInPlace() {
  std::vector<uint32_t> updater(graph_.resources.size(), kNone);
  for (const uint32_t p : order_) {
    for (uint32_t i = 0; i < portCount(p); ++i) {
      PortState& port = portsOf(p)[i];
      const PortSpec& spec = *port.spec;
      if (spec.direction != Direction::InOut || port.value.first == kNone) continue;
      port.firstVersion = static_cast<uint32_t>(versions_.size());
      for (uint32_t k = 0; k < port.value.count; ++k)
        versions_.push_back(versionSeen(port, port.value.first + k));
      for (uint32_t m = 0; m < spec.members.size(); ++m) {
        const uint32_t r = resourceOf(port, m);
        if (r == kNone) continue;
        uint32_t& version = versions_[port.firstVersion + (r - port.value.first)];
        if (version != graph_.resources[r].versions)
          error(description_.wires[port.wire].place, wirePath(port),
                fmt::format("`{}` and `{}` both update `{}` in place: their order is open",
                            graph_.passes[updater[r] == kNone ? p : updater[r]].name, graph_.passes[p].name,
                            graph_.resources[r].name),
                fmt::format("wire one after the other: `{}.{}`",
                            graph_.passes[updater[r] == kNone ? p : updater[r]].name, spec.name));
        version = ++graph_.resources[r].versions;
        updater[r] = p;
      }
    }
  }
}

// With updates in place, a reader of version v must run before the update to v + 1. Checks that such an order exists.
void Binder::checkInPlace() {
  if (order_.size() < graph_.passes.size()) return;
  const uint32_t count = static_cast<uint32_t>(graph_.passes.size());
  std::vector<uint32_t> updater(graph_.slots, kNone);
  for (uint32_t p = 0; p < count; ++p)
    for (const Access& a : graph_.passes[p].accesses)
      if (a.writes) updater[a.slot] = p;
  std::vector<std::pair<uint32_t, uint32_t>> edges;
  for (uint32_t p = 0; p < count; ++p) {
    for (const Access& a : graph_.passes[p].accesses) {
      if (a.previous) continue;
      const uint32_t made = a.writes && a.version > 0 ? updater[a.slot - 1] : kNone;
      if (a.writes && made != kNone) edges.emplace_back(made, p);
      if (a.writes) continue;
      if (const uint32_t by = updater[a.slot]; by != kNone) edges.emplace_back(by, p);
      if (const uint32_t next = updater[a.slot + 1]; next != kNone) edges.emplace_back(p, next);
    }
  }
  std::vector<uint32_t> first(count + 2, 0), waits(count, 0), ready;
  for (const auto& [from, to] : edges) ++first[from + 2], ++waits[to];
  for (uint32_t p = 2; p < count + 2; ++p) first[p] += first[p - 1];
  std::vector<uint32_t> next(edges.size());
  for (const auto& [from, to] : edges) next[first[from + 1]++] = to;
  for (uint32_t p = 0; p < count; ++p)
    if (waits[p] == 0) ready.push_back(p);
  for (size_t i = 0; i < ready.size(); ++i)
    for (uint32_t e = first[ready[i]]; e < first[ready[i] + 1]; ++e)
      if (--waits[next[e]] == 0) ready.push_back(next[e]);
  if (ready.size() == count) return;
  // Reports a reader that waits although its value is about to be overwritten.
  for (const PortState& port : ports_) {
    if (waits[port.pass] == 0 || port.wire == kNone || port.previous || port.value.first == kNone) continue;
    const PortSpec& spec = *port.spec;
    if (spec.direction != Direction::Input) continue;
    for (uint32_t m = 0; m < spec.members.size(); ++m) {
      const uint32_t r = resourceOf(port, m);
      if (r == kNone) continue;
      const uint32_t by = updater[graph_.resources[r].firstSlot + versionSeen(port, r) + 1];
      if (by == kNone || waits[by] == 0) continue;
      if (by == port.pass)
        return error(
            description_.wires[port.wire].place, wirePath(port),
            fmt::format("`{}` reads and updates `{}`: its input `{}` would be changed before it is read",
                        graph_.passes[by].name, description_.wires[port.wire].written, spec.name),
            "wire one of the two ports to another value");
      return error(
          description_.wires[port.wire].place, wirePath(port),
          fmt::format("`{}` must read `{}` before `{}` updates it in place, but it also waits for that pass",
                      graph_.passes[port.pass].name, description_.wires[port.wire].written,
                      graph_.passes[by].name),
          fmt::format("read the updated value from `{}`, or last frame's with @previous",
                      graph_.passes[by].name));
    }
  }
  error(description_.passes[0].place, {}, "updates in place leave no order in which these passes could run");
}

// Chooses one layout per pass and image, and one for all readers of a version, so that a level never needs two.
void Binder::chooseLayouts() {
  struct Seen {
    uint32_t pass = kNone;
    Usage usage = Usage::None;
    bool reads = false, writes = false;
  };
  const auto readLayout = scratch_.array(graph_.slots, VK_IMAGE_LAYOUT_UNDEFINED);
  const auto seen = scratch_.array<Seen>(graph_.resources.size() * 2);
  const auto isImage = [&](const Access& a) {
    return graph_.resources[a.resource].desc.kind == ResourceKind::Image && a.usage != Usage::None;
  };
  bool mixed = false;  // readers of a version want different layouts
  for (uint32_t p = 0; p < graph_.passes.size(); ++p) {
    for (const Access& a : graph_.passes[p].accesses) {
      Seen& s = seen[a.resource * 2 + a.previous];
      if (s.pass != p) s = {p, Usage::None, false, false};
      s.usage = s.usage | a.usage;
      s.reads |= a.reads;
      s.writes |= a.writes;
    }
    for (Access& a : graph_.passes[p].accesses) {
      if (!isImage(a)) continue;
      const Seen& s = seen[a.resource * 2 + a.previous];
      a.layout = accessLayout(s.usage, s.reads, s.writes);
      if (s.writes) continue;
      VkImageLayout& shared = readLayout[a.slot];
      if (shared == VK_IMAGE_LAYOUT_UNDEFINED)
        shared = a.layout;
      else if (shared != a.layout)
        shared = VK_IMAGE_LAYOUT_GENERAL, mixed = true;
    }
  }
  if (!mixed) return;
  for (BoundPass& pass : graph_.passes)
    for (Access& a : pass.accesses)
      if (isImage(a) && !a.writes) a.layout = readLayout[a.slot];
}

}  // namespace fovea::graph::detail
