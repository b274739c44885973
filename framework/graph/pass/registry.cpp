#include "framework/graph/pass/registry.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <utility>

#include "fovea/error.h"
#include "framework/base/files.h"
#include "framework/base/hash.h"
#include "framework/base/paths.h"
#include "framework/graph/pass/guard.h"
#include "framework/graph/pass/pass_file.h"
#include "framework/graph/pass/plugin_file.h"
#include "framework/graph/pass/validate.h"

namespace fovea::graph {

static_assert(kVersion == FOVEA_VERSION, "fovea/registration.h and CMakeLists.txt name different versions");

namespace {

// Registrations of linked passes run before main(), where no exception can be caught, so failures are kept instead.
std::vector<Diagnostic>& failedRegistrations() {
  static std::vector<Diagnostic> failures;
  return failures;
}

// 0 if it cannot be read.
uint64_t hashOfFile(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  Hasher hash;
  hash.add(text);
  return stream ? hash.value() : 0;
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
        // A graph may lie beside this folder, which is then found a second time.
        passFiles_.push_back({std::filesystem::canonical(file), hashOfFile(file), !find(declaration.type)});
        if (passFiles_.back().declares) add(std::move(declaration), makePlainPass);
      } catch (const Error& error) {
        for (const Diagnostic& d : error.diagnostics()) failedRegistrations().push_back(d);
      }
    }
  }
}

void Registry::add(PassDeclaration declaration, Factory factory) { add(std::move(declaration), factory, {}); }

void Registry::add(PassDeclaration declaration, Factory factory, std::string plugin) {
  validateDeclaration(declaration);
  auto at =
      std::lower_bound(entries_.begin(), entries_.end(), declaration.type,
                       [](const Entry& e, const std::string& type) { return e.declaration->type < type; });
  if (at != entries_.end() && at->declaration->type == declaration.type)
    throw Error(ExitCode::Internal, fmt::format("pass type `{}` is registered twice", declaration.type));
  entries_.insert(at,
                  {std::make_unique<PassDeclaration>(std::move(declaration)), factory, std::move(plugin)});
}

void Registry::addOrReplace(PassDeclaration declaration, Factory factory) {
  const auto at = std::find_if(entries_.begin(), entries_.end(),
                               [&](const Entry& e) { return e.declaration->type == declaration.type; });
  if (at == entries_.end() || !at->replaceable) {
    const std::string type = declaration.type;
    add(std::move(declaration), std::move(factory));
    const_cast<Entry*>(entry(type))->replaceable = true;
    return;
  }
  validateDeclaration(declaration);
  replaced_.push_back(
      std::exchange(at->declaration, std::make_unique<PassDeclaration>(std::move(declaration))));
  at->factory = std::move(factory);
}

const Registry::Entry* Registry::entry(std::string_view type) const {
  auto at = std::lower_bound(entries_.begin(), entries_.end(), type,
                             [](const Entry& e, std::string_view t) { return e.declaration->type < t; });
  return at != entries_.end() && at->declaration->type == type ? &*at : nullptr;
}

const PassDeclaration* Registry::find(std::string_view type) const {
  const Entry* found = entry(type);
  return found ? found->declaration.get() : nullptr;
}

std::string_view Registry::pluginOf(std::string_view type) const {
  const Entry* found = entry(type);
  return found ? std::string_view(found->plugin) : std::string_view();
}

std::unique_ptr<Pass> Registry::create(std::string_view type) const {
  const Entry* found = entry(type);
  if (!found || !found->factory)
    throw Error(ExitCode::Internal, fmt::format("no pass type `{}` to create", type));
  return found->factory();
}

std::vector<std::string> Registry::types() const {
  std::vector<std::string> names;
  for (const Entry& entry : entries_) names.push_back(entry.declaration->type);
  return names;
}

namespace {

// A registration of a plug-in. Only `abi` is known if that is the mark of another version.
struct PluginPass {
  Abi abi;
  const char* className = nullptr;
  PassDeclaration (*declaration)() = nullptr;
  Registry::Factory factory = nullptr;
};

// Where registrations go while dlopen() runs. They are looked at after it, because exceptions cannot leave dlopen().
std::vector<PluginPass>* loading = nullptr;

// What the plug-ins of this process register, by the handle of the system's loader. Loading a library a second time
// does not run its registrations again.
std::map<void*, std::vector<PluginPass>>& pluginPasses() {
  static std::map<void*, std::vector<PluginPass>> passes;
  return passes;
}

void* openCollecting(const std::filesystem::path& path, std::vector<PluginPass>& found) {
  loading = &found;
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  loading = nullptr;
  return handle;
}

// Everything that is wrong with the passes of a plug-in, with the code of the first failure.
struct PluginFailures {
  ExitCode code = ExitCode::BadInput;
  std::vector<Diagnostic> messages;

  void add(ExitCode failure, const std::vector<Diagnostic>& more) {
    if (messages.empty()) code = failure;
    messages.insert(messages.end(), more.begin(), more.end());
  }
};

std::vector<std::pair<PassDeclaration, Registry::Factory>> declarationsOf(
    const std::vector<PluginPass>& passes, const std::string& plugin, PluginFailures& failures) {
  std::vector<std::pair<PassDeclaration, Registry::Factory>> declarations;
  for (const PluginPass& pass : passes) {
    try {
      declarations.emplace_back(guarded({{}, pass.className, plugin}, "declaration()", pass.declaration),
                                pass.factory);
    } catch (const Error& e) {
      failures.add(e.code(), e.diagnostics());
    }
  }
  return declarations;
}

}  // namespace

Registration::Registration(const Abi& abi, const char* className, PassDeclaration (*declaration)(),
                           std::unique_ptr<Pass> (*factory)()) {
  const std::string mistake = describeOtherAbi(abi);
  if (loading) {
    loading->push_back(mistake.empty() ? PluginPass{abi, className, declaration, factory} : PluginPass{abi});
    return;
  }
  try {
    if (!mistake.empty()) throw Error(ExitCode::Internal, mistake);
    Registry::ofProcess().add(guarded({{}, className, {}}, "declaration()", declaration), factory);
  } catch (const Error& error) {
    for (const Diagnostic& d : error.diagnostics()) failedRegistrations().push_back(d);
  }
}

void Registry::throwIfRegistrationsFailed() {
  if (!failedRegistrations().empty()) throw Error(ExitCode::Internal, failedRegistrations());
}

void Registry::loadPlugin(const std::filesystem::path& file) {
  checkPluginMarks(file, readPluginFile(file));
  noteRead(file);
  const auto refuse = [&](std::string message, std::string remedy) {
    throw Error(ExitCode::BadInput,
                std::vector<Diagnostic>{
                    {Severity::Error, {file.string()}, {}, std::move(message), std::move(remedy)}});
  };
  std::error_code ec;
  const std::filesystem::path path = std::filesystem::absolute(file, ec);
  std::vector<PluginPass> found;
  // The library is never closed, because factories and declarations point into it.
  void* handle = openCollecting(path, found);
  if (!handle) {
    const char* reason = dlerror();
    refuse(fmt::format("cannot load plug-in: {}", reason ? reason : "?"),
           "build it with fovea_add_pass_plugin(), and install the libraries that it needs");
  }
  std::vector<PluginPass>& passes = pluginPasses()[handle];
  passes.insert(passes.end(), found.begin(), found.end());
  if (std::find(plugins_.begin(), plugins_.end(), handle) != plugins_.end()) return;
  if (passes.empty())
    refuse("the plug-in registers no pass",
           "put FOVEA_PASS(YourPass) at namespace scope in one of its sources");
  for (const PluginPass& pass : passes) checkPluginMarks(file, {pass.abi});
  const std::string name = file.string();
  PluginFailures failures;
  std::vector<std::string> added;
  for (auto& [declaration, factory] : declarationsOf(passes, name, failures)) {
    std::string type = declaration.type;
    try {
      add(std::move(declaration), factory, name);
      added.push_back(std::move(type));
    } catch (const Error& e) {
      std::vector<Diagnostic> messages = e.diagnostics();
      for (Diagnostic& d : messages) d.where.file = name;
      failures.add(ExitCode::BadInput, messages);
    }
  }
  if (!failures.messages.empty()) {
    std::erase_if(entries_, [&](const Entry& e) {
      return std::find(added.begin(), added.end(), e.declaration->type) != added.end();
    });
    throw Error(failures.code, std::move(failures.messages));
  }
  plugins_.push_back(handle);
  const std::filesystem::path shaders = path.parent_path() / "shaders";
  const bool known =
      std::find(pluginShaderPaths_.begin(), pluginShaderPaths_.end(), shaders) != pluginShaderPaths_.end();
  if (!known && std::filesystem::is_directory(shaders, ec)) pluginShaderPaths_.push_back(shaders);
}

void Registry::addFolder(const std::filesystem::path& folder) {
  Diagnostics mistakes;
  for (const std::filesystem::path& file : findPassFiles(folder)) {
    const std::filesystem::path known = std::filesystem::canonical(file);
    if (std::any_of(passFiles_.begin(), passFiles_.end(), [&](const PassFile& f) { return f.path == known; }))
      continue;
    try {
      PassDeclaration declaration = loadPassFile(file);
      if (find(declaration.type))
        throw Error(ExitCode::BadInput, {{Severity::Error, declaration.placeOf(""), "",
                                          fmt::format("there already is a pass type `{}`", declaration.type),
                                          "give the file another name"}});
      add(std::move(declaration), makePlainPass);
      passFiles_.push_back({known, hashOfFile(known), true});
    } catch (const Error& error) {
      for (const Diagnostic& d : error.diagnostics()) mistakes.add(d);
    }
  }
  mistakes.throwIfErrors();
}

void Registry::rereadFiles() {
  Diagnostics mistakes;
  for (PassFile& file : passFiles_) {
    std::error_code gone;
    if (!file.declares || !std::filesystem::exists(file.path, gone)) continue;
    const uint64_t hash = hashOfFile(file.path);
    if (hash == file.hash) continue;
    try {
      PassDeclaration declaration = loadPassFile(file.path);
      validateDeclaration(declaration);
      const auto at = std::find_if(entries_.begin(), entries_.end(),
                                   [&](const Entry& e) { return e.declaration->type == declaration.type; });
      if (at == entries_.end()) continue;
      replaced_.push_back(
          std::exchange(at->declaration, std::make_unique<PassDeclaration>(std::move(declaration))));
      file.hash = hash;
    } catch (const Error& error) {
      for (const Diagnostic& d : error.diagnostics()) mistakes.add(d);
    }
  }
  mistakes.throwIfErrors();
}

void Registry::addFoldersFromEnvironment() {
  for (const std::filesystem::path& folder : pathsInVariable("FOVEA_PASSES")) addFolder(folder);
}

void Registry::addFolderBeside(const std::filesystem::path& graph) {
  const std::filesystem::path folder = graph.parent_path() / "passes";
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) addFolder(folder);
}

}  // namespace fovea::graph
