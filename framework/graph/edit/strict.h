// What a graph file says in vain: for `fovea check --strict`.
#pragma once

#include <filesystem>

#include "framework/graph/compile/compile.h"

namespace fovea::graph {

// Adds a warning for each value of the file that equals what it inherits without it.
void warnAboutRepetition(const std::filesystem::path& file, const LoadOptions& options,
                         Diagnostics& diagnostics);

}  // namespace fovea::graph
