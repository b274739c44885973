#include "samples/fovea/view/graph/catalog.h"

#include <set>

#include "framework/base/paths.h"

namespace fovea::view {
namespace {

void addJsonFiles(const std::filesystem::path& folder, std::set<std::string>& names) {
  std::error_code ec;
  for (std::filesystem::directory_iterator at(folder.empty() ? "." : folder, ec), end; !ec && at != end;
       at.increment(ec)) {
    const std::filesystem::path& file = at->path();
    const std::string name = file.filename().string();
    // Schemas and passes lie beside graphs.
    if (file.extension() == ".json" && !name.ends_with(".schema.json") && !name.ends_with(".pass.json"))
      names.insert(file.stem().string());
  }
}

}  // namespace

std::vector<std::string> graphNames(const std::filesystem::path& current) {
  std::set<std::string> names;
  for (const std::filesystem::path& folder : dataFolders("graphs")) addJsonFiles(folder, names);
  addJsonFiles(current.parent_path(), names);
  return {names.begin(), names.end()};
}

std::filesystem::path graphByName(const std::filesystem::path& current, const std::string& name) {
  std::error_code ec;
  const std::filesystem::path beside = current.parent_path() / (name + ".json");
  if (std::filesystem::is_regular_file(beside, ec)) return beside;
  for (const std::filesystem::path& folder : dataFolders("graphs"))
    if (std::filesystem::is_regular_file(folder / (name + ".json"), ec)) return folder / (name + ".json");
  return name;
}

}  // namespace fovea::view
