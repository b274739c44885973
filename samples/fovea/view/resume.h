// Continues a run in a new process image: when a plug-in has changed, the program restarts itself, since the code of a
// plug-in cannot be replaced while objects of it exist. The address of the page stays the same.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/session/inputs.h"

namespace fovea::view {

// What the arguments of the program do not say any more, or never did.
struct Resume {
  std::string token;
  uint16_t port = 0;
  std::string graph, scene, second, tev;
  bool accumulate = true;
  std::vector<std::string> set;
  uint32_t width = 0, height = 0, seed = 1;
  std::string motion;  // as parseCommand() reads it
};

// Why a graph cannot be loaded with its plug-ins as they are now; empty if it can. Another process tries it, so that a
// plug-in that crashes does no harm here.
std::string whyNotLoadable(const session::GraphOptions& options);

// Restarts the program with its original arguments. Throws Error(Internal) if the system refuses.
[[noreturn]] void startAnew(const Resume& resume);
// What startAnew() was given, in the program that it has started. Takes it out of the environment.
std::optional<Resume> takeResume();

}  // namespace fovea::view
