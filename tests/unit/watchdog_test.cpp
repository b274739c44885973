// Tests what ends the process when a frame takes too long.
#include "framework/base/watchdog.h"

#include <gtest/gtest.h>

#include "framework/session/progress.h"

namespace fovea {
namespace {

using std::chrono::milliseconds;

const testing::ExitedWithCode kLost{int(ExitCode::DeviceLost)};
void sleep(milliseconds time) { std::this_thread::sleep_for(time); }

TEST(WatchdogDeathTest, EndsWhatTakesTooLong) {
  EXPECT_EXIT(
      {
        Watchdog watchdog(milliseconds(50), ExitCode::DeviceLost, "too long\n");
        watchdog.begin();
        sleep(milliseconds(60'000));
      },
      kLost, "^too long\n$");
}

TEST(Watchdog, LetsEndWhatEndsInTime) {
  Watchdog watchdog(milliseconds(2000), ExitCode::DeviceLost, "too long\n");
  for (int i = 0; i < 250; ++i) {  // together they last longer than the limit
    watchdog.begin();
    sleep(milliseconds(10));
  }
  watchdog.end();
  sleep(milliseconds(2500));
  Watchdog never(milliseconds(0), ExitCode::DeviceLost, "too long\n");
  never.begin();
  sleep(milliseconds(50));
}

TEST(WatchdogDeathTest, AFrameIsWatchedUntilItIsFinished) {
  EXPECT_EXIT(
      {
        session::Progress progress(true, 0.05);
        progress.frames(1, 2);
        sleep(milliseconds(60'000));
      },
      kLost, "^fovea: error: a frame takes longer than 0.1 s\n  -> .*--frame-limit");
}

TEST(Watchdog, WhatReportsProgressGoesOn) {
  session::Progress progress(true, 2);
  progress.frames(0, 1);
  for (int i = 0; i < 250; ++i) {
    progress.pass("path-trace", i / 250.0);
    sleep(milliseconds(10));
  }
  progress.frames(1, 1);
  sleep(milliseconds(2500));
  progress.frames(0, 1);
  progress.stage("measuring");
  sleep(milliseconds(2500));
}

}  // namespace
}  // namespace fovea
