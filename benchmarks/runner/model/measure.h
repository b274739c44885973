// What the passes of a graph do in a frame, and how long they take: figures that bounds are made of.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/runner/model/bound.h"
#include "benchmarks/runner/model/model.h"
#include "framework/graph/compile/plan.h"
#include "framework/graph/report/traffic.h"

namespace fovea::bench {

// One pass that runs. Numbers that differ from frame to frame are medians.
struct PassFigures {
  uint32_t pass = 0;  // index into BoundGraph::passes
  graph::PassTraffic traffic;
  double operations = 0, rays = 0;
  graph::CommandCounts commands;  // of the last frame
  double ms = 0;                  // where the pass works
  // Of what is no picture, such as shadow maps and buffers, a pass may reach only a part.
  Work leastWork() const { return {traffic.pictures.total(), operations, rays}; }
  Work mostWork() const { return {traffic.pictures.total() + traffic.others.total(), operations, rays}; }
};

struct FrameFigures {
  std::shared_ptr<const graph::Plan> plan;
  std::string scene, device;        // names
  std::vector<PassFigures> passes;  // in order of execution
  double wallMs = 0, gpuMs = 0;
};

FrameFigures measureFrame(const ModelOptions& options);

}  // namespace fovea::bench
