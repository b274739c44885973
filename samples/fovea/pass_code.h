// What a pass is made of, as a hash: results measured with it count only as long as it stays the same.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fovea::cli {

// Of the C++ sources in passes/TYPE when this program was built, and of the shaders in shaders/TYPE and
// shaders/common as they are now. Of a plug-in's pass: of shaders alone. 16 hexadecimal digits.
std::string passCode(const std::string& type);

// Written when building: folder of passes/ -> hash of its files; the commit, "" where none is known.
extern const std::vector<std::pair<std::string_view, std::string_view>> kPassSources;
extern const std::string_view kBuildCommit;

}  // namespace fovea::cli
