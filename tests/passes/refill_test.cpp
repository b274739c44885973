// Pass refill: the first candidates that hit something become the VPLs of a frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "fovea/test.h"
#include "tests/passes/manage_cases.h"

namespace fovea::test {
namespace {

std::vector<VplState> expectedList(const std::vector<Candidate>& candidates, size_t slots) {
  std::vector<VplState> list;
  for (const Candidate& c : candidates) {
    if (c.side == scene::kNoSide || list.size() == slots) continue;
    VplState& vpl = list.emplace_back();
    vpl.position = c.position;
    vpl.normal = vpl.localNormal = c.normal;
    vpl.life = 1;
    vpl.reflectance = c.reflectance;
    vpl.side = c.side;
    vpl.localPosition = c.localPosition;
    vpl.object = c.object;
  }
  list.resize(slots);
  return list;
}

// Fewer candidates than slots, as many, more, and none that hits anything; new ones in every frame.
TEST(Refill, TakesTheFirstCandidatesThatHit) {
  Dice dice(400);
  for (const size_t slots : {1, 7, 130, 300}) {
    for (const size_t count : {1, 64, 130, 700}) {
      SCOPED_TRACE(testing::Message() << count << " candidates for " << slots << " slots");
      PassTest test("refill");
      std::vector<Candidate> candidates(count);
      test.scene(boundsOnly()).param("count", static_cast<int>(slots));
      test.buffer("candidates", candidates, "Candidate");
      for (int frame = 0; frame < 3; ++frame) {
        for (Candidate& c : candidates) c = frame < 2 ? randomCandidate(dice, 0.5f) : Candidate();
        test.set("candidates", candidates);
        test.run(1);
        const std::vector<VplState> want = expectedList(candidates, slots),
                                    got = test.values<VplState>("list");
        ASSERT_EQ(got.size(), slots);
        EXPECT_EQ(std::memcmp(got.data(), want.data(), slots * sizeof(VplState)), 0);
        const auto hits = std::count_if(candidates.begin(), candidates.end(),
                                        [](const Candidate& c) { return c.side != scene::kNoSide; });
        EXPECT_EQ(test.counter("candidates"), hits);
        EXPECT_EQ(test.counter("alive"), std::min<size_t>(static_cast<size_t>(hits), slots));
      }
    }
  }
}

}  // namespace
}  // namespace fovea::test
