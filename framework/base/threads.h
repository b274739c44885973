// Runs the same work on several threads at once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <thread>
#include <vector>

namespace fovea {

// 0 means one thread per core.
inline uint32_t threadCount(uint32_t wanted) {
  return std::max(wanted != 0 ? wanted : std::thread::hardware_concurrency(), 1u);
}

// Calls work() `count` times concurrently, including once on this thread, and returns when all calls have returned.
template <class Work>
void onThreads(uint32_t count, const Work& work) {
  std::vector<std::jthread> helpers;
  for (uint32_t i = 1; i < count; ++i) helpers.emplace_back(work);
  work();
}

}  // namespace fovea
