// Internal to bind: what its steps share. Each step fills in a part of it from the parts before.
#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/graph/compile/compile.h"
#include "framework/graph/compile/fitting.h"

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

  bool misspelt = false;  // a wire has nearly its name, which is reported, so that it is not missing

  bool previous() const { return wire && wire->previous; }
};

// Where a resource comes from: a member of an output, or nothing if it is the caller's.
struct Origin {
  uint32_t pass = kNone;
  const MemberSpec* spec = nullptr;
};

// A value that a parameter of a pass or of the view does not allow.
struct WrongValue {
  const ParameterDescription* given = nullptr;
  const ParameterSpec* spec = nullptr;
  std::string path;   // where it is used
  std::string found;  // in words
  std::string text;   // of a text
};

struct Binding {
  const Description& description;
  const Environment& environment;
  Diagnostics& diagnostics;
  BoundGraph& graph;
  bool suggest = true;                         // whether messages say which values would fit
  std::vector<VkExtent2D> viewExtents = {};    // per BoundGraph::views
  std::vector<Port> ports = {};                // of all passes
  std::vector<uint32_t> firstPort = {};        // per pass, and the end of the last one
  std::vector<uint32_t> firstOfExternal = {};  // resource, per Description::externals
  std::vector<Origin> origins = {};            // per resource
  std::vector<uint32_t> versions = {};         // that ports make
  // Values that are not allowed. One mistake of the user may cause several, so they are reported together at the end.
  std::vector<WrongValue> wrongValues = {};
  std::vector<std::vector<const ParameterSpec*>> uses = {};   // per Description::graphParameters
  std::map<uint32_t, std::vector<std::string>> misfits = {};  // of the types of passes, in words
  std::vector<Removal> removals = {};  // Description::removals, with more that need them
  std::map<uint32_t, std::vector<const Port*>> unwired = {};  // inputs by pass

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

// ---- What to blame (blame.cpp) -----------------------------------------------------------------------

// Where the type of a pass was chosen: at the pass, or where the value of the graph parameter is that names it.
const json::Position& placeOfType(const Binding& b, uint32_t pass);
// Whether the type of a pass was chosen nearer to the user than the place of what does not fit it. The type is reported
// then, once with all that does not fit.
bool blameType(Binding& b, uint32_t pass, const json::Position& other, std::string misfit);
// Reports a contradiction between a wire and what it leads to: at the wire, at one that it follows through updates in
// place, or at the type of a pass among these, whichever is nearest to the user.
void blameAlong(Binding& b, const Port& port, std::string message, std::string remedy);
// The wire that is nearest to the user of those that contradict each other, or the first of several such wires.
const Port& nearestWire(const Binding& b, std::initializer_list<const Port*> ports);
// The value of one of these parameters of a pass, or of the view, that was chosen nearest to the user, and nearer than
// the pass's type.
// Nothing if there is none.
struct GivenValue {
  json::Position where;
  std::string path, name;
};
std::optional<GivenValue> nearestValue(const Binding& b, uint32_t pass,
                                       const std::vector<std::string>& names);
// The same for the values from which a size of the pass follows, also through the sizes of its inputs.
std::optional<GivenValue> nearestSource(Binding& b, uint32_t pass, const SizeExpr& size);
void reportUnwired(Binding& b);
void reportRemovals(Binding& b);
void reportMisfits(Binding& b);
void reportUnusedOverrides(Binding& b);

// ---- Values (values.cpp) -----------------------------------------------------------------------------

// Values of all `specs`: the given ones, or else the defaults. owner: who has these parameters, for messages; path: of
// their object in its document.
Parameters bindParameters(Binding& b, const std::string& owner, const std::string& path,
                          const std::vector<ParameterSpec>& specs,
                          std::span<const ParameterDescription> given, std::vector<Value>& values,
                          uint32_t pass = kNone);
void bindViewParameters(Binding& b, std::vector<Value>& values);
void reportWrongValues(Binding& b);
// The text in which a reference to a text of the environment, from its '$' on, is replaced by that text.
std::string fromEnvironment(const Binding& b, const std::string& text);

// Whether the members of the port are resources of their own.
inline bool makes(const PortSpec& spec) {
  return spec.direction == Direction::Output || spec.direction == Direction::Scratch;
}
// The resource that member `m` of this port stands for, or kNone.
uint32_t resourceOf(const Binding& b, const Port& port, uint32_t m);
// The resource that a size expression of the pass names: "vpls", "voxels.index"; or kNone.
uint32_t resourceNamed(Binding& b, uint32_t pass, std::string_view name);
// The version of the resource that an input sees.
uint32_t versionSeen(const Binding& b, const Port& port, uint32_t resource);

// ---- Steps, in this order ----------------------------------------------------------------------------

// connect.cpp: which resources each wired port stands for, and whether their types fit.
void assignWires(Binding& b);
void connectWire(Binding& b, Port& port);
void followValues(Binding& b);
void checkTypes(Binding& b);
// "an image of rgba16f", and what could be wired to an input that is not wired.
std::string describeWanted(const PortSpec& spec);
std::string missingRemedy(const Binding& b, const Port& missing);

// order.cpp: passes with producers first, without those on a cycle; then versions, and hazards that no order avoids.
std::vector<uint32_t> orderPasses(Binding& b);
void makeVersions(Binding& b, std::span<const uint32_t> order);
void checkInPlace(Binding& b);
void chooseLayouts(const BoundGraph& graph, std::vector<Access>& accesses);

// sizes.cpp: evaluates size expressions, and checks the device's limits.
void evaluateSizes(Binding& b, std::span<const uint32_t> order);

// requirements.cpp: RequirementSpec of each pass that runs. The graph must have no other mistakes.
void checkRequirements(Binding& b);

}  // namespace fovea::graph::detail
