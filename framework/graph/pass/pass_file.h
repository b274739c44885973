// Passes without C++: a file NAME.pass.json declares the pass type NAME, with its shaders next to it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/declaration.h"
#include "fovea/error.h"
#include "framework/base/json.h"

namespace fovea::graph {

// The declaration in a document. `file` gives the type its name and the shaders their folder. Mistakes are added to
// `diagnostics`, with their places; the declaration is of no use if there are any.
PassDeclaration readPassFile(const json::Value& document, const std::filesystem::path& file,
                             Diagnostics& diagnostics);
// The declaration of a pass on the CPU, which has no steps; hostPass() of the facade calls this.
PassDeclaration readHostPass(const json::Value& document, const std::string& type, Diagnostics& diagnostics);
// Also throws Error(BadInput) if the file cannot be read or is not JSON.
PassDeclaration loadPassFile(const std::filesystem::path& file);

// The pass files of a folder: DIR/NAME.pass.json and DIR/NAME/NAME.pass.json, sorted. Throws Error(BadInput) if there
// is no such folder, or if two files declare one name.
std::vector<std::filesystem::path> findPassFiles(const std::filesystem::path& folder);

}  // namespace fovea::graph
