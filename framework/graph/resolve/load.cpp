// Documents: finds and parses graph files, and merges what they extend.
#include <fmt/format.h>

#include <algorithm>

#include "framework/graph/compile/compile.h"
#include "framework/graph/migrate/migrate.h"
#include "framework/graph/resolve/expand.h"

namespace fovea::graph {

bool detail::replacesWhole(const json::Value& base, const json::Value& patch) {
  for (const char* key : {"type", "graph"}) {
    const json::Value* now = patch.find(key);
    if (!now || now->isNull()) continue;
    const json::Value* before = base.find(key);
    if (!before || before->string != now->string) return true;
  }
  return false;
}

namespace {

using json::Member;

class Merger {
 public:
  Merger(Diagnostics& diagnostics, std::vector<Removal>* removals)
      : diagnostics_(diagnostics), removals_(removals) {}

  // depth 0 is the document, 1 for instance its "passes", 2 one pass.
  void merge(json::Value& base, const json::Value& patch, const std::string& path, int depth, bool inPasses) {
    if (!patch.isObject()) {
      if (base.isObject() && isNeeded(path, depth, inPasses))
        return diagnostics_.error(patch.where.location(), path,
                                  fmt::format("expected an object, found {}", patch.describe()));
      base = patch;
      return;
    }
    if (!base.isObject() || (inPasses && depth == 2 && detail::replacesWhole(base, patch))) {
      if (removals_)
        std::erase_if(*removals_,
                      [&](const Removal& removal) { return removal.path.starts_with(path + "."); });
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
      if (removals_)  // what a file between had removed is there again
        std::erase_if(*removals_, [&](const Removal& removal) { return removal.path == memberPath; });
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
      if (removals_) removals_->push_back({nullptr, path, member.value.where});
      return;
    }
    std::vector<std::string> names;
    for (const Member& m : base.members) names.push_back(m.key);
    const std::string nearest = nearestName(member.key, names);
    diagnostics_.error(member.value.where.location(), path,
                       fmt::format("`null` removes nothing: what this extends has no `{}`", member.key),
                       nearest.empty() ? std::string() : fmt::format("did you mean `{}`?", nearest));
  }

  // Whether nothing but an object can be in the place of one: in parts of a graph, passes and parts of passes.
  static bool isNeeded(std::string_view path, int depth, bool inPasses) {
    constexpr std::string_view kParts[] = {"parameters", "inputs", "view", "passes", "outputs"};
    return inPasses ? depth <= 3 : std::ranges::find(kParts, path) != std::end(kParts);
  }

  Diagnostics& diagnostics_;
  std::vector<Removal>* removals_;
};

std::filesystem::path canonicalPath(const std::filesystem::path& file) {
  std::error_code ec;
  std::filesystem::path path = std::filesystem::weakly_canonical(file, ec);
  return ec ? file : path;
}

void requireObject(const json::Value& document, Diagnostics& diagnostics) {
  if (document.isObject()) return;
  diagnostics.error(document.where.location(), {},
                    fmt::format("a graph is an object, this is {}", document.describe()));
  diagnostics.throwIfErrors();
}

// `chain` holds the files on the way from the first document to this one.
void mergeChain(Merged& merged, const std::filesystem::path& file, const LoadOptions& options,
                Diagnostics& diagnostics, std::vector<std::filesystem::path>& chain) {
  const json::Value* extends = merged.document->find("extends");
  if (!extends) return;
  const auto stop = [&](std::string message, std::string remedy = {}) {
    diagnostics.error(extends->where.location(), "extends", std::move(message), std::move(remedy));
    diagnostics.throwIfErrors();
  };
  if (!extends->isString()) stop(fmt::format("expected a file name, found {}", extends->describe()));
  const std::filesystem::path base = findGraphFile(extends->string, file, options.searchPaths);
  if (base.empty())
    stop(fmt::format("no graph file `{}`", extends->string),
         detail::graphFileRemedy(extends->string, file, options.searchPaths));
  chain.push_back(canonicalPath(file));
  if (std::find(chain.begin(), chain.end(), canonicalPath(base)) != chain.end())
    stop(fmt::format("`{}` extends itself", extends->string), "a base must not extend what extends it");
  auto read = [&] {
    try {
      return std::make_shared<const json::Value>(detail::readGraphFile(base, diagnostics));
    } catch (const Error& error) {
      for (const Diagnostic& d : error.diagnostics()) diagnostics.add(d);
      diagnostics.throwIfErrors();
      throw;
    }
  };
  const std::shared_ptr<const json::Value> patch = merged.document;
  merged.document = read();
  merged.files.push_back(merged.document->where.file);
  requireObject(*merged.document, diagnostics);
  mergeChain(merged, base, options, diagnostics, chain);
  merged.document = std::make_shared<const json::Value>(
      mergeDocuments(*merged.document, *patch, diagnostics, &merged.removals));
}

}  // namespace

json::Value mergeDocuments(json::Value base, const json::Value& patch, Diagnostics& diagnostics,
                           std::vector<Removal>* removals) {
  Merger(diagnostics, removals).merge(base, patch, {}, 0, false);
  return base;
}

Merged mergeExtends(std::shared_ptr<const json::Value> document, const std::filesystem::path& file,
                    const LoadOptions& options, Diagnostics& diagnostics) {
  requireObject(*document, diagnostics);
  Merged merged{std::move(document), {}, {}};
  merged.files.push_back(merged.document->where.file);
  std::vector<std::filesystem::path> chain;
  mergeChain(merged, file, options, diagnostics, chain);
  for (Removal& removal : merged.removals) removal.document = merged.document.get();
  return merged;
}

Removal* findRemoval(std::vector<Removal>& removals, const json::Value* document, std::string_view path) {
  for (Removal& removal : removals)
    if (removal.document == document && (path == removal.path || path.starts_with(removal.path + ".")))
      return &removal;
  return nullptr;
}

int layerOf(const Description& description, const json::Position& where) {
  const auto at = std::find(description.files.begin(), description.files.end(), where.file);
  return at == description.files.end() ? -1 : static_cast<int>(at - description.files.begin());
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
  std::vector<std::filesystem::path> folders = {{}};
  std::vector<std::string> looked;
  for (const std::filesystem::path& folder : searchPaths) {
    looked.push_back(folder.string());
    if (name.is_absolute()) continue;
    for (const std::string& file : {nameOrPath, nameOrPath + ".json"})
      if (std::filesystem::is_regular_file(folder / file, ec)) return folder / file;
    folders.push_back(folder);
  }
  const std::string nearest = nearestGraphFile(nameOrPath, folders);
  throw Error(ExitCode::BadInput, fmt::format("no graph `{}`", nameOrPath),
              !nearest.empty() ? fmt::format("did you mean `{}`?", nearest)
              : looked.empty() ? std::string("give the path of a graph file")
                               : fmt::format("it is no file, and not in {}", fmt::join(looked, ", ")));
}

std::string nearestGraphFile(const std::string& name, const std::vector<std::filesystem::path>& folders) {
  // With or without its ending, as the name itself is.
  const bool ending = name.ends_with(".json");
  const std::filesystem::path parent = std::filesystem::path(name).parent_path();
  std::vector<std::string> known;
  std::error_code ec;
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path in = folder / parent;
    for (std::filesystem::directory_iterator at(in.empty() ? "." : in, ec), end; !ec && at != end;
         at.increment(ec))
      if (at->path().extension() == ".json" && !at->path().stem().has_extension())
        known.push_back((parent / (ending ? at->path().filename() : at->path().stem())).string());
  }
  return nearestName(name, known);
}

std::string detail::graphFileRemedy(const std::string& name, const std::filesystem::path& from,
                                    const std::vector<std::filesystem::path>& searchPaths) {
  std::vector<std::filesystem::path> folders = {from.parent_path()};
  folders.insert(folders.end(), searchPaths.begin(), searchPaths.end());
  const std::string nearest = nearestGraphFile(name, folders);
  if (!nearest.empty()) return fmt::format("did you mean `{}`?", nearest);
  return fmt::format("it is looked up beside {} and in the search paths", from.string());
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
  json::Value merged = *mergeExtends(std::move(document), file, options, diagnostics).document;
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
