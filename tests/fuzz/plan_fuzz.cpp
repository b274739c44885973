// libFuzzer entry for the phases of the compiler: the bytes choose the passes and the wires of a graph, which is valid
// in nearly all cases, then the order and the memory. Every plan must be sound.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "framework/graph/verify/checker.h"
#include "framework/graph/verify/null_device.h"
#include "tests/unit/random_graph.h"

namespace {

using namespace fovea::graph;  // NOLINT: the parts of the compiler

struct Types {
  Registry registry;
  std::vector<test::RandomType> list = test::addRandomTypes(registry, 42);
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const Types types;
  test::Dice dice(std::string_view(reinterpret_cast<const char*>(data), size));
  CompileOptions options;
  options.alias = !dice.chance(10);
  options.granularity = dice.chance(30) ? 1024 : 1;
  const uint32_t order = dice(256), memory = dice(256);
  fovea::Diagnostics messages;
  std::shared_ptr<const BoundGraph> graph;
  try {
    graph = test::bindText(test::randomGraph(types.list, dice), types.registry, messages);
  } catch (const fovea::Error& e) {
    if (e.code() != fovea::ExitCode::BadInput) std::abort();
    return 0;
  }
  if (order > 0) options.randomOrder = order;
  if (memory > 0) options.memory = test::randomMemory(memory, graph);
  const Plan plan = compile(graph, options);
  for (const std::string& problem : checkPlan(plan, {4, options.memory})) {
    std::fprintf(stderr, "%s\n", problem.c_str());
    std::abort();
  }
  NullDevice(plan).frame();
  return 0;
}
