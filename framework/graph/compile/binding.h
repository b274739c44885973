// Internal to bind: what its steps share. Each step fills in a part of it from the parts before.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/graph/compile/compile.h"

namespace fovea::graph::detail {

// The value of a port: consecutive resources that an output port makes or the caller provides.
struct PortValue {
  uint32_t first = kNone;  // kNone: nothing, or a mistake that has been reported
  uint32_t count = 0;
  const PortSpec* origin = nullptr;  // nullptr: external
  uint32_t member = kNone;           // a single member of a bundle, as a plain value
  uint32_t external = kNone;         // Description::externals
};

struct Port {
  const PortSpec* spec = nullptr;  // nullptr: an output of the graph
  uint32_t pass = kNone;
  uint16_t index = 0;                                                                   // in the declaration
  enum class State : uint8_t { Unknown, BeingFollowed, Known } state = State::Unknown;  // of the value
  const WireDescription* wire = nullptr;
  uint32_t source = kNone;  // producing port
  PortValue value;
  uint32_t firstVersion = kNone;  // producing ports: index into Binding::versions, one entry per resource

  bool previous() const { return wire && wire->previous; }
};

// Where a resource comes from: a member of an output, or nothing if it is the caller's.
struct Origin {
  uint32_t pass = kNone;
  const MemberSpec* spec = nullptr;
};

struct Binding {
  const Description& description;
  const Environment& environment;
  Diagnostics& diagnostics;
  BoundGraph& graph;
  std::vector<VkExtent2D> viewExtents = {};    // per BoundGraph::views
  std::vector<Port> ports = {};                // of all passes
  std::vector<uint32_t> firstPort = {};        // per pass, and the end of the last one
  std::vector<uint32_t> firstOfExternal = {};  // resource, per Description::externals
  std::vector<Origin> origins = {};            // per resource
  std::vector<uint32_t> versions = {};         // that ports make

  std::span<Port> portsOf(uint32_t pass) {
    return std::span(ports).subspan(firstPort[pass], firstPort[pass + 1] - firstPort[pass]);
  }
};

void report(Binding& b, const json::Position& where, std::string path, std::string message,
            std::string remedy = {});
// "did you mean `x`?" or "it has: a, b".
std::string remedyFor(std::string_view name, const std::vector<std::string>& names);
// "passes.blur", "passes.blur.type"; and where a wire of a pass or of the graph's outputs is written.
std::string passPath(const Binding& b, uint32_t pass, std::string_view rest = {});
std::string wirePath(const Binding& b, const Port& port);
// Reports a mistake where the port is wired.
void reportWire(Binding& b, const Port& port, std::string message, std::string remedy = {});

// Whether the members of the port are resources of their own.
inline bool makes(const PortSpec& spec) {
  return spec.direction == Direction::Output || spec.direction == Direction::Scratch;
}
// The resource that member `m` of this port stands for, or kNone.
uint32_t resourceOf(const Binding& b, const Port& port, uint32_t m);
// The version of the resource that an input sees.
uint32_t versionSeen(const Binding& b, const Port& port, uint32_t resource);

// ---- Steps, in this order ----------------------------------------------------------------------------

// connect.cpp: which resources each wired port stands for, and whether their types fit.
void assignWires(Binding& b);
void connectWire(Binding& b, Port& port);
void followValues(Binding& b);
void checkTypes(Binding& b);

// order.cpp: passes with producers first, without those on a cycle; then versions, and hazards that no order avoids.
std::vector<uint32_t> orderPasses(Binding& b);
void makeVersions(Binding& b, std::span<const uint32_t> order);
void checkInPlace(Binding& b);
void chooseLayouts(const BoundGraph& graph, std::vector<Access>& accesses);

// sizes.cpp: evaluates size expressions, and checks the device's limits.
void evaluateSizes(Binding& b, std::span<const uint32_t> order);

}  // namespace fovea::graph::detail
