// Shows what the user is waiting for on one line of the terminal, and ends what they would wait for in vain.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "framework/base/watchdog.h"

namespace fovea::session {

// Seconds that a frame may take. Tracing a reference on a CPU can take minutes, during which the pass reports progress.
inline constexpr double kFrameLimit = 3600;

// Writes to stderr, and only if that is a terminal. The line is wiped when the object is destroyed, so that errors
// and results stand alone. If a frame takes longer than `frameLimit` seconds (0: no limit), and no pass of it reports
// progress for so long, the process ends with the exit code of a device that is lost.
class Progress {
 public:
  explicit Progress(bool quiet, double frameLimit = kFrameLimit);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void stage(const std::string& what);  // "loading scene my_scene"
  // Precedes everything that follows, such as "job 3/40 (12 min left), ".
  void setPrefix(const std::string& prefix) { prefix_ = prefix; }
  // Number of frames done so far, from which the remaining time is estimated.
  void frames(uint64_t done, uint64_t total);
  // Share of its work that a pass of the current frame has done.
  void pass(const std::string& name, double share);
  void clear();

 private:
  Watchdog watchdog_;
  bool enabled_ = false, shown_ = false;
  std::chrono::steady_clock::time_point start_, passStart_;
  std::string prefix_, framesLine_, pass_;  // last text of frames(); the pass that reported last
  double passShare_ = 0;
  void show(const std::string& line);
};

// What is said of a frame that takes too long.
std::string frameLimitMessage(double seconds);

std::string formatDuration(double seconds);  // "0.8 s", "12 s", "3 min 20 s"

}  // namespace fovea::session
