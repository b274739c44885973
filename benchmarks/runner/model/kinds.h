// Kinds of devices, by what they can do at most.
#pragma once

#include <span>
#include <string>

namespace fovea::bench {

struct Rates {
  double bytes = 0, operations = 0, rays = 0;  // a second
};

struct Kind {
  const char *name, *device;
  Rates rates;
  struct Sources {
    const char *bytes, *operations, *rays;
  } sources;
};

std::span<const Kind> kinds();
// Throws Error(Usage) with the names of all kinds if none is called so.
const Kind& kindNamed(const std::string& name);

}  // namespace fovea::bench
