// Loading plug-ins: what is refused, what the message says, and what stays out of the registry. The plug-ins are in
// tests/plugins.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "framework/graph/pass/plugin_file.h"
#include "framework/graph/pass/registry.h"
#include "places.h"
#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string plugin(const char* name) { return std::string(FOVEA_TEST_PLUGINS) + "/" + name + "_plugin.so"; }

std::string contents(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void replaceAll(std::string& text, std::string_view from, std::string_view to) {
  ASSERT_EQ(from.size(), to.size());
  size_t found = 0;
  for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size(), ++found)
    text.replace(at, from.size(), to);
  ASSERT_GT(found, 0u) << from;
}

// The message with which a fresh registry refuses a file. It must stay empty.
std::string refusal(const std::string& file, ExitCode code = ExitCode::BadInput) {
  Registry registry;
  try {
    registry.loadPlugin(file);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), code) << e.what();
    EXPECT_THAT(e.what(), HasSubstr(std::filesystem::path(file).filename().string()));
    EXPECT_THAT(registry.types(), testing::IsEmpty());
    return e.what();
  }
  ADD_FAILURE() << file << " is accepted";
  return {};
}

TEST(Plugin, RegistersItsPassesAndKnowsWhereTheyComeFrom) {
  Registry registry;
  registry.loadPlugin(plugin("faulty"));
  EXPECT_THAT(registry.types(), testing::ElementsAre("faulty-constructor", "faulty-execute", "faulty-prepare",
                                                     "faulty-record"));
  EXPECT_EQ(registry.pluginOf("faulty-record"), plugin("faulty"));
  registry.loadPlugin(plugin("faulty"));  // again: no effect
  registry.loadPlugin(std::string(FOVEA_TEST_PLUGINS) + "/../plugins/faulty_plugin.so");
  EXPECT_EQ(registry.types().size(), 4u);
  registry.add(PassDeclaration("own", "doc"), nullptr);
  EXPECT_EQ(registry.pluginOf("own"), "");
}

TEST(Plugin, OfAnotherVersionIsRefused) {
  TempFolder folder;
  std::string library = contents(plugin("faulty"));
  const std::string mark(passAbi().text);
  ASSERT_THAT(mark, testing::MatchesRegex("fovea [0-9.]+ [0-9a-f]+"));
  std::string other = "fovea 9.8.7" + mark.substr(11);
  replaceAll(library, mark, other);
  EXPECT_THAT(refusal(folder.write("other.so", library)),
              AllOf(HasSubstr("other.so: error: "), HasSubstr("compiled for fovea 9.8.7"),
                    HasSubstr("this is fovea " + std::string(kVersion)), HasSubstr("-> compile it again")));
}

TEST(Plugin, OfTheSameVersionWithOtherTypesIsRefused) {
  TempFolder folder;
  std::string library = contents(plugin("faulty"));
  const std::string mark(passAbi().text);
  const std::string types = mark.substr(mark.rfind(' ') + 1);
  replaceAll(library, types, "0123456789abcdef");
  EXPECT_THAT(refusal(folder.write("other.so", library)),
              AllOf(HasSubstr("other headers"), HasSubstr("0123456789abcdef"), HasSubstr(types),
                    HasSubstr("-> compile it again")));
}

TEST(Plugin, RegistrationWithTheMarkOfAnotherVersionIsNotRead) {
  EXPECT_THAT(refusal(plugin("other_version")), AllOf(HasSubstr("fovea 0.0.7"), HasSubstr(kVersion)));
}

TEST(Plugin, WithoutAMarkIsRefusedBeforeItRuns) {
  EXPECT_THAT(refusal(plugin("unmarked")), HasSubstr("FOVEA_PASS"));
  EXPECT_THAT(refusal(plugin("no_pass")), HasSubstr("FOVEA_PASS"));  // it would abort
}

TEST(Plugin, FailedDeclarationsAreReportedTogetherAndEachTime) {
  for (int i = 0; i < 2; ++i)
    EXPECT_THAT(refusal(plugin("broken_declaration"), ExitCode::Internal),
                AllOf(HasSubstr("the default 5 is outside 6 to 9"), HasSubstr("class `Thrower`"),
                      HasSubstr("declaration()"), HasSubstr("std::out_of_range"),
                      HasSubstr("the moon is too far away"), Not(HasSubstr("of fovea"))));
  EXPECT_THAT(refusal(plugin("twice")), HasSubstr("`sound` is registered twice"));
}

TEST(Plugin, TypeThatIsThereAlreadyKeepsThePlugInOut) {
  Registry registry;
  registry.add(PassDeclaration("faulty-prepare", "doc"), nullptr);
  EXPECT_THROW(registry.loadPlugin(plugin("faulty")), Error);
  EXPECT_THAT(registry.types(), testing::ElementsAre("faulty-prepare"));
}

TEST(Plugin, CutShortAnywhereIsRefused) {
  TempFolder folder;
  const std::string library = contents(plugin("faulty"));
  ASSERT_GT(library.size(), 4096u);
  for (size_t length = 0; length < library.size(); length += 1 + length / 7)
    EXPECT_THAT(refusal(folder.write("short.so", library.substr(0, length))),
                HasSubstr("cannot load plug-in"))
        << length;
  EXPECT_THAT(refusal(folder.write("short.so", library.substr(0, library.size() - 1))),
              HasSubstr("cut short"));
}

TEST(Plugin, FieldsOfTheHeadersMayHoldAnything) {
  TempFolder folder;
  const std::string library = contents(plugin("faulty"));
  // Every field of the header, of the first program headers and of the last section headers, with extreme values. Only
  // the reader is asked, because the loader of the system trusts what it is given.
  size_t refused = 0, tried = 0;
  const auto damage = [&](size_t at) {
    for (const char value : {'\x00', '\x7f', '\xff'}) {
      std::string damaged = library;
      damaged[at] = value;
      ++tried;
      try {
        readPluginFile(folder.write("damaged.so", damaged));
      } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::BadInput);
        ++refused;
      }
    }
  };
  for (size_t at = 0; at < 64 + 4 * 56; ++at) damage(at);
  for (size_t at = library.size() - 3 * 64; at < library.size(); ++at) damage(at);
  EXPECT_GT(refused, tried / 8);
}

TEST(Plugin, FilesOfAnotherKindAreRefused) {
  TempFolder folder;
  EXPECT_THAT(refusal("/nowhere/plugin.so"), HasSubstr("does not exist"));
  EXPECT_THAT(refusal(folder.write("text.so", "no library")), HasSubstr("no ELF file"));
  EXPECT_THAT(refusal(folder.write("empty.so", "")), HasSubstr("no ELF file"));
  const std::string pipe = std::filesystem::path(folder.write("a", "")).parent_path() / "pipe.so";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal(pipe), HasSubstr("no regular file"));
  EXPECT_THAT(refusal(FOVEA_TEST_PLUGINS), HasSubstr("a directory"));
  std::string foreign = contents(plugin("faulty"));
  foreign[18] = foreign[19] = 0x55;  // e_machine
  EXPECT_THAT(refusal(folder.write("foreign.so", foreign)), HasSubstr("another processor"));
  foreign = contents(plugin("faulty"));
  foreign[4] = 1;  // ELFCLASS32
  EXPECT_THAT(refusal(folder.write("foreign.so", foreign)), HasSubstr("another processor"));
  EXPECT_THAT(refusal("/proc/self/exe"), testing::Not(testing::IsEmpty()));
}

}  // namespace
}  // namespace fovea::graph::test
