#include "framework/graph/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/gpu/format.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/compile/schedule.h"
#include "framework/graph/report/planned_commands.h"
#include "framework/graph/report/traffic.h"

namespace fovea::graph {

namespace {

struct Name {
  uint64_t bit;
  const char* name;
};

constexpr Name kStageNames[] = {{VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, "indirect"},
                                {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex"},
                                {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"},
                                {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "early-tests"},
                                {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "late-tests"},
                                {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "color"},
                                {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"},
                                {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"}};

constexpr Name kUsageNames[] = {{uint32_t(Usage::Sampled), "sampled"},
                                {uint32_t(Usage::StorageRead), "storage read"},
                                {uint32_t(Usage::StorageWrite), "storage write"},
                                {uint32_t(Usage::ColorAttachment), "color attachment"},
                                {uint32_t(Usage::DepthAttachment), "depth attachment"},
                                {uint32_t(Usage::Uniform), "uniform"},
                                {uint32_t(Usage::TexelRead), "texel buffer"},
                                {uint32_t(Usage::Indirect), "indirect"},
                                {uint32_t(Usage::TransferRead), "transfer read"},
                                {uint32_t(Usage::TransferWrite), "transfer write"},
                                {uint32_t(Usage::HostRead), "host read"},
                                {uint32_t(Usage::HostWrite), "host write"}};

template <size_t N>
std::string join(uint64_t bits, const Name (&names)[N]) {
  std::string text;
  for (const Name& n : names)
    if (bits & n.bit) text.append(text.empty() ? "" : "+").append(n.name);
  return text.empty() ? "none" : text;
}

const char* layoutName(VkImageLayout layout) {
  switch (layout) {
    case VK_IMAGE_LAYOUT_UNDEFINED:
      return "undefined";
    case VK_IMAGE_LAYOUT_GENERAL:
      return "general";
    case VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL:
      return "color";
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL:
      return "depth";
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL:
      return "depth-read";
    case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL:
      return "shader-read";
    case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL:
      return "transfer-source";
    case VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL:
      return "transfer-target";
    default:
      return "other";
  }
}

const char* lifetimeName(const BoundResource& r) {
  if (r.external) return "input";
  if (r.history) return "history";
  if (r.lifetime == Lifetime::View) return "kept with the view";
  if (r.lifetime == Lifetime::Scene) return "kept with the scene";
  return "transient";
}

void addBatch(std::string& text, const BarrierBatch& batch, const BoundGraph& graph) {
  if (batch.srcStage || batch.dstStage)
    text += fmt::format("    wait    {} -> {}{}\n", join(batch.srcStage, kStageNames),
                        join(batch.dstStage, kStageNames), batch.srcAccess ? "" : " (order only)");
  for (const ImageBarrier& b : batch.images)
    text += fmt::format("    layout  {}{}: {} -> {}, {} -> {}\n", graph.resources[b.resource].name,
                        b.previous ? "@previous" : "", layoutName(b.oldLayout), layoutName(b.newLayout),
                        join(b.srcStage, kStageNames), join(b.dstStage, kStageNames));
}

std::string printWait(const Dependency& wait) {
  return fmt::format("{} -> {}{}", join(wait.srcStage, kStageNames), join(wait.dstStage, kStageNames),
                     wait.srcAccess ? "" : " (order only)");
}

void addSteps(std::string& text, const Plan& plan, uint32_t pass) {
  if (plan.steps.empty()) return;
  const PassDeclaration& declaration = *plan.graph->passes[pass].declaration;
  if (declaration.stepsByFrame && !plan.steps[pass].empty())
    text += "      of these, as the frame needs them\n";
  for (const PlannedStep& step : plan.steps[pass]) {
    const StepSpec& spec = declaration.steps[step.step];
    if (step.before) text += fmt::format("      wait    {}\n", printWait(step.before));
    text += fmt::format("      step    {}{}\n", spec.name,
                        spec.shader.empty() ? "" : fmt::format(" ({})", spec.shader));
  }
}

// Nothing for a plan that was made without shaders, and a dash where only a frame shows the commands.
std::string commandsText(const Plan& plan, const Level& level, uint32_t pass) {
  if (plan.steps.empty()) return "";
  const std::optional<CommandCounts> c = plannedCommands(plan, level, pass);
  if (!c) return "      commands  -\n";
  const auto count = [](uint32_t number, const char* what) {
    return number == 0 ? "" : fmt::format(", {} {}", what, number);
  };
  const std::string list = count(c->dispatches, "dispatches") + count(c->indirectDispatches, "indirect") +
                           count(c->draws, "draws") + count(c->transfers, "transfers") +
                           count(c->barriers, "barriers");
  return fmt::format("      commands{}\n", list.empty() ? "  none" : " " + list.substr(1));
}

// The level of each pass; kNone if it is culled.
std::vector<uint32_t> levelsOf(const Plan& plan) {
  std::vector<uint32_t> level(plan.graph->passes.size(), kNone);
  for (uint32_t l = 0; l < plan.levels.size(); ++l)
    for (const uint32_t p : plan.levels[l].passes) level[p] = l;
  return level;
}

std::vector<Interval> lives(const Plan& plan) {
  const BoundGraph& graph = *plan.graph;
  const std::vector<uint32_t> level = levelsOf(plan);
  std::vector<Interval> intervals(graph.resources.size());
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    if (level[p] == kNone) continue;
    for (const Access& a : graph.passes[p].accesses) {
      intervals[a.resource].first = std::min(intervals[a.resource].first, level[p]);
      intervals[a.resource].last = std::max(intervals[a.resource].last, level[p]);
    }
  }
  for (const BoundOutput& o : graph.outputs)
    intervals[o.resource].last = static_cast<uint32_t>(plan.levels.size());
  return intervals;
}

std::vector<uint32_t> placements(const Plan& plan) {
  std::vector<uint32_t> of(plan.graph->resources.size(), kNone);
  for (uint32_t i = 0; i < plan.placements.size(); ++i) of[plan.placements[i].resource] = i;
  return of;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n')
      out += "\\n";
    else
      out += c;
  }
  return out + "\"";
}

}  // namespace

std::string describe(const ResourceDesc& d) {
  if (d.kind == ResourceKind::Buffer) return fmt::format("{} x {} B {}", d.count, d.stride, d.element);
  std::string format = "?";
  for (const gpu::FormatInfo& info : gpu::formats())
    if (info.format == d.format) format = info.name;
  std::string size = fmt::format("{}x{}", d.width, d.height);
  if (d.volume) size += fmt::format("x{}", d.depth);
  if (d.array) size += fmt::format(" x {} layers", d.layers);
  if (d.mips > 1) size += fmt::format(", {} mips", d.mips);
  return size + " " + format;
}

std::string printBytes(uint64_t bytes) {
  if (bytes < 1024) return fmt::format("{} B", bytes);
  if (bytes < 1024 * 1024) return fmt::format("{:.1f} KiB", static_cast<double>(bytes) / 1024);
  if (bytes < uint64_t(1) << 30) return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024 * 1024));
  return fmt::format("{:.2f} GiB", static_cast<double>(bytes) / (1024.0 * 1024 * 1024));
}

// Whether the CPU works at the pass, or at steps of it.
static bool isOnHost(const BoundGraph& graph, uint32_t pass) {
  const PassDeclaration& d = *graph.passes[pass].declaration;
  return d.kind == PassKind::Host || (d.tracesRays && graph.raysOnHost);
}

namespace {

struct AllTraffic : PassTraffic {
  uint64_t pixels = 0;
  double perPixel() const { return pixels > 0 ? double(pictures.total()) / double(pixels) : 0; }
};

AllTraffic sum(const std::vector<PassTraffic>& passes, const BoundGraph& graph) {
  AllTraffic all;
  for (const PassTraffic& t : passes) {
    all.pictures += t.pictures;
    all.others += t.others;
  }
  all.pixels = outputPixels(graph);
  return all;
}

}  // namespace

std::string planText(const Plan& plan) {
  const BoundGraph& graph = *plan.graph;
  std::string text = fmt::format("graph {}", graph.name);
  if (!graph.description.empty()) text += fmt::format(": {}", graph.description);
  text += "\n\norder\n";
  for (uint32_t l = 0; l < plan.levels.size(); ++l) {
    text += fmt::format("  level {}\n", l);
    addBatch(text, plan.levels[l].before, graph);
    for (const uint32_t p : plan.levels[l].passes) {
      const BoundPass& pass = graph.passes[p];
      text += fmt::format("    pass    {} ({}){}", pass.name, pass.declaration->type,
                          isOnHost(graph, p) ? ", on the host" : "");
      if (pass.view != 0) text += fmt::format(", view {}", graph.views[pass.view]);
      text += '\n' + commandsText(plan, plan.levels[l], p);
      addSteps(text, plan, p);
    }
  }
  text += "  end\n";
  addBatch(text, plan.end, graph);
  for (uint32_t p = 0; p < graph.passes.size(); ++p)
    if (!plan.passLive[p])
      text += fmt::format("  culled    {} ({})\n", graph.passes[p].name, graph.passes[p].declaration->type);

  text += "\nresources\n";
  const std::vector<Interval> life = lives(plan);
  const std::vector<uint32_t> place = placements(plan);
  size_t width = 8;
  for (uint32_t r = 0; r < graph.resources.size(); ++r)
    if (plan.resourceLive[r]) width = std::max(width, graph.resources[r].name.size());
  for (uint32_t r = 0; r < graph.resources.size(); ++r) {
    const BoundResource& resource = graph.resources[r];
    if (!plan.resourceLive[r]) continue;
    text += fmt::format(
        "  {:<{}}  {:<28} {:>10}  {}", resource.name, width, describe(resource.desc),
        printBytes(place[r] != kNone ? plan.placements[place[r]].bytes : estimateMemory(resource.desc).bytes),
        lifetimeName(resource));
    if (place[r] != kNone)
      text += fmt::format(", levels {}-{}, heap {} at {}", life[r].first,
                          life[r].last == plan.levels.size() ? "end" : std::to_string(life[r].last),
                          plan.placements[place[r]].heap, plan.placements[place[r]].offset);
    text += fmt::format(" [{}]\n", join(resource.usage, kUsageNames));
  }
  text += "\noutputs\n";
  for (const BoundOutput& o : graph.outputs)
    text += fmt::format("  {:<{}}  {}\n", o.name, width, graph.resources[o.resource].name);
  text +=
      fmt::format("\nmemory: transient {} ({} without aliasing), kept {}\n", printBytes(plan.bytesAliased),
                  printBytes(plan.bytesUnaliased), printBytes(plan.bytesKept));
  const AllTraffic all = sum(traffic(plan), graph);
  text +=
      fmt::format("traffic: pictures {:.0f} B a pixel ({} read, {} written), all else {} read, {} written\n",
                  all.perPixel(), printBytes(all.pictures.read), printBytes(all.pictures.written),
                  printBytes(all.others.read), printBytes(all.others.written));
  return text;
}

std::string planDot(const Plan& plan) {
  const BoundGraph& graph = *plan.graph;
  const std::vector<uint32_t> level = levelsOf(plan);
  std::string text = fmt::format(
      "digraph {} {{\n  rankdir=LR;\n  node [shape=box, fontname=\"sans-serif\"];\n", quoted(graph.name));
  std::vector<std::vector<uint32_t>> writers(graph.resources.size());  // by version
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    const BoundPass& pass = graph.passes[p];
    const std::string place = level[p] == kNone ? "culled" : fmt::format("level {}", level[p]);
    text += fmt::format("  p{} [label={}{}];\n", p,
                        quoted(fmt::format("{}\n{}, {}", pass.name, pass.declaration->type, place)),
                        level[p] == kNone                          ? ", style=dashed, fontcolor=gray"
                        : pass.declaration->kind == PassKind::Host ? ", style=filled, fillcolor=lightyellow"
                                                                   : "");
    for (const Access& a : pass.accesses) {
      if (!a.writes) continue;
      if (writers[a.resource].size() <= a.version) writers[a.resource].resize(a.version + 1, kNone);
      writers[a.resource][a.version] = p;
    }
  }
  for (uint32_t r = 0; r < graph.resources.size(); ++r)
    if (graph.resources[r].external)
      text += fmt::format("  r{} [label={}, shape=ellipse];\n", r, quoted(graph.resources[r].name));
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    for (const Access& a : graph.passes[p].accesses) {
      if (!a.reads || (a.writes && a.version <= 1 && !graph.resources[a.resource].external)) continue;
      const std::vector<uint32_t>& by = writers[a.resource];
      const uint32_t version = a.previous ? static_cast<uint32_t>(by.size()) - 1
                               : a.writes ? a.version - 1
                                          : a.version;
      const bool made = version < by.size() && by[version] != kNone;
      text += fmt::format("  {}{} -> p{} [label={}{}];\n", made ? "p" : "r", made ? by[version] : a.resource,
                          p, quoted(graph.resources[a.resource].name),
                          a.previous ? ", style=dashed, constraint=false" : "");
    }
  }
  for (const BoundOutput& o : graph.outputs)
    text += fmt::format("  {} [shape=plaintext];\n  p{} -> {} [label={}];\n", quoted("output " + o.name),
                        writers[o.resource][o.version], quoted("output " + o.name),
                        quoted(graph.resources[o.resource].name));
  return text + "}\n";
}

namespace {

nlohmann::ordered_json batchJson(const BarrierBatch& batch, const BoundGraph& graph) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (batch.srcStage || batch.dstStage)
    json["memory"] = {{"from", join(batch.srcStage, kStageNames)},
                      {"to", join(batch.dstStage, kStageNames)},
                      {"flush", batch.srcAccess != 0}};
  for (const ImageBarrier& b : batch.images)
    json["images"].push_back({{"resource", graph.resources[b.resource].name},
                              {"previous", b.previous},
                              {"from", join(b.srcStage, kStageNames)},
                              {"to", join(b.dstStage, kStageNames)},
                              {"old_layout", layoutName(b.oldLayout)},
                              {"new_layout", layoutName(b.newLayout)}});
  return json;
}

}  // namespace

static nlohmann::ordered_json stepsJson(const Plan& plan, uint32_t pass) {
  const BoundPass& bound = plan.graph->passes[pass];
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PlannedStep& step : plan.steps[pass]) {
    const StepSpec& spec = bound.declaration->steps[step.step];
    nlohmann::ordered_json entry{{"name", spec.name}};
    if (!spec.shader.empty()) entry["shader"] = spec.shader;
    if (step.before)
      entry["wait"] = {{"from", join(step.before.srcStage, kStageNames)},
                       {"to", join(step.before.dstStage, kStageNames)},
                       {"flush", step.before.srcAccess != 0}};
    for (const StepAccess& a : step.accesses) {
      const std::string& resource = plan.graph->resources[bound.accesses[a.access].resource].name;
      if (a.reads) entry["reads"].push_back(resource);
      if (a.writes) entry["writes"].push_back(resource);
    }
    list.push_back(std::move(entry));
  }
  return list;
}

static nlohmann::ordered_json trafficJson(const PassTraffic& t) {
  const auto bytes = [](const Traffic& moved) {
    return nlohmann::ordered_json{{"read", moved.read}, {"written", moved.written}};
  };
  return {{"pictures", bytes(t.pictures)}, {"others", bytes(t.others)}};
}

static nlohmann::ordered_json commandsJson(const std::optional<CommandCounts>& c) {
  if (!c) return nullptr;
  return {{"dispatches", c->dispatches}, {"indirect_dispatches", c->indirectDispatches},
          {"draws", c->draws},           {"renderings", c->renderings},
          {"transfers", c->transfers},   {"barriers", c->barriers}};
}

std::string planJson(const Plan& plan) {
  using Json = nlohmann::ordered_json;
  const BoundGraph& graph = *plan.graph;
  Json json{{"graph", graph.name}, {"hash", fmt::format("{:016x}", plan.hash)}, {"views", graph.views}};
  const std::vector<PassTraffic> moved = traffic(plan);
  json["levels"] = Json::array();
  for (const Level& level : plan.levels) {
    Json passes = Json::array();
    for (const uint32_t p : level.passes) {
      passes.push_back({{"name", graph.passes[p].name},
                        {"type", graph.passes[p].declaration->type},
                        {"view", graph.views[graph.passes[p].view]},
                        {"host", isOnHost(graph, p)},
                        {"traffic", trafficJson(moved[p])},
                        {"commands", commandsJson(plannedCommands(plan, level, p))}});
      if (!plan.steps.empty() && !plan.steps[p].empty()) passes.back()["steps"] = stepsJson(plan, p);
    }
    json["levels"].push_back({{"barriers", batchJson(level.before, graph)}, {"passes", std::move(passes)}});
  }
  json["end"] = batchJson(plan.end, graph);
  json["culled"] = Json::array();
  for (uint32_t p = 0; p < graph.passes.size(); ++p)
    if (!plan.passLive[p]) json["culled"].push_back(graph.passes[p].name);
  const std::vector<Interval> life = lives(plan);
  const std::vector<uint32_t> place = placements(plan);
  json["resources"] = Json::array();
  for (uint32_t r = 0; r < graph.resources.size(); ++r) {
    const BoundResource& resource = graph.resources[r];
    if (!plan.resourceLive[r]) continue;
    Json entry{
        {"name", resource.name}, {"is", describe(resource.desc)}, {"lifetime", lifetimeName(resource)}};
    entry["bytes"] =
        place[r] != kNone ? plan.placements[place[r]].bytes : estimateMemory(resource.desc).bytes;
    if (life[r].first != kNone) entry["levels"] = {life[r].first, life[r].last};
    if (place[r] != kNone) {
      entry["heap"] = plan.placements[place[r]].heap;
      entry["offset"] = plan.placements[place[r]].offset;
    }
    json["resources"].push_back(std::move(entry));
  }
  json["outputs"] = Json::object();
  for (const BoundOutput& o : graph.outputs) json["outputs"][o.name] = graph.resources[o.resource].name;
  json["memory"] = {{"transient", plan.bytesAliased},
                    {"transient_without_aliasing", plan.bytesUnaliased},
                    {"kept", plan.bytesKept}};
  const AllTraffic all = sum(moved, graph);
  json["traffic"] = trafficJson(all);
  json["traffic"]["picture_bytes_per_pixel"] = all.perPixel();
  return json.dump(2) + "\n";
}

std::string writePlan(const Plan& plan, PlanForm form) {
  return form == PlanForm::Text ? planText(plan) : form == PlanForm::Dot ? planDot(plan) : planJson(plan);
}

}  // namespace fovea::graph
