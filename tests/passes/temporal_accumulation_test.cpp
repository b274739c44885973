// Tests the running mean over frames: which samples count, and with which weight.
#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/error.h"
#include "framework/base/random.h"
#include "tests/passes/eye_scene.h"
#include "tests/references/blocks.h"

namespace fovea::test {
namespace {

std::vector<uint16_t> halves(const std::vector<glm::vec4>& image) {
  std::vector<uint16_t> half;
  for (const glm::vec4& v : image)
    for (int c = 0; c < 4; ++c) half.push_back(glm::packHalf1x16(v[c]));
  return half;
}

// The position of every pixel, as x | y << 16.
std::vector<uint32_t> ownPlaces() {
  std::vector<uint32_t> places;
  for (int i = 0; i < kSize.x * kSize.y; ++i) places.push_back(uint32_t(i % kSize.x | i / kSize.x << 16));
  return places;
}

// One frame of the pass; `samples` holds one per block of 2 x 2 pixels, or one per pixel. ageing: of the history, as
// light has changed; not wired if negative. tiles: those that are written; all if empty.
std::vector<float> accumulate(const Eye& eye, const std::vector<glm::vec4>& samples,
                              const std::vector<glm::vec4>& history, int firstSamples = 1,
                              const std::vector<uint32_t>& origin = ownPlaces(), float saccade = 0,
                              float ageing = -1, const std::vector<uint8_t>& tiles = {},
                              int foveaSamples = 1) {
  PassTest test("temporal-accumulation");
  test.param("frames", 8.0).param("first_samples", firstSamples);
  test.param("fovea_samples", foveaSamples).param("saccade_samples", 3);
  test.beforeFrame([saccade](PassTest&, scene::Frame& f) { f.saccade = saccade; });
  eye.seen.wire(test);
  const uint32_t block = samples.size() == history.size() ? 1 : 2;
  test.image("origin", VK_FORMAT_R32_UINT, uint32_t(kSize.x), uint32_t(kSize.y), 1, origin);
  test.image("samples", VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(kSize.x) / block, uint32_t(kSize.y) / block,
             1, halves(samples));
  test.image("history", VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(kSize.x), uint32_t(kSize.y), 1,
             halves(history));
  if (ageing >= 0)
    test.buffer("change", std::vector<glm::vec4>{{0, ageing, ageing / (1 + ageing), 0}}, "LightChange");
  if (!tiles.empty()) test.image("tiles", VK_FORMAT_R8_UNORM, kTiles.x, kTiles.y, 1, tiles);
  test.scene(eye.scene).run(firstSamples > 1 ? 1 : 2);  // the rays of a first frame are other ones
  return test.floats("mean");
}

std::vector<glm::vec4> everywhere(glm::ivec2 size, glm::vec4 value) {
  return std::vector<glm::vec4>(size_t(size.x * size.y), value);
}

const glm::vec4 kNoSample(0, 0, 0, passes::sampleCode(2, {1, 0}, false));

// When nothing moves, each of n frames has the same weight, up to eight; after that the newest one has an eighth.
TEST(TemporalAccumulation, MeanOfTheFramesSoFar) {
  const Eye eye({0, 0, 0});
  for (const auto& [count, place] :
       {std::pair(1.0f, glm::uvec2(0, 0)), {5, {1, 0}}, {8, {0, 1}}, {20, {1, 1}}}) {
    const auto got = accumulate(eye, everywhere(kSize / 2, {4, 2, 1, passes::sampleCode(2, place, true)}),
                                everywhere(kSize, {1, 1, 3, count}));
    int own = 0, other = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        const float* v = &got[4 * size_t(y * kSize.x + x)];
        const glm::ivec2 from = glm::ivec2(x, y) / 2 * 2 + glm::ivec2(place);
        const bool mine = sameSurface(eye.seen.at(x, y), eye.seen.at(from.x, from.y));
        const float n = std::min(count + 1, 8.0f);
        const glm::vec3 sample(4, 2, 1), old(1, 1, 3);
        const glm::vec3 want = mine ? old + (sample - old) / n : old;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(v[c], want[c], 2e-3f * want[c]) << x << " " << y;
        EXPECT_EQ(v[3], mine ? n : count);
        ++(mine ? own : other);
      }
    EXPECT_GT(own, 1500);
    EXPECT_GT(other, 10);
  }
}

// A surface that asks for no samples borrows none around it.
TEST(TemporalAccumulation, NothingWhereNoSamplesAreWanted) {
  const Eye eye({0, 0, 0});
  auto samples = everywhere(kSize / 2, {4, 2, 1, passes::sampleCode(2, {1, 0}, true)});
  const glm::ivec2 alone = kSize / 4, size = kSize / 2;
  for (const float sign : {1.0f, -1.0f}) {
    samples[size_t(alone.y * size.x + alone.x)] = {0, 0, 0, sign * kNoSample.a};
    const auto got = accumulate(eye, samples, everywhere(kSize, glm::vec4(0)));
    const float* v = &got[4 * size_t(2 * alone.y * kSize.x + 2 * alone.x)];
    EXPECT_EQ(v[0], sign > 0 ? 4 : 0);
    EXPECT_EQ(v[4 * 2], 4) << "its neighbour has a sample";
  }
}

// Larger blocks have correspondingly smaller weights.
TEST(TemporalAccumulation, BlocksOfEightChangeLess) {
  const Eye eye({0, 0, 0});
  const auto got = accumulate(eye, everywhere(kSize / 2, {9, 9, 9, 8}), everywhere(kSize, {1, 1, 1, -100}));
  int own = 0;
  for (size_t i = 0; i < got.size(); i += 4) {
    EXPECT_TRUE(got[i + 3] == -100 || got[i + 3] == -32);
    EXPECT_NEAR(got[i], got[i + 3] == -32 ? 1.25 : 1, 1e-3);
    own += got[i + 3] == -32;
  }
  EXPECT_GT(own, 1000);
}

// A wide block lies where the lattice is in this frame, and its sample counts for those of its pixels that show the same
// surface as the sampled one.
TEST(TemporalAccumulation, WideBlocksLieElsewhereInEachFrame) {
  const Eye eye({0, 0, 0});
  const glm::uvec2 place(3, 6);
  ASSERT_NE(passes::latticeOffset(1, 8), glm::uvec2(0));
  const auto got = accumulate(eye, everywhere(kSize / 2, {9, 9, 9, passes::sampleCode(8, place, true)}),
                              everywhere(kSize, {1, 1, 1, 4}), 1, ownPlaces(), 1);
  int own = 0, other = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const glm::ivec2 from =
          glm::clamp(passes::blockCorner({x, y}, 8, 1) + glm::ivec2(place), glm::ivec2(0), kSize - 1);
      const bool mine = sameSurface(eye.seen.at(x, y), eye.seen.at(from.x, from.y));
      EXPECT_EQ(got[4 * size_t(y * kSize.x + x) + 3], mine ? -5 : 4) << x << " " << y;
      ++(mine ? own : other);
    }
  EXPECT_GT(own, 1000);
  EXPECT_GT(other, 30);
}

// Samples in the fovea count by their rays, of which there are more in the frames after a jump of the gaze. Then the
// mean is as short as that of single rays, and the history of wide blocks counts less. Those outside have one ray as
// ever.
TEST(TemporalAccumulation, SamplesWeighAsManyRaysAsTheyHave) {
  const Eye eye({0, 0, 0});
  struct Case {
    int foveaSamples;
    float saccade, side, history, count,
        weight;  // side: width of the blocks; history, count: of rays in the means
  };
  for (const Case& c :
       {Case{1, 1, 2, 4, 7, 3 / 7.0f}, Case{1, 0.125f, 2, 4, 7, 3 / 7.0f}, Case{1, 1, 2, 7, 8, 3 / 8.0f},
        Case{1, 1, 2, -16, 7, 3 / 7.0f},  // of wide blocks: 16 rays count as 8 * 8 / 16
        Case{1, 0.125f, 2, -16, 7, 3 / 7.0f}, Case{1, 1, 2, -5, 8, 3 / 8.0f},
        Case{1, 1, 8, -16, -17, 1 / 17.0f}, Case{2, 0, 2, 5, 7, 2 / 7.0f}, Case{2, 0, 2, 15, 16, 2 / 16.0f},
        Case{2, 0, 2, -20, 16, 2 / 16.0f}, Case{2, 0, 8, -20, -21, 1 / 21.0f}, Case{2, 1, 2, 4, 7, 3 / 7.0f},
        Case{2, 1, 2, 16, 8, 3 / 8.0f}, Case{2, 1, 2, -16, 7, 3 / 7.0f},
        Case{2, 1, 8, -16, -17, 1 / 17.0f}}) {
    const auto got =
        accumulate(eye, everywhere(kSize / 2, {9, 9, 9, c.side}), everywhere(kSize, {1, 1, 1, c.history}), 1,
                   ownPlaces(), c.saccade, -1, {}, c.foveaSamples);
    int own = 0;
    for (size_t i = 0; i < got.size(); i += 4) {
      if (got[i] == 1) continue;  // another surface than its block's sample
      EXPECT_NEAR(got[i], 1 + 8 * c.weight, 5e-3f) << c.side << " " << c.history;
      EXPECT_EQ(got[i + 3], c.count) << c.side << " " << c.history;
      ++own;
    }
    EXPECT_GT(own, 1000);
  }
}

// Where there is no mean yet, the samples around the pixel make one; if they are single rays, the brightest is left
// out. The mean counts as many samples as lie on the same surface, each with the weight of a first frame.
TEST(TemporalAccumulation, SamplesAroundWhereThereIsNone) {
  const Eye eye({0, 0, 0});
  auto samples = everywhere(kSize / 2, {4, 2, 1, 2});
  for (int y = 1; y < kSize.y / 2; y += 3)
    for (int x = 1; x < kSize.x / 2; x += 3)
      samples[size_t(y * (kSize.x / 2) + x)] = {4000, 2000, 1000, 2};  // one of nine
  for (const int first : {1, 16}) {
    const auto got = accumulate(eye, samples, everywhere(kSize, glm::vec4(0)), first);
    int counted = 0;
    for (int y = 2; y < kSize.y - 2; ++y)
      for (int x = 2; x < kSize.x - 2; ++x) {
        const float* v = &got[4 * size_t(y * kSize.x + x)];
        int same = 0;
        float sum = 0, all = 0;
        for (int k = 0; k < 9; ++k) {
          const glm::ivec2 block = glm::ivec2(x + 2 * (k % 3 - 1), y + 2 * (k / 3 - 1)) / 2;
          const float value = samples[size_t(block.y * (kSize.x / 2) + block.x)].z;
          const bool own = sameSurface(eye.seen.at(x, y), eye.seen.at(2 * block.x, 2 * block.y));
          same += own, sum += own ? value : 0, all += value;
        }
        EXPECT_EQ(v[3], float(same * first)) << x << " " << y;
        const float mean = same > 0 ? sum / float(same) : all / 9;
        if (first > 1) {
          for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(v[c], float(4 >> c) * mean, 1e-3 * float(4 >> c) * mean) << x << " " << y;
          }
        } else if (same != 1) {  // a single sample cannot be judged
          EXPECT_EQ(glm::vec3(v[0], v[1], v[2]), glm::vec3(4, 2, 1)) << x << " " << y;
        }
        counted += same > 0;
      }
    EXPECT_GT(counted, 1200);
  }
}

// Narrow blocks lie where light changes quickly, such as beside a lamp: they tell wide ones nothing.
TEST(TemporalAccumulation, SamplesAroundOfTheSameWidth) {
  const Eye eye({0, 0, 0});
  auto samples = everywhere(kSize / 2, {4, 2, 1, 8});
  for (int y = 0; y < kSize.y / 2; ++y)
    for (int x = 0; x < kSize.x / 2; ++x)
      if (x / 4 == 2) samples[size_t(y * (kSize.x / 2) + x)] = {4000, 2000, 1000, 2};
  const auto got = accumulate(eye, samples, everywhere(kSize, glm::vec4(0)), 16);
  int wide = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const glm::ivec2 from = glm::ivec2(x, y) / 8 * 8;
      if (x / 8 == 2 || !sameSurface(eye.seen.at(x, y), eye.seen.at(from.x, from.y))) continue;
      EXPECT_EQ(got[4 * size_t(y * kSize.x + x)], 4) << x << " " << y;
      ++wide;
    }
  EXPECT_GT(wide, 800);
}

// When every pixel has a sample, only its own counts, also where there is no mean yet, however bright it is.
TEST(TemporalAccumulation, ASampleForEveryPixel) {
  const Eye eye({0, 0, 0});
  std::vector<glm::vec4> samples, history = everywhere(kSize, {1, 1, 3, 8});
  for (int i = 0; i < kSize.x * kSize.y; ++i) samples.emplace_back(i % 7 == 0 ? 4000 : i % 5, i % 3, 2, 1);
  for (size_t i = 0; i < history.size(); i += 3) history[i] = glm::vec4(0);
  const auto got = accumulate(eye, samples, history);
  for (int i = 0; i < kSize.x * kSize.y; ++i) {
    ASSERT_GT(eye.seen.at(i % kSize.x, i / kSize.x).distance, 0);
    const float* v = &got[4 * size_t(i)];
    const bool alone = history[size_t(i)].a == 0;
    EXPECT_EQ(v[3], alone ? 1 : 8) << i;
    for (int c = 0; c < 3; ++c) {
      const float sample = samples[size_t(i)][c], old = history[size_t(i)][c];
      const float want = alone ? sample : old + (sample - old) / 8;
      EXPECT_NEAR(v[c], want, 2e-3f * want) << i;
    }
  }
}

// The image's numbers are the nearest ones to the means: rounding takes no light away, although it happens every frame.
TEST(TemporalAccumulation, RoundingTakesNoLight) {
  const Eye eye({0, 0, 0});
  for (const float scale : {1.0f, 1e-5f}) {  // normal numbers and those below 2^-14
    std::vector<glm::vec4> samples, history;
    const auto value = [scale](uint32_t stream, int i) {
      const float v = scale * (1 + uniformFloat(hashCombine(stream, uint32_t(i))));
      return glm::unpackHalf1x16(glm::packHalf1x16(v));
    };
    for (int i = 0; i < kSize.x * kSize.y; ++i) {
      samples.emplace_back(value(1, i), value(2, i), value(3, i), 1);
      history.emplace_back(value(4, i), value(5, i), value(6, i), 8);
    }
    const auto got = accumulate(eye, samples, history);
    const double step = scale == 1 ? 0x1p-10 : 0x1p-24;
    double sum = 0;
    for (size_t i = 0; i < samples.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const float want = history[i][c] + (samples[i][c] - history[i][c]) / 8;
        EXPECT_NEAR(got[4 * i + size_t(c)], want, 0.501 * step) << i;
        sum += got[4 * i + size_t(c)] - want;
      }
    EXPECT_NEAR(sum / double(3 * samples.size()), 0, 0.02 * step);
  }
}

// A sample for a single pixel may ask for a longer mean; one that no longer does so shortens it again.
TEST(TemporalAccumulation, SamplesThatAskForALongerMean) {
  const Eye eye({0, 0, 0});
  const struct {
    float longer, before, after;
  } cases[] = {{3, 5, 6}, {3, 20, 21}, {3, 24, 24}, {3, 30, 24}, {1, 20, 8}, {0, 20, 8}};
  for (const auto& c : cases) {
    const auto got =
        accumulate(eye, everywhere(kSize, {4, 2, 1, c.longer}), everywhere(kSize, {1, 1, 3, c.before}));
    EXPECT_EQ(got[3], c.after);
    EXPECT_NEAR(got[0], 1 + 3 / c.after, 4e-3) << c.longer << ", " << c.before;
  }
}

// After a jump of the gaze, a mean that was not longer, and hence of other samples, counts as few frames.
TEST(TemporalAccumulation, LongerMeansBeginAnewAfterASaccade) {
  const Eye eye({0, 0, 0});
  const struct {
    float longer, before, saccade, after;
  } cases[] = {{3, 8, 1, 2 + 3},     // samples have the weight 3
               {3, 8, 0.5f, 6 + 3},  // four frames later
               {3, 1, 1, 1 + 3},
               {3, 12, 1, 12 + 3},  // was longer already
               {1, 8, 1, 8}};
  for (const auto& c : cases) {
    const auto got = accumulate(eye, everywhere(kSize, {4, 2, 1, c.longer}),
                                everywhere(kSize, {1, 1, 3, c.before}), 1, ownPlaces(), c.saccade);
    EXPECT_EQ(got[3], c.after) << c.longer << ", " << c.before;
    EXPECT_NEAR(got[0], 1 + 3 * std::min(3 / c.after, 1.0f), 4e-3) << c.longer << ", " << c.before;
  }
}

// The history comes from the surface's previous position, with samples for all pixels and for blocks. Where there is
// no such position there is no history.
TEST(TemporalAccumulation, TakesOverWhatItsOriginHad) {
  const Eye eye({0, 0, 0});
  std::vector<glm::vec4> history;
  std::vector<uint32_t> origin;
  for (int i = 0; i < kSize.x * kSize.y; ++i) {
    const int x = i % kSize.x, y = i / kSize.x;
    history.emplace_back(x + 1, y + 1, 1, 5);
    origin.push_back(i % 3 == 0 ? 0xffffffffu
                                : uint32_t((x + 7) % kSize.x) | uint32_t((y + 30) % kSize.y) << 16);
  }
  const auto blocks = accumulate(eye, everywhere(kSize / 2, kNoSample), history, 1, origin);
  const auto pixels = accumulate(eye, everywhere(kSize, {6, 60, 1, 1}), history, 1, origin);
  for (int i = 0; i < kSize.x * kSize.y; ++i) {
    const bool none = i % 3 == 0;
    const glm::vec2 old((i % kSize.x + 7) % kSize.x + 1, (i / kSize.x + 30) % kSize.y + 1), sample(6, 60);
    EXPECT_EQ(blocks[4 * size_t(i) + 3], none ? 0 : 5) << i;
    EXPECT_EQ(pixels[4 * size_t(i) + 3], none ? 1 : 6) << i;
    const glm::vec2 kept = none ? glm::vec2(0) : old, mean = none ? sample : old + (sample - old) / 6.0f;
    for (int c = 0; c < 2; ++c) {
      EXPECT_EQ(blocks[4 * size_t(i) + size_t(c)], kept[c]) << i;
      EXPECT_NEAR(pixels[4 * size_t(i) + size_t(c)], mean[c], 2e-3f * mean[c]) << i;
    }
  }
}

// When light changes, n rays are worth n / (1 + n s), samples for narrow blocks are of up to three rays, and the mean is
// less long.
TEST(TemporalAccumulation, HistoryAgesWhenLightChanges) {
  const Eye eye({0, 0, 0});
  struct Case {
    float side, history, ageing, rays;  // width of the blocks, 0: a sample for every pixel
    int foveaSamples = 1;
  };
  for (const Case& c :
       {Case{2, 4, 0, 1}, Case{2, 4, 0.25f, 1}, Case{2, 6, 0.5f, 2}, Case{2, 6, 16, 3}, Case{8, 12, 0.25f, 1},
        Case{0, 4, 0.25f, 1}, Case{0, 4, 16, 1}, Case{2, 14, 0, 2, 2}, Case{2, 14, 0.0625f, 2, 2},
        Case{2, 14, 16, 3, 2}, Case{2, 14, 0.01f, 2, 2}, Case{8, 12, 0.25f, 1, 2}}) {
    const glm::ivec2 size = c.side > 0 ? kSize / 2 : kSize;
    const float history = c.side > 2 ? -c.history : c.history;
    const auto got =
        accumulate(eye, everywhere(size, {9, 9, 9, c.side}), everywhere(kSize, {1, 1, 1, history}), 1,
                   ownPlaces(), 0, c.ageing, {}, c.foveaSamples);
    const float worth = c.history / (1 + c.history * c.ageing), lost = c.ageing / (1 + c.ageing),
                most = 8 * glm::mix(float(c.foveaSamples), 1.0f, lost),
                count = c.side == 2 ? std::min(worth + c.rays, most) : worth + c.rays;
    int own = 0;
    for (size_t i = 0; i < got.size(); i += 4) {
      if (got[i] == 1) continue;  // another surface than its block's sample
      EXPECT_NEAR(got[i], 1 + 8 * c.rays / count, 5e-3f) << c.side << " " << c.ageing;
      EXPECT_NEAR(std::abs(got[i + 3]), count, 1e-3f * count) << c.side << " " << c.ageing;
      ++own;
    }
    EXPECT_GT(own, 1000);
  }
}

TEST(TemporalAccumulation, OnlyInItsTiles) {
  const Eye eye({0, 0, 0});
  for (const auto& samples : {everywhere(kSize / 2, {4, 2, 1, passes::sampleCode(2, {1, 0}, true)}),
                              everywhere(kSize, {4, 2, 1, 1})}) {
    const auto history = everywhere(kSize, {1, 1, 3, 5});
    std::vector<float> want = accumulate(eye, samples, history);
    clearOutside(want, 4);
    EXPECT_EQ(accumulate(eye, samples, history, 1, ownPlaces(), 0, -1, kSomeTiles), want);
  }
}

// Other light at the same pixels gets a mean of the same samples with the same weights.
TEST(TemporalAccumulation, GlossHasTheSameMean) {
  const Eye eye({0, 0, 0});
  for (const int block : {1, 2}) {
    std::vector<glm::vec4> samples, history(size_t(kSize.x * kSize.y));
    for (int i = 0; i < kSize.x * kSize.y / (block * block); ++i)
      samples.emplace_back(0.25f * float(i % 7), 1, 2,
                           block == 1 ? 0 : passes::sampleCode(2, {i % 2, 0}, i % 5 != 0));
    for (size_t i = 0; i < history.size(); ++i) history[i] = glm::vec4(1, 0.5f * float(i % 3), 2, i % 4);
    const auto doubled = [](std::vector<glm::vec4> image) {
      for (glm::vec4& v : image) v = glm::vec4(2.0f * glm::vec3(v), v.a);
      return image;
    };
    PassTest test("temporal-accumulation");
    test.param("frames", 8.0).param("first_samples", 1).view("materials", "full");
    eye.seen.wire(test);
    test.image("origin", VK_FORMAT_R32_UINT, uint32_t(kSize.x), uint32_t(kSize.y), 1, ownPlaces());
    const auto wire = [&](const char* port, int width, const std::vector<glm::vec4>& values) {
      test.image(port, VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(kSize.x / width), uint32_t(kSize.y / width), 1,
                 halves(values));
    };
    wire("samples", block, samples);
    wire("history", 1, history);
    wire("gloss", block, doubled(samples));
    wire("gloss_history", 1, doubled(history));
    test.scene(eye.scene).run();
    const auto mean = test.floats("mean"), gloss = test.floats("gloss_mean"),
               alone = accumulate(eye, samples, history);
    ASSERT_EQ(gloss.size(), mean.size());
    for (size_t i = 0; i < mean.size(); ++i) {
      ASSERT_EQ(mean[i], alone[i]) << i;
      ASSERT_NEAR(gloss[i], mean[i] * (i % 4 == 3 ? 1.0f : 2.0f), 2e-3f * mean[i]) << i;
    }
  }
}

// What is wired as gloss has to be there as a whole: passes with diffuse materials make a single texel of it.
TEST(TemporalAccumulation, GlossNeedsAHistoryAndItsSize) {
  const Eye eye({0, 0, 0});
  const struct {
    glm::ivec2 gloss, history;
    const char* says;
  } cases[] = {{kSize / 2, {0, 0}, "only one is wired"},
               {{1, 1}, kSize, "`gloss` is not of the size of `samples`"},
               {kSize / 2, {1, 1}, "`gloss_history` is not of the size of `mean`"}};
  for (const auto& [gloss, glossHistory, says] : cases) {
    PassTest test("temporal-accumulation");
    test.view("materials", "full");
    eye.seen.wire(test);
    test.image("origin", VK_FORMAT_R32_UINT, uint32_t(kSize.x), uint32_t(kSize.y), 1, ownPlaces());
    const auto wire = [&](const char* port, glm::ivec2 size) {
      if (size.x > 0)
        test.image(port, VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(size.x), uint32_t(size.y), 1,
                   halves(everywhere(size, kNoSample)));
    };
    wire("samples", kSize / 2);
    wire("gloss", gloss);
    wire("history", kSize);
    wire("gloss_history", glossHistory);
    try {
      test.scene(eye.scene).run();
      FAIL() << "no error";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(says), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace fovea::test
