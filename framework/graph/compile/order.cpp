// Bind, order: cycles, versions of resources that are updated in place, and the layout of each access.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "framework/graph/compile/binding.h"
#include "framework/graph/compile/schedule.h"

namespace fovea::graph::detail {
namespace {

// Whether each pass is in the order; the others are on a cycle, or wait for one.
std::vector<uint8_t> placedPasses(size_t passes, std::span<const uint32_t> order) {
  std::vector<uint8_t> placed(passes, 0);
  for (const uint32_t p : order) placed[p] = 1;
  return placed;
}

// Every waiting pass has a waiting producer, so walking up must return to a pass already visited.
void reportCycles(Binding& b, const std::vector<uint8_t>& placed) {
  const size_t passes = b.graph.passes.size();
  std::vector<uint32_t> producer(passes, kNone);
  std::vector<const Port*> waiting(passes, nullptr);  // the port that reads the producer
  for (const Port& port : b.ports) {
    if (port.source == kNone || port.previous() || placed[port.pass]) continue;
    const uint32_t from = b.ports[port.source].pass;
    if (placed[from] || producer[port.pass] != kNone) continue;
    producer[port.pass] = from;
    waiting[port.pass] = &port;
  }
  std::vector<uint8_t> seen(passes, 0);
  for (uint32_t start = 0; start < passes; ++start) {
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
    for (const uint32_t p : circle) names += b.graph.passes[p].name + " <- ";
    const Port* port = waiting[circle[0]];
    for (const uint32_t p : circle) port = &nearestWire(b, {port, waiting[p]});
    reportWire(b, *port,
               fmt::format("these passes wait for each other: {}{}", names, b.graph.passes[circle[0]].name),
               "one of these wires must read last frame's value: append @previous");
  }
}

// Each update in place makes the next version. Two updates of the same version have no defined order.
void updateInPlace(Binding& b, Port& port, std::vector<uint32_t>& updaters) {
  port.firstVersion = static_cast<uint32_t>(b.versions.size());
  for (uint32_t k = 0; k < port.value.count; ++k)
    b.versions.push_back(versionSeen(b, port, port.value.first + k));
  for (uint32_t m = 0; m < port.spec->members.size(); ++m) {
    const uint32_t r = resourceOf(b, port, m);
    if (r == kNone) continue;
    BoundResource& resource = b.graph.resources[r];
    uint32_t& version = b.versions[port.firstVersion + (r - port.value.first)];
    if (version != resource.versions) {
      const std::string& other = b.graph.passes[updaters[r] == kNone ? port.pass : updaters[r]].name;
      reportWire(b, port,
                 fmt::format("`{}` and `{}` both update `{}` in place: their order is open", other,
                             b.graph.passes[port.pass].name, resource.name),
                 fmt::format("wire one after the other: `{}.{}`", other, port.spec->name));
    }
    version = ++resource.versions;
    updaters[r] = port.pass;
  }
}

}  // namespace

// Uses the order of declaration if it has producers first, as in most graphs.
std::vector<uint32_t> orderPasses(Binding& b) {
  std::vector<Precedence::Edge> edges;
  edges.reserve(b.description.wires.size());
  bool asDeclared = true;
  for (const Port& port : b.ports) {
    if (port.source == kNone || port.previous()) continue;
    const uint32_t before = b.ports[port.source].pass;
    asDeclared &= before < port.pass;
    edges.emplace_back(before, port.pass);
  }
  std::vector<uint32_t> order(b.graph.passes.size());
  std::iota(order.begin(), order.end(), 0u);
  if (!asDeclared) order = Precedence(b.graph.passes.size(), edges).sorted();
  if (order.size() < b.graph.passes.size()) reportCycles(b, placedPasses(b.graph.passes.size(), order));
  return order;
}

void makeVersions(Binding& b, std::span<const uint32_t> order) {
  std::vector<uint32_t> updaters(b.graph.resources.size(), kNone);
  for (const uint32_t p : order)
    for (Port& port : b.portsOf(p))
      if (port.spec->direction == Direction::InOut && port.value.first != kNone)
        updateInPlace(b, port, updaters);
  for (BoundResource& r : b.graph.resources) {
    r.firstSlot = b.graph.slots;
    b.graph.slots += r.versions + 2;  // version 0 and last frame's copy
  }
}

// With updates in place, a reader of version v must run before the update to v + 1. Checks that such an order exists.
void checkInPlace(Binding& b) {
  const std::vector<BoundPass>& passes = b.graph.passes;
  if (std::none_of(b.ports.begin(), b.ports.end(),
                   [](const Port& port) { return port.spec->direction == Direction::InOut; }))
    return;
  const std::vector<uint32_t> makers = makersOfVersions(b.graph);
  const std::vector<uint32_t> order =
      precedence(b.graph, makers, std::vector<uint8_t>(passes.size(), 1)).sorted();
  if (order.size() == passes.size()) return;
  const std::vector<uint8_t> placed = placedPasses(passes.size(), order);
  // Reports a reader that waits although its value is about to be overwritten.
  for (const Port& port : b.ports) {
    if (placed[port.pass] || !port.wire || port.previous() || port.value.first == kNone) continue;
    const PortSpec& spec = *port.spec;
    if (spec.direction != Direction::Input) continue;
    for (uint32_t m = 0; m < spec.members.size(); ++m) {
      const uint32_t r = resourceOf(b, port, m);
      if (r == kNone) continue;
      const uint32_t by = makers[b.graph.resources[r].firstSlot + versionSeen(b, port, r) + 1];
      if (by == kNone || placed[by]) continue;
      if (by == port.pass)
        return reportWire(
            b, port,
            fmt::format("`{}` reads and updates `{}`: its input `{}` would be changed before it is read",
                        passes[by].name, port.wire->text(), spec.name),
            "wire one of the two ports to another value");
      return reportWire(
          b, port,
          fmt::format("`{}` must read `{}` before `{}` updates it in place, but it also waits for that pass",
                      passes[port.pass].name, port.wire->text(), passes[by].name),
          fmt::format("read the updated value from `{}`, or last frame's with @previous", passes[by].name));
    }
  }
  report(b, b.description.passes[0].written->keyWhere, {},
         "updates in place leave no order in which these passes could run");
}

// Chooses one layout per pass and image, and one for all readers of a version, so that a level never needs two.
void chooseLayouts(const BoundGraph& graph, std::vector<Access>& accesses) {
  struct Seen {
    uint32_t pass = kNone;
    Usage usage = Usage::None;
    bool reads = false, writes = false;
  };
  std::vector<VkImageLayout> readLayout(graph.slots, VK_IMAGE_LAYOUT_UNDEFINED);
  std::vector<Seen> seen(graph.resources.size() * 2);
  const auto isImage = [&](const Access& a) {
    return graph.resources[a.resource].desc.kind == ResourceKind::Image && a.usage != Usage::None;
  };
  bool mixed = false;  // readers of a version want different layouts
  size_t first = 0;    // access of the pass
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    const auto own = std::span(accesses).subspan(first, graph.passes[p].accesses.size());
    first += own.size();
    for (const Access& a : own) {
      Seen& s = seen[a.resource * 2 + a.previous];
      if (s.pass != p) s = {p, Usage::None, false, false};
      s.usage = s.usage | a.usage;
      s.reads |= a.reads;
      s.writes |= a.writes;
    }
    for (Access& a : own) {
      if (!isImage(a)) continue;
      const Seen& s = seen[a.resource * 2 + a.previous];
      a.layout = accessLayout(s.usage, s.reads, s.writes);
      if (s.writes) continue;
      VkImageLayout& shared = readLayout[a.slot];
      const bool differs = shared != VK_IMAGE_LAYOUT_UNDEFINED && shared != a.layout;
      shared = differs ? VK_IMAGE_LAYOUT_GENERAL : a.layout;
      mixed |= differs;
    }
  }
  if (!mixed) return;
  for (Access& a : accesses)
    if (isImage(a) && !a.writes && readLayout[a.slot] != VK_IMAGE_LAYOUT_UNDEFINED)
      a.layout = readLayout[a.slot];
}

}  // namespace fovea::graph::detail
