// Ends the process when something that cannot be stopped takes too long, such as a shader that never ends.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "fovea/error.h"

namespace fovea {

class Watchdog {
 public:
  // Watches nothing if `limit` is 0. Throws Error(OutOfMemory) if no thread can be created.
  Watchdog(std::chrono::duration<double> limit, ExitCode code, std::string message);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  // From now on end() or another begin() has to follow within the limit. If it does not, the process prints the message
  // and ends with the code, without destroying anything.
  void begin() { since_ = Clock::now().time_since_epoch().count(); }
  void end() { since_ = kNever; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::rep kNever = 0;
  void watch(const std::stop_token& stop);

  Clock::duration limit_;
  ExitCode code_;
  std::string message_;
  std::atomic<Clock::rep> since_ = kNever;
  // Made here, as it needs memory, and the lack of that would end a thread with the process.
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::jthread thread_;
};

}  // namespace fovea
