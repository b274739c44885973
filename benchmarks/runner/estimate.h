// How long the rest of a suite takes, from what was measured so far. References usually dominate: a reference counts by
// its paths, and a job by its frames, since their rates have nothing to do with each other.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/runner/suite.h"

namespace fovea::bench {

class Estimate {
 public:
  // What is to be done. A reference that several jobs need counts once.
  void addJob(const Job& job);
  void addReference(const std::string& name, double paths) { references_.try_emplace(name, paths); }

  // A job was done in `seconds`, which include those of the references that it `made`; it `needed` others, too, which
  // other processes may have made.
  void finish(const Job& job, double seconds, const std::vector<std::pair<std::string, double>>& made,
              const std::vector<std::string>& needed);

  size_t jobs() const { return jobs_; }                     // left
  size_t references() const { return references_.size(); }  // left
  double paths() const;                                     // of those
  // Of all that is left. Unknown while there is a kind of work, references or jobs, of which nothing was measured.
  std::optional<double> secondsLeft() const;

 private:
  struct Rate {
    double work = 0, seconds = 0;
    std::optional<double> time(double left) const;
  };
  std::map<std::string, double> references_;  // left: name -> paths
  size_t jobs_ = 0;
  double work_ = 0;  // of the jobs left
  Rate pathRate_, jobRate_;
};

}  // namespace fovea::bench
