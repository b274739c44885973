// All pass types known to the process, whether linked in or loaded from plug-ins.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/pass.h"

namespace fovea::graph {

class Registry {
 public:
  using Factory = std::function<std::unique_ptr<Pass>()>;
  // With the passes that are linked in and those that the project declares in files.
  static Registry& global();

  // Throws Error(Internal) if the type is already registered or if the declaration contradicts itself (duplicate
  // names, a default out of range, a size that names an unknown parameter or port, ...).
  void add(PassDeclaration declaration, Factory factory);
  // Adds a pass at any time, and replaces one that this function has added. Graphs that are bound to that stay valid.
  void addOrReplace(PassDeclaration declaration, Factory factory);
  const PassDeclaration* find(std::string_view type) const;
  std::unique_ptr<Pass> create(std::string_view type) const;
  std::vector<std::string> types() const;  // sorted

  // Loads a shared library whose static FOVEA_PASS registrations join this registry, all of them or none. Its shaders
  // are looked up in a folder `shaders` beside it. Throws Error(BadInput) if the file is no plug-in for this version of
  // fovea or if a declaration contradicts itself, and Error(Internal) if a declaration throws.
  void loadPlugin(const std::filesystem::path& file);
  // Adds the passes of all pass files in a folder (see pass_file.h). A folder may be named again. Throws
  // Error(BadInput) with every mistake of every file.
  void addFolder(const std::filesystem::path& folder);
  // Adds the passes of the folders that the environment variable FOVEA_PASSES names, separated by colons.
  void addFoldersFromEnvironment();
  // Adds the passes of a folder `passes` beside a graph file, if there is one.
  void addFolderBeside(const std::filesystem::path& graph);
  // Declares the passes of pass files whose text has changed again. The declarations that they replace stay valid for
  // graphs that are bound to them. Throws Error(BadInput) with every mistake; the passes of wrong files stay as they
  // were.
  void rereadFiles();
  // The file of the plug-in that registered a type, as it was given to loadPlugin(); empty for other types.
  std::string_view pluginOf(std::string_view type) const;
  const std::vector<std::filesystem::path>& pluginShaderPaths() const { return pluginShaderPaths_; }

  // FOVEA_PASS registrations run where no exception can be caught. Their errors are kept and thrown here as
  // Error(Internal). Call this once at the start of a program.
  static void throwIfRegistrationsFailed();

 private:
  friend struct Registration;
  static Registry& ofProcess();  // while it is filled, before main()
  void addStock();
  struct Entry {
    std::unique_ptr<PassDeclaration> declaration;  // stable address
    Factory factory;
    std::string plugin;        // its file; empty for types that are linked in
    bool replaceable = false;  // added by addOrReplace()
  };
  const Entry* entry(std::string_view type) const;
  void add(PassDeclaration declaration, Factory factory, std::string plugin);
  std::vector<Entry> entries_;  // sorted by type
  std::vector<std::filesystem::path> pluginShaderPaths_;
  struct PassFile {
    std::filesystem::path path;
    uint64_t hash = 0;      // of its text
    bool declares = false;  // false where another file of the same name takes precedence
  };
  std::vector<PassFile> passFiles_;
  std::vector<std::unique_ptr<PassDeclaration>> replaced_;
  std::vector<void*> plugins_;  // handles of the system's loader
};

}  // namespace fovea::graph
