#include "framework/base/legible.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/error.h"

namespace fovea {
namespace {

using testing::HasSubstr;

TEST(Legible, ControlCharacters) {
  EXPECT_EQ(legible(std::string_view("a\0b\x1b[2J\x7f", 8)), "a\\x00b\\x1b[2J\\x7f");
  EXPECT_EQ(legible("two\n  -> lines\twith `quotes` and ünïcödé"),
            "two\n  -> lines\twith `quotes` and ünïcödé");
  const Error error(ExitCode::BadInput, std::string("`tone\0map` is unknown", 21), "rename it");
  EXPECT_THAT(error.what(), HasSubstr("`tone\\x00map` is unknown\n  -> rename it"));
}

TEST(Legible, LongValues) {
  const std::string path(250, 'p');
  EXPECT_EQ(legible("`" + path + "`"), "`" + path + "`");
  EXPECT_EQ(legible("found `" + std::string(100'000, 'x') + "`, no number"),
            "found `" + std::string(80, 'x') + "... (100000 bytes)`, no number");
  EXPECT_EQ(legible("found " + std::string(300, 'y') + " there"),
            "found " + std::string(80, 'y') + "... (300 bytes) there");
  std::string words;
  for (int i = 0; i < 1000; ++i) words += "word ";
  EXPECT_EQ(legible(words), words);  // a list
  EXPECT_EQ(legible("`" + words + "`").size(), 2 + 80 + std::string("... (5000 bytes)").size());
  std::string umlauts = "x";
  while (umlauts.size() < 300) umlauts += "ü";
  EXPECT_EQ(legible(umlauts), umlauts.substr(0, 79) + "... (301 bytes)");  // no half of a character
  EXPECT_EQ(legible("an odd ` stays"), "an odd ` stays");
}

}  // namespace
}  // namespace fovea
