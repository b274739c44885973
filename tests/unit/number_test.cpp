// Tests which texts are decimal numbers.
#include "framework/base/number.h"

#include <gtest/gtest.h>

namespace fovea {
namespace {

TEST(Number, Decimals) {
  EXPECT_EQ(parseDecimal("0"), 0);
  EXPECT_EQ(parseDecimal("-0.25"), -0.25);
  EXPECT_EQ(parseDecimal(".5"), 0.5);
  EXPECT_EQ(parseDecimal("-.5"), -0.5);
  EXPECT_EQ(parseDecimal("5."), 5);
  EXPECT_EQ(parseDecimal("5e2"), 500);
  EXPECT_EQ(parseDecimal("5E-1"), 0.5);
  EXPECT_EQ(parseDecimal("0e5"), 0);
}

TEST(Number, NothingElse) {
  for (const char* text :
       {"",      "-",  ".",   "-.",    "+5",  "--5",   "05",    "-05",    "00",   "00.5", "0x10",
        "0x1p3", "1e", "e5",  "1e999", "nan", "NaN",   "-nan",  "nan(1)", "inf",  "-inf", "infinity",
        " 5",    "5 ", "5\n", "5m",    "5,0", "1'000", "1_000", "5f",     "1.2.3"})
    EXPECT_FALSE(parseDecimal(text)) << text;
}

}  // namespace
}  // namespace fovea
