// Tests the stable layout of graph files: it is its own result, and the graph means the same.
#include <gtest/gtest.h>

#include "framework/graph/edit/format.h"
#include "tests/unit/random_graph.h"

namespace fovea::graph::test {
namespace {

TEST(GraphLayout, KeysHaveAFixedOrder) {
  EXPECT_EQ(
      formatText(
          R"({"outputs":{"o":"a"},"passes":{"b":null,"a":{"params":{"z":1e-3,"y":2.50},"x":[],"inputs":{},
                         "type":"t","comment":"c"}},"later":1, "version":2})",
          "g.json"),
      R"({
  "version": 2,
  "passes": {
    "b": null,
    "a": { "comment": "c", "type": "t", "inputs": {}, "params": { "z": 0.001, "y": 2.5 }, "x": [] }
  },
  "outputs": { "o": "a" },
  "later": 1
}
)");
  EXPECT_THROW(formatText("{", "g.json"), Error);
  EXPECT_EQ(formatText("[1,2]", "g.json"), "[\n  1,\n  2\n]\n");
}

// Hash of the bound graph, or what is wrong with it.
std::string meaningOf(const std::string& text, const Registry& registry) {
  Diagnostics messages;
  try {
    return std::to_string(bindText(text, registry, messages)->hash);
  } catch (const Error& error) {
    return error.diagnostics()[0].message;
  }
}

TEST(GraphLayout, OfTenThousandRandomGraphs) {
  Registry registry;
  const std::vector<RandomType> types = addRandomTypes(registry, 42);
  for (uint32_t seed = 0; seed < 10000; ++seed) {
    Dice dice(seed);
    const std::string text = randomGraph(types, dice);
    const std::string formatted = formatText(text, "g.json");
    ASSERT_EQ(formatText(formatted, "g.json"), formatted) << seed;
    ASSERT_EQ(meaningOf(text, registry), meaningOf(formatted, registry)) << seed;
  }
}

}  // namespace
}  // namespace fovea::graph::test
