#include "framework/base/watchdog.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "framework/base/threads.h"

namespace fovea {

Watchdog::Watchdog(std::chrono::duration<double> limit, ExitCode code, std::string message)
    : limit_(std::chrono::duration_cast<Clock::duration>(limit)), code_(code), message_(std::move(message)) {
  if (limit_ <= Clock::duration::zero()) return;
  try {
    thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
  } catch (const std::system_error& e) {
    throw noThread(e);
  }
}

Watchdog::~Watchdog() = default;

void Watchdog::watch(const std::stop_token& stop) {
  const auto pause =
      std::clamp<Clock::duration>(limit_ / 8, std::chrono::milliseconds(5), std::chrono::seconds(1));
  std::unique_lock lock(mutex_);
  while (!stopped_.wait_for(lock, stop, pause, [&] { return stop.stop_requested(); })) {
    const Clock::rep since = since_;
    if (since == kNever || Clock::now().time_since_epoch() - Clock::duration(since) < limit_) continue;
    // The thread that hangs may hold the locks of streams.
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message_.data(), message_.size());
    std::_Exit(int(code_));
  }
}

}  // namespace fovea
