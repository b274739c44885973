// What numbers are made by, as hashes: results count only as long as it stays the same. Comments and spaces
// do not count.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fovea::bench {

// Of a pass: passes/TYPE and what it uses of framework/scene and framework/base when this program was built,
// and the shaders in shaders/TYPE with what they include, as they are now. Of a plug-in's pass: of shaders
// alone. 16 hexadecimal digits.
std::string passCode(const std::string& type);
// Of what runs every pass: framework/gpu, the executor, the scene on the device and its shaders.
std::string frameworkCode();

// Written when building: folder of passes/ -> hash of its code; hash of what runs passes; of what measures
// errors and times; the commit, "" where none is known.
extern const std::vector<std::pair<std::string_view, std::string_view>> kPassSources;
extern const std::string_view kFrameworkSources;
extern const std::string_view kMeasureSources;
extern const std::string_view kBuildCommit;

}  // namespace fovea::bench
