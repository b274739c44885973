// Measures what compiling a graph costs, by phase and per pass, for chains, diamonds, fan-ins, and graphs of history
// and long lifetimes, of 19 to 5,000 passes. From resolve to plan a pass may cost 1 us, whatever the size of the
// graph. "ResolveToPlan" is the cost, after parsing, of editing the text of a graph live. "BindToPlan" is the same
// without resolving: the cost of another view size.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "framework/base/memory.h"
#include "framework/graph/compile/alias.h"
#include "framework/graph/compile/barriers.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/compile/schedule.h"

namespace fovea::graph {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

// In a graph of history, every second pass reads its own last frame, and the first image lives until the last pass. In
// one of long lifetimes every image is read twice: by the next pass, and 16 passes later.
enum Shape { kChain, kDiamond, kFanIn, kHistory, kLongLived };
constexpr Shape kShapes[] = {kChain, kDiamond, kFanIn, kHistory, kLongLived};
constexpr int kSizes[] = {19, 100, 500, 5000};

// The last pass of the fan-in reads everything, so its type depends on the number of passes.
std::unique_ptr<Registry> makeRegistry(int passes) {
  auto registry = std::make_unique<Registry>();
  PassDeclaration source("source", "Makes an image");
  source.parameter("radius", real(0.5, 0, 1), "a length").parameter("count", integer(4, 1, 100), "a number");
  source.output("image", image2D(kFormat), Usage::StorageWrite, "made");
  registry->add(source, nullptr);
  PassDeclaration filter("filter", "One in, one out");
  filter.parameter("radius", real(0.5, 0, 1), "a length").parameter("count", integer(4, 1, 100), "a number");
  filter.input("image", image2D(kFormat), Usage::Sampled, "read");
  filter.output("image_out", image2D(kFormat), Usage::StorageWrite, "written");
  registry->add(filter, nullptr);
  PassDeclaration join("join", "Two in, one out");
  join.input("a", image2D(kFormat), Usage::Sampled, "read").makeOptional();
  join.input("b", image2D(kFormat), Usage::Sampled, "read");
  join.output("image", image2D(kFormat), Usage::StorageWrite, "written");
  registry->add(join, nullptr);
  PassDeclaration all("all", "Many in, one out");
  for (int i = 0; i + 1 < passes; ++i)
    all.input(fmt::format("i{}", i), image2D(kFormat), Usage::Sampled, "read");
  all.output("image", image2D(kFormat), Usage::StorageWrite, "written");
  registry->add(all, nullptr);
  return registry;
}

std::string makeGraph(Shape shape, int passes) {
  std::string text = "{\"parameters\": {\"radius\": 0.25},\n\"passes\": {\n";
  for (int p = 0; p < passes; ++p) {
    const std::string params = "\"params\": {\"radius\": \"$radius\", \"count\": 7}";
    std::string pass;
    if (p == 0 || (shape == kFanIn && p + 1 < passes)) {
      pass = fmt::format("\"type\": \"source\", {}", params);
    } else if (shape == kChain) {
      pass = fmt::format("\"type\": \"filter\", \"inputs\": {{\"image\": \"p{}\"}}, {}", p - 1, params);
    } else if (shape == kDiamond) {
      // ... -> a -> {b, c} -> a' -> ...: every third pass joins the two before it.
      if (p % 3 == 0)
        pass =
            fmt::format("\"type\": \"join\", \"inputs\": {{\"a\": \"p{}\", \"b\": \"p{}\"}}", p - 2, p - 1);
      else
        pass = fmt::format("\"type\": \"filter\", \"inputs\": {{\"image\": \"p{}\"}}, {}", p - p % 3, params);
    } else if (shape == kHistory) {
      const std::string other = p % 2 == 0 ? fmt::format("p{}@previous", p) : "p0";
      pass = fmt::format("\"type\": \"join\", \"inputs\": {{\"a\": \"p{}\", \"b\": \"{}\"}}", p - 1, other);
    } else if (shape == kLongLived) {
      pass = fmt::format("\"type\": \"join\", \"inputs\": {{\"a\": \"p{}\", \"b\": \"p{}\"}}", p - 1,
                         std::max(0, p - 16));
    } else {
      std::string inputs;
      for (int i = 0; i + 1 < passes; ++i)
        inputs += fmt::format("{}\"i{}\": \"p{}.image\"", i ? ", " : "", i, i);
      pass = fmt::format("\"type\": \"all\", \"inputs\": {{{}}}", inputs);
    }
    text += fmt::format("  \"p{}\": {{{}}}{}\n", p, pass, p + 1 < passes ? "," : "");
  }
  // A diamond cut off before its join ends with its last pass.
  return text + fmt::format("}},\n\"outputs\": {{\"image\": \"p{}\"}}}}\n", passes - 1);
}

struct Fixture {
  std::unique_ptr<Registry> registry;
  std::string text;
  std::shared_ptr<const json::Value> document;
  Diagnostics messages;
  Description description;
  Environment environment;
  std::shared_ptr<const BoundGraph> graph;
  std::vector<MemoryNeed> sizes;

  Fixture(Shape shape, int passes) {
    registry = makeRegistry(passes);
    text = makeGraph(shape, passes);
    document = std::make_shared<const json::Value>(json::parse(text, "graph.json"));
    environment.registry = registry.get();
    environment.views = {{"main", {1024, 1024}}};
    description = resolve(document, "graph.json", {}, messages);
    graph = std::make_shared<const BoundGraph>(bind(description, environment, messages));
    for (const BoundResource& r : graph->resources) sizes.push_back(estimateMemory(r.desc));
  }
  CompileOptions options() const {
    CompileOptions options;
    options.memory = [this](uint32_t r) { return sizes[r]; };
    return options;
  }
};

// All graphs are made before the first measurement, as those of a program that has just read its files. Made later,
// they would lie scattered over the memory that earlier measurements have freed, and seem to cost up to twice as much.
const Fixture& fixture(const benchmark::State& state) {
  static std::map<std::pair<int64_t, int64_t>, Fixture> made;
  if (made.empty())
    for (const Shape shape : kShapes)
      for (const int passes : kSizes) made.try_emplace({shape, passes}, shape, passes);
  return made.at({state.range(0), state.range(1)});
}

// Time per pass in the column `per_pass`.
void report(benchmark::State& state) {
  state.counters["per_pass"] =
      benchmark::Counter(static_cast<double>(state.range(1)),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void parse(benchmark::State& state) {
  const Fixture& f = fixture(state);
  for (auto _ : state) benchmark::DoNotOptimize(json::parse(f.text, "graph.json"));
  report(state);
}

void resolveDocument(benchmark::State& state) {
  const Fixture& f = fixture(state);
  for (auto _ : state) {
    Diagnostics messages;
    benchmark::DoNotOptimize(resolve(f.document, "graph.json", {}, messages));
  }
  report(state);
}

void bindDescription(benchmark::State& state) {
  const Fixture& f = fixture(state);
  for (auto _ : state) {
    Diagnostics messages;
    benchmark::DoNotOptimize(bind(f.description, f.environment, messages));
  }
  report(state);
}

void schedulePasses(benchmark::State& state) {
  const Fixture& f = fixture(state);
  for (auto _ : state) benchmark::DoNotOptimize(schedule(*f.graph));
  report(state);
}

void aliasMemory(benchmark::State& state) {
  const Fixture& f = fixture(state);
  const Schedule order = schedule(*f.graph);
  for (auto _ : state) {
    const std::vector<Interval> intervals = lifetimes(*f.graph, order);
    std::vector<AliasRequest> requests;
    for (uint32_t r = 0; r < intervals.size(); ++r) requests.push_back({r, intervals[r], f.sizes[r]});
    benchmark::DoNotOptimize(placeResources(requests, 1, true));
  }
  report(state);
}

void barriers(benchmark::State& state) {
  const Fixture& f = fixture(state);
  const Schedule order = schedule(*f.graph);
  const std::vector<Interval> intervals = lifetimes(*f.graph, order);
  const std::vector<Placement> placements = compile(f.graph, f.options()).placements;
  for (auto _ : state) benchmark::DoNotOptimize(placeBarriers(*f.graph, order, intervals, placements));
  report(state);
}

void bindToPlan(benchmark::State& state) {
  const Fixture& f = fixture(state);
  const CompileOptions options = f.options();
  for (auto _ : state) {
    Diagnostics messages;
    auto graph = std::make_shared<const BoundGraph>(bind(f.description, f.environment, messages));
    benchmark::DoNotOptimize(compile(graph, options));
  }
  report(state);
}

void resolveToPlan(benchmark::State& state) {
  const Fixture& f = fixture(state);
  const CompileOptions options = f.options();
  for (auto _ : state) {
    Diagnostics messages;
    const Description description = resolve(f.document, "graph.json", {}, messages);
    auto graph = std::make_shared<const BoundGraph>(bind(description, f.environment, messages));
    benchmark::DoNotOptimize(compile(graph, options));
  }
  report(state);
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"shape", "passes"});
  for (const Shape shape : kShapes)
    for (const int passes : kSizes) b->Args({shape, passes});
}

// As the program fovea does.
const bool kKeepsMemory = (keepFreedMemory(), true);

BENCHMARK(parse)->Name("Parse")->Apply(sizes);
BENCHMARK(resolveDocument)->Name("Resolve")->Apply(sizes);
BENCHMARK(bindDescription)->Name("Bind")->Apply(sizes);
BENCHMARK(schedulePasses)->Name("Schedule")->Apply(sizes);
BENCHMARK(aliasMemory)->Name("LifetimesAndAlias")->Apply(sizes);
BENCHMARK(barriers)->Name("Barriers")->Apply(sizes);
BENCHMARK(resolveToPlan)->Name("ResolveToPlan")->Apply(sizes);
BENCHMARK(bindToPlan)->Name("BindToPlan")->Apply(sizes);

}  // namespace
}  // namespace fovea::graph
