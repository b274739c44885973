// The least time that a device needs for some work, and for passes that wait for each other.
#pragma once

#include <cstdint>
#include <span>

#include "benchmarks/runner/model/kinds.h"
#include "framework/graph/compile/schedule.h"

namespace fovea::bench {

struct Work {
  uint64_t bytes = 0;  // read and written
  double operations = 0, rays = 0;
};

enum class Limit : uint8_t { Nothing, Bytes, Operations, Rays };
const char* limitName(Limit limit);

// The longest of the times that the three kinds of work take by themselves, and which of them that is.
struct Bound {
  double ms = 0;
  Limit limit = Limit::Nothing;  // if there is no work
};
Bound boundOf(const Work& work, const Rates& rates);

// The time of the longest chain of passes that depend on each other, which no second queue can shorten. ms: the times of
// all passes, by index; 0 for those that do not run.
double longestChain(const graph::Precedence& order, std::span<const double> ms);

}  // namespace fovea::bench
