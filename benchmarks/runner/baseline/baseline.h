// What an earlier run of `fovea bench passes` measured, which a later run compares itself with.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fovea::bench {

// The content of a file that `fovea bench passes -o` wrote: {"with": settings, "repeats": [{"passes", "frame",
// "counters"}, ..]}, in which every list of times has a number at least. Throws Error(BadInput) with the place of every
// mistake.
nlohmann::ordered_json readBaseline(const std::string& file);

}  // namespace fovea::bench
