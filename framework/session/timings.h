// Times and counters of a run, collected frame by frame, then printed as a table or written as JSON or CSV.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "framework/graph/run/execute.h"

namespace fovea::session {

// The settings of a run, which every file that the run writes contains.
struct RunInfo {
  std::string device, graph, graphHash, scene;
  uint32_t width = 0, height = 0;
  uint32_t warmup = 0, seed = 0;
  uint64_t peakDeviceBytes = 0, peakHostBytes = 0;
};

// Of this process, so far.
uint64_t peakHostBytes();

// In milliseconds. p95 is the nearest rank: the smallest value that at least 95% of the frames do not exceed.
struct Spread {
  double median = 0, min = 0, p95 = 0;
};
Spread spreadOf(std::vector<double> values);

class Timings {
 public:
  explicit Timings(std::shared_ptr<const graph::Plan> plan) : plan_(std::move(plan)) {}

  void add(const graph::FrameResult& result);  // outputs are not kept
  bool empty() const { return frames_.empty(); }
  // Calls `visit(const graph::FrameResult&)` with every frame, in order.
  void eachFrame(const std::function<void(const graph::FrameResult&)>& visit) const;
  // Name of a PassTiming's pass. In a scene that moves, `animate` precedes the passes and computes the vertices.
  std::string name(uint32_t pass) const;
  std::string type(uint32_t pass) const;

  std::string table() const;  // for people
  std::string json(const RunInfo& run) const;
  std::string csv() const;  // a row per frame and pass
  // The extension, .json or .csv, selects the format. Throws Error(CannotWrite).
  void write(const std::filesystem::path& file, const RunInfo& run) const;

 private:
  static constexpr uint32_t kAnimate = ~0u;
  struct Row {  // one pass over all frames
    uint32_t pass = 0;
    bool host = false;
    Spread gpu, cpu;
    std::vector<std::pair<std::string, Spread>> steps;              // none if the pass has a single one
    double time() const { return host ? cpu.median : gpu.median; }  // where the pass does its work
  };
  struct ViewTotal {   // total of all passes of one view, ms per frame
    std::string view;  // "none" for passes without a view, such as the first eye's shading
    uint32_t passes = 0;
    Spread time;
  };
  std::string viewTable() const;
  std::string counterTable() const;
  std::vector<std::pair<std::string, Spread>> steps(uint32_t pass) const;
  std::vector<Row> rows() const;                                 // in order of execution
  std::vector<ViewTotal> viewTotals() const;                     // empty for graphs with a single view
  std::vector<std::pair<std::string, double>> counters() const;  // medians, in order of first appearance
  template <class Get>
  Spread frameSpread(Get get) const;

  // A run may have millions of frames, and most have the same passes, steps and counters. These are kept once, as a
  // frame whose numbers do not count, and of each frame only its numbers.
  struct Frame {
    uint64_t number = 0;
    size_t shape = 0;
    std::vector<double> values;
  };

  std::shared_ptr<const graph::Plan> plan_;
  std::vector<graph::FrameResult> shapes_;
  std::vector<Frame> frames_;
  std::map<uint32_t, graph::CommandCounts> commands_;  // of the passes of the last frame
};

}  // namespace fovea::session
