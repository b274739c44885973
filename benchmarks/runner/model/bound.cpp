#include "benchmarks/runner/model/bound.h"

#include <algorithm>
#include <vector>

namespace fovea::bench {

const char* limitName(Limit limit) {
  switch (limit) {
    case Limit::Nothing:
      break;
    case Limit::Bytes:
      return "bytes";
    case Limit::Operations:
      return "operations";
    case Limit::Rays:
      return "rays";
  }
  return "-";
}

Bound boundOf(const Work& work, const Rates& rates) {
  Bound bound;
  const auto consider = [&](Limit limit, double amount, double rate) {
    const double ms = 1e3 * amount / rate;
    if (ms > bound.ms) bound = {ms, limit};
  };
  consider(Limit::Bytes, double(work.bytes), rates.bytes);
  consider(Limit::Operations, work.operations, rates.operations);
  consider(Limit::Rays, work.rays, rates.rays);
  return bound;
}

double longestChain(const graph::Precedence& order, std::span<const double> ms) {
  std::vector<double> start(ms.size(), 0.0);
  double longest = 0;
  for (const uint32_t pass : order.sorted()) {
    const double end = start[pass] + ms[pass];
    longest = std::max(longest, end);
    for (const uint32_t next : order.after(pass)) start[next] = std::max(start[next], end);
  }
  return longest;
}

}  // namespace fovea::bench
