#include "framework/graph/pass/registry.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "fovea/error.h"
#include "framework/base/paths.h"
#include "framework/graph/pass/pass_file.h"
#include "framework/graph/pass/validate.h"

namespace fovea::graph {
namespace {

// Registrations run before main() or inside dlopen(), where no exception can be caught, so failures are kept instead.
std::vector<Diagnostic>& failedRegistrations() {
  static std::vector<Diagnostic> failures;
  return failures;
}

// For passes that their steps describe in full.
std::unique_ptr<Pass> makePlainPass() { return std::make_unique<Pass>(); }

}  // namespace

Registry& Registry::ofProcess() {
  static Registry registry;
  return registry;
}

Registry& Registry::global() {
  static const bool stocked = [] {
    ofProcess().addStock();
    return true;
  }();
  (void)stocked;
  return ofProcess();
}

// The first of several data folders that declare a type counts, as for shaders and graphs.
void Registry::addStock() {
  for (const std::filesystem::path& folder : dataFolders("passes")) {
    for (const std::filesystem::path& file : findPassFiles(folder)) {
      try {
        PassDeclaration declaration = loadPassFile(file);
        if (!find(declaration.type)) add(std::move(declaration), makePlainPass);
      } catch (const Error& error) {
        for (const Diagnostic& d : error.diagnostics()) failedRegistrations().push_back(d);
      }
    }
  }
}

void Registry::add(PassDeclaration declaration, Factory factory) {
  validateDeclaration(declaration);
  auto at =
      std::lower_bound(entries_.begin(), entries_.end(), declaration.type,
                       [](const Entry& e, const std::string& type) { return e.declaration->type < type; });
  if (at != entries_.end() && at->declaration->type == declaration.type)
    throw Error(ExitCode::Internal, fmt::format("pass type `{}` is registered twice", declaration.type));
  entries_.insert(at, {std::make_unique<PassDeclaration>(std::move(declaration)), factory});
}

const PassDeclaration* Registry::find(std::string_view type) const {
  auto at = std::lower_bound(entries_.begin(), entries_.end(), type,
                             [](const Entry& e, std::string_view t) { return e.declaration->type < t; });
  return at != entries_.end() && at->declaration->type == type ? at->declaration.get() : nullptr;
}

std::unique_ptr<Pass> Registry::create(std::string_view type) const {
  for (const Entry& entry : entries_) {
    if (entry.declaration->type != type) continue;
    if (!entry.factory) break;
    return entry.factory();
  }
  throw Error(ExitCode::Internal, fmt::format("no pass type `{}` to create", type));
}

std::vector<std::string> Registry::types() const {
  std::vector<std::string> names;
  for (const Entry& entry : entries_) names.push_back(entry.declaration->type);
  return names;
}

Registration::Registration(PassDeclaration declaration, std::unique_ptr<Pass> (*factory)()) {
  try {
    Registry::ofProcess().add(std::move(declaration), factory);
  } catch (const Error& error) {
    for (const Diagnostic& d : error.diagnostics()) failedRegistrations().push_back(d);
  }
}

void Registry::throwIfRegistrationsFailed() {
  if (!failedRegistrations().empty()) throw Error(ExitCode::Internal, failedRegistrations());
}

void Registry::loadPlugin(const std::filesystem::path& file) {
  std::error_code ec;
  const std::filesystem::path path = std::filesystem::absolute(file, ec);
  if (!std::filesystem::exists(path, ec))
    throw Error(ExitCode::BadInput, fmt::format("plug-in {} does not exist", file.string()));
  const size_t failuresBefore = failedRegistrations().size();
  const size_t typesBefore = entries_.size();
  // The library is never closed, because factories and declarations point into it.
  if (!dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    const char* reason = dlerror();
    throw Error(ExitCode::BadInput,
                fmt::format("cannot load plug-in {}: {}", file.string(), reason ? reason : "?"),
                "build it against the same version of fovea, as a shared library");
  }
  if (failedRegistrations().size() > failuresBefore) {
    std::vector<Diagnostic> failures(failedRegistrations().begin() + static_cast<ptrdiff_t>(failuresBefore),
                                     failedRegistrations().end());
    failedRegistrations().resize(failuresBefore);
    for (Diagnostic& d : failures) d.message = fmt::format("plug-in {}: {}", file.string(), d.message);
    throw Error(ExitCode::BadInput, std::move(failures));
  }
  const std::filesystem::path shaders = path.parent_path() / "shaders";
  const bool known =
      std::find(pluginShaderPaths_.begin(), pluginShaderPaths_.end(), shaders) != pluginShaderPaths_.end();
  if (!known && std::filesystem::is_directory(shaders, ec)) pluginShaderPaths_.push_back(shaders);
  if (entries_.size() == typesBefore && !loaded(path))
    throw Error(ExitCode::BadInput, fmt::format("plug-in {} registers no pass", file.string()),
                "put FOVEA_PASS(YourPass) at namespace scope in one of its sources");
  if (!loaded(path)) plugins_.push_back(path);
}

void Registry::addFolder(const std::filesystem::path& folder) {
  Diagnostics mistakes;
  for (const std::filesystem::path& file : findPassFiles(folder)) {
    const std::filesystem::path known = std::filesystem::canonical(file);
    if (std::find(passFiles_.begin(), passFiles_.end(), known) != passFiles_.end()) continue;
    try {
      PassDeclaration declaration = loadPassFile(file);
      if (find(declaration.type))
        throw Error(ExitCode::BadInput, {{Severity::Error, declaration.placeOf(""), "",
                                          fmt::format("there already is a pass type `{}`", declaration.type),
                                          "give the file another name"}});
      add(std::move(declaration), makePlainPass);
      passFiles_.push_back(known);
    } catch (const Error& error) {
      for (const Diagnostic& d : error.diagnostics()) mistakes.add(d);
    }
  }
  mistakes.throwIfErrors();
}

void Registry::addFoldersFromEnvironment() {
  const char* variable = std::getenv("FOVEA_PASSES");
  const std::string text = variable ? variable : "";
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(':', begin), text.size());
    if (end > begin) addFolder(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

bool Registry::loaded(const std::filesystem::path& plugin) const {
  return std::find(plugins_.begin(), plugins_.end(), plugin) != plugins_.end();
}

}  // namespace fovea::graph
