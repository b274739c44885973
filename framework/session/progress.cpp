#include "framework/session/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace fovea::session {

Progress::Progress(bool quiet, double frameLimit)
    : watchdog_(std::chrono::duration<double>(frameLimit), ExitCode::DeviceLost,
                frameLimitMessage(frameLimit)),
      enabled_(!quiet && isatty(STDERR_FILENO)) {}

void Progress::show(const std::string& line) {
  if (!enabled_) return;
  std::fprintf(stderr, "\r\x1b[K%s%s", prefix_.c_str(), line.c_str());
  std::fflush(stderr);
  shown_ = true;
}

void Progress::stage(const std::string& what) {
  watchdog_.end();
  show(what + " ...");
}

void Progress::frames(uint64_t done, uint64_t total) {
  if (done < total)
    watchdog_.begin();
  else
    watchdog_.end();
  const auto now = std::chrono::steady_clock::now();
  if (done == 0) start_ = now;
  std::string line = fmt::format("frame {}/{}", std::min(done + 1, total), total);
  if (done > 0 && done < total) {
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    line += fmt::format(", {} left", formatDuration(elapsed / double(done) * double(total - done)));
  }
  framesLine_ = line;
  pass_.clear();
  show(line);
}

void Progress::pass(const std::string& name, double share) {
  watchdog_.begin();
  const auto now = std::chrono::steady_clock::now();
  if (pass_ != name || share < passShare_) {
    pass_ = name;
    passStart_ = now;
    passShare_ = share;
  }
  std::string line = fmt::format("{}: {} {:.0f}%", framesLine_, name, 100 * share);
  const double elapsed = std::chrono::duration<double>(now - passStart_).count();
  if (share > passShare_ && elapsed > 1)
    line += fmt::format(", {} left", formatDuration(elapsed / (share - passShare_) * (1 - share)));
  show(line);
}

void Progress::clear() {
  watchdog_.end();
  if (!shown_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

std::string frameLimitMessage(double seconds) {
  return fmt::format(
      "{}fovea: error: a frame takes longer than {}\n  -> if its passes do end, allow more with "
      "--frame-limit; what was "
      "finished before is kept\n",
      isatty(STDERR_FILENO) ? "\n" : "", formatDuration(seconds));
}

std::string formatDuration(double seconds) {
  if (seconds < 10) return fmt::format("{:.1f} s", seconds);
  if (seconds < 60) return fmt::format("{:.0f} s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace fovea::session
