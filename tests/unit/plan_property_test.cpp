// Every plan of random graphs, orders and memory must pass the independent checker.
#include <gtest/gtest.h>

#include "framework/graph/verify/checker.h"
#include "tests/unit/random_graph.h"

namespace fovea::graph::test {
namespace {

constexpr uint32_t kGraphs = 1500;

// Valid reasons to refuse a random graph; anything else is a defect of the generator or of bind.
bool expectedRefusal(const std::string& message) {
  for (const char* known : {"before", "is updated in place later", "leave no order"})
    if (message.find(known) != std::string::npos) return true;
  return false;
}

TEST(PlanProperty, RandomGraphsAreFreeOfHazards) {
  uint32_t accepted = 0, refused = 0, plans = 0, histories = 0, kept = 0, aliasing = 0, hosts = 0,
           inPlace = 0;
  for (uint32_t set = 0; set < 5; ++set) {
    Registry registry;
    const std::vector<RandomType> types = addRandomTypes(registry, 1000 + set);
    for (uint32_t g = 0; g < kGraphs / 5; ++g) {
      const uint32_t seed = set * 100000 + g;
      const std::string text = randomGraph(types, seed);
      std::shared_ptr<const BoundGraph> graph;
      Diagnostics messages;
      try {
        graph = bindText(text, registry, messages);
      } catch (const Error& error) {
        ++refused;
        for (const Diagnostic& d : error.diagnostics())
          ASSERT_TRUE(d.severity != Severity::Error || expectedRefusal(d.message)) << d.format() << "\n"
                                                                                   << text;
        continue;
      }
      ++accepted;
      for (uint32_t variant = 0; variant < 4; ++variant) {
        CompileOptions options;
        options.alias = variant != 3;
        options.granularity = variant == 2 ? 1024 : 1;
        if (variant > 0) options.memory = randomMemory(seed + variant, graph);
        if (variant > 0) options.randomOrder = seed * 4 + variant;
        const Plan plan = compile(graph, options);
        ++plans;
        const std::vector<std::string> problems = checkPlan(plan, {4, options.memory});
        ASSERT_TRUE(problems.empty()) << "seed " << seed << ", variant " << variant << ":\n"
                                      << fmt::format("{}", fmt::join(problems, "\n")) << "\n"
                                      << text;
        aliasing += plan.bytesAliased < plan.bytesUnaliased;
        ASSERT_LE(plan.bytesAliased,
                  plan.bytesUnaliased + plan.placements.size() * 4096);  // gaps of alignment
      }
      for (const BoundResource& r : graph->resources) {
        histories += r.history;
        kept += r.lifetime != Lifetime::Transient;
      }
      for (const BoundPass& pass : graph->passes) {
        hosts += pass.declaration->kind == PassKind::Host;
        for (const Access& a : pass.accesses) inPlace += a.reads && a.writes && a.version > 1;
      }
    }
  }
  // The test means something only if the graphs contain what it is about.
  EXPECT_GE(accepted, 1000u) << refused << " refused";
  EXPECT_EQ(plans, accepted * 4);
  EXPECT_GE(histories, 500u);
  EXPECT_GE(kept, 500u);
  EXPECT_GE(hosts, 500u);
  EXPECT_GE(inPlace, 500u);
  EXPECT_GE(aliasing, 1000u);
  RecordProperty("accepted", static_cast<int>(accepted));
  RecordProperty("refused", static_cast<int>(refused));
}

}  // namespace
}  // namespace fovea::graph::test
