#include "framework/session/timings.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "framework/base/text_file.h"
#include "framework/graph/compile/plan.h"

namespace fovea::session {
namespace {

using Json = nlohmann::ordered_json;

double medianOf(std::vector<double> values) { return spreadOf(std::move(values)).median; }

// The clocks resolve microseconds; more digits would be meaningless.
double rounded(double ms) { return std::round(ms * 1000.0) / 1000.0; }

Json toJson(const Spread& s) {
  return {{"median", rounded(s.median)}, {"min", rounded(s.min)}, {"p95", rounded(s.p95)}};
}

std::string formatMs(double ms) { return fmt::format("{:.2f}", ms); }

std::string formatCount(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) {
    std::string digits = fmt::format("{:.0f}", std::abs(value));
    for (size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, ",");
    return (value < 0 ? "-" : "") + digits;
  }
  return fmt::format("{:.6g}", value);
}

// The counters of one pass as "vpls=1000;paths=2048".
std::string countersOf(const graph::FrameResult& frame, const std::string& pass) {
  std::string text;
  for (const auto& [name, value] : frame.counters) {
    const size_t dot = name.rfind('.');
    if (dot == std::string::npos || name.compare(0, dot, pass) != 0) continue;
    if (!text.empty()) text += ';';
    text += fmt::format("{}={:.17g}", name.substr(dot + 1), value);
  }
  return text;
}

// All numbers of a frame, in an order that its shape determines.
template <class Result, class Visit>
void eachNumber(Result& frame, const Visit& visit) {
  for (auto* ms : {&frame.gpuMs, &frame.animateMs, &frame.animateCpuMs, &frame.cpuMs, &frame.wallMs})
    visit(*ms);
  for (auto& pass : frame.passes) {
    visit(pass.gpuMs);
    visit(pass.cpuMs);
    for (auto& step : pass.steps) visit(step.gpuMs);
  }
  for (auto& [name, value] : frame.counters) visit(value);
}

bool sameShape(const graph::FrameResult& a, const graph::FrameResult& b) {
  const auto sameStep = [](const graph::StepTiming& s, const graph::StepTiming& t) {
    return s.name == t.name;
  };
  const auto samePass = [&](const graph::PassTiming& s, const graph::PassTiming& t) {
    return s.pass == t.pass && std::ranges::equal(s.steps, t.steps, sameStep);
  };
  const auto sameName = [](const auto& s, const auto& t) { return s.first == t.first; };
  return std::ranges::equal(a.passes, b.passes, samePass) &&
         std::ranges::equal(a.counters, b.counters, sameName);
}

}  // namespace

uint64_t peakHostBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return uint64_t(usage.ru_maxrss) * 1024;
}

Spread spreadOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  const double median = n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
  return {median, values.front(), values[(n * 95 + 99) / 100 - 1]};
}

void Timings::add(const graph::FrameResult& result) {
  graph::FrameResult kept = {.frame = result.frame,
                             .gpuMs = result.gpuMs,
                             .animateMs = result.animateMs,
                             .animateCpuMs = result.animateCpuMs,
                             .cpuMs = result.cpuMs,
                             .wallMs = result.wallMs,
                             .passes = result.passes,
                             .counters = result.counters,
                             .outputs = {}};
  if (kept.animateMs > 0 || kept.animateCpuMs > 0)
    kept.passes.insert(kept.passes.begin(),
                       graph::PassTiming{kAnimate, kept.animateMs, kept.animateCpuMs, {}});
  for (const graph::PassTiming& t : result.passes) commands_[t.pass] = t.commands;
  const auto same = [&](const graph::FrameResult& shape) { return sameShape(shape, kept); };
  const auto shape = std::find_if(shapes_.begin(), shapes_.end(), same);
  Frame& frame = frames_.emplace_back(Frame{kept.frame, size_t(shape - shapes_.begin()), {}});
  size_t count = 0;
  eachNumber(kept, [&](double) { ++count; });
  frame.values.reserve(count);
  eachNumber(kept, [&](double value) { frame.values.push_back(value); });
  if (shape == shapes_.end()) shapes_.push_back(std::move(kept));
}

void Timings::eachFrame(const std::function<void(const graph::FrameResult&)>& visit) const {
  std::vector<graph::FrameResult> shown = shapes_;
  for (const Frame& frame : frames_) {
    graph::FrameResult& result = shown[frame.shape];
    result.frame = frame.number;
    auto value = frame.values.begin();
    eachNumber(result, [&](double& number) { number = *value++; });
    visit(result);
  }
}

std::string Timings::name(uint32_t pass) const {
  return pass == kAnimate ? "animate" : plan_->graph->passes[pass].name;
}
std::string Timings::type(uint32_t pass) const {
  return pass == kAnimate ? "scene" : plan_->graph->passes[pass].declaration->type;
}

std::vector<Timings::Row> Timings::rows() const {
  std::vector<uint32_t> order;
  std::map<uint32_t, std::pair<std::vector<double>, std::vector<double>>> values;
  eachFrame([&](const graph::FrameResult& frame) {
    for (const graph::PassTiming& t : frame.passes) {
      auto [entry, isNew] = values.try_emplace(t.pass);
      if (isNew) order.push_back(t.pass);
      entry->second.first.push_back(t.gpuMs);
      entry->second.second.push_back(t.cpuMs);
    }
  });
  std::vector<Row> rows;
  for (uint32_t index : order) {
    const bool host =
        index != kAnimate && plan_->graph->passes[index].declaration->kind == graph::PassKind::Host;
    rows.push_back(
        {index, host, spreadOf(values[index].first), spreadOf(values[index].second), steps(index)});
  }
  return rows;
}

// A step that did not run in a frame took no time there.
std::vector<std::pair<std::string, Spread>> Timings::steps(uint32_t pass) const {
  std::vector<std::pair<std::string, std::vector<double>>> values;
  size_t f = 0;
  eachFrame([&](const graph::FrameResult& frame) {
    for (const graph::PassTiming& t : frame.passes) {
      if (t.pass != pass) continue;
      for (const graph::StepTiming& step : t.steps) {
        auto known =
            std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.first == step.name; });
        if (known == values.end())
          known = values.insert(known, {step.name, std::vector<double>(frames_.size())});
        known->second[f] += step.gpuMs;
      }
    }
    ++f;
  });
  std::vector<std::pair<std::string, Spread>> list;
  for (auto& [name, times] : values) list.emplace_back(name, spreadOf(std::move(times)));
  if (list.size() == 1) list.clear();
  return list;
}

// Totals of the passes of the second eye and of every other separate view, by the time where each pass works. The
// passes of a part of a graph (right/direct) have the view that the part was given.
std::vector<Timings::ViewTotal> Timings::viewTotals() const {
  const graph::BoundGraph& graph = *plan_->graph;
  std::vector<ViewTotal> totals = {{"none", 0, {}}};
  std::vector<size_t> slot(graph.views.size(), 0);  // index of each view in `totals`
  const auto slotOf = [&](uint32_t pass) {
    if (pass == kAnimate) return size_t(0);
    const graph::BoundPass& p = graph.passes[pass];
    if (p.view == 0 && !p.declaration->usesView) return size_t(0);
    if (slot[p.view] == 0) slot[p.view] = totals.size(), totals.push_back({graph.views[p.view], 0, {}});
    return slot[p.view];
  };
  const std::vector<Row> all = rows();
  for (const Row& row : all) ++totals[slotOf(row.pass)].passes;
  if (totals.size() < 3) return {};
  std::vector<std::vector<double>> times(totals.size());
  eachFrame([&](const graph::FrameResult& frame) {
    std::vector<double> sums(totals.size(), 0.0);
    for (const graph::PassTiming& t : frame.passes) {
      const bool host = t.pass != kAnimate && graph.passes[t.pass].declaration->kind == graph::PassKind::Host;
      sums[slotOf(t.pass)] += host ? t.cpuMs : t.gpuMs;
    }
    for (size_t i = 0; i < sums.size(); ++i) times[i].push_back(sums[i]);
  });
  for (size_t i = 0; i < totals.size(); ++i) totals[i].time = spreadOf(times[i]);
  return totals;
}

std::vector<std::pair<std::string, double>> Timings::counters() const {
  std::vector<std::string> order;
  std::map<std::string, std::vector<double>> values;
  eachFrame([&](const graph::FrameResult& frame) {
    for (const auto& [name, value] : frame.counters) {
      auto [entry, isNew] = values.try_emplace(name);
      if (isNew) order.push_back(name);
      entry->second.push_back(value);
    }
  });
  std::vector<std::pair<std::string, double>> result;
  for (const std::string& name : order) result.emplace_back(name, medianOf(values[name]));
  return result;
}

template <class Get>
Spread Timings::frameSpread(Get get) const {
  std::vector<double> values;
  eachFrame([&](const graph::FrameResult& frame) { values.push_back(get(frame)); });
  return spreadOf(std::move(values));
}

std::string Timings::table() const {
  const std::vector<Row> all = rows();
  size_t nameWidth = 5, typeWidth = 4;
  double total = 0;
  for (const Row& row : all) {
    nameWidth = std::max(nameWidth, name(row.pass).size());
    for (const auto& [step, time] : row.steps) nameWidth = std::max(nameWidth, step.size() + 2);
    typeWidth = std::max(typeWidth, type(row.pass).size());
    total += row.time();
  }
  std::string text;
  const auto add = [&](const std::string& name, const std::string& type,
                       const std::array<std::string, 4>& times, const std::string& share) {
    text += fmt::format("{:<{}}  {:<{}}  {:>10} {:>10} {:>10}  {:>10}{}\n", name, nameWidth, type, typeWidth,
                        times[0], times[1], times[2], times[3], share);
  };
  const auto times = [](const Spread& gpu, const Spread& cpu) {
    return std::array{formatMs(gpu.median), formatMs(gpu.min), formatMs(gpu.p95), formatMs(cpu.median)};
  };
  add("pass", "type", {"gpu ms", "min", "p95", "cpu ms"}, "   share");
  const std::string rule = std::string(text.size() - 1, '-') + '\n';
  text += rule;
  for (const Row& row : all) {
    add(name(row.pass), type(row.pass), times(row.gpu, row.cpu),
        fmt::format("{:>7.1f}%", total > 0 ? 100 * row.time() / total : 0));
    for (const auto& [step, time] : row.steps)
      add("  " + step, "", {formatMs(time.median), formatMs(time.min), formatMs(time.p95), ""}, "");
  }
  text += rule;
  add("frame", "", times(frameSpread([](const auto& f) { return f.gpuMs; }), frameSpread([](const auto& f) {
                           return f.cpuMs;
                         })),
      "");
  const Spread wall = frameSpread([](const auto& f) { return f.wallMs; });
  text += frames_.size() == 1
              ? fmt::format("wall time of the frame: {} ms\n", formatMs(wall.median))
              : fmt::format("wall time of a frame: {} ms (min {}, p95 {}) over {} frames\n",
                            formatMs(wall.median), formatMs(wall.min), formatMs(wall.p95), frames_.size());
  return text + viewTable() + counterTable();
}

std::string Timings::viewTable() const {
  const std::vector<ViewTotal> totals = viewTotals();
  std::string text = totals.empty() ? "" : "\nby view, ms a frame (median, min, p95)\n";
  for (const ViewTotal& t : totals)
    text += fmt::format("  {:<8} {:>10} {:>10} {:>10}  {} passes\n", t.view, formatMs(t.time.median),
                        formatMs(t.time.min), formatMs(t.time.p95), t.passes);
  return text;
}

std::string Timings::counterTable() const {
  const auto counted = counters();
  size_t width = 0;
  for (const auto& [name, value] : counted) width = std::max(width, name.size());
  std::string text = counted.empty() ? "" : "\ncounters of a frame\n";
  for (const auto& [name, value] : counted)
    text += fmt::format("  {:<{}}  {:>14}\n", name, width, formatCount(value));
  return text;
}

std::string Timings::json(const RunInfo& run) const {
  Json passes = Json::array();
  for (const Row& row : rows()) {
    Json pass = {{"name", name(row.pass)},
                 {"type", type(row.pass)},
                 {"gpu_ms", toJson(row.gpu)},
                 {"cpu_ms", toJson(row.cpu)}};
    if (const auto found = commands_.find(row.pass); found != commands_.end())
      pass["commands"] = {
          {"dispatches", found->second.dispatches}, {"indirect_dispatches", found->second.indirectDispatches},
          {"draws", found->second.draws},           {"renderings", found->second.renderings},
          {"transfers", found->second.transfers},   {"barriers", found->second.barriers}};
    for (const auto& [step, time] : row.steps)
      pass["steps"].push_back({{"name", step}, {"gpu_ms", toJson(time)}});
    passes.push_back(std::move(pass));
  }
  Json views = Json::object();
  for (const ViewTotal& t : viewTotals()) {
    views[t.view] = {{"passes", t.passes}, {"ms", toJson(t.time)}};
  }
  Json counted = Json::object();
  for (const auto& [name, value] : counters()) counted[name] = value;
  Json frames = Json::array();
  eachFrame([&](const graph::FrameResult& f) {
    Json one = {{"frame", f.frame},
                {"wall_ms", rounded(f.wallMs)},
                {"gpu_ms", rounded(f.gpuMs)},
                {"cpu_ms", rounded(f.cpuMs)}};
    one["counters"] = Json::object();
    for (const auto& [name, value] : f.counters) one["counters"][name] = value;
    frames.push_back(std::move(one));
  });
  Json document = {
      {"device", run.device},
      {"graph", run.graph},
      {"graph_hash", run.graphHash},
      {"scene", run.scene},
      {"size", {run.width, run.height}},
      {"warmup", run.warmup},
      {"seed", run.seed},
      {"frame",
       {{"gpu_ms", toJson(frameSpread([](const auto& f) { return f.gpuMs; }))},
        {"cpu_ms", toJson(frameSpread([](const auto& f) { return f.cpuMs; }))},
        {"wall_ms", toJson(frameSpread([](const auto& f) { return f.wallMs; }))}}},
      {"passes", passes},
      {"counters", counted},
      {"frames", frames},
      {"peak_bytes", {{"device", run.peakDeviceBytes}, {"host", run.peakHostBytes}}},
  };
  if (!views.empty()) document["views"] = views;
  return document.dump(2) + '\n';
}

std::string Timings::csv() const {
  std::string text = "frame,pass,type,gpu_ms,cpu_ms,frame_gpu_ms,frame_cpu_ms,frame_wall_ms,counters\n";
  eachFrame([&](const graph::FrameResult& frame) {
    for (const graph::PassTiming& t : frame.passes)
      text += fmt::format("{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{}\n", frame.frame, name(t.pass),
                          type(t.pass), t.gpuMs, t.cpuMs, frame.gpuMs, frame.cpuMs, frame.wallMs,
                          countersOf(frame, name(t.pass)));
  });
  return text;
}

void Timings::write(const std::filesystem::path& file, const RunInfo& run) const {
  writeText(file, file.extension() == ".csv" ? csv() : json(run));
}

}  // namespace fovea::session
