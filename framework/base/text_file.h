// Text files that are never left half-written.
#pragma once

#include <filesystem>
#include <string>

namespace fovea {

// Writes as an OutputFile (files.h). Throws Error(CannotWrite) naming the file and the reason.
void writeText(const std::filesystem::path& file, const std::string& text);
// Throws Error(CannotWrite) if `file` cannot be created there; leaves nothing behind.
void checkTextWritable(const std::filesystem::path& file);

}  // namespace fovea
