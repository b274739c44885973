// The first half of resolve: `extends`.
#include <fmt/format.h>

#include <algorithm>

#include "framework/graph/compile/resolve.h"

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

const json::Value& mergeChain(const json::Value& document, const std::filesystem::path& file,
                              const LoadOptions& options, Diagnostics& diagnostics,
                              std::vector<std::filesystem::path>& chain, json::Value& merged) {
  const json::Value* found = document.find("extends");
  if (!found) return document;
  const json::Value& extends = *found;
  const SourceLocation where = extends.where.location();
  if (!extends.isString()) {
    diagnostics.error(where, "extends", fmt::format("expected a file name, found {}", extends.describe()));
    return document;
  }
  const std::filesystem::path base = findGraphFile(extends.string, file, options.searchPaths);
  if (base.empty()) {
    diagnostics.error(where, "extends", fmt::format("no graph file `{}`", extends.string),
                      fmt::format("it is looked up beside {} and in the search paths", file.string()));
    return document;
  }
  chain.push_back(canonicalPath(file));
  if (std::find(chain.begin(), chain.end(), canonicalPath(base)) != chain.end()) {
    diagnostics.error(where, "extends", fmt::format("`{}` extends itself", extends.string),
                      "a base must not extend what extends it");
    return document;
  }
  json::Value extended;
  try {
    extended = json::parseFile(base);
  } catch (const Error& error) {
    for (const Diagnostic& d : error.diagnostics()) diagnostics.add(d);
    return document;
  }
  if (!extended.isObject()) {
    diagnostics.error(extended.where.location(), {},
                      fmt::format("expected an object, found {}", extended.describe()));
    return document;
  }
  json::Value all;
  if (&mergeChain(extended, base, options, diagnostics, chain, all) == &extended) all = std::move(extended);
  return merged = mergeDocuments(std::move(all), document, diagnostics);
}

}  // namespace

json::Value mergeDocuments(json::Value base, const json::Value& patch, Diagnostics& diagnostics) {
  Merger(diagnostics).merge(base, patch, {}, 0, false);
  return base;
}

const json::Value& mergeExtends(const json::Value& document, const std::filesystem::path& file,
                                const LoadOptions& options, Diagnostics& diagnostics, json::Value& merged) {
  if (!document.isObject()) {
    diagnostics.error(document.where.location(), {},
                      fmt::format("a graph is an object, this is {}", document.describe()));
    merged.type = json::Value::Type::Object;
    merged.where = document.where;
    return merged;
  }
  std::vector<std::filesystem::path> chain;
  return mergeChain(document, file, options, diagnostics, chain, merged);
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

}  // namespace fovea::graph
