// The fuzzer's corpus must stay sound, also when its bytes are changed, cut or doubled.
#include <gtest/gtest.h>

#include "places.h"
#include "tests/fuzz/graph_fuzz.h"

namespace fovea::graph::test {
namespace {

std::vector<std::string> corpus() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(FOVEA_SOURCE_DIR "/tests/fuzz/corpus/graph"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const std::filesystem::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return texts;
}

TEST(GraphCorpus, EveryFileIsAGraphOrAnError) {
  size_t graphs = 0;
  const std::vector<std::string> texts = corpus();
  for (const std::string& text : texts) graphs += fuzzGraph(text);
  EXPECT_GE(texts.size(), 10u);
  EXPECT_GE(graphs, 5u);
}

TEST(GraphCorpus, MutationsAreGraphsOrErrors) {
  const std::vector<std::string> texts = corpus();
  Dice dice(99);
  size_t graphs = 0;
  const char kTokens[] = "{}[]\",:0$@.-eian\\ ";
  for (int round = 0; round < 4000; ++round) {
    std::string text = texts[dice(static_cast<uint32_t>(texts.size()))];
    const uint32_t edits = 1 + dice(2);
    for (uint32_t i = 0; i < edits && !text.empty(); ++i) {
      const uint32_t at = dice(static_cast<uint32_t>(text.size())), length = dice(20);
      switch (dice(8)) {
        case 0:
          text[at] = kTokens[dice(sizeof kTokens - 1)];
          break;
        case 1:
          text[at] = static_cast<char>(dice(256));
          break;
        case 2:
          text.erase(at, length);
          break;
        case 3:
          text.insert(dice(static_cast<uint32_t>(text.size())), text.substr(at, length));
          break;
        default:
          if (const size_t digit = text.find_first_of("0123456789", at); digit != std::string::npos)
            text[digit] = static_cast<char>('0' + dice(10));
          break;
      }
    }
    if (text.find("\"/") == std::string::npos) graphs += fuzzGraph(text);
  }
  EXPECT_GE(graphs, 50u);
}

}  // namespace
}  // namespace fovea::graph::test
