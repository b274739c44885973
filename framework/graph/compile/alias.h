// Alias: transient resources whose lifetimes do not meet share memory.
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

// Largest first, each into the tightest gap that is free during its whole life, else on top. Deterministic:
// ties go to the earlier life, then the smaller resource number; equal gaps to the lower offset. Offsets and
// sizes are multiples of `granularity` (bufferImageGranularity), so that images and buffers may be
// neighbours.
AliasResult placeResources(std::span<const AliasRequest> requests, uint64_t granularity, bool alias);

}  // namespace fovea::graph
