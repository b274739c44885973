// Tests from which pixels others take samples of indirect light: passes reservoirs-neighbours and reservoirs-permutation.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/passes/reservoir_reference.h"

namespace fovea::test {
namespace {

constexpr int kWidth = 61, kHeight = 46;
constexpr double kPlane = 0.01, kCosine = 0.9;

// Two walls that meet, a step in one of them, and some background.
GBuffer surfaces() {
  const scene::PixelRays rays = raysOnto({0, 0, 0}, {-2, -1, -2}, {0.08f, 0, -0.02f}, {0, 0.04f, 0});
  return {kWidth, kHeight, rays, [=](int x, int y) {
            SurfacePixel p;
            const glm::vec3 ray = pointOn(rays, x, y, 1);
            const float toLeft = -2 / ray.x, toBack = (y < 12 ? -3.8f : -4.0f) / ray.z;
            const bool left = ray.x < 0 && toLeft < toBack;
            p.normal = left ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
            p.distance = x > 55 && y > 40 ? 0.0f : left ? toLeft : toBack;
            p.position = p.distance * ray;
            return p;
          }};
}

bool similar(const SurfacePixel& p, const SurfacePixel& q) {
  return p.distance > 0 && q.distance > 0 &&
         std::abs(glm::dot(q.position - p.position, p.normal)) <= kPlane * p.distance &&
         glm::dot(p.normal, q.normal) >= kCosine;
}

std::vector<uint32_t> neighbours(const GBuffer& g, int count, double radius, int iteration, uint32_t frames) {
  PassTest test("reservoirs-neighbours");
  g.wire(test);
  test.param("neighbours", count).param("radius", radius).param("iteration", iteration);
  test.param("plane_tolerance", kPlane).param("least_cosine", kCosine);
  test.run(frames);
  return test.values<uint32_t>("sources");
}

TEST(ReservoirsNeighbours, LieOnSimilarSurfacesInRings) {
  const GBuffer g = surfaces();
  constexpr int kCount = 5;
  constexpr double kRadius = 0.15;
  const auto sources = neighbours(g, kCount, kRadius, 0, 1);
  ASSERT_EQ(sources.size(), size_t(kCount * kWidth * kHeight));
  int found = 0, inside = 0;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const int x = i % kWidth, y = i / kWidth;
    for (int k = 0; k < kCount; ++k) {
      const uint32_t source = sources[size_t(i * kCount + k)];
      // Where all around shows the same surface, all are found but those that would be the pixel itself.
      const bool amid = x > 30 && x < 46 && y > 22 && y < 32;
      inside += amid;
      EXPECT_FALSE(amid && k > 0 && source == kNoPixel) << x << ", " << y;
      if (source == kNoPixel) continue;
      ++found;
      const int qx = int(source & 0xffffu), qy = int(source >> 16);
      ASSERT_TRUE(qx < kWidth && qy < kHeight);
      EXPECT_TRUE(similar(g.at(x, y), g.at(qx, qy))) << x << ", " << y << " and " << qx << ", " << qy;
      const double away = std::hypot(qx - x, qy - y), widest = kRadius * kWidth;
      EXPECT_GE(away, widest * std::sqrt(k / double(kCount)) - 0.75);
      EXPECT_LE(away, widest * std::sqrt((k + 1) / double(kCount)) + 0.75);
      EXPECT_GT(away, 0);
    }
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(found, kWidth * kHeight * kCount / 2);
}

TEST(ReservoirsNeighbours, AreOthersInEachIterationAndFrame) {
  const GBuffer g = surfaces();
  const auto first = neighbours(g, 3, 0.15, 0, 1), second = neighbours(g, 3, 0.15, 1, 1),
             next = neighbours(g, 3, 0.15, 0, 2);
  EXPECT_EQ(first, neighbours(g, 3, 0.15, 0, 1));
  for (const auto& other : {second, next}) {
    int same = 0, both = 0;
    for (size_t i = 0; i < first.size(); ++i) {
      if (first[i] == kNoPixel || other[i] == kNoPixel) continue;
      ++both;
      same += first[i] == other[i];
    }
    EXPECT_GT(both, 1000);
    EXPECT_LT(same, both / 20);
  }
}

std::vector<uint32_t> permuted(const GBuffer& g, const std::vector<uint32_t>& origin, uint32_t frames,
                               bool permute = true) {
  PassTest test("reservoirs-permutation");
  g.wire(test, "previous");
  test.param("permute", permute);
  test.param("plane_tolerance", kPlane).param("least_cosine", kCosine);
  test.image("origin", VK_FORMAT_R32_UINT, kWidth, kHeight, 1, origin);
  test.run(frames);
  return test.values<uint32_t>("sources");
}

TEST(ReservoirsPermutation, CanBeSwitchedOff) {
  const GBuffer g = surfaces();
  std::vector<uint32_t> origin;
  for (int i = 0; i < kWidth * kHeight; ++i)
    origin.push_back(i % 5 == 2 ? kNoPixel : packPixel(i % kWidth, 7));
  EXPECT_EQ(permuted(g, origin, 1, false), origin);
  EXPECT_NE(permuted(g, origin, 1), origin);
}

TEST(ReservoirsPermutation, ExchangesPixelsOfOneSurface) {
  const GBuffer g = surfaces();
  std::vector<uint32_t> origin;
  for (int i = 0; i < kWidth * kHeight; ++i)
    origin.push_back(i % 7 == 2 || g.pixels[size_t(i)].distance == 0 ? kNoPixel
                                                                     : packPixel(i % kWidth, i / kWidth));
  std::set<std::vector<uint32_t>> all;
  for (const uint32_t frames : {1u, 2u, 3u}) {
    const auto sources = permuted(g, origin, frames);
    all.insert(sources);
    std::set<uint32_t> taken;
    int moved = 0, stayed = 0;
    for (int i = 0; i < int(origin.size()); ++i) {
      if (origin[size_t(i)] == kNoPixel) {
        EXPECT_EQ(sources[size_t(i)], kNoPixel);
        continue;
      }
      const uint32_t source = sources[size_t(i)];
      const int x = i % kWidth, y = i / kWidth, qx = int(source & 0xffffu), qy = int(source >> 16);
      ASSERT_TRUE(qx < kWidth && qy < kHeight);
      EXPECT_LE(std::max(std::abs(qx - x), std::abs(qy - y)), 3);
      EXPECT_TRUE(source == origin[size_t(i)] || similar(g.at(x, y), g.at(qx, qy)));
      EXPECT_TRUE(taken.insert(source).second) << "pixel " << i << " takes what another one has";
      (source == origin[size_t(i)] ? stayed : moved) += 1;
    }
    EXPECT_GT(moved, 1500);
    EXPECT_GT(stayed, 50);  // at borders and edges
  }
  EXPECT_EQ(all.size(), 3u);
}

}  // namespace
}  // namespace fovea::test
