// Internal to bind: flat tables over the ports of all passes. Names were turned into numbers by resolve, so binding is
// a few walks over arrays; texts are only put together for messages.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/graph/compile/compile.h"
#include "framework/graph/compile/scratch.h"

namespace fovea::graph::detail {

// The value of a port: consecutive resources that an output port makes or the caller provides.
struct PortValue {
  uint32_t first = kNone;  // kNone: nothing, or a mistake that has been reported
  uint32_t count = 0;
  const PortSpec* origin = nullptr;  // nullptr: external
  uint32_t member = kNone;           // a single member of a bundle, as a plain value
  uint32_t external = kNone;
};

struct PortState {
  explicit PortState(const PortSpec* declared, uint32_t ofPass, uint16_t number)
      : spec(declared), pass(ofPass), index(number) {}
  const PortSpec* spec;  // nullptr: an output of the graph
  uint32_t pass;
  uint16_t index;  // in the declaration
  bool previous = false;
  uint8_t state = 0;        // value: 0 unknown, 1 being followed, 2 known
  uint32_t wire = kNone;    // Description::wires
  uint32_t source = kNone;  // producing port
  PortValue value;
  uint32_t firstVersion = kNone;  // producing ports: index into versions_, one entry per resource
};

// Whether the members of the port are resources of their own.
inline bool makes(const PortSpec& spec) {
  return spec.direction == Direction::Output || spec.direction == Direction::Scratch;
}

// Hidden because nothing outside the library calls it; its functions then call each other directly or are
// inlined. Functions that are rarely called or report a mistake are kept out of line, so that the code that runs
// for each pass stays short.
class [[gnu::visibility("hidden")]] Binder;

class Binder {
 public:
  // `graph` must be empty; it is filled in.
  Binder(const Description& description, const Environment& environment, Diagnostics& diagnostics,
         BoundGraph& graph);
  void run();

 private:
  // bind.cpp: passes, parameters, accesses, outputs
  void openViews();
  void declare();
  void bindView(BoundPass& pass, const PassDescription& from);
  void bindParameters(BoundPass& pass, const PassDescription& from);
  void readParameter(const ParameterSpec& spec, const ParameterDescription& given,
                     const PassDescription& pass, Value& out);
  [[gnu::noinline]] void readOther(const ParameterSpec& spec, const ParameterDescription& given,
                                   const PassDescription& pass, Value& out);
  [[gnu::noinline]] void bindParameter(const std::vector<ParameterSpec>& specs,
                                       const ParameterDescription& given, const PassDescription& from,
                                       std::vector<Value>::iterator values);
  void reportParameter(const ParameterSpec& spec, const ParameterDescription& given,
                       const PassDescription& pass);
  bool assign(const ParameterSpec& spec, const ParameterDescription& given, Value& out) const;
  [[gnu::noinline]] bool assignText(const ParameterSpec& spec, std::string_view given, Value& out) const;
  void makeExternals();
  void makeResources();
  void makeAccesses();
  void addAccesses(BoundPass& pass, const PortState& port);
  void bindOutputs();
  void markHistory();
  uint64_t hash() const;

  // connect.cpp: wires
  void assignWires();
  void connectWire(PortState& port, const WireDescription& wire);
  [[gnu::noinline]] void connectExternal(PortState& port, const WireDescription& wire);
  [[gnu::noinline]] void reportNoOutput(PortState& port, const WireDescription& wire, uint32_t pass);
  std::string connectedPath(const PortState& port, const WireDescription& wire) const;
  bool selectPort(const WireDescription& wire, uint32_t pass, uint32_t& port, uint32_t& member);
  [[gnu::noinline]] bool selectMember(const PortSpec& spec, Symbol name, uint32_t& member) const;
  void followValues();
  void followValue(uint32_t port);
  void takeValue(PortState& port);
  [[gnu::noinline]] void takeMember(PortState& port, uint32_t member);
  void checkTypes();
  void checkPort(PortState& port, const PortSpec& spec);
  std::string_view bundleOf(const PortValue& value) const;
  bool fits(const MemberSpec& wanted, uint32_t resource) const;
  void reportUnwired(const PortState& port, const PortSpec& spec);
  [[gnu::noinline]] void reportMisfit(const PortState& port, const PortSpec& spec, uint32_t m);
  std::string describeMisfit(const PortState& port, const MemberSpec& wanted, uint32_t m) const;
  // The resource that member `m` of this port stands for, or kNone.
  uint32_t resourceOf(const PortState& port, uint32_t m) const {
    const PortValue& value = port.value;
    if (value.count == 1 && port.spec->bundle.empty()) return value.first;
    if (value.origin == port.spec) return value.first + m;
    return value.first == kNone ? kNone : resourceNamed(value, port.spec->members[m].name);
  }
  uint32_t resourceNamed(const PortValue& value, const std::string& member) const;
  std::string missingRemedy(const PortSpec& spec) const;
  std::string describeValue(const PortValue& value) const;
  std::string describeWanted(const PortSpec& spec) const;

  // order.cpp: order, versions, and hazards that no order can avoid
  void orderPasses();
  void reportCycle(std::span<const uint32_t> waiting);
  void makeVersions();
  void updateInPlace();
  void checkInPlace();
  uint32_t versionSeen(const PortState& port, uint32_t resource) const {
    if (port.source == kNone) return 0;  // external, before any update
    const PortState& source = ports_[port.source];
    if (source.firstVersion == kNone) return 0;  // after a mistake
    return versions_[source.firstVersion + (resource - source.value.first)];
  }
  void chooseLayouts();

  // sizes.cpp
  void evaluateSizes();
  bool evaluatePass(uint32_t pass, int depth);
  bool evaluateResource(uint32_t pass, const PortSpec& spec, const MemberSpec& member, VkExtent2D view,
                        BoundResource& resource, int depth);
  bool evaluateSize(uint32_t pass, const PortSpec& spec, const MemberSpec& member, const SizeExpr& size,
                    const char* what, int64_t limit, int64_t& out, int depth);
  bool evaluate(uint32_t pass, const SizeExpr& size, int64_t& out, int depth, std::string& why);
  bool evaluateTerm(uint32_t pass, const SizeExpr::Term& term, int64_t& out, int depth, std::string& why);
  bool sizeOfPort(uint32_t pass, const SizeExpr::Term& term, int64_t& out, int depth, std::string& why);
  bool withinLimits(const MemberSpec& member, const ResourceDesc& desc) const;
  void reportLimits(uint32_t pass, const PortSpec& spec, const MemberSpec& member, const ResourceDesc& desc);
  std::string parametersOf(const ResourceSpec& spec) const;
  std::string otherChoices(uint32_t p, const ResourceSpec& spec) const;

  std::string_view text(Symbol symbol) const { return description_.symbols[symbol]; }
  [[gnu::cold]] void error(const Place& place, std::string path, std::string message,
                           std::string remedy = {});
  std::string passPath(uint32_t pass, std::string_view rest = {}) const;
  std::string wirePath(const PortState& port) const;
  PortState* portsOf(uint32_t pass) { return ports_.data() + firstPort_[pass]; }
  uint32_t portCount(uint32_t pass) const { return firstPort_[pass + 1] - firstPort_[pass]; }

  const Description& description_;
  const Environment& environment_;
  Diagnostics& diagnostics_;
  const Registry& registry_;
  BoundGraph& graph_;
  // Values of all passes; complete before anyone reads them.
  std::shared_ptr<std::vector<Value>> values_ = std::make_shared<std::vector<Value>>();
  Scratch scratch_;
  std::span<uint32_t> passBySymbol_;
  std::span<uint32_t> firstPort_;  // per pass, and the end of the last one
  ScratchVector<PortState> ports_{scratch_};
  ScratchVector<uint32_t> versions_{scratch_};
  ScratchVector<uint32_t> order_{scratch_};          // passes, producers first; incomplete after a cycle
  ScratchVector<uint32_t> externalFirst_{scratch_};  // first resource of each external
  ScratchVector<VkExtent2D> viewExtents_{scratch_};  // per BoundGraph::views
  ScratchVector<uint32_t> resourcePass_{scratch_};   // producing pass; kNone for externals
  ScratchVector<const MemberSpec*> resourceSpec_{scratch_};  // as declared by its producer
  ScratchVector<uint32_t> chain_{scratch_};                  // used by followValue
  std::span<uint8_t> sized_;  // per pass: 0 pending, 1 in progress, 2 done, 3 failed
  size_t resourceCount_ = 0;  // number of resources made by passes
  bool inPlace_ = false, history_ = false;
  bool inOrder_ = true;  // all passes are declared after those they wait for
};

// "image rgba16f", "buffer of Vpl (64 bytes each)"
std::string describeResource(ResourceKind kind, VkFormat format, bool volume, bool array,
                             std::string_view element, uint32_t stride);

}  // namespace fovea::graph::detail
