// The folder of a benchmark holds results, pictures, references and tables and is shared by every process that works
// on the suite. Every file appears as a whole, by a rename. Processes never wait for each other except for a
// reference that one of them is making.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "benchmarks/runner/suite.h"
#include "fovea/image.h"

namespace fovea::bench {

inline constexpr int kBenchFormat = 1;

// What a result depends on besides its job: {"device": .., "graph": .., "scene": .., "passes": {..}, ..}.
struct Fingerprint {
  nlohmann::ordered_json parts;
  std::string key(const Job& job) const;  // 16 hexadecimal digits
};

struct StoredResult {
  std::filesystem::path file;
  nlohmann::ordered_json json;
};

// The files of results by the name of their job, as they were in the folder at one moment.
using ResultFiles = std::map<std::string, std::vector<std::filesystem::path>>;

// All results of the job among these, whatever their key; there is one unless something on which it depends has
// changed. Throws Error(BadInput) on a file that is not a result.
std::vector<StoredResult> resultsOf(const Job& job, const ResultFiles& files);

class BenchFolder {
 public:
  // `cache`: folder of the references, which several benchmark folders may share; if empty, references/ in `folder`.
  explicit BenchFolder(std::filesystem::path folder, std::filesystem::path cache = {})
      : folder_(std::move(folder)), cache_(cache.empty() ? folder_ / "references" : std::move(cache)) {}

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path picture(const std::string& name) const {
    return folder_ / "pictures" / (name + ".png");
  }
  std::filesystem::path table(const std::string& name) const { return folder_ / "tables" / (name + ".csv"); }
  std::filesystem::path reference(const std::string& name) const { return cache_ / (name + ".exr"); }

  // Creates the subfolders and tries to write `bytes` of results and `referenceBytes` of references into them. Throws
  // Error(CannotWrite) naming the obstacle: permissions or too little space.
  void prepare(uint64_t bytes, uint64_t referenceBytes) const;
  ResultFiles resultFiles() const;
  void write(const Job& job, const std::string& key, const nlohmann::ordered_json& result) const;

  // Returns the reference `name` and calls `make` if it does not exist. If another process is making it, waits for as
  // long as that process lives; `waiting` is called meanwhile and gives up by returning false (Error(Interrupted)).
  image::File findOrMakeReference(const std::string& name,
                                  const std::function<image::File(const std::function<void()>& alive)>& make,
                                  const std::function<bool()>& waiting) const;

 private:
  std::filesystem::path folder_, cache_;
};

// The result of each job that has one, in the order of the jobs. The results of the `chosen` jobs must belong
// together; otherwise Error(BadInput) names the files and the difference: sizes, parameters, devices, scenes or
// passes. Results of other jobs are included if they belong with these; `leaveOut` is told why one does not.
std::vector<StoredResult> mergedResults(const BenchFolder& folder, const std::vector<Job>& jobs,
                                        const std::vector<bool>& chosen,
                                        const std::function<void(const std::string&)>& leaveOut);

// The first difference as text, such as "passes.deferred: 0123.. there, 4567.. here"; "" if there is none.
std::string firstDifference(const nlohmann::ordered_json& there, const nlohmann::ordered_json& here,
                            const std::string& path = {});

}  // namespace fovea::bench
