#include "framework/base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "fovea/error.h"
#include "framework/base/text_file.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Files : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / ("fovea-files-" + std::string(info->name()) + std::to_string(getpid()));
    fs::create_directories(folder_ / "sub");
  }
  void TearDown() override { fs::remove_all(folder_); }
  static std::string contentOf(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path folder_;
};

TEST_F(Files, NamesOfOneFile) {
  writeText(folder_ / "a", "a");
  fs::create_symlink(folder_ / "a", folder_ / "link");
  fs::create_hard_link(folder_ / "a", folder_ / "hard");
  fs::create_symlink(folder_ / "new", folder_ / "dangling");
  for (const char* name : {"./a", "sub/../a", "link", "hard"})
    EXPECT_TRUE(sameFile(folder_ / "a", folder_ / name)) << name;
  EXPECT_TRUE(sameFile(folder_ / "new", folder_ / "sub/../new"));
  EXPECT_FALSE(sameFile(folder_ / "a", folder_ / "sub/a"));
  EXPECT_FALSE(sameFile(folder_ / "a", folder_ / "new"));
}

TEST_F(Files, OutputsThatWouldReplaceOneAnother) {
  EXPECT_NO_THROW(checkOutputs({folder_ / "a", folder_ / "b", "/dev/null", "/dev/null"}));
  try {
    checkOutputs({folder_ / "a", folder_ / "sub/../a"});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::Usage);
    EXPECT_THAT(e.what(), HasSubstr((folder_ / "sub/../a").string()));
  }
  writeText(folder_ / "input", "");
  noteRead(folder_ / "input");
  EXPECT_THROW(checkOutputs({folder_ / "sub/../input"}), Error);
}

TEST_F(Files, WhatCannotBeRead) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  writeText(folder_ / "a", "a");
  EXPECT_EQ(whyUnreadable(folder_ / "a"), "");
  EXPECT_THAT(whyUnreadable(folder_ / "pipe"), HasSubstr("pipe"));
  EXPECT_THAT(whyUnreadable(folder_ / "sub"), HasSubstr("folder"));
  EXPECT_THAT(whyUnreadable(folder_ / "none"), HasSubstr("No such file"));
  EXPECT_THAT(whyUnreadable("/dev/zero"), HasSubstr("device"));
}

TEST_F(Files, FoldersThatCannotBeSearched) {
  fs::create_symlink("loop", folder_ / "loop");  // leads to itself, for which no privilege helps
  EXPECT_FALSE(isFile(folder_ / "none"));
  EXPECT_TRUE(isFolder(folder_ / "sub"));
  EXPECT_THROW(isFile(folder_ / "loop/shader.comp"), Error);
}

TEST_F(Files, OutputsAppearWholeOrNotAtAll) {
  writeText(folder_ / "a.txt", "old");
  {
    const OutputFile output(folder_ / "a.txt");
    EXPECT_EQ(output.temporary().extension(), ".txt");
    std::ofstream(output.temporary()) << "half";
  }
  EXPECT_EQ(contentOf(folder_ / "a.txt"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);  // a.txt and sub
}

TEST_F(Files, LinksAreFollowed) {
  fs::create_symlink("sub/target", folder_ / "first");
  fs::create_symlink("first", folder_ / "second");
  writeText(folder_ / "second", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "second") && fs::is_symlink(folder_ / "first"));
  EXPECT_EQ(contentOf(folder_ / "sub/target"), "new");
  fs::create_symlink("loop", folder_ / "loop");
  EXPECT_THROW(writeText(folder_ / "loop", "new"), Error);
  EXPECT_THAT(whyUnwritable(folder_ / "loop"), HasSubstr("symbolic links"));
}

TEST_F(Files, FullDevice) {
  try {
    writeText("/dev/full", "text");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::CannotWrite);
    EXPECT_THAT(e.what(), HasSubstr("No space left"));
  }
  EXPECT_NO_THROW(writeText("/dev/null", "text"));
}

}  // namespace
}  // namespace fovea
