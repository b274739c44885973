// Internal to resolve: scopes (the graph itself and each instance of a sub-graph) and the state needed to expand them.
#pragma once

#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/base/same_text.h"
#include "framework/graph/compile/resolve.h"
#include "framework/graph/compile/scratch.h"

namespace fovea::graph::detail {

// Names of passes, parameters and inputs consist of letters, digits, _ and -.
bool isName(std::string_view name);

// A place inside a document, such as "passes.a.inputs.b", whose text is only put together for messages. It refers to
// its parts and does not own them.
class Trail {
 public:
  Trail() = default;
  Trail(const std::string& whole) : key_(whole) {}  // NOLINT: implicit, a text is a place
  Trail(const char* whole) : key_(whole) {}         // NOLINT
  Trail(const Trail& before, std::string_view key) : before_(&before), key_(key) {}
  std::string text() const { return before_ ? json::joinPath(before_->text(), key_) : std::string(key_); }

 private:
  const Trail* before_ = nullptr;
  std::string_view key_;
};

// One graph document in use: the whole graph, or a sub-graph under a prefix.
struct Scope {
  struct Parameter {
    std::string_view name;  // in its document
    ParameterDescription value;
    bool used = false;
  };
  struct Input {
    std::string name;
    bool optional = false;
    bool used = false;
    const json::Value* wire = nullptr;  // what the parent wired, in the spelling of the parent's document
    uint32_t external = kNone;          // index of the input among those of the whole graph
    Place place;
  };

  explicit Scope(Scratch& scratch) : parameters(scratch) {}

  std::string prefix;       // "" or "left/"
  std::string path;         // in the parent's document, e.g. "passes.left"
  Scope* parent = nullptr;  // nullptr for the whole graph
  std::string file;
  const json::Value* document = nullptr;
  Symbol view = kNone;
  ScratchVector<Parameter> parameters;
  std::vector<Input> inputs;
  std::map<std::string, Scope*, std::less<>> instances;

  Parameter* findParameter(std::string_view name) {
    for (Parameter& p : parameters)
      if (sameText(p.name, name)) return &p;
    return nullptr;
  }
  Input* findInput(std::string_view name);
};

// "pass.port.member@previous", split into its parts.
struct WireParts {
  std::string_view names[3];
  uint32_t count = 0;     // 4 if there are more than three
  bool open = false;      // a name is empty
  std::string_view rest;  // everything from the '@' on

  std::string_view pass() const { return names[0]; }
  std::string_view port() const { return names[1]; }
  std::string_view member() const { return names[2]; }
};

struct RawWire {
  Scope* scope;
  std::string_view pass;  // name in its document
  std::string_view target;
  const json::Value* value;
  Place keyPlace;
};

// Hidden because nothing outside the library calls it; its functions then call each other directly or are inlined.
class [[gnu::visibility("hidden")]] Expander;

class Expander {
 public:
  Expander(Description& description, const LoadOptions& options, Diagnostics& diagnostics);

  // expand.cpp: structure and parameters
  void expandRoot(const json::Value& document, const std::filesystem::path& file);
  void reportUnused();

  // wiring.cpp
  void resolveWires();

 private:
  struct PendingOverride {
    std::string target, name;  // "left/blur", "radius"; target is "" for a parameter of the graph
    const Override* source = nullptr;
    bool used = false;
  };

  void expandScope(Scope& scope);
  void readParameters(Scope& scope, const json::Value* given, const Trail& givenPath);
  void overrideParameters(Scope& scope);
  void readRootInputs(Scope& scope);
  void readInputs(Scope& scope, const json::Value* wires);
  void expandPass(Scope& scope, const json::Member& member);
  PassDescription& addPass(Scope& scope, const json::Member& member, const Trail& path,
                           const json::Value* type);
  void addPassInputs(Scope& scope, const json::Member& pass, const std::vector<json::Member>& inputs,
                     const Trail& path);
  void addPassParameters(Scope& scope, PassDescription& pass, const json::Value* params, const Trail& path);
  void overridePass(PassDescription& pass);
  void expandInstance(Scope& parent, const json::Member& member, const json::Value& graph,
                      json::ObjectReader& reader);
  ResourceDesc readResource(Scope& scope, json::ObjectReader& reader);
  int64_t readSize(Scope& scope, json::ObjectReader& reader, const char* key, int64_t fallback);
  Symbol readView(Scope& scope, const json::Value& value, const Trail& path);
  Symbol readType(Scope& scope, const json::Value& type, const Trail& path);
  // A literal or "$name".
  bool readScalar(Scope& scope, const json::Value& value, const Trail& path, ParameterDescription& out);
  [[gnu::noinline]] void reportNoScalar(const json::Value& value, const Trail& path);
  [[gnu::noinline]] void reportNoParameter(const Scope& scope, const json::Value& value, const Trail& path);
  ParameterDescription overrideValue(const ParameterDescription& current, const Override& source);

  bool resolveWire(Scope& scope, const json::Value& value, const Trail& path, WireDescription& wire,
                   int depth);
  Symbol findPass(const Scope& scope, std::string_view name) const;
  bool resolveInput(Scope& scope, const json::Value& value, const Trail& path, const WireParts& parts,
                    WireDescription& wire, int depth);
  bool resolveInstance(Scope& child, const json::Value& value, const Trail& path, const WireParts& parts,
                       WireDescription& wire, int depth);
  bool combine(const json::Value& value, const Trail& path, std::string_view member, bool previous,
               WireDescription& wire);
  void resolveOutputs();
  void describeWire(const json::Value& value, const Place& keyPlace, WireDescription& wire);

  [[gnu::cold]] void error(const json::Position& where, const Trail& path, std::string message,
                           std::string remedy = {});
  std::string nearestRemedy(std::string_view word, const std::vector<std::string>& names);
  Place place(const json::Position& position) {
    if (position.file.get() != latestFile_) enterFile(position.file);
    return {latestIndex_, position.line, position.column};
  }
  void enterFile(const std::shared_ptr<const std::string>& file);
  static bool containsItself(const Scope& scope, const std::filesystem::path& file);
  Symbol intern(std::string_view text) { return description_.symbols.intern(text); }
  std::string_view keep(std::string_view text) { return description_.symbols.keep(text); }

  Description& description_;
  const LoadOptions& options_;
  Diagnostics& diagnostics_;
  Scratch scratch_;
  std::list<Scope, ScratchAllocator<Scope>> scopes_{scratch_};                 // pointed to, as are
  std::list<json::Value, ScratchAllocator<json::Value>> documents_{scratch_};  // the documents of sub-graphs
  ScratchVector<RawWire> rawWires_{scratch_};
  ScratchVector<uint32_t> rawFirst_{scratch_};  // per pass
  std::vector<PendingOverride> overrides_;
  // Files met so far and their numbers. They are held so that no address is reused.
  ScratchVector<std::pair<std::shared_ptr<const std::string>, uint32_t>> files_{scratch_};
  const std::string noFile_;                  // latestFile_ points here before any file is met
  const std::string* latestFile_ = &noFile_;  // file of the latest place(), and its index
  uint32_t latestIndex_ = kNone;
  std::span<uint8_t> isPass_;  // indexed by symbol
  size_t made_ = 0;            // number of passes and scopes
  bool full_ = false;
};

}  // namespace fovea::graph::detail
