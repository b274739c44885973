// Runs the same work on several threads at once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <system_error>
#include <thread>
#include <vector>

#include "fovea/error.h"

namespace fovea {

// For the exception of a thread that the system refuses to make.
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

// Calls work() `count` times concurrently, including once on this thread, and returns when all calls have returned.
template <class Work>
void onThreads(uint32_t count, const Work& work) {
  std::vector<std::jthread> helpers;
  try {
    for (uint32_t i = 1; i < count; ++i) helpers.emplace_back(work);
  } catch (const std::system_error& e) {
    throw noThread(e);
  }
  work();
}

}  // namespace fovea
