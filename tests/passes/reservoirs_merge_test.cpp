// Compares merged reservoirs with a plain version in double precision, and their mean with the true light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/passes/reservoir_reference.h"

namespace fovea::test {
namespace {

constexpr glm::ivec2 kSize(21, 13);  // not whole work groups
constexpr int kSources = 4, kPixels = kSize.x * kSize.y;

// Surfaces below and points above that send light down.
GBuffer ground(Numbers& numbers, glm::ivec2 size, float step = 0.1f, float height = 0.1f) {
  return {size.x, size.y, raysOnto({1, 3, 1}, {0, 0, 0}, {step, 0, 0}, {0, 0, step}), [&](int x, int y) {
            SurfacePixel p;
            p.position = {step * float(x), height * numbers.next(), step * float(y)};
            p.distance = 3;
            p.normal = glm::normalize(glm::vec3(numbers.next() - 0.5f, 1, numbers.next() - 0.5f));
            return p;
          }};
}

Reservoir point(Numbers& numbers) {
  Reservoir r;
  r.position = {3 * numbers.next() - 0.5f, 0.3f + numbers.next(), 2 * numbers.next()};
  r.normal = glm::normalize(glm::vec3(numbers.next() - 0.5f, -0.5f, numbers.next() - 0.5f));
  r.radiance = {numbers.next(), numbers.next(), numbers.next()};
  return r;
}

struct Input {
  GBuffer here, there;
  std::vector<Reservoir> own, others;
  std::vector<uint32_t> sources, visibility;

  static Input random(uint32_t seed) {
    Numbers numbers{seed};
    Input in{ground(numbers, kSize), ground(numbers, kSize), {}, {}, {}, {}};
    for (int i = 0; i < kPixels; ++i) {
      for (std::vector<Reservoir>* list : {&in.own, &in.others}) {
        Reservoir r = point(numbers);
        r.weight = numbers.next() < 0.15f ? 0.0f : 5 * numbers.next();
        r.count = numbers.next() < 0.1f ? 0.0f : float(1 + numbers.below(40));
        if (r.count == 0) r = {};
        list->push_back(r);
      }
      for (int k = 0; k < kSources; ++k) {
        const uint32_t source = packPixel(numbers.below(kSize.x), numbers.below(kSize.y));
        in.sources.push_back(i % 11 == 3 || numbers.next() < 0.2f ? kNoPixel : source);
      }
      in.visibility.push_back(hashPcg(numbers.state));
    }
    return in;
  }
  std::vector<Reservoir> merge(bool unbiased, float most, float limit, bool visible = true) const {
    const uint32_t width = uint32_t(here.width), height = uint32_t(here.height),
                   each = uint32_t(sources.size() / here.pixels.size());
    PassTest test("reservoirs-merge");
    here.wire(test);
    there.wire(test, "moved");
    test.param("unbiased", unbiased).param("most", int(most)).param("growth_limit", double(limit));
    test.param("iteration", 2).seed(7);
    test.buffer("own", own, "Reservoir");
    test.buffer("others", others, "Reservoir");
    test.image("sources", VK_FORMAT_R32_UINT, each * width, height, 1, sources);
    if (visible) test.image("visibility", VK_FORMAT_R32_UINT, width, height, 1, visibility);
    test.run();
    return test.values<Reservoir>("reservoirs");
  }
};

// By how much the solid angle of the sample grows, 0 if that is not allowed.
double growth(const SurfacePixel& from, const SurfacePixel& to, const Reservoir& r, double limit) {
  const double a = solidAngle(from, r), b = solidAngle(to, r);
  if (a <= 0 || b <= 0) return 0;
  return b / a <= limit && a / b <= limit ? b / a : 0;
}

struct Offer {
  const Reservoir* sample = nullptr;
  double weight = 0;
};

// The samples among which the pixel chooses, each with its weight: first those of its sources, then its own. Written with
// the sum over all pairs, in densities per solid angle of the pixel.
std::vector<Offer> offersAt(const Input& in, int i, bool unbiased, double most, double limit) {
  const SurfacePixel& here = in.here.pixels[size_t(i)];
  const Reservoir& ours = in.own[size_t(i)];
  struct Source {
    const SurfacePixel* at;
    const Reservoir* r;
    double count;
    bool weSee, itSees;
  };
  std::vector<Source> list;
  double all = 0;
  for (int k = 0; k < kSources; ++k) {
    const uint32_t source = in.sources[size_t(i * kSources + k)];
    if (source == kNoPixel) {
      list.push_back({nullptr, nullptr, 0, false, false});
      continue;
    }
    const size_t j = size_t(source >> 16) * kSize.x + (source & 0xffffu);
    const uint32_t bits = in.visibility[size_t(i)] >> 2 * k;
    list.push_back({&in.there.pixels[j], &in.others[j], std::min(double(in.others[j].count), most),
                    !unbiased || (bits & 1u) != 0, !unbiased || (bits & 2u) != 0});
    all += list.back().count;
  }
  const auto density = [&](const Source& s, const Reservoir& sample) {  // of the source, in our solid angle
    const double g = growth(*s.at, here, sample, limit);
    return g > 0 ? cosineAt(*s.at, sample) / g : 0.0;
  };
  std::vector<Offer> offers;
  double share = all > 0 ? 0 : 1;
  for (const Source& s : list) {
    if (all == 0 || s.at == nullptr) continue;
    const double part = s.count / all;
    if (s.r->weight > 0 && s.weSee && growth(*s.at, here, *s.r, limit) > 0) {
      const double its = all * density(s, *s.r), our = ours.count * cosineAt(here, *s.r);
      const double target = luminance(*s.r) * cosineAt(here, *s.r);
      offers.push_back(
          {s.r,
           its > 0 ? part * its / (its + our) * target * s.r->weight * growth(*s.at, here, *s.r, limit) : 0});
    } else {
      offers.push_back({s.r, 0});
    }
    const double its = s.itSees ? all * density(s, ours) : 0, our = ours.count * cosineAt(here, ours);
    if (our > 0) share += part * our / (its + our);
  }
  if (ours.weight > 0)
    offers.push_back({&ours, share * luminance(ours) * cosineAt(here, ours) * ours.weight});
  return offers;
}

void expectMerged(bool unbiased, float most, float limit) {
  int merged = 0, empty = 0, foreign = 0;
  for (const uint32_t seed : {1u, 2u, 3u}) {
    const Input in = Input::random(seed);
    const auto result = in.merge(unbiased, most, limit);
    for (int i = 0; i < kPixels; ++i) {
      SCOPED_TRACE(i);
      const Reservoir& r = result[size_t(i)];
      double sum = 0, count = in.own[size_t(i)].count;
      bool known = false;
      const Offer* chosen = nullptr;
      const auto offers = offersAt(in, i, unbiased, most, limit);
      for (const Offer& o : offers) {
        sum += o.weight;
        if (o.weight > 0 && o.sample->position == r.position) chosen = &o;
      }
      for (int k = 0; k < kSources; ++k)
        if (const uint32_t s = in.sources[size_t(i * kSources + k)]; s != kNoPixel) {
          count += std::min(in.others[size_t(s >> 16) * kSize.x + (s & 0xffffu)].count, most);
          known = true;
        }
      EXPECT_NEAR(r.count, count, 1e-3);
      if (sum == 0) {
        EXPECT_EQ(r.weight, 0);
        ++empty;
        continue;
      }
      ASSERT_NE(chosen, nullptr);
      EXPECT_EQ(r.radiance, chosen->sample->radiance);
      EXPECT_EQ(r.normal, chosen->sample->normal);
      const double target = luminance(r) * cosineAt(in.here.pixels[size_t(i)], r);
      EXPECT_NEAR(r.weight * target / sum, 1, 2e-3);  // growth at grazing angles, in single precision
      ++merged;
      foreign += known && chosen->sample != &in.own[size_t(i)];
    }
  }
  EXPECT_GT(merged, 500);
  EXPECT_GT(empty, 5);
  EXPECT_GT(foreign, limit < 2 ? 60 : 200);
}

TEST(ReservoirsMerge, KeepsOneSampleForAll) { expectMerged(true, 500, 10); }
TEST(ReservoirsMerge, SourcesCountForAtMostSoManySamples) { expectMerged(true, 7, 10); }
TEST(ReservoirsMerge, SolidAnglesMayDifferByTheLimit) { expectMerged(true, 500, 1.5f); }
TEST(ReservoirsMerge, VisibilityIsIgnoredIfBiased) { expectMerged(false, 500, 10); }

// How often each sample is chosen: the same pixel 4096 times.
TEST(ReservoirsMerge, ChoosesInProportionToTheWeights) {
  constexpr int kSide = 64;
  const Input small = Input::random(5);
  std::vector<Offer> offers;
  int at = 0;  // a pixel with five offers
  const auto none = [](const Offer& o) { return o.weight == 0; };
  for (; at < kPixels; ++at) {
    offers = offersAt(small, at, false, 500, 10);
    if (offers.size() == kSources + 1 && std::ranges::none_of(offers, none)) break;
  }
  ASSERT_LT(at, kPixels);
  const SurfacePixel& pixel = small.here.pixels[size_t(at)];
  const scene::PixelRays rays = raysOnto({1, 3, 1}, pixel.position, glm::vec3(0), glm::vec3(0));
  Input in{{kSide, kSide, rays, [&](int, int) { return pixel; }}, small.there, {}, {}, {}, {}};
  in.there = GBuffer(kSide, kSide, [&](int x, int y) {
    return small.there.at(std::min(x, kSize.x - 1), std::min(y, kSize.y - 1));
  });
  in.own.assign(kSide * kSide, small.own[size_t(at)]);
  in.visibility.assign(kSide * kSide, small.visibility[size_t(at)]);
  for (int i = 0; i < kSide * kSide; ++i) {
    in.others.push_back(
        small.others[size_t(std::min(i / kSide, kSize.y - 1) * kSize.x + std::min(i % kSide, kSize.x - 1))]);
    in.sources.insert(in.sources.end(), small.sources.begin() + at * kSources,
                      small.sources.begin() + (at + 1) * kSources);
  }
  double sum = 0;
  for (const Offer& o : offers) sum += o.weight;
  const auto result = in.merge(false, 500, 10);
  for (const Offer& o : offers) {
    const double p = o.weight / sum, n = kSide * kSide;
    const double times = double(
        std::ranges::count_if(result, [&](const Reservoir& r) { return r.position == o.sample->position; }));
    EXPECT_NEAR(times / n, p, 4 * std::sqrt(p * (1 - p) / n) + 1e-3);
  }
}

// ---- The mean ------------------------------------------------------------------------------------------------------

// Emissive patches. Every second pixel sees all of them, the others, in the shade, only a few: the sample of each pixel
// is one of the patches, chosen evenly. Whatever pixels share with each other, the mean of what their reservoirs stand
// for is the light that there is.
struct Patches {
  static constexpr int kSide = 64, kCount = 12, kSeenInShade = 3;
  static constexpr float kArea = 0.02f;
  GBuffer seen;
  std::vector<Reservoir> list;

  explicit Patches(Numbers& numbers) : seen(ground(numbers, {kSide, kSide}, 1.0f / kSide, 0)) {
    for (int k = 0; k < kCount; ++k) list.push_back(point(numbers));
  }
  static bool inShade(size_t pixel) { return pixel % 2 == 0; }
  bool sees(size_t pixel, int patch) const {
    return (patch < kSeenInShade || !inShade(pixel)) &&
           solidAngle(seen.pixels[pixel], list[size_t(patch)]) > 0;
  }
  double irradiance(size_t pixel) const {
    double sum = 0;
    for (int k = 0; k < kCount; ++k)
      if (const Reservoir& r = list[size_t(k)]; sees(pixel, k))
        sum += luminance(r) * cosineAt(seen.pixels[pixel], r) * solidAngle(seen.pixels[pixel], r) * kArea;
    return sum;
  }
};

// The share of the light that merged reservoirs stand for, in the shade and out of it.
glm::dvec2 lightKept(bool unbiased) {
  glm::dvec2 sum(0), wanted(0);
  for (uint32_t seed = 1; seed <= 8; ++seed) {
    Numbers numbers{seed};
    const Patches patches(numbers);
    Input in{patches.seen, patches.seen, {}, {}, {}, {}};
    std::vector<int> drawn;
    for (size_t i = 0; i < patches.seen.pixels.size(); ++i) {
      const int k = numbers.below(Patches::kCount);
      Reservoir r = patches.list[size_t(k)];
      const double density = Patches::kCount * Patches::kArea * solidAngle(patches.seen.pixels[i], r);
      r.weight = patches.sees(i, k) ? float(density) : 0.0f;
      r.count = float(1 + numbers.below(3));
      in.own.push_back(r);
      drawn.push_back(k);
    }
    in.others = in.own;
    for (size_t i = 0; i < in.own.size(); ++i) {
      uint32_t bits = 0;
      for (int k = 0; k < kSources; ++k) {
        const int x = numbers.below(Patches::kSide), y = numbers.below(Patches::kSide);
        const size_t j = size_t(y * Patches::kSide + x);
        in.sources.push_back(packPixel(x, y));
        bits |= (patches.sees(i, drawn[j]) ? 1u : 0u) << 2 * k | (patches.sees(j, drawn[i]) ? 2u : 0u)
                                                                     << 2 * k;
      }
      in.visibility.push_back(bits);
    }
    const auto merged = in.merge(unbiased, 500, 4);
    for (size_t i = 0; i < merged.size(); ++i) {
      const int part = Patches::inShade(i) ? 0 : 1;
      sum[part] += luminance(merged[i]) * cosineAt(patches.seen.pixels[i], merged[i]) * merged[i].weight;
      wanted[part] += patches.irradiance(i);
    }
  }
  return sum / wanted;
}

TEST(ReservoirsMerge, KeepsTheLight) {
  const glm::dvec2 kept = lightKept(true);
  EXPECT_NEAR(kept[0], 1, 0.02);
  EXPECT_NEAR(kept[1], 1, 0.02);
}

TEST(ReservoirsMerge, LeaksLightIntoTheShadeIfBiased) {
  const glm::dvec2 kept = lightKept(false);
  EXPECT_GT(kept[0], 1.5);
  EXPECT_LT(kept[1], 0.95);
}

}  // namespace
}  // namespace fovea::test
