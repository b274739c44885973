// Runs the executor on a real device with passes made for these tests: what the plan promises must come out as values.
#include "framework/graph/run/execute.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "fovea/error.h"
#include "framework/base/random.h"
#include "framework/gpu/device.h"
#include "framework/graph/pass/registry.h"
#include "framework/scene/frame.h"
#include "framework/session/test_device.h"
#include "tests/support/graph_runner.h"

namespace fovea::graph {
namespace {

using namespace test;  // NOLINT: helpers

class MixImage : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("test-mix", "Hashes its inputs together.");
    d.input("a", image2D(kFormat), Usage::Sampled, "first");
    d.input("b", image2D(kFormat), Usage::Sampled, "second").makeOptional();
    d.output("value", test::image(), Usage::StorageWrite, "hash of key, a and b");
    d.parameter("key", integer(1, 0, 1 << 30), "mixed in");
    return d;
  }
  void prepare(PrepareContext& context) override {
    addTestShaders(context);
    Defines defines;
    if (context.has("b")) defines["HAS_B"] = "1";
    kernel_ = context.compute("mix_image.comp", defines);
  }
  void record(RecordContext& context) override { context.use(kernel_).dispatchOver("value"); }

 private:
  Kernel kernel_;
};
FOVEA_PASS(MixImage);

class MixOnHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("test-mix-host", "The same as test-mix, on the CPU.", PassKind::Host);
    d.input("a", image2D(kFormat), Usage::HostRead, "first");
    d.output("value", test::image(), Usage::HostWrite, "hash of key and a");
    d.parameter("key", integer(1, 0, 1 << 30), "mixed in");
    return d;
  }
  void execute(HostContext& context) override {
    const auto a = context.inputAs<uint32_t>("a");
    const auto value = context.outputAs<uint32_t>("value");
    const uint32_t key = static_cast<uint32_t>(context.parameters().integer("key"));
    for (size_t i = 0; i < value.size(); ++i) value[i] = hashCombine(key, a[i]);
  }
};
FOVEA_PASS(MixOnHost);

class SlowOnHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("test-slow-host", "Copies, and takes 40 ms for it.", PassKind::Host);
    d.input("a", image2D(kFormat), Usage::HostRead, "what to copy");
    d.output("value", test::image(), Usage::HostWrite, "the copy");
    return d;
  }
  void execute(HostContext& context) override {
    std::ranges::copy(context.inputAs<uint32_t>("a"), context.outputAs<uint32_t>("value").begin());
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
  }
};
FOVEA_PASS(SlowOnHost);

class CountUp : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("test-count", "Adds its key to a buffer it keeps.");
    d.output("total", buffer("Word", 4, 100), Usage::StorageRead | Usage::StorageWrite, "sums")
        .keep(Lifetime::View);
    d.parameter("key", integer(1, 0, 1 << 30), "added every frame");
    d.counter("touched", "elements touched this frame");
    return d;
  }
  void prepare(PrepareContext& context) override {
    addTestShaders(context);
    kernel_ = context.compute("count_up.comp");
  }
  void record(RecordContext& context) override {
    context.use(kernel_).dispatchThreads(static_cast<uint32_t>(context.count("total")));
  }

 private:
  Kernel kernel_;
};
FOVEA_PASS(CountUp);

// Writes which of its outputs have readers.
class AskReaders : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("test-readers", "Fills two images, and says who is read.");
    d.output("value", test::image(), Usage::StorageWrite, "the value");
    d.output("pair", "pair", {member("one", test::image(), Usage::TransferWrite)}, "more");
    d.counter("read", "1: value, 2: pair.one");
    return d;
  }
  void prepare(PrepareContext& context) override {
    addTestShaders(context);
    kernel_ = context.compute("fill_image.comp");
    read_ = int(context.isRead("value")) + 2 * int(context.isRead("pair.one"));
  }
  void record(RecordContext& context) override {
    context.use(kernel_).constant("key", 1).dispatchOver("value");
    context.clear("pair.one", {});
    context.counter("read", read_);
  }

 private:
  Kernel kernel_;
  double read_ = 0;
};
FOVEA_PASS(AskReaders);

TEST(Execute, ChainOverSeveralFrames) {
  Runner runner(R"({"passes": {
    "fill": {"type": "test-fill", "params": {"key": 7}},
    "one": {"type": "test-mix", "inputs": {"a": "fill"}, "params": {"key": 3}},
    "two": {"type": "test-mix", "inputs": {"a": "one", "b": "fill"}, "params": {"key": 5}}},
    "outputs": {"x": "two"}})");
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t fill = 7 + i, one = hashCombine(3, fill);
    expectAll(runner.frame(), "x", hashCombine(hashCombine(5, one), fill));
  }
}

TEST(Execute, HistoryStartsAtZeroAndIsResetByACameraCut) {
  Runner runner(R"({"passes": {
    "fill": {"type": "test-fill", "params": {"key": 7}},
    "mix": {"type": "test-mix", "inputs": {"a": "fill", "b": "mix@previous"}, "params": {"key": 5}}},
    "outputs": {"x": "mix"}})");
  uint32_t previous = 0;
  for (uint32_t i = 0; i < 6; ++i) {
    const bool cut = i == 4;
    if (cut) previous = 0;
    const uint32_t expected = hashCombine(hashCombine(5, 7 + i), previous);
    expectAll(runner.frame(cut), "x", expected);
    previous = expected;
  }
}

TEST(Execute, PassesKnowWhichOutputsAreRead) {
  for (const auto& [rest, expected] : std::initializer_list<std::pair<const char*, double>>{
           {R"(}, "outputs": {"x": "p.value"}})", 1},
           {R"(}, "outputs": {"x": "p.pair.one"}})", 2},
           {R"(, "m": {"type": "test-mix", "inputs": {"a": "p.value"}}}, "outputs": {"x": "m"}})", 1},
           {R"(, "m": {"type": "test-mix", "inputs": {"a": "p.value", "b": "p.pair.one@previous"}}},
               "outputs": {"x": "m"}})",
            3}}) {
    Runner runner(std::string(R"({"passes": {"p": {"type": "test-readers"})") + rest);
    const FrameResult result = runner.frame();
    ASSERT_EQ(result.counters.size(), 1u);
    EXPECT_EQ(result.counters[0].second, expected) << rest;
  }
}

TEST(Execute, KeptBufferAndCounters) {
  Runner runner(
      R"({"passes": {"count": {"type": "test-count", "params": {"key": 4}}}, "outputs": {"x": "count"}})");
  for (uint32_t i = 0; i < 5; ++i) {
    const FrameResult result = runner.frame(i == 3);
    expectAll(result, "x", 4 * (i < 3 ? i + 1 : i - 2));
    ASSERT_EQ(result.counters.size(), 1u);
    EXPECT_EQ(result.counters[0].first, "count.touched");
    EXPECT_EQ(result.counters[0].second, 100);
  }
}

TEST(Execute, HostPassReadsWhatTheGpuWroteThisFrame) {
  Runner runner(R"({"passes": {
    "fill": {"type": "test-fill", "params": {"key": 11}},
    "host": {"type": "test-mix-host", "inputs": {"a": "fill"}, "params": {"key": 9}},
    "after": {"type": "test-mix", "inputs": {"a": "host", "b": "fill"}, "params": {"key": 2}}},
    "outputs": {"x": "after", "h": "host"}})");
  for (uint32_t i = 0; i < 3; ++i) {
    const FrameResult result = runner.frame();
    const uint32_t fill = 11 + i, host = hashCombine(9, fill);
    expectAll(result, "h", host);
    expectAll(result, "x", hashCombine(hashCombine(2, host), fill));
  }
}

TEST(Execute, TimingsNameEveryLivePass) {
  Runner runner(R"({"passes": {
    "fill": {"type": "test-fill"}, "unused": {"type": "test-fill"},
    "mix": {"type": "test-mix", "inputs": {"a": "fill"}}}, "outputs": {"x": "mix"}})");
  const FrameResult result = runner.frame();
  ASSERT_EQ(result.passes.size(), 2u);
  EXPECT_EQ(runner.plan->graph->passes[result.passes[0].pass].name, "fill");
  EXPECT_EQ(runner.plan->graph->passes[result.passes[1].pass].name, "mix");
  EXPECT_GT(result.gpuMs, 0);
  EXPECT_GE(result.gpuMs * 1.001 + 1e-3, result.passes[0].gpuMs + result.passes[1].gpuMs);
}

// Neither the time that a host pass waits nor the time that the device waits for it counts as time of the pass.
TEST(Execute, HostPassesCountTheirOwnTimeOnce) {
  Runner runner(R"({"passes": {
    "fill": {"type": "test-fill"}, "first": {"type": "test-slow-host", "inputs": {"a": "fill"}},
    "second": {"type": "test-slow-host", "inputs": {"a": "first"}}}, "outputs": {"x": "second"}})");
  double leastCpu[3] = {1e9, 1e9, 1e9}, leastGpu[3] = {1e9, 1e9, 1e9};  // a busy machine delays some frames
  for (int frame = 0; frame < 5; ++frame) {
    const FrameResult result = runner.frame();
    ASSERT_EQ(result.passes.size(), 3u);
    for (size_t i : {1, 2}) {
      EXPECT_GE(result.passes[i].cpuMs, 40);
      leastCpu[i] = std::min(leastCpu[i], double(result.passes[i].cpuMs));
      leastGpu[i] = std::min(leastGpu[i], double(result.passes[i].gpuMs));
    }
  }
  for (size_t i : {1, 2}) {
    EXPECT_LT(leastCpu[i], 75);
    EXPECT_LT(leastGpu[i], 30);
  }
}

// Random graphs of mixing passes: every value is a hash of everything upstream, so that a missing barrier, an overlap
// in the heap or a wrong order shows as a wrong number. The test means something only if memory is really aliased.
struct RandomGraph {
  std::string text;
  std::vector<uint32_t> values;  // per pass, updated per frame
  struct Node {
    uint32_t key, a, b;
    bool fill, history, host;
  };
  std::vector<Node> nodes;

  explicit RandomGraph(uint32_t seed) {
    auto draw = [state = seed]() mutable { return state = hashPcg(state + 1); };
    const uint32_t count = 6 + draw() % 14;
    std::string passes, outputs;
    for (uint32_t i = 0; i < count; ++i) {
      Node n{draw() % 1000, i ? draw() % i : 0, i ? draw() % i : 0, i < 2, draw() % 5 == 0, draw() % 9 == 0};
      nodes.push_back(n);
      auto name = [](uint32_t k) { return "p" + std::to_string(k); };
      passes += (i ? ", \"" : "\"") + name(i) + "\": ";
      const std::string params = "\"params\": {\"key\": " + std::to_string(n.key) + "}}";
      if (n.fill)
        passes += "{\"type\": \"test-fill\", " + params;
      else if (n.host)
        passes += "{\"type\": \"test-mix-host\", \"inputs\": {\"a\": \"" + name(n.a) + "\"}, " + params;
      else
        passes += "{\"type\": \"test-mix\", \"inputs\": {\"a\": \"" + name(n.a) + "\", \"b\": \"" +
                  (n.history ? name(i) + "@previous" : name(n.b)) + "\"}, " + params;
    }
    for (uint32_t i = count - 2; i < count; ++i)
      outputs +=
          (outputs.empty() ? "\"o" : ", \"o") + std::to_string(i) + "\": \"p" + std::to_string(i) + "\"";
    text = "{\"passes\": {" + passes + "}, \"outputs\": {" + outputs + "}}";
    values.assign(count, 0);
  }

  void step(uint32_t frame) {
    for (size_t i = 0; i < nodes.size(); ++i) {
      const Node& n = nodes[i];
      const uint32_t previous = values[i];
      if (n.fill)
        values[i] = n.key + frame;
      else if (n.host)
        values[i] = hashCombine(n.key, values[n.a]);
      else
        values[i] = hashCombine(hashCombine(n.key, values[n.a]), n.history ? previous : values[n.b]);
    }
  }
};

TEST(Execute, RandomGraphsComputeTheirValues) {
  uint64_t saved = 0;
  for (uint32_t seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomGraph graph(seed);
    CompileOptions options;
    if (seed % 2) options.randomOrder = seed;
    Runner runner(graph.text, options);
    saved += runner.plan->bytesUnaliased - runner.plan->bytesAliased;
    for (uint32_t frame = 0; frame < 4; ++frame) {
      graph.step(frame);
      const FrameResult result = runner.frame();
      for (const auto& [name, data] : result.outputs)
        expectAll(result, name, graph.values[std::stoul(name.substr(1))]);
      if (HasFatalFailure()) FAIL() << graph.text;
    }
  }
  EXPECT_GT(saved, 0u) << "no graph shared memory: the test proves nothing about aliasing";
}

TEST(Execute, UnknownOutputIsNamed) {
  Runner runner(R"({"passes": {"fill": {"type": "test-fill"}}, "outputs": {"x": "fill"}})");
  ExecutorOptions options;
  options.readback = {"y"};
  try {
    Executor executor(test::testDevice(), runner.plan, Registry::global(), *runner.gpuScene, options);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("no output `y`"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace fovea::graph
