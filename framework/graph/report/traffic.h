// How many bytes the passes of a plan move if they touch all of what they reach once.
#pragma once

#include <cstdint>
#include <vector>

#include "framework/graph/compile/plan.h"

namespace fovea::graph {

struct Traffic {
  uint64_t read = 0, written = 0;
  uint64_t total() const { return read + written; }
  Traffic& operator+=(const Traffic& other) {
    read += other.read;
    written += other.written;
    return *this;
  }
};

// Every resource counts once for each pass that reads it and once for each that writes it, in full. A pass that works on
// few pixels moves less; one that reads a pixel's neighbourhood, or reads in several steps, moves more, where that is no
// longer in a cache.
struct PassTraffic {
  Traffic pictures;  // images of two dimensions and one layer: the G-buffer, light, what is kept of them
  Traffic others;    // shadow maps, voxels, buffers
};

// By index into BoundGraph::passes; nothing for passes that are culled.
std::vector<PassTraffic> traffic(const Plan& plan);

// Pixels of the largest picture among the outputs of the graph; 0 if there is none.
uint64_t outputPixels(const BoundGraph& graph);

}  // namespace fovea::graph
