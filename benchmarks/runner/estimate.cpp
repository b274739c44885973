#include "benchmarks/runner/estimate.h"

#include <algorithm>

namespace fovea::bench {
namespace {

// Loading a scene, compiling shaders and setting up a graph take about as long as frames of so many pixels.
constexpr double kSetUp = 4e6;
constexpr double kRunsOfASearch = 12;

double workOf(const Job& job) {
  const double pixels = double(job.size.x) * double(job.size.y);
  return (job.match ? kRunsOfASearch : 1) * (kSetUp + pixels * (double(job.warmup) + double(job.frames)));
}

}  // namespace

void Estimate::addJob(const Job& job) {
  ++jobs_;
  work_ += workOf(job);
}

void Estimate::finish(const Job& job, double seconds, const std::vector<std::pair<std::string, double>>& made,
                      const std::vector<std::string>& needed) {
  double own = seconds;
  for (const auto& [name, spent] : made) {
    own -= spent;
    if (const auto found = references_.find(name); found != references_.end()) {
      pathRate_.work += found->second;
      pathRate_.seconds += spent;
    }
  }
  for (const std::string& name : needed) references_.erase(name);
  jobRate_.work += workOf(job);
  jobRate_.seconds += std::max(own, 0.0);
  work_ -= workOf(job);
  --jobs_;
}

double Estimate::paths() const {
  double sum = 0;
  for (const auto& [name, paths] : references_) sum += paths;
  return sum;
}

std::optional<double> Estimate::Rate::time(double left) const {
  if (left <= 0) return 0;
  if (work <= 0) return std::nullopt;
  return left * seconds / work;
}

std::optional<double> Estimate::secondsLeft() const {
  const auto references = pathRate_.time(paths()), jobs = jobRate_.time(jobs_ > 0 ? work_ : 0);
  if (!references || !jobs) return std::nullopt;
  return *references + *jobs;
}

}  // namespace fovea::bench
