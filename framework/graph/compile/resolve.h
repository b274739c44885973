// Resolves JSON to a description: merges `extends`, instances sub-graphs under their prefixes and applies parameters
// and overrides. Wires are split and lead to passes; pass types are not considered yet.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/error.h"
#include "fovea/graph.h"
#include "fovea/pass.h"
#include "framework/base/json.h"

namespace fovea::graph {

// --set name=value
struct Override {
  std::string name;   // "radius" or "pass.radius"
  std::string value;  // as typed
};

struct LoadOptions {
  std::vector<Override> overrides;
  std::vector<std::filesystem::path> searchPaths;
};

// "pass.port.member@previous", split into its parts. "inputs.x" of a sub-graph has been replaced by what the parent
// wired.
struct WireDescription {
  const json::Member* written =
      nullptr;                       // the input port or output of the graph, and the wire as in its document
  uint32_t pass = 0;                 // index into Description::passes, unless `external` is set
  std::optional<uint32_t> external;  // index into Description::externals
  std::string_view port, member;     // "" for the only output and for the whole port
  bool previous = false;

  const std::string& target() const { return written->key; }
  const std::string& text() const { return written->value.string; }
};

struct ParameterDescription {
  const json::Member* given = nullptr;    // the name, and the value or a reference such as "$radius"
  const json::Value* value = nullptr;     // true, false, a number or a text
  const json::Position* where = nullptr;  // where a wrong value is reported
  bool fromCommandLine = false;           // a text is yet to be read as the parameter's own type
  bool fromEnvironment = false;  // a text that stands for one of Environment::texts, as "$scene.materials"
};

struct PassDescription {
  std::string name;                                 // with its prefix: "left/blur"
  const json::Member* written = nullptr;            // in its document, under its own name
  const json::Value* type = nullptr;                // a text; nullptr after a mistake
  std::optional<std::string_view> view;             // explicit or inherited; nothing for the default view
  const json::Value* ownView = nullptr;             // where it is set at the pass itself
  uint32_t firstInput = 0, inputCount = 0;          // Description::wires
  uint32_t firstParameter = 0, parameterCount = 0;  // Description::parameters
};

// An input of the whole graph, in the caller's memory.
struct ExternalDescription {
  std::string name;
  std::string bundle;                   // "" for a plain input
  std::vector<std::string> members;     // "" for a plain input
  std::vector<ResourceDesc> resources;  // width 0 stands for the size of the default view
  json::Position where;
};

struct Description {
  std::string name;  // file stem
  std::string description;
  SourceLocation start;                 // of the graph as a whole, for messages
  std::vector<PassDescription> passes;  // declaration order, sub-graphs expanded in place
  std::vector<WireDescription> wires;
  std::vector<ParameterDescription> parameters;
  std::vector<ParameterDescription> view;  // given values of viewParameters()
  std::vector<WireDescription> outputs;
  std::vector<ExternalDescription> externals;
  // What the above refers to: the documents, and values that are in no document, such as those of overrides.
  std::vector<std::shared_ptr<const json::Value>> documents;
  std::vector<std::shared_ptr<const json::Member>> made;
};

// Merges `patch` over `base` as in RFC 7396, keys of the base first. An object under "passes" whose "type" or "graph"
// differs replaces that of the base. A null that removes nothing is an error. Exposed for tests.
json::Value mergeDocuments(json::Value base, const json::Value& patch, Diagnostics& diagnostics);

// The document with everything it extends merged in: `document` itself if it extends nothing.
std::shared_ptr<const json::Value> mergeExtends(std::shared_ptr<const json::Value> document,
                                                const std::filesystem::path& file, const LoadOptions& options,
                                                Diagnostics& diagnostics);

// Looks for `name`, with or without ".json", relative to the folder of `from` and then in the search paths. Empty if
// it is not found.
std::filesystem::path findGraphFile(const std::string& name, const std::filesystem::path& from,
                                    const std::vector<std::filesystem::path>& searchPaths);

// Reads text from the command line: as true or false if `type` is Bool, otherwise as a number, which is
// written as in JSON. False if it is none.
bool readTyped(const std::string& text, json::Value::Type type, json::Value& out);

// Limits of a graph file, so that a file cannot exhaust memory.
inline constexpr size_t kMaxPasses = 10000;
inline constexpr int kMaxInstanceDepth = 16;

Description resolve(std::shared_ptr<const json::Value> document, const std::filesystem::path& file,
                    const LoadOptions& options, Diagnostics& diagnostics);

}  // namespace fovea::graph
