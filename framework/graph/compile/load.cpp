// Documents: finds and parses graph files, and merges what they extend.
#include <fmt/format.h>

#include <algorithm>

#include "framework/graph/compile/compile.h"
#include "framework/graph/compile/expand.h"
#include "framework/graph/migrate/migrate.h"

namespace fovea::graph {
namespace {

using json::Member;

// Whether the patch turns the pass into one of another kind, in which case no old setting may remain.
bool replacesWhole(const json::Value& base, const json::Value& patch) {
  for (const char* key : {"type", "graph"}) {
    const json::Value* now = patch.find(key);
    if (!now) continue;
    const json::Value* before = base.find(key);
    if (!before || before->string != now->string) return true;
  }
  return false;
}

class Merger {
 public:
  explicit Merger(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  // depth 0 is the document, 1 for instance its "passes", 2 one pass.
  void merge(json::Value& base, const json::Value& patch, const std::string& path, int depth, bool inPasses) {
    if (!patch.isObject()) {
      base = patch;
      return;
    }
    if (!base.isObject() || (inPasses && depth == 2 && replacesWhole(base, patch))) {
      base = json::Value();
      base.type = json::Value::Type::Object;
    }
    base.where = patch.where;
    for (const Member& member : patch.members) {
      const std::string memberPath = json::joinPath(path, member.key);
      const auto at = std::find_if(base.members.begin(), base.members.end(),
                                   [&](const Member& m) { return m.key == member.key; });
      if (member.value.isNull()) {
        remove(base, at, member, memberPath);
        continue;
      }
      const bool passes = depth == 0 ? member.key == "passes" : inPasses;
      Member& target = at != base.members.end() ? *at : base.members.emplace_back(Member{member.key, {}, {}});
      target.keyWhere = member.keyWhere;
      merge(target.value, member.value, memberPath, depth + 1, passes);
    }
  }

 private:
  void remove(json::Value& base, std::vector<Member>::iterator at, const Member& member,
              const std::string& path) {
    if (at != base.members.end()) {
      base.members.erase(at);
      return;
    }
    std::vector<std::string> names;
    for (const Member& m : base.members) names.push_back(m.key);
    const std::string nearest = nearestName(member.key, names);
    diagnostics_.error(member.value.where.location(), path,
                       fmt::format("`null` removes nothing: what this extends has no `{}`", member.key),
                       nearest.empty() ? std::string() : fmt::format("did you mean `{}`?", nearest));
  }

  Diagnostics& diagnostics_;
};

std::filesystem::path canonicalPath(const std::filesystem::path& file) {
  std::error_code ec;
  std::filesystem::path path = std::filesystem::weakly_canonical(file, ec);
  return ec ? file : path;
}

using Document = std::shared_ptr<const json::Value>;

// `chain` holds the files on the way from the first document to this one.
Document mergeChain(Document document, const std::filesystem::path& file, const LoadOptions& options,
                    Diagnostics& diagnostics, std::vector<std::filesystem::path>& chain) {
  const json::Value* extends = document->find("extends");
  if (!extends) return document;
  const auto mistake = [&](std::string message, std::string remedy = {}) {
    diagnostics.error(extends->where.location(), "extends", std::move(message), std::move(remedy));
    return document;
  };
  if (!extends->isString())
    return mistake(fmt::format("expected a file name, found {}", extends->describe()));
  const std::filesystem::path base = findGraphFile(extends->string, file, options.searchPaths);
  if (base.empty())
    return mistake(fmt::format("no graph file `{}`", extends->string),
                   fmt::format("it is looked up beside {} and in the search paths", file.string()));
  chain.push_back(canonicalPath(file));
  if (std::find(chain.begin(), chain.end(), canonicalPath(base)) != chain.end())
    return mistake(fmt::format("`{}` extends itself", extends->string),
                   "a base must not extend what extends it");
  Document extended;
  try {
    extended = std::make_shared<const json::Value>(detail::readGraphFile(base, diagnostics));
  } catch (const Error& error) {
    for (const Diagnostic& d : error.diagnostics()) diagnostics.add(d);
    return document;
  }
  if (!extended->isObject()) {
    diagnostics.error(extended->where.location(), {},
                      fmt::format("expected an object, found {}", extended->describe()));
    return document;
  }
  extended = mergeChain(std::move(extended), base, options, diagnostics, chain);
  return std::make_shared<const json::Value>(mergeDocuments(*extended, *document, diagnostics));
}

}  // namespace

json::Value mergeDocuments(json::Value base, const json::Value& patch, Diagnostics& diagnostics) {
  Merger(diagnostics).merge(base, patch, {}, 0, false);
  return base;
}

std::shared_ptr<const json::Value> mergeExtends(std::shared_ptr<const json::Value> document,
                                                const std::filesystem::path& file, const LoadOptions& options,
                                                Diagnostics& diagnostics) {
  if (!document->isObject()) {
    diagnostics.error(document->where.location(), {},
                      fmt::format("a graph is an object, this is {}", document->describe()));
    json::Value empty;
    empty.type = json::Value::Type::Object;
    empty.where = document->where;
    return std::make_shared<const json::Value>(std::move(empty));
  }
  std::vector<std::filesystem::path> chain;
  return mergeChain(std::move(document), file, options, diagnostics, chain);
}

std::filesystem::path findGraphFile(const std::string& name, const std::filesystem::path& from,
                                    const std::vector<std::filesystem::path>& searchPaths) {
  if (name.empty() || name.size() > 4000) return {};
  std::vector<std::filesystem::path> folders = {from.parent_path()};
  folders.insert(folders.end(), searchPaths.begin(), searchPaths.end());
  std::error_code ec;
  for (const std::filesystem::path& folder : folders) {
    for (const std::string& candidate : {name, name + ".json"}) {
      std::filesystem::path path = folder / candidate;
      if (std::filesystem::is_regular_file(path, ec)) return path;
    }
  }
  return {};
}

std::filesystem::path findGraph(const std::string& nameOrPath,
                                const std::vector<std::filesystem::path>& searchPaths) {
  std::error_code ec;
  for (const std::string& name : {nameOrPath, nameOrPath + ".json"})
    if (std::filesystem::is_regular_file(name, ec)) return name;
  const std::filesystem::path name(nameOrPath);
  std::vector<std::string> known, looked;
  for (const std::filesystem::path& folder : searchPaths) {
    looked.push_back(folder.string());
    if (name.is_absolute()) continue;
    for (const std::string& file : {nameOrPath, nameOrPath + ".json"})
      if (std::filesystem::is_regular_file(folder / file, ec)) return folder / file;
    for (std::filesystem::directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec))
      if (at->path().extension() == ".json") known.push_back(at->path().stem().string());
  }
  const std::string nearest = nearestName(name.stem().string(), known);
  throw Error(ExitCode::BadInput, fmt::format("no graph `{}`", nameOrPath),
              !nearest.empty() ? fmt::format("did you mean `{}`?", nearest)
              : looked.empty() ? std::string("give the path of a graph file")
                               : fmt::format("it is no file, and not in {}", fmt::join(looked, ", ")));
}

json::Value detail::readGraphFile(const std::filesystem::path& file, Diagnostics& diagnostics) {
  std::error_code unknown;
  const uintmax_t bytes = std::filesystem::file_size(file, unknown);
  if (!unknown && bytes > kMaxGraphBytes)
    throw Error(
        ExitCode::BadInput,
        fmt::format("{} has {} bytes; a graph file may have {}", file.string(), bytes, kMaxGraphBytes),
        "make sub-graphs of parts that repeat");
  json::Value document = json::parseFile(file);
  migrateLoaded(document, diagnostics);
  return document;
}

json::Value loadMerged(const std::string& nameOrPath, const LoadOptions& options) {
  const std::filesystem::path file = findGraph(nameOrPath, options.searchPaths);
  Diagnostics diagnostics;
  auto document = std::make_shared<const json::Value>(detail::readGraphFile(file, diagnostics));
  json::Value merged = *mergeExtends(std::move(document), file, options, diagnostics);
  diagnostics.throwIfErrors();
  std::erase_if(merged.members, [](const json::Member& member) { return member.key == "extends"; });
  return merged;
}

Override parseOverride(std::string_view text) {
  const size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0)
    throw Error(ExitCode::Usage, fmt::format("--set {}: expected name=value", text),
                "e.g. --set radius=3 for the graph, or --set blur.radius=3 for a pass");
  return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

}  // namespace fovea::graph
