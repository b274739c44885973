// Internal to resolve: scopes, and what the functions that expand them share.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <memory_resource>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "framework/graph/resolve/resolve.h"

namespace fovea::graph::detail {

// One graph document in use: the whole graph, or a sub-graph under a prefix.
struct Scope {
  struct Input {
    const json::Member* declared = nullptr;
    bool optional = false;
    bool used = false;
    const json::Value* wire = nullptr;  // what the parent wired, in the spelling of the parent's document
    std::optional<uint32_t> external;   // index of the input among those of the whole graph
  };

  std::string prefix;       // "" or "left/"
  Scope* parent = nullptr;  // nullptr for the whole graph
  std::filesystem::path file;
  const json::Value* document = nullptr;
  std::optional<std::string_view> view;
  std::vector<uint32_t> parameters;  // Description::graphParameters
  std::vector<Input> inputs;
  std::map<std::string, Scope*, std::less<>> instances;
  std::vector<std::string> broken;  // passes, instances and inputs with a mistake that has been reported

  bool isBroken(std::string_view name) const {
    return std::find(broken.begin(), broken.end(), name) != broken.end();
  }
  Input* findInput(std::string_view name);
};

// Reads a graph file of at most kMaxGraphBytes and brings it to the newest version. Throws Error(BadInput) if it is no
// JSON.
inline constexpr uint64_t kMaxGraphBytes = uint64_t(8) << 20;  // kMaxPasses of 800 bytes each
json::Value readGraphFile(const std::filesystem::path& file, Diagnostics& diagnostics);
// Whether the patch turns the pass into one of another kind, in which case no old setting may remain.
bool replacesWhole(const json::Value& base, const json::Value& patch);
// What to do where no file of this name is found beside `from` or in the search paths.
std::string graphFileRemedy(const std::string& name, const std::filesystem::path& from,
                            const std::vector<std::filesystem::path>& searchPaths);

struct Expansion {
  struct PendingOverride {
    std::string target, name;  // "left/blur", "radius"; target is "" for a parameter of the graph
    const Override* source = nullptr;
    bool used = false;
  };
  // Where a pass comes from. Its wires are resolved when all passes are known.
  struct Origin {
    Scope* scope = nullptr;
    const json::Value* inputs = nullptr;  // an object, or nullptr
  };

  Description& description;
  const LoadOptions& options;
  Diagnostics& diagnostics;
  std::deque<Scope> scopes = {};     // pointed to
  std::vector<Origin> origins = {};  // per pass
  // Description::passes by full name. The table takes its memory from one buffer, because allocating each entry costs a
  // sixth of resolve.
  std::pmr::monotonic_buffer_resource memory = {};
  std::pmr::unordered_map<std::string, uint32_t> passes{&memory};
  std::vector<PendingOverride> overrides = {};
  std::map<size_t, std::vector<std::string>> missed =
      {};           // by Description::removals: what needs what is gone
  size_t made = 0;  // number of passes and scopes
  bool full = false;
};

// Reports a mistake at a position, with the place of `value` inside the document of the scope.
void report(Expansion& all, const Scope& scope, const json::Position& where, const json::Value& value,
            std::string message, std::string remedy = {});
inline void report(Expansion& all, const Scope& scope, const json::Value& value, std::string message,
                   std::string remedy = {}) {
  report(all, scope, value.where, value, std::move(message), std::move(remedy));
}
// The place of `value` in the document of the scope, such as "passes.a.inputs.b".
std::string pathOf(const Scope& scope, const json::Value& value);
// "did you mean `x`?", or else which names there are.
std::string nearestRemedy(std::string_view word, const std::vector<std::string>& names);

// The target of overrides of what belongs to the frame: "view.materials".
inline constexpr std::string_view kViewTarget = "view";

// Names of passes, parameters and inputs consist of letters, digits, _ and -.
bool isName(std::string_view name);

// Whether what is missing at this place of the scope's document was removed by a `null` that is nearer to the user than
// `by`, the place that refers to it. If so, bind() reports the `null` once for all such places; `who` names this one.
bool blameRemoval(Expansion& all, const Scope& scope, const std::string& path, const json::Position& by,
                  std::string who);

// parameters.cpp: of the graph, of sub-graphs and of the command line.
void readOverrides(Expansion& all);
// Declares the parameters of a scope: with their defaults, with what the parent gives, or as the command line says.
void readParameters(Expansion& all, Scope& scope, const json::Value* given);
// Reads a literal or "$name". False after a mistake, which is reported.
bool readScalar(Expansion& all, Scope& scope, const json::Value& value, ParameterDescription& out);
// Appends to `list` the values of an object, or those that overrides of `target` put in their place or beside them.
void readValues(Expansion& all, Scope& scope, std::vector<ParameterDescription>& list,
                const json::Value* values, std::string_view target);
void reportUnusedParameters(Expansion& all);

// inputs.cpp: of the whole graph, and of a sub-graph whose parent gives `wires`
void readRootInputs(Expansion& all, Scope& scope);
void readInputs(Expansion& all, Scope& scope, const json::Value* wires);

// wiring.cpp: fills in the wires and outputs of the description
void resolveWires(Expansion& all);

}  // namespace fovea::graph::detail
