// Any text read as a graph file must give either an Error with a message or a plan that the checker finds sound.
#pragma once

#include <cstdio>
#include <cstdlib>

#include "framework/graph/edit/format.h"
#include "framework/graph/report/report.h"
#include "framework/graph/verify/checker.h"
#include "framework/graph/verify/null_device.h"
#include "tests/unit/random_graph.h"

namespace fovea::graph::test {

inline const Registry& fuzzRegistry() {
  static const Registry* registry = [] {
    auto* r = new Registry;
    addBasicTypes(*r);
    addRandomTypes(*r, 42);
    return r;
  }();
  return *registry;
}

// Returns whether the text is a graph; aborts on a defect.
inline bool fuzzGraph(std::string_view text) {
  Diagnostics messages;
  std::shared_ptr<const BoundGraph> graph;
  try {
    // Nothing lies beside this file, so `extends` and sub-graphs are looked up but not found.
    LoadOptions options;
    if (text.find("\"n\":") != std::string_view::npos) options.overrides = {{"n", "5"}};
    const Description description = loadText(text, "/nonexistent/fuzz.json", options, messages);
    graph = std::make_shared<const BoundGraph>(bind(description, basicEnvironment(fuzzRegistry()), messages));
  } catch (const Error& e) {
    if (e.code() == ExitCode::BadInput && !e.diagnostics().empty()) return false;
    std::fprintf(stderr, "%s\n", e.what());
    std::abort();
  }
  // The stable layout is its own result, and the graph means the same in it.
  const std::string formatted = formatText(text, "/nonexistent/fuzz.json");
  LoadOptions same;
  if (text.find("\"n\":") != std::string_view::npos) same.overrides = {{"n", "5"}};
  const Description again = loadText(formatted, "/nonexistent/fuzz.json", same, messages);
  if (formatText(formatted, "/nonexistent/fuzz.json") != formatted ||
      bind(again, basicEnvironment(fuzzRegistry()), messages).hash != graph->hash)
    std::abort();
  for (const bool random : {false, true}) {
    CompileOptions options;
    if (random) options.randomOrder = 1;
    const Plan plan = compile(graph, options);
    for (const std::string& problem : checkPlan(plan)) {
      std::fprintf(stderr, "%s\n", problem.c_str());
      std::abort();
    }
    planText(plan);
    planDot(plan);
    planJson(plan);
    NullDevice(plan).frame();
  }
  return true;
}

}  // namespace fovea::graph::test
