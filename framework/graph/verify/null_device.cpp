#include "framework/graph/verify/null_device.h"

namespace fovea::graph {

void NullDevice::add(NullEvent event) {
  event.frame = counters_.frames;
  if (log_) events_.push_back(event);
}

void NullDevice::play(const BarrierBatch& batch) {
  if (batch.empty()) return;
  ++counters_.barrierCommands;
  if (batch.srcStage || batch.dstStage) {
    ++counters_.memoryBarriers;
    add({NullEvent::Type::MemoryBarrier});
  }
  for (const ImageBarrier& barrier : batch.images) {
    ++counters_.imageBarriers;
    // The copies of a history resource swap every frame.
    const bool history = plan_.graph->resources[barrier.resource].history;
    const uint32_t copy =
        history ? static_cast<uint32_t>((counters_.frames + (barrier.previous ? 1 : 0)) % 2) : 0;
    add({NullEvent::Type::ImageBarrier, 0, barrier.resource, copy});
  }
}

void NullDevice::frame() {
  add({NullEvent::Type::BeginFrame});
  for (const Level& level : plan_.levels) {
    play(level.before);
    for (const uint32_t pass : level.passes) {
      ++counters_.passes;
      counters_.hostPasses += plan_.graph->passes[pass].declaration->kind == PassKind::Host;
      add({NullEvent::Type::Pass, 0, pass});
    }
  }
  play(plan_.end);
  add({NullEvent::Type::EndFrame});
  ++counters_.frames;
}

std::string NullDevice::print() const {
  std::string text;
  for (const NullEvent& event : events_) {
    switch (event.type) {
      case NullEvent::Type::BeginFrame:
        text += "frame " + std::to_string(event.frame);
        break;
      case NullEvent::Type::MemoryBarrier:
        text.append("  barrier memory");
        break;
      case NullEvent::Type::ImageBarrier:
        text.append("  barrier ").append(plan_.graph->resources[event.index].name);
        text.append("[").append(std::to_string(event.copy)).append("]");
        break;
      case NullEvent::Type::Pass:
        text.append("  pass ").append(plan_.graph->passes[event.index].name);
        break;
      case NullEvent::Type::EndFrame:
        continue;
    }
    text += '\n';
  }
  return text;
}

}  // namespace fovea::graph
