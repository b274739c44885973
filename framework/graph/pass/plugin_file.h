// Reads from the file of a plug-in what must be known before its code may run.
#pragma once

#include <filesystem>
#include <vector>

#include "fovea/registration.h"

namespace fovea::graph {

// Checks that the file is a complete shared library for this kind of processor and returns the marks that FOVEA_PASS
// left in it, one a pass. dlopen() maps a file without comparing its headers with its length, so that a file cut short
// would end the process with SIGBUS. Throws Error(BadInput), at once even for a pipe or a device.
std::vector<Abi> readPluginFile(const std::filesystem::path& file);

// Throws Error(BadInput) that names the file, both versions and the remedy, unless all marks are those of this fovea
// and there is at least one.
void checkPluginMarks(const std::filesystem::path& file, const std::vector<Abi>& marks);

// What is wrong with a mark, as the message of an error; empty for the mark of this fovea.
std::string describeOtherAbi(const Abi& mark);

}  // namespace fovea::graph
