// Runs the same work on several threads at once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <system_error>
#include <thread>

#include "fovea/error.h"

namespace fovea {

// For the exception thrown when the system refuses to create a thread.
inline Error noThread(const std::system_error& e) {
  return Error(ExitCode::OutOfMemory, std::string("the system makes no more threads: ") + e.what(),
               "end other programs, or raise the limit of threads (ulimit -u)");
}
inline bool isNoThread(const std::system_error& e) {
  return e.code() == std::errc::resource_unavailable_try_again;
}

// For failures of libraries that do not tell their reason.
inline void throwIfNoThreads() {
  try {
    std::jthread([] {});
  } catch (const std::system_error& e) {
    throw noThread(e);
  }
}

// 0 means one thread per core.
inline uint32_t threadCount(uint32_t wanted) {
  return std::max(wanted != 0 ? wanted : std::thread::hardware_concurrency(), 1u);
}

// Calls work() on this thread and on up to `count` - 1 others, and returns when all calls have returned. Each call
// takes items of work until none are left, since a call that does not start in time is left out. The other threads are
// kept for later calls, as creating them costs more than some passes. Throws what work() throws, and Error(OutOfMemory)
// if the system creates no more threads.
void onThreads(uint32_t count, const std::function<void()>& work);

}  // namespace fovea
