// Aliasing: transient resources whose lifetimes do not overlap share memory.
#pragma once

#include <span>
#include <vector>

#include "framework/graph/compile/compile.h"
#include "framework/graph/compile/schedule.h"

namespace fovea::graph {

struct AliasRequest {
  uint32_t resource = kNone;
  Interval interval;  // levels, both ends included
  MemoryNeed need;
};

struct AliasResult {
  std::vector<Placement> placements;  // in the order of the requests
  std::vector<Plan::Heap> heaps;      // one per distinct set of memory types, in the order of appearance
  uint64_t bytesAliased = 0, bytesUnaliased = 0;
};

// Places the resources from the largest to the smallest, each in the tightest gap that is free during its whole
// lifetime, otherwise on top. Deterministic: ties are broken by the earlier lifetime, then by the lower resource
// number; among equal gaps the lower offset wins. Offsets and sizes are multiples of `granularity`
// (bufferImageGranularity), so that images and buffers may be neighbours.
AliasResult placeResources(std::span<const AliasRequest> requests, uint64_t granularity, bool alias);

}  // namespace fovea::graph
