// Writes the tables of a benchmark: means over seeds, beside the paper's numbers.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/runner/folder.h"
#include "benchmarks/runner/suite.h"

namespace fovea::bench {

// Every number of a result by name, in the order of the result: "error.fovea.mse", "time.wall_ms" (median),
// "pass.deferred.gpu_ms", "counter.deferred.pairs", "second_eye.ms", "match.value".
std::vector<std::pair<std::string, double>> numbersOf(const nlohmann::ordered_json& result);

struct Mean {
  double mean = 0, halfWidth = 0;  // of the 95% interval (Student's t); NaN for a single value
  size_t count = 0;
};
Mean meanOf(const std::vector<double>& values);

// Writes tables/SWEEP.csv with one row per scene, graph, combination of the varied parameters, and number.
// `paper` and `ratio` (ours / the paper's) are given if benchmarks/paper.json has that number. `bound` is `>` or
// `<` if the number is only known to be above or below what is shown, for example because the whole range of a
// search was not enough, and `~` if seeds disagree on that. Also writes report.json, from which the report is
// made, with the `command` that makes all of it. Returns the tables as shown on a terminal: errors, times and
// ratios alone. Throws Error(CannotWrite).
std::string writeTables(const BenchFolder& folder, const Suite& suite,
                        const std::vector<StoredResult>& results,
                        const std::map<std::string, std::string>& missingScenes, const std::string& command);

}  // namespace fovea::bench
