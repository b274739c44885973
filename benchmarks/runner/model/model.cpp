#include "benchmarks/runner/model/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "benchmarks/runner/model/measure.h"
#include "framework/base/text_file.h"
#include "framework/graph/report/report.h"

namespace fovea::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCaveats = R"(
A bound is the longest of bytes / bandwidth, operations / rate and rays / rate. The bytes are those of the pictures
that a pass reads or writes, once and in full; one that works on few pixels moves less. Of all else, which is shadow
maps, voxels and buffers, a pass may reach only a part. Operations are those that shaders ran in these frames on the
device; steps on the host count none, and their times are those of the host. A bound leaves out caches, latency,
occupancy, rasterisation, filtering, whole numbers, and the commands themselves.
)";

constexpr const char* kSecondQueue = R"(
A second queue: the longest chain of passes that wait for each other has {:.3f} of the {:.3f} ms of bounds and {:.3f} of
the {:.3f} ms measured. By dependencies alone a frame could be at most {:.2f} and {:.2f} times as fast.
)";

// The passes of a frame with their bounds.
class Model {
 public:
  Model(const ModelOptions& options, const Kind& kind, FrameFigures figures);
  void print() const;
  Json json() const;

 private:
  struct Queues {  // ms
    double all = 0, chain = 0;
    double gain() const { return chain > 0 ? all / chain : 1; }
  };
  Queues queues(const std::vector<double>& msOfPasses) const;
  Json passJson(size_t index) const;
  void printHeader() const;
  void printRow(const std::string& name, const PassFigures& pass, const std::string& limit,
                double bound) const;

  const ModelOptions& options_;
  Kind kind_;
  Rates rates_;
  FrameFigures figures_;
  std::vector<Bound> bounds_;  // as FrameFigures::passes
  PassFigures sum_;
  double inFullMs_ = 0;  // sum of the bounds if all resources count
  Queues bound_, measured_;
  size_t nameWidth_ = 5;
};

Model::Model(const ModelOptions& options, const Kind& kind, FrameFigures figures)
    : options_(options), kind_(kind), rates_(kind.rates), figures_(std::move(figures)) {
  const auto given = [](const std::optional<double>& value, double unit, double& rate, const char*& source) {
    if (value) rate = *value * unit, source = "given as an option";
  };
  given(options.bandwidth, 1e9, rates_.bytes, kind_.sources.bytes);
  given(options.flops, 1e12, rates_.operations, kind_.sources.operations);
  given(options.rayRate, 1e9, rates_.rays, kind_.sources.rays);
  std::vector<double> boundMs(figures_.plan->graph->passes.size()), measuredMs(boundMs.size());
  for (const PassFigures& pass : figures_.passes) {
    bounds_.push_back(boundOf(pass.leastWork(), rates_));
    inFullMs_ += boundOf(pass.mostWork(), rates_).ms;
    boundMs[pass.pass] = bounds_.back().ms, measuredMs[pass.pass] = pass.ms;
    sum_.traffic.pictures += pass.traffic.pictures, sum_.traffic.others += pass.traffic.others;
    sum_.operations += pass.operations, sum_.rays += pass.rays, sum_.ms += pass.ms;
    sum_.commands.dispatches += pass.commands.dispatches;
    sum_.commands.indirectDispatches += pass.commands.indirectDispatches;
    sum_.commands.draws += pass.commands.draws, sum_.commands.barriers += pass.commands.barriers;
    nameWidth_ = std::max(nameWidth_, figures_.plan->graph->passes[pass.pass].name.size());
  }
  bound_ = queues(boundMs), measured_ = queues(measuredMs);
}

Model::Queues Model::queues(const std::vector<double>& msOfPasses) const {
  const graph::Plan& plan = *figures_.plan;
  const graph::Precedence order =
      graph::precedence(*plan.graph, graph::makersOfVersions(*plan.graph), plan.passLive);
  Queues queues{0, longestChain(order, msOfPasses)};
  for (const double ms : msOfPasses) queues.all += ms;
  return queues;
}

// "1.23 G"
std::string scaled(double value) {
  const char* units[] = {"", " k", " M", " G", " T"};
  size_t unit = 0;
  for (; value >= 999.5 && unit + 1 < std::size(units); ++unit) value /= 1000;
  return value == 0 ? "-" : fmt::format("{:.3g}{}", value, units[unit]);
}

std::string share(double bound, double measured) {
  return measured > 0 ? fmt::format("{:.1f}%", 100 * bound / measured) : "-";
}

void Model::printRow(const std::string& name, const PassFigures& pass, const std::string& limit,
                     double bound) const {
  const graph::CommandCounts& c = pass.commands;
  fmt::print("{:<{}} {:>10} {:>10} {:>8} {:>8} {:>5} {:>5} {:>5} {:>5} {:>9.3f} {:<10} {:>10.3f} {:>8}\n",
             name, nameWidth_, graph::printBytes(pass.traffic.pictures.total()),
             graph::printBytes(pass.traffic.others.total()), scaled(pass.operations), scaled(pass.rays),
             c.dispatches, c.indirectDispatches, c.draws, c.barriers, bound, limit, pass.ms,
             share(bound, pass.ms));
}

void Model::printHeader() const {
  fmt::print("{} on {}, {}, seed {}\n", figures_.plan->graph->name, figures_.scene, options_.size,
             options_.seed);
  fmt::print("bounds for {}: {}\n", kind_.name, kind_.device);
  const auto rate = [](const char* what, double value, const char* unit, const char* source) {
    fmt::print("  {:<10} {:.4g} {}: {}\n", what, value, unit, source);
  };
  rate("bytes", 1e-9 * rates_.bytes, "GB/s", kind_.sources.bytes);
  rate("operations", 1e-12 * rates_.operations, "TFLOP/s", kind_.sources.operations);
  rate("rays", 1e-9 * rates_.rays, "Grays/s", kind_.sources.rays);
  fmt::print("measured on {}, median of {} frames\n\n", figures_.device, options_.frames);
  fmt::print("{:<{}} {:>10} {:>10} {:>8} {:>8} {:>5} {:>5} {:>5} {:>5} {:>9} {:<10} {:>10} {:>8}\n", "pass",
             nameWidth_, "pictures", "all else", "flop", "rays", "disp", "indir", "draws", "barr", "bound ms",
             "by", "measured", "bound");
}

void Model::print() const {
  printHeader();
  for (size_t i = 0; i < bounds_.size(); ++i)
    printRow(figures_.plan->graph->passes[figures_.passes[i].pass].name, figures_.passes[i],
             limitName(bounds_[i].limit), bounds_[i].ms);
  printRow("sum", sum_, "", bound_.all);
  fmt::print("frame measured: {:.3f} ms on the device, {:.3f} ms from frame to frame\n", figures_.gpuMs,
             figures_.wallMs);
  fmt::print("sum of the bounds if all else counted in full, too: {:.3f} ms\n", inFullMs_);
  fmt::print(kSecondQueue, bound_.chain, bound_.all, measured_.chain, measured_.all, bound_.gain(),
             measured_.gain());
  fmt::print("{}", kCaveats);
}

// As in the plan that `fovea check` prints.
Json trafficJson(const graph::PassTraffic& traffic) {
  const auto json = [](const graph::Traffic& moved) {
    return Json{{"read", moved.read}, {"written", moved.written}};
  };
  return {{"pictures", json(traffic.pictures)}, {"others", json(traffic.others)}};
}

Json Model::passJson(size_t index) const {
  const PassFigures& pass = figures_.passes[index];
  const graph::BoundPass& bound = figures_.plan->graph->passes[pass.pass];
  const graph::CommandCounts& c = pass.commands;
  return {{"name", bound.name},
          {"type", bound.declaration->type},
          {"traffic", trafficJson(pass.traffic)},
          {"operations", pass.operations},
          {"rays", pass.rays},
          {"commands",
           {{"dispatches", c.dispatches},
            {"indirect_dispatches", c.indirectDispatches},
            {"draws", c.draws},
            {"renderings", c.renderings},
            {"transfers", c.transfers},
            {"barriers", c.barriers}}},
          {"bound_ms", bounds_[index].ms},
          {"bound_by", limitName(bounds_[index].limit)},
          {"bound_in_full_ms", boundOf(pass.mostWork(), rates_).ms},
          {"measured_ms", pass.ms}};
}

Json Model::json() const {
  const auto queuesJson = [](const Queues& q) {
    return Json{{"sum_ms", q.all}, {"longest_chain_ms", q.chain}, {"most_gain", q.gain()}};
  };
  Json passes = Json::array();
  for (size_t i = 0; i < bounds_.size(); ++i) passes.push_back(passJson(i));
  return {{"graph", figures_.plan->graph->name},
          {"scene", figures_.scene},
          {"size", options_.size},
          {"set", options_.graph.set},
          {"first", options_.first},
          {"frames", options_.frames},
          {"warmup", options_.warmup},
          {"seed", options_.seed},
          {"kind", {{"name", kind_.name}, {"device", kind_.device}}},
          {"rates",
           {{"bytes_per_s", rates_.bytes},
            {"operations_per_s", rates_.operations},
            {"rays_per_s", rates_.rays},
            {"sources",
             {{"bytes", kind_.sources.bytes},
              {"operations", kind_.sources.operations},
              {"rays", kind_.sources.rays}}}}},
          {"measured_on", figures_.device},
          {"passes", passes},
          {"sum",
           {{"traffic", trafficJson(sum_.traffic)},
            {"operations", sum_.operations},
            {"rays", sum_.rays},
            {"bound_ms", bound_.all},
            {"bound_in_full_ms", inFullMs_},
            {"measured_ms", measured_.all}}},
          {"frame", {{"gpu_ms", figures_.gpuMs}, {"wall_ms", figures_.wallMs}}},
          {"second_queue", {{"bound", queuesJson(bound_)}, {"measured", queuesJson(measured_)}}}};
}

}  // namespace

ExitCode benchModel(const ModelOptions& options) {
  const Kind& kind = kindNamed(options.kind);
  if (!options.json.empty()) checkTextWritable(options.json);
  const Model model(options, kind, measureFrame(options));
  if (!options.json.empty()) writeText(options.json, model.json().dump(2) + "\n");
  if (!options.quiet) model.print();
  return ExitCode::Ok;
}

}  // namespace fovea::bench
