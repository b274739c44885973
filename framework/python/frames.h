// A finished frame, with the names that its session knows.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fovea/graph.h"

namespace fovea::python {

struct Times {
  std::string name;
  double gpuMs = 0, cpuMs = 0;
  std::vector<std::pair<std::string, double>> steps;
};

struct Frame {
  graph::FrameResult result;
  std::vector<Times> passes;  // in order of execution
};

}  // namespace fovea::python
