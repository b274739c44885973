#include "framework/base/budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/error.h"
#include "framework/image/header.h"

namespace fovea {
namespace {

using testing::HasSubstr;

TEST(Budget, RefusesWithTheFigures) {
  ASSERT_GT(contentLimit(), uint64_t(64) << 20);
  EXPECT_NO_THROW(claimContent(1 << 20, "a picture"));
  try {
    claimContent(contentLimit() + 1, "a picture");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::OutOfMemory);
    EXPECT_THAT(e.what(), HasSubstr("a picture would need"));
    EXPECT_THAT(e.what(), HasSubstr("FOVEA_MEMORY_LIMIT"));
  }
}

TEST(Budget, ClaimsOfASceneAddUp) {
  const uint64_t most = contentLimit() / 3 * 2;
  claimContent(most, "one");
  EXPECT_NO_THROW(claimContent(most, "another that does not belong to it"));
  const ContentBudget scene;
  claimContent(most, "one");
  {
    const ContentBudget model;
    EXPECT_THROW(claimContent(most, "another"), Error);
  }
  EXPECT_THROW(claimContent(most, "another"), Error);
}

TEST(ImageHeader, GivesTheSize) {
  const std::vector<uint8_t> png = {0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0, 0, 0, 13,
                                    'I',  'H', 'D', 'R', 0,  0,  64, 0,  0, 0, 1, 2};
  const auto size = image::headerSize(png);
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width, 16384u);
  EXPECT_EQ(size->height, 258u);
  EXPECT_EQ(size->pixels(), 16384u * 258u);
  // A comment and padding before the frame header, which has the height first.
  const std::vector<uint8_t> jpeg = {0xff, 0xd8, 0xff, 0xfe, 0, 4, 'h', 'i', 0xff, 0xff,
                                     0xc2, 0,    17,   8,    1, 2, 3,   4,   3,    0};
  const auto other = image::headerSize(jpeg);
  ASSERT_TRUE(other);
  EXPECT_EQ(other->width, 772u);
  EXPECT_EQ(other->height, 258u);
  for (size_t n = 0; n < png.size(); ++n) EXPECT_FALSE(image::headerSize({png.data(), n})) << n;
  for (size_t n = 0; n + 2 < jpeg.size(); ++n) image::headerSize({jpeg.data(), n});  // stays inside
  EXPECT_FALSE(image::headerSize({}));
}

}  // namespace
}  // namespace fovea
