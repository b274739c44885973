// Internal to resolve: scopes, and what the functions that expand them share.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory_resource>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "framework/graph/compile/resolve.h"

namespace fovea::graph::detail {

// One graph document in use: the whole graph, or a sub-graph under a prefix.
struct Scope {
  struct Parameter {
    const json::Member* declared = nullptr;  // in its document
    ParameterDescription value;
    bool used = false;
  };
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
  std::vector<Parameter> parameters;
  std::vector<Input> inputs;
  std::map<std::string, Scope*, std::less<>> instances;

  Parameter* findParameter(std::string_view name);
  Input* findInput(std::string_view name);
};

// Reads a graph file of at most kMaxGraphBytes and brings it to the newest version. Throws Error(BadInput) if it is no
// JSON.
inline constexpr uint64_t kMaxGraphBytes = uint64_t(8) << 20;  // kMaxPasses of 800 bytes each
json::Value readGraphFile(const std::filesystem::path& file, Diagnostics& diagnostics);

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
std::string nearestRemedy(std::string_view word, const std::vector<std::string>& names);

// The target of overrides of what belongs to the frame: "view.materials".
inline constexpr std::string_view kViewTarget = "view";

// Names of passes, parameters and inputs consist of letters, digits, _ and -.
bool isName(std::string_view name);

// Reads a literal or "$name". False after a mistake, which is reported.
bool readScalar(Expansion& all, Scope& scope, const json::Value& value, ParameterDescription& out);

// inputs.cpp: of the whole graph, and of a sub-graph whose parent gives `wires`
void readRootInputs(Expansion& all, Scope& scope);
void readInputs(Expansion& all, Scope& scope, const json::Value* wires);

// wiring.cpp: fills in the wires and outputs of the description
void resolveWires(Expansion& all);

}  // namespace fovea::graph::detail
