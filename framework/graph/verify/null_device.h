// Replays plans without a device and logs which commands would be recorded, and in which order. Used by tests, and to
// see what a graph does.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/graph/compile/plan.h"

namespace fovea::graph {

struct NullEvent {
  enum class Type : uint8_t { BeginFrame, MemoryBarrier, ImageBarrier, Pass, EndFrame };
  Type type;
  uint64_t frame = 0;
  uint32_t index = kNone;  // Pass: the pass; ImageBarrier: the resource
  uint32_t copy = 0;       // ImageBarrier: which of the two images of a history resource
};

struct NullCounters {
  uint64_t frames = 0, passes = 0, hostPasses = 0;
  uint64_t barrierCommands = 0;  // vkCmdPipelineBarrier2
  uint64_t memoryBarriers = 0, imageBarriers = 0;
};

class NullDevice {
 public:
  // If `log` is false, events are counted but not kept.
  explicit NullDevice(const Plan& plan, bool log = true) : plan_(plan), log_(log) {}

  void frame();
  const std::vector<NullEvent>& events() const { return events_; }
  const NullCounters& counters() const { return counters_; }
  // One line per event: "frame 0", "  barrier memory", "  barrier a.image[0]", "  pass blur".
  std::string print() const;

 private:
  void play(const BarrierBatch& batch);
  void add(NullEvent event);
  const Plan& plan_;
  bool log_;
  std::vector<NullEvent> events_;
  NullCounters counters_;
};

}  // namespace fovea::graph
