// Walks the tables of tests/data/hostile: each file in them is refused at once, with the message given next to it, or
// read with that warning.
#include <gtest/gtest.h>

#include <ctime>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "benchmarks/runner/baseline/baseline.h"
#include "benchmarks/runner/suite.h"
#include "fovea/image.h"
#include "framework/graph/compile/compile.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/motion/motion.h"
#include "framework/session/compared.h"
#include "scene_support.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

const fs::path kTables = FOVEA_TEST_DATA "/hostile";
// Of CPU time, so that it does not count what else the machine does.
constexpr double kMostSeconds = FOVEA_SANITIZED ? 20 : 1;

// Physical memory that the process uses, and the most that it has used since the last call of forgetPeak(), in MiB.
uint64_t memoryOf(const std::string& line) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (uint64_t kilobytes; word == line && status >> kilobytes) return kilobytes >> 10;
  return 0;
}
uint64_t memoryNow() { return memoryOf("VmRSS:"); }
uint64_t peakMemory() { return memoryOf("VmHWM:"); }
bool forgetPeak() { return bool(std::ofstream("/proc/self/clear_refs") << 5 << std::flush); }
constexpr uint64_t kMostMemory = FOVEA_SANITIZED ? 1000 : 500;

// ---- How each kind of file is read

// Each returns its warnings.
std::string readGraph(const fs::path& file) {
  graph::Registry registry;
  registry.addFolder(file.parent_path() / "passes");
  graph::Environment environment;
  environment.registry = &registry;
  Diagnostics messages;
  const graph::Description description = graph::load(file.string(), {}, messages);
  graph::compile(std::make_shared<const graph::BoundGraph>(graph::bind(description, environment, messages)));
  return messages.format();
}

std::string readScene(const fs::path& file) {
  Diagnostics warnings;
  flatten(scene::load(file.string(), warnings));
  return warnings.format();
}

template <class Read>
auto silent(Read read) {
  return [read](const fs::path& file) {
    read(file);
    return std::string();
  };
}

const std::map<std::string, std::function<std::string(const fs::path&)>>& readers() {
  static const std::map<std::string, std::function<std::string(const fs::path&)>> list = {
      {"baselines", silent([](const fs::path& file) { bench::readBaseline(file.string()); })},
      {"environments", silent([](const fs::path& file) { scene::loadEnvironment(file, 1, 0); })},
      {"gazes", silent([](const fs::path& file) { scene::readGazeCsv(file); })},
      {"graphs", readGraph},
      {"models", readScene},
      {"passes", silent([](const fs::path& file) { graph::Registry().addFolder(file.parent_path()); })},
      {"pictures",
       silent([](const fs::path& file) { session::loadCompared(file.string(), file.string(), {}, {}); })},
      {"scenes", readScene},
      {"suites", silent([](const fs::path& file) { bench::loadSuite(file.string(), {}); })},
  };
  return list;
}

// ---- The good files that the tables change

std::string contentOf(const fs::path& file) {
  if (!fs::is_regular_file(file)) return {};
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string fromHex(const std::string& text) {
  std::string digits, bytes;
  for (const char c : text)
    if (std::isxdigit(static_cast<unsigned char>(c))) digits += c;
  for (size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return bytes;
}

image::Image ramp(uint32_t width, uint32_t height) {
  image::Image picture{width, height, 3, {}};
  for (uint32_t i = 0; i < width * height * 3; ++i) picture.data.push_back(float(i) / 64);
  return picture;
}

std::map<std::string, std::string> makeGoodFiles() {
  const TemporaryFolder folder;
  image::write(folder.path() / "picture.png", {{"", ramp(4, 2)}});
  image::write(folder.path() / "picture.pfm", {{"", ramp(4, 2)}});
  image::write(folder.path() / "picture.exr", {{"radiance", ramp(4, 2)}, {"indirect", ramp(4, 2)}},
               {{"exposure", "1.5"}, {"gaze", "0.5,0.5"}});
  std::map<std::string, std::string> files = {{"triangle.glb", test::TriangleDocument().glb()}};
  for (const fs::path& from :
       {kTables / "good", fs::path(FOVEA_SOURCE_DIR) / "tests/fuzz/corpus/gltf", folder.path()})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(from)) {
      if (!entry.is_regular_file()) continue;
      fs::path name = entry.path().lexically_relative(from);
      std::string content = contentOf(entry.path());
      if (name.extension() == ".hex") name.replace_extension(), content = fromHex(content);
      files[name.string()] = content;
    }
  return files;
}

const std::map<std::string, std::string>& goodFiles() {
  static const std::map<std::string, std::string> files = makeGoodFiles();
  return files;
}

void writeGoodFiles(const TemporaryFolder& folder) {
  for (const auto& [name, content] : goodFiles()) folder.write(name, content);
}

// ---- The tables

struct Case {
  std::string table, kind, name, file;  // kind: how the file is read; the table's name up to a dash
  int line = 0;
  ExitCode code = ExitCode::BadInput;
  std::vector<std::string> edits;  // lines, in the order of the table
  std::vector<std::string> says;   // parts of the message
  bool refused = true;             // or read, with the message as a warning
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.table << ".txt:" << c.line; }

std::vector<Case> readTables() {
  std::vector<fs::path> tables;
  for (const fs::directory_entry& entry : fs::directory_iterator(kTables))
    if (entry.path().extension() == ".txt") tables.push_back(entry.path());
  std::sort(tables.begin(), tables.end());
  std::vector<Case> cases;
  for (const fs::path& file : tables) {
    const std::string table = file.stem().string();
    std::ifstream stream(file);
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
      ++number;
      if (line.empty() || line[0] == '#') continue;
      if (line[0] == '@') {
        Case& c = cases.emplace_back();
        c.table = table, c.kind = table.substr(0, table.find('-')), c.line = number;
        int code = int(ExitCode::BadInput);
        std::istringstream(line.substr(1)) >> c.name >> c.file >> code;
        c.code = ExitCode(code);
      } else if (line[0] == '=' || line[0] == '~') {
        cases.back().says.push_back(line.substr(2));
        cases.back().refused = line[0] == '=';
      } else {
        cases.back().edits.push_back(line);
      }
    }
  }
  return cases;
}

// Applies the edits of a case to the files of a folder, in memory until flush().
class Editor {
 public:
  explicit Editor(const TemporaryFolder& folder, const std::string& file) : folder_(folder) { open(file); }

  void apply(const std::string& edit) {
    edited_ = true;
    const std::string rest = edit.size() > 2 ? edit.substr(2) : "";
    if (edit[0] == '-' || edit[0] == '+') {
      if (edit[0] == '-' && replacing_) replace();
      std::optional<std::string>& part = edit[0] == '-' ? old_ : new_;
      part = part ? *part + "\n" + rest : rest;
      replacing_ = edit[0] == '+';
      return;
    }
    replace();
    std::istringstream words(edit);
    std::string verb, place;
    words >> verb >> place;
    if (verb == "file") {
      flush();
      open(place);
    } else if (verb == "cut") {
      content_.resize(content_.size() - std::stoul(place));
    } else if (verb == "bytes") {
      std::string bytes;
      std::getline(words, bytes);
      bytes = fromHex(bytes);
      content_.replace(offsetOf(place), bytes.size(), bytes);
    } else if (verb == "times") {
      const std::string text = edit.substr(verb.size() + place.size() + 2);
      const size_t sign = std::min(text.find('%'), text.size());
      for (size_t i = 0; i < std::stoul(place); ++i) {
        content_ += text.substr(0, sign);
        if (sign < text.size()) content_ += std::to_string(i) + text.substr(sign + 1);
      }
    } else {
      ADD_FAILURE() << "no edit: " << edit;
    }
  }
  void flush() {
    replace();
    if (edited_) folder_.write(file_, content_);
  }

 private:
  void open(const std::string& file) {
    file_ = file;
    edited_ = false;
    content_ = contentOf(folder_.path() / file);
  }
  // "12", or "IHDR+4": so many bytes behind the beginning of a text.
  size_t offsetOf(const std::string& place) const {
    const size_t plus = place.find('+');
    if (plus == std::string::npos) return std::stoul(place);
    const size_t at = content_.find(place.substr(0, plus));
    EXPECT_NE(at, std::string::npos) << "no " << place;
    return at + std::stoul(place.substr(plus + 1));
  }
  void replace() {
    if (!old_ && new_) {
      content_ += *new_ + "\n";
    } else if (old_) {
      const size_t at = content_.find(*old_);
      ASSERT_NE(at, std::string::npos) << file_ << " has no " << *old_;
      EXPECT_EQ(content_.find(*old_, at + 1), std::string::npos) << file_ << " has it twice: " << *old_;
      content_.replace(at, old_->size(), new_.value_or(""));
    }
    old_.reset(), new_.reset();
    replacing_ = false;
  }

  const TemporaryFolder& folder_;
  std::string file_, content_;
  std::optional<std::string> old_, new_;  // of an edit that is being read
  bool replacing_ = false, edited_ = false;
};

class Hostile : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override { writeGoodFiles(folder_); }
  TemporaryFolder folder_;
};

TEST_P(Hostile, HasItsMessageAtOnce) {
  const Case& c = GetParam();
  Editor editor(folder_, c.file);
  for (const std::string& edit : c.edits) editor.apply(edit);
  editor.flush();
  std::string message;
  ASSERT_TRUE(forgetPeak());
  const uint64_t memory = memoryNow();
  ASSERT_GT(memory, 0u);
  const std::clock_t start = std::clock();
  bool refused = false;
  try {
    message = readers().at(c.kind)(folder_.path() / c.file);
  } catch (const Error& e) {
    refused = true;
    message = e.what();
    EXPECT_EQ(int(e.code()), int(c.code)) << message;
  }
  EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, kMostSeconds);
  EXPECT_GE(peakMemory(), memory / 2);
  EXPECT_LT(peakMemory(), memory + kMostMemory);
  const std::string folder = folder_.path().string() + "/";
  for (size_t at; (at = message.find(folder)) != std::string::npos;) message.erase(at, folder.size());
  EXPECT_EQ(refused, c.refused) << message;
  ASSERT_FALSE(message.empty()) << "accepted";
  EXPECT_LT(message.size(), 6000u);
  EXPECT_FALSE(c.says.empty()) << "the table says nothing of: " << message;
  for (const std::string& part : c.says)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nis not in\n" << message;
}

INSTANTIATE_TEST_SUITE_P(All, Hostile, testing::ValuesIn(readTables()),
                         [](const auto& info) { return info.param.kind + "_" + info.param.name; });

// What the cases change is good before, or they might be refused for another reason.
TEST(HostileTables, ChangeGoodFiles) {
  TemporaryFolder folder;
  writeGoodFiles(folder);
  std::set<std::pair<std::string, std::string>> files;
  for (const Case& c : readTables())
    if (!c.edits.empty() && goodFiles().contains(c.file)) files.emplace(c.kind, c.file);
  EXPECT_GE(files.size(), 15u);
  for (const auto& [kind, file] : files)
    EXPECT_NO_THROW(readers().at(kind)(folder.path() / file)) << kind << ": " << file;
}

TEST(HostileTables, HoldTwoHundredFiles) { EXPECT_GE(readTables().size(), 200u); }

}  // namespace
}  // namespace fovea
