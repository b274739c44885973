// Entry points of the compiler: from a name to a description.
#include <fmt/format.h>

#include "framework/graph/compile/compile.h"

namespace fovea::graph {

Override parseOverride(std::string_view text) {
  const size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0)
    throw Error(ExitCode::Usage, fmt::format("--set {}: expected name=value", text),
                "e.g. --set vpl_count=500 or --set deferred.kernel=disc");
  return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
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

Description load(const std::string& nameOrPath, const LoadOptions& options, Diagnostics& diagnostics) {
  const std::filesystem::path file = findGraph(nameOrPath, options.searchPaths);
  return resolve(json::parseFile(file), file, options, diagnostics);
}

json::Value loadMerged(const std::string& nameOrPath, const LoadOptions& options) {
  const std::filesystem::path file = findGraph(nameOrPath, options.searchPaths);
  const json::Value document = json::parseFile(file);
  Diagnostics diagnostics;
  json::Value merged;
  merged = mergeExtends(document, file, options, diagnostics, merged);
  diagnostics.throwIfErrors();
  std::erase_if(merged.members, [](const json::Member& member) { return member.key == "extends"; });
  return merged;
}

Description loadText(std::string_view text, const std::filesystem::path& file, const LoadOptions& options,
                     Diagnostics& diagnostics) {
  return resolve(json::parse(text, file.string()), file, options, diagnostics);
}

}  // namespace fovea::graph
