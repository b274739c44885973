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

  std::string typed() const { return "--set " + name + "=" + value; }
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
  bool broken = false;  // leads nowhere, because of a mistake that has been reported
  bool open = false;    // leads to an optional input of a sub-graph to which nothing is wired
  // If the wire passes inputs and outputs of sub-graphs: the part that is written nearest to the user, and its place.
  const json::Value* nearest = nullptr;
  std::string nearestPath = {};

  const json::Position& where() const { return nearest ? nearest->where : written->value.where; }

  const std::string& target() const { return written->key; }
  const std::string& text() const { return written->value.string; }
};

struct ParameterDescription {
  const json::Member* given = nullptr;  // the name, and the value or a reference such as "$radius"
  const json::Value* value = nullptr;   // true, false, a number or a text, where it was written or typed
  std::optional<uint32_t> from;         // of a reference: index into Description::graphParameters
  bool fromCommandLine = false;         // a text is yet to be read as the parameter's own type
  bool fromEnvironment = false;  // a text that stands for one of Environment::texts, as "$scene.materials"
};

// A parameter of the graph or of a sub-graph.
struct GraphParameter {
  const json::Member* declared = nullptr;  // in its document
  std::string target;                      // the sub-graph, as in --set: "" or "right"
  std::string path;                        // of the value, for messages: "parameters.kernel"
  ParameterDescription value;              // `value.value` is nullptr after a mistake
  bool used = false;

  std::string name() const { return target.empty() ? declared->key : target + "." + declared->key; }
};

// What a `null` in a file has removed from what the file extends.
struct Removal {
  const json::Value* document = nullptr;   // the merged one
  std::string path;                        // "passes.blur"
  json::Position where;                    // of the null
  std::vector<std::string> neededAt = {};  // the places that need what is gone
};

struct PassDescription {
  std::string name;                                 // with its prefix: "left/blur"
  const json::Member* written = nullptr;            // in its document, under its own name
  const json::Value* document = nullptr;            // the merged one
  const json::Value* type = nullptr;                // a text; nullptr after a mistake
  std::optional<uint32_t> typeFrom;                 // Description::graphParameters, of "blur-$kernel"
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

// A document with everything it extends merged in, and what became of it on the way.
struct Merged {
  std::shared_ptr<const json::Value> document;
  std::vector<Removal> removals;
  std::vector<std::shared_ptr<const std::string>> files;  // of the document first
};

struct Description {
  std::string name;  // file stem
  std::string description;
  SourceLocation start;                 // of the graph as a whole, for messages
  std::vector<PassDescription> passes;  // declaration order, sub-graphs expanded in place
  std::vector<WireDescription> wires;
  std::vector<ParameterDescription> parameters;
  std::vector<ParameterDescription> view;  // given values of viewParameters()
  std::vector<GraphParameter> graphParameters;
  std::vector<std::string> instances;     // names of sub-graphs, as in --set: "right"
  std::vector<Override> unusedOverrides;  // whose names are those of no parameter that a document mentions
  std::vector<WireDescription> outputs;
  std::vector<ExternalDescription> externals;
  std::vector<Removal> removals;
  // The files, from what the user names to what it extends, and then those of sub-graphs.
  std::vector<std::shared_ptr<const std::string>> files;
  // What the above refers to: the documents, and values that are in no document, such as those of overrides.
  std::vector<std::shared_ptr<const json::Value>> documents;
  std::vector<std::shared_ptr<const json::Member>> made;

  std::shared_ptr<const json::Value> take(Merged merged);  // keeps the document and what is known of it
};

// How near to the user something is written: negative for the command line, 0 for the file that the user names, more for
// each file that is extended. Where two things contradict each other, the nearer one is to blame, because the other was
// right without it.
int layerOf(const Description& description, const json::Position& where);

// The removal of what is at this place of a document, or of something that contained it; nullptr if there is none.
Removal* findRemoval(std::vector<Removal>& removals, const json::Value* document, std::string_view path);

// Merges `patch` over `base` as in RFC 7396, keys of the base first. An object under "passes" whose "type" or "graph"
// differs replaces that of the base. A null that removes nothing is an error, and so is another value in place of an
// object that graphs need. Exposed for tests.
json::Value mergeDocuments(json::Value base, const json::Value& patch, Diagnostics& diagnostics,
                           std::vector<Removal>* removals = nullptr);

// Throws Error(BadInput) with all in `diagnostics` if a file that is extended cannot be read, as nothing else that could
// be said would help.
Merged mergeExtends(std::shared_ptr<const json::Value> document, const std::filesystem::path& file,
                    const LoadOptions& options, Diagnostics& diagnostics);

// Looks for `name`, with or without ".json", relative to the folder of `from` and then in the search paths. Empty if
// it is not found.
std::filesystem::path findGraphFile(const std::string& name, const std::filesystem::path& from,
                                    const std::vector<std::filesystem::path>& searchPaths);
// The graph whose name is nearest to `name` in these folders, "" if none is near.
std::string nearestGraphFile(const std::string& name, const std::vector<std::filesystem::path>& folders);

// Reads text from the command line: as true or false if `type` is Bool, otherwise as a number, which is
// written as in JSON. False if it is none.
bool readTyped(const std::string& text, json::Value::Type type, json::Value& out);

// Limits of a graph file, so that a file cannot exhaust memory.
inline constexpr size_t kMaxPasses = 10000;
inline constexpr int kMaxInstanceDepth = 16;

Description resolve(std::shared_ptr<const json::Value> document, const std::filesystem::path& file,
                    const LoadOptions& options, Diagnostics& diagnostics);

}  // namespace fovea::graph
