#include "framework/session/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

#include "fovea/error.h"

namespace fovea::session {
namespace {

std::atomic<bool> asked = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set in a signal handler");

// Printed at once because finishing the frame may take seconds.
extern "C" void onInterrupt(int) {
  asked = true;
  static constexpr char kText[] = "\nfovea: interrupted: finishing the frame (Ctrl-C again: stop at once)\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kText, sizeof kText - 1);
}

extern "C" void onInterruptStop(int) {
  static constexpr char kText[] = "\nfovea: interrupted\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kText, sizeof kText - 1);
  _exit(int(ExitCode::Interrupted));
}

void handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART | SA_RESETHAND;  // a second signal finds the default action
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void stopAtInterrupts() { handle(onInterruptStop); }
void catchInterrupts() { handle(onInterrupt); }

bool interrupted() { return asked; }

}  // namespace fovea::session
