// Which methods need the CPU for a part of the frame.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "framework/base/paths.h"
#include "framework/graph/compile/compile.h"
#include "framework/session/graph_run.h"
#include "places.h"

namespace fovea::test {
namespace {

// With rays on the device, only the ground truth and the method that starts from its paths compute on the host.
TEST(HostPasses, OnlyThePathTracerIsOne) {
  const std::filesystem::path folder = std::filesystem::path(FOVEA_SOURCE_DIR) / "graphs";
  std::set<std::string> onHost;
  int graphs = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::filesystem::path& file = entry.path();
    if (file.extension() != ".json" || file.stem() == "fovea-graph.schema" ||
        file.parent_path().filename() == "parts")
      continue;
    graph::LoadOptions options;
    options.searchPaths = dataFolders("graphs");
    graph::Environment environment =
        session::sceneEnvironment(nullptr, {}, {}, {64, 64}, session::RaysOn::Device);
    Diagnostics messages;
    const auto bound = std::make_shared<const graph::BoundGraph>(
        graph::bind(graph::load(file.string(), options, messages), environment, messages));
    const graph::Plan plan = graph::compile(bound);
    for (size_t i = 0; i < bound->passes.size(); ++i)
      if (plan.passLive[i] && bound->passes[i].declaration->kind == graph::PassKind::Host)
        onHost.insert(file.stem().string());
    ++graphs;
  }
  EXPECT_GE(graphs, 25);
  EXPECT_EQ(onHost, (std::set<std::string>{"pt_denoised", "reference", "reference_stereo"}));
}

}  // namespace
}  // namespace fovea::test
