// The tables of a benchmark: means over seeds, beside the paper's numbers.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/runner/folder.h"
#include "benchmarks/runner/suite.h"

namespace fovea::bench {

// Every number of a result by name, in its order: "error.fovea.mse", "time.wall_ms" (median),
// "pass.deferred.gpu_ms", "counter.deferred.pairs", "second_eye.ms", "match.value".
std::vector<std::pair<std::string, double>> numbersOf(const nlohmann::ordered_json& result);

struct Mean {
  double mean = 0, halfWidth = 0;  // of the 95% interval (Student's t); NaN for a single value
  size_t count = 0;
};
Mean meanOf(const std::vector<double>& values);

// tables/SWEEP.csv: a row per scene, graph, combination of the varied parameters, and number; `paper` and
// `ratio` (ours / the paper's) where benchmarks/paper.json has that number; `bound` is `>` or `<` where a
// number is only known to be above or below what is shown, as when all of a search's range was not enough,
// `~` where seeds disagree on that. Also writes report.json, which the report is made from, with the
// `command` that makes all of it. Returns the tables as a terminal shows them: errors, times and ratios
// alone. Throws Error(CannotWrite).
std::string writeTables(const BenchFolder& folder, const Suite& suite,
                        const std::vector<StoredResult>& results,
                        const std::map<std::string, std::string>& missingScenes, const std::string& command);

}  // namespace fovea::bench
