#include "framework/graph/verify/checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "framework/graph/verify/checker_model.h"

namespace fovea::graph {
namespace {

using namespace checker;

// ---- The checker's own idea of what a usage means ----------------------------------------------------

struct UsageRule {
  Usage usage;
  VkPipelineStageFlags2 stages;  // 0 means the shader stages of the pass
  VkAccessFlags2 read, write;
  std::vector<VkImageLayout> layouts;
};

const std::vector<UsageRule>& usageRules() {
  constexpr VkPipelineStageFlags2 kTests =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
  static const std::vector<UsageRule> rules = {
      {Usage::Sampled,
       0,
       VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
       0,
       {kGeneral, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}},
      {Usage::StorageRead, 0, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, 0, {kGeneral}},
      {Usage::StorageWrite, 0, 0, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, {kGeneral}},
      {Usage::ColorAttachment,
       VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
       0,
       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
       {kGeneral, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}},
      {Usage::DepthAttachment,
       kTests,
       VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
       VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
       {kGeneral, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}},
      {Usage::Uniform, 0, VK_ACCESS_2_UNIFORM_READ_BIT, 0, {}},
      {Usage::TexelRead, 0, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT, 0, {}},
      {Usage::Indirect, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, 0, {}},
      {Usage::TransferRead,
       VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
       VK_ACCESS_2_TRANSFER_READ_BIT,
       0,
       {kGeneral, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}},
      {Usage::TransferWrite,
       VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
       0,
       VK_ACCESS_2_TRANSFER_WRITE_BIT,
       {kGeneral, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL}},
      // Host passes reach their resources through copies to and from staging memory.
      {Usage::HostRead,
       VK_PIPELINE_STAGE_2_COPY_BIT,
       VK_ACCESS_2_TRANSFER_READ_BIT,
       0,
       {kGeneral, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}},
      {Usage::HostWrite,
       VK_PIPELINE_STAGE_2_COPY_BIT,
       0,
       VK_ACCESS_2_TRANSFER_WRITE_BIT,
       {kGeneral, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL}},
  };
  return rules;
}

VkPipelineStageFlags2 stagesOfPass(PassKind kind) {
  VkPipelineStageFlags2 stages = 0;
  if (kind == PassKind::Compute || kind == PassKind::ComputeAndGraphics)
    stages |= VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  if (kind == PassKind::Graphics || kind == PassKind::ComputeAndGraphics)
    stages |= VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  return stages;
}

std::vector<Need> needsOf(PassKind kind, const Access& access) {
  std::vector<Need> needs;
  for (const UsageRule& rule : usageRules()) {
    if (!any(access.usage, rule.usage)) continue;
    const StageSet stages = stageSet(rule.stages ? rule.stages : stagesOfPass(kind));
    if (rule.read) needs.push_back({stages, rule.read, false, access.reads});
    if (rule.write && access.writes) needs.push_back({stages, rule.write, true, false});
  }
  return needs;
}

constexpr VkAccessFlags2 kWriteAccesses =
    VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;

// Reads and writes of a step, each as a need of its own.
std::vector<Need> needsOfStep(const StepAccess& access) {
  std::vector<Need> needs;
  const StageSet stages = stageSet(access.stage);
  if (access.mask & ~kWriteAccesses)
    needs.push_back({stages, access.mask & ~kWriteAccesses, false, access.reads});
  if (access.mask & kWriteAccesses) needs.push_back({stages, access.mask & kWriteAccesses, true, false});
  return needs;
}

// ---- Memory ------------------------------------------------------------------------------------------

// The contents of a piece of memory.
struct Contents {
  bool valid = false;
  uint32_t version = 0;
  int64_t frame = -1;  // -1 means as zeroed or uploaded before the first frame
};

struct Copy {
  uint32_t resource = kNone;
  Contents contents;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  std::vector<Event> events;
  std::vector<uint32_t> overlaps;  // other copies in the same memory
  int64_t takenInFrame = -1;       // transient: the frame in which its memory was last taken
};

class Checker {
 public:
  Checker(const Plan& plan, const PlanCheckOptions& options)
      : plan_(plan), graph_(*plan.graph), options_(options) {}

  std::vector<std::string> run() {
    checkPasses();
    checkMemory();
    if (!problems_.empty()) return std::move(problems_);
    start();
    for (frame_ = 0; frame_ < options_.frames && problems_.size() < kMaxProblems; ++frame_) playFrame();
    return std::move(problems_);
  }

 private:
  static constexpr size_t kMaxProblems = 20;

  template <class... Args>
  void problem(fmt::format_string<Args...> format, Args&&... args) {
    std::string text = fmt::format(format, std::forward<Args>(args)...);
    if (said_.insert(text).second) problems_.push_back(fmt::format("frame {}: {}", frame_, text));
  }

  bool transient(uint32_t r) const {
    const BoundResource& resource = graph_.resources[r];
    return resource.lifetime == Lifetime::Transient && !resource.external && !resource.history;
  }
  bool image(uint32_t r) const { return graph_.resources[r].desc.kind == ResourceKind::Image; }
  const char* name(uint32_t r) const { return graph_.resources[r].name.c_str(); }
  Copy& copyOf(uint32_t r, bool previous) { return copies_[r * 2 + (previous ? 1 : 0)]; }

  void checkPasses();
  void checkMemory();
  void start();
  void playFrame();
  void playBarriers(const BarrierBatch& batch);
  void playTransition(const ImageBarrier& b, const BarrierBatch& batch);
  void playPass(uint32_t p);
  void playSteps(uint32_t p);
  void touch(uint32_t p, Copy& copy, const std::vector<const Access*>& accesses);
  void checkContents(uint32_t p, const Copy& copy, const Access& access);
  void checkWaits(const char* who, const Copy& copy, const std::vector<Event>& events, const Need& need);
  void take(const char* who, Copy& copy, const std::vector<Need>& needs);
  void playEnd();
  void checkStart();

  const Plan& plan_;
  const BoundGraph& graph_;
  const PlanCheckOptions& options_;
  int64_t frame_ = 0;
  std::vector<std::string> problems_;
  std::set<std::string> said_;
  std::vector<Copy> copies_;  // per resource: current, previous
  std::vector<uint32_t> lastVersion_;
};

void Checker::checkPasses() {
  std::vector<uint32_t> runs(graph_.passes.size(), 0);
  for (const Level& level : plan_.levels)
    for (const uint32_t p : level.passes) {
      if (p >= runs.size()) return problem("a level names pass {} of {}", p, runs.size());
      ++runs[p];
    }
  for (size_t p = 0; p < runs.size(); ++p)
    if (runs[p] != (plan_.passLive[p] ? 1u : 0u))
      problem("pass `{}` runs {} times but is {}", graph_.passes[p].name, runs[p],
              plan_.passLive[p] ? "live" : "culled");
  // Nothing that has an effect may be culled.
  for (size_t p = 0; p < runs.size(); ++p) {
    bool matters = graph_.passes[p].declaration->sideEffects;
    for (const Access& a : graph_.passes[p].accesses) {
      if (!a.writes) continue;
      matters = matters || graph_.resources[a.resource].external;
      for (const BoundOutput& o : graph_.outputs) matters = matters || o.resource == a.resource;
    }
    if (matters && !plan_.passLive[p])
      problem("pass `{}` is culled but makes an output", graph_.passes[p].name);
  }
}

void Checker::checkMemory() {
  std::vector<uint32_t> placed(graph_.resources.size(), 0);
  for (const Placement& p : plan_.placements) {
    if (p.resource >= graph_.resources.size() || p.heap >= plan_.heaps.size())
      return problem("a placement of nothing");
    ++placed[p.resource];
    const MemoryNeed need =
        options_.memory ? options_.memory(p.resource) : estimateMemory(graph_.resources[p.resource].desc);
    if (!transient(p.resource)) problem("`{}` must not share memory", name(p.resource));
    if (p.bytes < need.bytes) problem("`{}` has {} bytes, needs {}", name(p.resource), p.bytes, need.bytes);
    if (p.offset % std::max<uint64_t>(1, need.alignment))
      problem("`{}` is misaligned at {}", name(p.resource), p.offset);
    if (p.offset + p.bytes > plan_.heaps[p.heap].bytes)
      problem("`{}` reaches past its heap", name(p.resource));
    if ((plan_.heaps[p.heap].memoryTypeBits & ~need.memoryTypeBits) != 0)
      problem("`{}` is in memory of a type it cannot use", name(p.resource));
  }
  for (uint32_t r = 0; r < placed.size(); ++r)
    if (placed[r] != (plan_.resourceLive[r] && transient(r) ? 1u : 0u))
      problem("`{}` has {} places in the heaps", name(r), placed[r]);
}

void Checker::start() {
  copies_.assign(graph_.resources.size() * 2, {});
  lastVersion_.assign(graph_.resources.size(), 0);
  for (const BoundPass& pass : graph_.passes)
    for (const Access& a : pass.accesses)
      if (a.writes && plan_.passLive[static_cast<size_t>(&pass - graph_.passes.data())])
        lastVersion_[a.resource] = std::max(lastVersion_[a.resource], a.version);
  for (uint32_t r = 0; r < graph_.resources.size(); ++r) {
    for (int c = 0; c < 2; ++c) {
      Copy& copy = copies_[r * 2 + c];
      copy.resource = r;
      if (transient(r)) continue;
      copy.contents = {true, 0, -1};
      copy.layout = plan_.startLayout[r][static_cast<size_t>(c)];
    }
  }
  for (const Placement& a : plan_.placements)
    for (const Placement& b : plan_.placements)
      if (a.resource != b.resource && a.heap == b.heap && a.offset < b.offset + b.bytes &&
          b.offset < a.offset + a.bytes)
        copyOf(a.resource, false).overlaps.push_back(b.resource * 2);
}

void Checker::playFrame() {
  checkStart();
  for (const Level& level : plan_.levels) {
    playBarriers(level.before);
    for (const uint32_t p : level.passes) playPass(p);
  }
  playBarriers(plan_.end);
  playEnd();
  for (uint32_t r = 0; r < graph_.resources.size(); ++r)
    if (graph_.resources[r].history) std::swap(copyOf(r, false), copyOf(r, true));
}

void Checker::checkStart() {
  for (uint32_t r = 0; r < graph_.resources.size(); ++r) {
    if (transient(r) || !plan_.resourceLive[r] || !image(r)) continue;
    for (int c = 0; c < (graph_.resources[r].history ? 2 : 1); ++c)
      if (copies_[r * 2 + c].layout != plan_.startLayout[r][static_cast<size_t>(c)])
        problem("`{}` starts the frame in layout {}, the plan says {}", name(r),
                static_cast<int>(copies_[r * 2 + c].layout),
                static_cast<int>(plan_.startLayout[r][static_cast<size_t>(c)]));
  }
}

void Checker::playBarriers(const BarrierBatch& batch) {
  const Scope all{stageSet(batch.srcStage), stageSet(batch.dstStage), batch.srcAccess, batch.dstAccess};
  // The barriers of one command do not wait for each other, so all are examined before anything changes.
  for (const ImageBarrier& b : batch.images) playTransition(b, batch);
  for (Copy& copy : copies_)
    for (Event& event : copy.events) applyBarrier(event, all);
  for (const ImageBarrier& b : batch.images) {
    const Scope scope{stageSet(b.srcStage), stageSet(b.dstStage), b.srcAccess, b.dstAccess};
    Copy& copy = copyOf(b.resource, b.previous);
    copy.layout = b.newLayout;
    // The layout change has waited for everything before it; now everything waits for it.
    Event event;
    event.write = event.available = true;
    event.after = scope.dst;
    for (int i = 0; i < kStageCount; ++i)
      if (scope.dst >> i & 1) event.seen[static_cast<size_t>(i)] = scope.dstAccess;
    copy.events = {event};
  }
}

void Checker::playTransition(const ImageBarrier& b, const BarrierBatch& batch) {
  const Scope scope{stageSet(b.srcStage), stageSet(b.dstStage), b.srcAccess, b.dstAccess};
  const Scope all{stageSet(batch.srcStage), stageSet(batch.dstStage), batch.srcAccess, batch.dstAccess};
  Copy& copy = copyOf(b.resource, b.previous);
  if (!image(b.resource)) return problem("a change of layout of the buffer `{}`", name(b.resource));
  if (b.oldLayout != VK_IMAGE_LAYOUT_UNDEFINED && b.oldLayout != copy.layout)
    problem("`{}` is in layout {}, the barrier says {}", name(b.resource), static_cast<int>(copy.layout),
            static_cast<int>(b.oldLayout));
  if (b.newLayout == VK_IMAGE_LAYOUT_UNDEFINED) problem("`{}` is put into no layout", name(b.resource));
  if (b.oldLayout == VK_IMAGE_LAYOUT_UNDEFINED) copy.contents.valid = false;
  for (const Event& event : copy.events) {
    if (!inFirstScope(event, scope))
      problem("the change of layout of `{}` does not wait for an earlier access", name(b.resource));
    else if (event.write && !flushed(event, scope) && !(inFirstScope(event, all) && flushed(event, all)))
      problem("the change of layout of `{}` does not flush an earlier write", name(b.resource));
  }
  if (!transient(b.resource) || copy.takenInFrame == frame_) return;
  if (b.oldLayout != VK_IMAGE_LAYOUT_UNDEFINED)
    problem("`{}` is used before it is initialised", name(b.resource));
  copy.takenInFrame = frame_;
  for (const uint32_t other : copy.overlaps) {
    Copy& occupant = copies_[other];
    for (const Event& event : occupant.events) {
      if (!inFirstScope(event, scope))
        problem("`{}` takes memory of `{}` without waiting for it", name(b.resource),
                name(occupant.resource));
      else if (event.write && !flushed(event, all))
        problem("`{}` takes memory of `{}` without flushing its writes", name(b.resource),
                name(occupant.resource));
    }
    occupant.contents.valid = false;
    occupant.events.clear();
  }
}

void Checker::playPass(uint32_t p) {
  const BoundPass& pass = graph_.passes[p];
  // Ports of one pass that refer to the same copy are one access to the outside.
  std::vector<uint32_t> order;
  for (const Access& a : pass.accesses) {
    const uint32_t copy = a.resource * 2 + (a.previous ? 1 : 0);
    if (std::find(order.begin(), order.end(), copy) == order.end()) order.push_back(copy);
  }
  for (const uint32_t copy : order) {
    std::vector<const Access*> accesses;
    for (const Access& a : pass.accesses)
      if (a.resource * 2 + (a.previous ? 1 : 0) == copy) accesses.push_back(&a);
    touch(p, copies_[copy], accesses);
  }
  if (!plan_.steps.empty() && !pass.declaration->stepsByFrame) playSteps(p);
}

// Inside a pass, every step must wait for the steps before it, except for those with which it may run together.
void Checker::playSteps(uint32_t p) {
  const BoundPass& pass = graph_.passes[p];
  std::vector<std::vector<Event>> past(copies_.size()), together(copies_.size());
  for (const PlannedStep& step : plan_.steps[p]) {
    const StepSpec& spec = pass.declaration->steps[step.step];
    if (!spec.together)
      for (size_t c = 0; c < past.size(); ++c) {
        past[c].insert(past[c].end(), together[c].begin(), together[c].end());
        together[c].clear();
      }
    const Dependency& wait = step.before;
    const Scope scope{stageSet(wait.srcStage), stageSet(wait.dstStage), wait.srcAccess, wait.dstAccess};
    for (auto* list : {&past, &together})
      for (std::vector<Event>& events : *list)
        for (Event& event : events) applyBarrier(event, scope);
    const std::string who = fmt::format("{}, step {}", pass.name, spec.name);
    for (const StepAccess& a : step.accesses) {
      const Access& access = pass.accesses[a.access];
      const size_t c = access.resource * 2 + (access.previous ? 1 : 0);
      for (const Need& need : needsOfStep(a)) {
        checkWaits(who.c_str(), copies_[c], past[c], need);
        for (const Event& event : eventsOf(need)) together[c].push_back(event);
      }
    }
  }
}

void Checker::touch(uint32_t p, Copy& copy, const std::vector<const Access*>& accesses) {
  const BoundPass& pass = graph_.passes[p];
  const uint32_t r = copy.resource;
  std::vector<Need> needs;
  bool reads = false, writes = false;
  uint32_t made = 0;
  for (const Access* a : accesses) {
    for (const Need& need : needsOf(pass.declaration->kind, *a)) needs.push_back(need);
    reads |= a->reads;
    writes |= a->writes;
    if (a->writes) made = a->version;
    if (image(r) && a->usage != Usage::None) {
      if (a->layout != copy.layout)
        problem("`{}` accesses `{}` in layout {}, it is in {}", pass.name, name(r),
                static_cast<int>(a->layout), static_cast<int>(copy.layout));
      for (const UsageRule& rule : usageRules())
        if (any(a->usage, rule.usage) &&
            std::find(rule.layouts.begin(), rule.layouts.end(), a->layout) == rule.layouts.end())
          problem("`{}` cannot access `{}` in layout {}", pass.name, name(r), static_cast<int>(a->layout));
    }
  }
  if (needs.empty()) return;
  for (const Access* a : accesses)
    if (a->reads) checkContents(p, copy, *a);
  if (writes && !reads && transient(r) && copy.takenInFrame != frame_) take(pass.name.c_str(), copy, needs);
  std::vector<Event> fresh;
  for (const Need& need : needs) {
    checkWaits(pass.name.c_str(), copy, copy.events, need);
    for (Event& event : eventsOf(need)) fresh.push_back(event);
  }
  // A pass that declares only writes still discards nothing that it updates in place: its writes
  // must see what they change.
  if (writes) {
    copy.contents = {true, made, frame_};
    copy.events.clear();  // all were waited for, so waiting for this write waits for them, too
  }
  copy.events.insert(copy.events.end(), fresh.begin(), fresh.end());
}

void Checker::checkWaits(const char* who, const Copy& copy, const std::vector<Event>& events,
                         const Need& need) {
  for (const Event& event : events) {
    if (!event.write && !need.write) continue;
    if (!ordered(event, need))
      problem("`{}` does not wait for an earlier {} of `{}`", who, event.write ? "write" : "read",
              name(copy.resource));
    else if (event.write && !event.available)
      problem("`{}` comes after a write of `{}` that nothing flushed", who, name(copy.resource));
    else if (need.contents && !visible(event, need))
      problem("`{}` does not see an earlier write of `{}`", who, name(copy.resource));
  }
}

// The first write of a frame to a transient buffer invalidates everything else that used this memory.
void Checker::take(const char* who, Copy& copy, const std::vector<Need>& needs) {
  if (image(copy.resource)) problem("`{}` uses `{}` before it has a layout", who, name(copy.resource));
  copy.takenInFrame = frame_;
  for (const uint32_t other : copy.overlaps) {
    Copy& occupant = copies_[other];
    for (const Need& need : needs) {
      Need write = need;
      write.write = true;
      for (const Event& event : occupant.events) {
        if (!ordered(event, write))
          problem("`{}` takes memory of `{}` without waiting for it", name(copy.resource),
                  name(occupant.resource));
        else if (event.write && !event.available)
          problem("`{}` takes memory of `{}` without flushing its writes", name(copy.resource),
                  name(occupant.resource));
      }
    }
    occupant.contents.valid = false;
    occupant.events.clear();
  }
}

void Checker::checkContents(uint32_t p, const Copy& copy, const Access& access) {
  const uint32_t r = access.resource;
  const char* who = graph_.passes[p].name.c_str();
  if (!copy.contents.valid) return problem("`{}` reads `{}`, which holds nothing", who, name(r));
  const Contents& is = copy.contents;
  Contents should{true, access.writes ? access.version - 1 : access.version, frame_};
  if (access.previous || should.version == 0) {
    // The last version of the last frame, or what was there before the first frame.
    should.frame = frame_ - 1;
    should.version = frame_ == 0 ? 0 : lastVersion_[r];
    if (lastVersion_[r] == 0) should = {true, 0, -1};
  }
  if (is.version != should.version || is.frame != should.frame)
    problem("`{}` should read version {} of frame {} of `{}`, finds version {} of frame {}", who,
            should.version, should.frame - frame_, name(r), is.version, is.frame - frame_);
}

void Checker::playEnd() {
  const Need transfer{stageSet(VK_PIPELINE_STAGE_2_COPY_BIT), VK_ACCESS_2_TRANSFER_READ_BIT, false, true};
  std::vector<uint8_t> done(graph_.resources.size(), 0);
  for (const BoundOutput& output : graph_.outputs) {
    if (std::exchange(done[output.resource], 1)) continue;
    Copy& copy = copyOf(output.resource, false);
    if (!copy.contents.valid || copy.contents.version != output.version || copy.contents.frame != frame_)
      problem("output `{}` does not hold version {} of this frame at the end", output.name, output.version);
    if (image(output.resource) && copy.layout != VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL)
      problem("output `{}` ends in layout {}", output.name, static_cast<int>(copy.layout));
    checkWaits("the readback", copy, copy.events, transfer);
    for (Event& event : eventsOf(transfer)) copy.events.push_back(event);
  }
  for (uint32_t r = 0; r < graph_.resources.size(); ++r)
    if (plan_.resourceLive[r] && image(r) && plan_.endLayout[r] != copyOf(r, false).layout)
      problem("`{}` ends the frame in layout {}, the plan says {}", name(r),
              static_cast<int>(copyOf(r, false).layout), static_cast<int>(plan_.endLayout[r]));
}

}  // namespace

std::vector<std::string> checkPlan(const Plan& plan, const PlanCheckOptions& options) {
  return Checker(plan, options).run();
}

}  // namespace fovea::graph
