// The folder of a benchmark: results, pictures, references and tables, shared by every process that works on
// the suite. Every file appears whole, by a rename; two processes never wait for each other but for a
// reference that one of them is making.
#pragma once

#include <filesystem>
#include <functional>
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

class BenchFolder {
 public:
  // `cache`: where references are, for several folders to share; empty: references/ in `folder`.
  explicit BenchFolder(std::filesystem::path folder, std::filesystem::path cache = {})
      : folder_(std::move(folder)), cache_(cache.empty() ? folder_ / "references" : std::move(cache)) {}

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path picture(const std::string& name) const {
    return folder_ / "pictures" / (name + ".png");
  }
  std::filesystem::path table(const std::string& name) const { return folder_ / "tables" / (name + ".csv"); }
  std::filesystem::path reference(const std::string& name) const { return cache_ / (name + ".exr"); }

  // Makes the sub-folders and tries to write `bytes` of results and `referenceBytes` of references into them.
  // Throws Error(CannotWrite) naming what is in the way: permissions, or too little room.
  void prepare(uint64_t bytes, uint64_t referenceBytes) const;
  // All results of the job, whatever their key: one, unless something that they depend on changed. Throws
  // Error(BadInput) on a file that is no result.
  std::vector<StoredResult> results(const Job& job) const;
  void write(const Job& job, const std::string& key, const nlohmann::ordered_json& result) const;

  // The reference `name`, made by `make` unless it is there; a process that is making it is waited for as
  // long as it lives. `waiting` is called meanwhile; false gives up (Error(Interrupted)).
  image::File findOrMakeReference(const std::string& name,
                                  const std::function<image::File(const std::function<void()>& alive)>& make,
                                  const std::function<bool()>& waiting) const;

 private:
  std::filesystem::path folder_, cache_;
};

// The one result of each job that has any, in the order of the jobs. Those of the jobs that are `chosen` must
// belong together: Error(BadInput) names files and what differs otherwise: sizes, parameters, devices, scenes
// or passes. Of the other jobs those are taken that belong to them; `leaveOut` is told why one does not.
std::vector<StoredResult> mergedResults(const BenchFolder& folder, const std::vector<Job>& jobs,
                                        const std::vector<bool>& chosen,
                                        const std::function<void(const std::string&)>& leaveOut);

// "passes.deferred: 0123.. there, 4567.. here"; "" when alike.
std::string firstDifference(const nlohmann::ordered_json& there, const nlohmann::ordered_json& here,
                            const std::string& path = {});

}  // namespace fovea::bench
