// Graph files of version 1 give the same pictures as before: as they are, and rewritten by `fovea migrate`.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "framework/graph/migrate/migrate.h"
#include "framework/scene/load.h"
#include "places.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// The file in a folder of its own, rewritten.
fs::path migrated(const fs::path& file) {
  const fs::path copy = fs::path(testing::TempDir()) / ("migrated_" + file.filename().string());
  std::vector<graph::Change> changes;
  std::ofstream(copy) << graph::migrateText(textOf(file), file.string(), changes);
  EXPECT_FALSE(changes.empty());
  return copy;
}

void expectTheSame(const std::string& old, const std::string& stock, const std::vector<std::string>& set) {
  Diagnostics messages;
  const scene::Scene scene = scene::load("cornellbox", messages);
  const fs::path file = fs::path(FOVEA_SOURCE_DIR "/tests/data/graphs/version1") / old;
  GraphRunOptions options;
  options.size = {48, 48};
  options.frames = 2;
  options.outputs = {"radiance"};
  const auto asItIs = runGraph(file.string(), scene, options).outputs.at("radiance").bytes;
  const auto rewritten = runGraph(migrated(file).string(), scene, options).outputs.at("radiance").bytes;
  options.set = set;
  EXPECT_TRUE(asItIs == runGraph(stock, scene, options).outputs.at("radiance").bytes);
  EXPECT_TRUE(asItIs == rewritten);
}

TEST(Version1, AGraphOfItsOwn) {
  expectTheSame("lit.json", "direct", {"view.materials=full", "shadow_map_size=256"});
}

TEST(Version1, AVariant) {
  expectTheSame("small_fovea.json", "ours",
                {"view.fovea_radius=0.1", "vpl_count=64", "map_size=32", "voxels=32", "shadow_map_size=256"});
}

}  // namespace
}  // namespace fovea::test
