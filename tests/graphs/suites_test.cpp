// Tests that the stock suites of benchmarks name graphs that exist and give them parameters that they have.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "benchmarks/runner/suite.h"
#include "framework/base/paths.h"
#include "framework/graph/compile/compile.h"
#include "framework/session/graph_run.h"
#include "places.h"

namespace fovea::test {
namespace {

TEST(Suites, GraphsTakeTheirParameters) {
  const std::filesystem::path folder = std::filesystem::path(FOVEA_SOURCE_DIR) / "benchmarks/suites";
  std::set<std::vector<std::string>> seen;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    for (const bench::Job& job : bench::loadSuite(entry.path().stem().string(), {folder}).jobs) {
      graph::LoadOptions options;
      options.searchPaths = dataFolders("graphs");
      std::vector<std::string> settings = {job.graph};
      for (const auto& [name, value] : job.set) settings.push_back(name + "=" + value);
      if (!seen.insert(settings).second) continue;
      std::transform(settings.begin() + 1, settings.end(), std::back_inserter(options.overrides),
                     [](const std::string& text) { return graph::parseOverride(text); });
      try {
        Diagnostics messages;
        graph::bind(graph::load(job.graph, options, messages),
                    session::sceneEnvironment(nullptr, {}, {}, {job.size.x, job.size.y}), messages);
      } catch (const Error& e) {
        ADD_FAILURE() << entry.path().filename() << ", " << job.name() << ": " << e.what();
      }
    }
  EXPECT_GT(seen.size(), 100u);
}

}  // namespace
}  // namespace fovea::test
