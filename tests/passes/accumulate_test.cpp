#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "fovea/test.h"
#include "framework/base/random.h"

namespace fovea::test {
namespace {

constexpr uint32_t kWidth = 19, kHeight = 11;

std::vector<float> noise(uint32_t frame) {
  std::vector<float> texels(kWidth * kHeight * 4);
  for (uint32_t i = 0; i < texels.size(); ++i) texels[i] = 10 * uniformFloat(randomStream(7, frame, 0, i));
  return texels;
}

// Feeds noise(frame) to every frame; the camera jumps at frame `cut` (or never).
std::vector<float> accumulate(uint32_t frames, double alpha, uint64_t cut = ~0ull) {
  PassTest test("accumulate");
  test.param("alpha", alpha).viewSize(kWidth, kHeight);
  test.image("value", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, noise(0));
  test.beforeFrame([&](PassTest& t, scene::Frame& frame) {
    t.set("value", noise(uint32_t(frame.index)));
    if (frame.index == cut) frame.cameraCut = true;
  });
  test.run(frames);
  EXPECT_EQ(test.counter("non_finite"), 0);
  return test.floats("mean");
}

void expectMean(const std::vector<float>& mean, uint32_t first, uint32_t last, double alpha) {
  std::vector<double> want(mean.size(), 0.0);
  for (uint32_t frame = first; frame < last; ++frame) {
    const auto x = noise(frame);
    const double weight = std::max(1.0 / (frame - first + 1), alpha);
    for (size_t i = 0; i < want.size(); ++i) want[i] += (x[i] - want[i]) * weight;
  }
  ASSERT_EQ(mean.size(), size_t(kWidth) * kHeight * 4);
  for (size_t i = 0; i < want.size(); ++i)
    ASSERT_NEAR(mean[i], i % 4 == 3 ? double(last - first) : want[i], 2e-5) << "channel " << i;
}

TEST(Accumulate, MeanOfAllFrames) {
  expectMean(accumulate(1, 0), 0, 1, 0);
  expectMean(accumulate(9, 0), 0, 9, 0);
}

TEST(Accumulate, StartsAnewOnACameraCut) { expectMean(accumulate(9, 0, 5), 5, 9, 0); }

TEST(Accumulate, ExponentialMean) { expectMean(accumulate(9, 0.25), 0, 9, 0.25); }

TEST(Accumulate, NotANumberDoesNotStay) {
  PassTest test("accumulate");
  test.viewSize(1, 1);
  test.image("value", VK_FORMAT_R32G32B32A32_SFLOAT, 1, 1, 1, std::vector<float>{1, 2, 3, 0});
  test.beforeFrame([&](PassTest& t, scene::Frame& frame) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    if (frame.index == 1) t.set("value", std::vector<float>{nan, 2, 3, 0});
    if (frame.index == 2) t.set("value", std::vector<float>{3, 4, 5, 0});
  });
  test.run(2);
  EXPECT_EQ(test.counter("non_finite"), 1);
  test.run(1);
  EXPECT_EQ(test.counter("non_finite"), 0);
  EXPECT_EQ(test.floats("mean"), (std::vector<float>{2, 3, 4, 2}));
}

}  // namespace
}  // namespace fovea::test
