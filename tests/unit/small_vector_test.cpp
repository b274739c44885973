// Compares SmallVector with std::vector over random edits that cross the limit between inline and allocated elements.
#include "framework/base/small_vector.h"

#include <gmock/gmock.h>

#include <vector>

#include "framework/base/random.h"

namespace fovea {
namespace {

using testing::ElementsAreArray;
using Small = SmallVector<uint64_t, 3>;

TEST(SmallVector, RandomEditsAsOnAVector) {
  Small list;
  std::vector<uint64_t> expected;
  for (uint32_t step = 0; step < 4000; ++step) {
    const uint32_t draw = hashCombine(7u, step), at = draw / 8 % (uint32_t(expected.size()) + 1);
    const std::vector<uint64_t> some = {draw, draw + 1, draw + 2};
    switch (expected.size() > 12 ? 7 : draw % 6) {
      case 0:
      case 1:
        list.push_back(draw), expected.push_back(draw);
        break;
      case 2:
        *list.insert(list.begin() + at, draw) += 1, *expected.insert(expected.begin() + at, draw) += 1;
        break;
      case 3:
        list.insert(list.begin() + at, some.begin(), some.end());
        expected.insert(expected.begin() + at, some.begin(), some.end());
        break;
      case 4:
      case 5:
        if (at == expected.size()) break;
        list.erase(list.begin() + at), expected.erase(expected.begin() + at);
        break;
      default:
        list.clear(), expected.clear();
    }
    ASSERT_THAT(list, ElementsAreArray(expected)) << step;
  }
}

TEST(SmallVector, CopiesAndMoves) {
  for (const size_t count : {0, 1, 3, 4, 20}) {
    std::vector<uint64_t> expected(count);
    for (size_t i = 0; i < count; ++i) expected[i] = 10 + i;
    Small list;
    list.assign(expected.begin(), expected.end());
    Small copy = list, other;
    other.assign(expected.rbegin(), expected.rend());
    if (count > 0) copy[0] = 99;
    EXPECT_THAT(list, ElementsAreArray(expected));
    Small moved = std::move(copy);
    EXPECT_TRUE(copy.empty());  // NOLINT: may be used again
    copy.push_back(1);
    EXPECT_EQ(copy.size(), 1u);
    EXPECT_EQ(moved.size(), count);
    moved = list;
    EXPECT_THAT(moved, ElementsAreArray(expected));
    moved = std::move(other);
    std::swap(moved, list);
    EXPECT_THAT(moved, ElementsAreArray(expected));
    EXPECT_THAT(list, ElementsAreArray(expected.rbegin(), expected.rend()));
  }
}

}  // namespace
}  // namespace fovea
