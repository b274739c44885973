// Threads that are kept between pieces of work.
#include "framework/base/threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <vector>

namespace fovea {
namespace {

// Adds up [1, n] on several threads.
uint64_t sumTo(uint32_t n, uint32_t threads) {
  std::atomic<uint32_t> next = 1;
  std::atomic<uint64_t> sum = 0;
  onThreads(threads, [&] {
    for (uint32_t i = next++; i <= n; i = next++) sum += i;
  });
  return sum;
}

TEST(Threads, AllOfTheWorkIsDone) {
  for (const uint32_t threads : {0u, 1u, 2u, 7u, 40u})
    for (const uint32_t n : {0u, 1u, 100000u}) EXPECT_EQ(sumTo(n, threads), uint64_t(n) * (n + 1) / 2);
}

// Work that waits until another thread works, too, would never end on one.
TEST(Threads, WorkIsDoneAtTheSameTime) {
  std::atomic<uint32_t> working = 0;
  onThreads(3, [&] {
    ++working;
    while (working < 2) std::this_thread::yield();
  });
  EXPECT_GE(working, 2u);
}

TEST(Threads, TheSameOnesHelpAgain) {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  for (int i = 0; i < 200; ++i) {
    std::atomic<uint32_t> working = 0;
    onThreads(3, [&] {
      ++working;
      while (working < 2) std::this_thread::yield();
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
    });
  }
  EXPECT_LE(seen.size(), 41u);  // as many as the widest test has asked for
}

TEST(Threads, WorkMayAskForHelpItself) {
  std::atomic<uint64_t> sum = 0;
  std::atomic<uint32_t> next = 0;
  onThreads(4, [&] {
    while (next++ < 20) sum += sumTo(1000, 4);
  });
  EXPECT_EQ(sum, 20u * 500500u);
}

TEST(Threads, CallersDoNotWaitForOneAnother) {
  std::vector<uint64_t> sums(8);
  {
    std::vector<std::jthread> callers;
    for (uint64_t& sum : sums)
      callers.emplace_back([&sum] {
        for (int i = 0; i < 50; ++i) sum += sumTo(1000, 4);
      });
  }
  for (const uint64_t sum : sums) EXPECT_EQ(sum, 50u * 500500u);
}

TEST(Threads, ExceptionsReachTheCaller) {
  for (const bool here : {true, false}) {
    std::atomic<uint32_t> working = 0;
    const auto caller = std::this_thread::get_id();
    const auto work = [&] {
      ++working;
      while (working < 2) std::this_thread::yield();
      if ((std::this_thread::get_id() == caller) == here) throw std::runtime_error("dropped");
    };
    EXPECT_THROW(onThreads(3, work), std::runtime_error) << here;
  }
  EXPECT_EQ(sumTo(1000, 4), 500500u);  // and leave the threads as they were
}

}  // namespace
}  // namespace fovea
