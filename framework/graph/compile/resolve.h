// Resolves JSON to a description: merges `extends`, instances sub-graphs under their prefixes and applies parameters
// and overrides. Names are interned and wires are split; pass types are not considered yet.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/base/json.h"
#include "framework/graph/compile/plan.h"

namespace fovea::graph {

// --set name=value
struct Override {
  std::string name;   // "vpl_count" or "pass.param"
  std::string value;  // as typed
};

struct LoadOptions {
  std::vector<Override> overrides;
  std::vector<std::filesystem::path> searchPaths;
};

// Densely numbered strings, so that later phases can index arrays.
using Symbol = uint32_t;

class SymbolTable {
 public:
  Symbol intern(std::string_view text);
  Symbol find(std::string_view text) const;  // kNone when unknown
  // The text keeps its address while others are added and when the table is moved.
  std::string_view operator[](Symbol symbol) const { return entries_[symbol].text; }
  size_t size() const { return entries_.size(); }
  // Copies a text that nobody looks up; the copy lives as long as the table.
  std::string_view keep(std::string_view text) {
    if (blocks_.empty() || blocks_.back().size - blocks_.back().used < text.size()) addBlock(text.size());
    Block& block = blocks_.back();
    char* kept = block.characters.get() + std::exchange(block.used, block.used + text.size());
    std::copy(text.begin(), text.end(), kept);
    return {kept, text.size()};
  }
  uint64_t hash(Symbol symbol) const { return entries_[symbol].hash; }
  void reserve(size_t count);

 private:
  static uint32_t tagOf(uint64_t hash) { return static_cast<uint32_t>(hash >> 32); }
  // The slot that holds the text, or the free one where it belongs.
  size_t slotOf(std::string_view text, uint64_t hash) const;

  Symbol internHere(std::string_view text);
  Symbol findHere(std::string_view text) const;
  // These are rare and kept out of line, so that the frequent cases make no calls.
  [[gnu::noinline]] Symbol internAny(std::string_view text);
  [[gnu::noinline]] Symbol findLong(std::string_view text) const;
  [[gnu::noinline]] void addBlock(size_t least);
  [[gnu::noinline]] Symbol add(std::string_view text, uint64_t hash, size_t slot);

  struct Entry {
    std::string_view text;
    uint64_t hash;
  };
  std::vector<Entry> entries_;
  struct Block {
    std::unique_ptr<char[]> characters;
    size_t size = 0, used = 0;
  };
  std::vector<Block> blocks_;  // storage of the texts
  struct Slot {
    uint32_t tag = 0;  // upper half of the hash
    Symbol symbol = kNone;
  };
  std::vector<Slot> slots_;  // open addressing; the size is a power of two, at most half used; kNone is free
};

// A position in the files, for messages only.
struct Place {
  uint32_t file = 0;  // Description::files
  int line = 0, column = 0;
};

// "pass.port.member@previous", split into its parts. "inputs.x" of a sub-graph has been replaced
// by what the parent wired.
struct WireDescription {
  std::string_view target;    // input port of the reading pass, or name of the graph's output
  std::string_view written;   // for messages; both are kept by Description::symbols
  Symbol pass = kNone;        // kNone if `external` is set
  Symbol port = kNone;        // kNone for the only output
  Symbol member = kNone;      // kNone for the whole port
  uint32_t external = kNone;  // index into Description::externals
  bool previous = false;
  Place keyPlace, place;
};

struct ParameterDescription {
  std::string_view name;  // kept by Description::symbols
  json::Value::Type type = json::Value::Type::Null;
  bool fromCommandLine = false;  // String: yet to be read as the parameter's own type
  int64_t integer = 0;           // Int, Bool
  double real = 0;
  Symbol text = kNone;
  Place keyPlace, place;
};

struct PassDescription {
  Symbol name = kNone;  // with its prefix: "left/blur"
  Symbol type = kNone;
  Symbol view = kNone;                              // explicit or inherited; kNone for the default view
  bool ownView = false;                             // set at the pass itself
  uint32_t firstInput = 0, inputCount = 0;          // Description::wires
  uint32_t firstParameter = 0, parameterCount = 0;  // Description::parameters
  Place place, typePlace, viewPlace;
};

// An input of the whole graph, in the caller's memory.
struct ExternalDescription {
  Symbol name = kNone;
  Symbol bundle = kNone;
  std::vector<Symbol> members;          // "" for a plain input
  std::vector<ResourceDesc> resources;  // width 0 stands for the size of the default view
  Place place;
};

struct Description {
  std::string name;  // file stem
  std::string description;
  std::vector<std::string> files;
  SymbolTable symbols;
  std::vector<PassDescription> passes;  // declaration order, sub-graphs expanded in place
  std::vector<WireDescription> wires;
  std::vector<ParameterDescription> parameters;
  std::vector<WireDescription> outputs;
  std::vector<ExternalDescription> externals;

  SourceLocation location(const Place& place) const { return {files[place.file], place.line, place.column}; }
  // The name of a pass inside its document: "blur" for "left/blur".
  std::string_view localName(const PassDescription& pass) const {
    const std::string_view name = symbols[pass.name];
    return name.substr(name.rfind('/') + 1);
  }
};

// Merges `patch` over `base` as in RFC 7396, keys of the base first. An object under "passes" whose "type" or "graph"
// differs replaces that of the base. A null that removes nothing is an error. Exposed for tests.
json::Value mergeDocuments(json::Value base, const json::Value& patch, Diagnostics& diagnostics);

// The document with everything it extends merged in: `document` itself if it extends nothing, otherwise `merged`.
const json::Value& mergeExtends(const json::Value& document, const std::filesystem::path& file,
                                const LoadOptions& options, Diagnostics& diagnostics, json::Value& merged);

// Looks for `name`, with or without ".json", relative to the folder of `from` and then in the search paths. Empty if
// it is not found.
std::filesystem::path findGraphFile(const std::string& name, const std::filesystem::path& from,
                                    const std::vector<std::filesystem::path>& searchPaths);

// Limits of a graph file, so that a file cannot exhaust memory.
inline constexpr size_t kMaxPasses = 10000;
inline constexpr int kMaxInstanceDepth = 16;

Description resolve(const json::Value& document, const std::filesystem::path& file,
                    const LoadOptions& options, Diagnostics& diagnostics);

}  // namespace fovea::graph
