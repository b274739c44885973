// Checks which triangles of random soups are drawn, using points on them that lie in the view.
#include "framework/scene/device/draw_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "framework/scene/frame.h"

namespace fovea::scene {
namespace {

constexpr uint32_t kStatic = 3000, kAll = 3100;

// Small triangles all around the origin, with neighbours at neighbouring indices; the last ones move.
Geometry soup(uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto vector = [&](float size) {
    return size * glm::vec3(uniform(random), uniform(random), uniform(random));
  };
  Geometry g;
  glm::vec3 place(0);
  for (uint32_t i = 0; i < kAll; ++i) {
    if (i % 40 == 0) place = vector(10);
    for (int k = 0; k < 3; ++k) g.positions.push_back(place + vector(0.5f));
    g.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, 0});
  }
  for (const glm::vec3& p : g.positions) {
    g.boundsMin = glm::min(g.boundsMin, p);
    g.boundsMax = glm::max(g.boundsMax, p);
  }
  g.staticTriangles = kStatic;
  return g;
}

const std::vector<DrawRun> kRuns{{DrawKind::DoubleSided, 0, 1000},
                                 {DrawKind::Masked, 1000, 1},
                                 {DrawKind::SingleSided, 1001, kAll - 1001}};

DrawKind kindOf(uint32_t triangle) {
  return triangle < 1000    ? DrawKind::DoubleSided
         : triangle == 1000 ? DrawKind::Masked
                            : DrawKind::SingleSided;
}

TEST(DrawClusters, HoldTheStillTrianglesInOrderUnderTheirSpheres) {
  const Geometry g = soup(1);
  for (const uint32_t size : {1u, 7u, 128u, 5000u}) {
    uint32_t next = 0;
    for (const DrawCluster& c : drawClusters(kRuns, g, size)) {
      ASSERT_EQ(c.firstTriangle, next);
      ASSERT_GT(c.triangleCount, 0u);
      EXPECT_LE(c.triangleCount, size);
      next += c.triangleCount;
      for (uint32_t i = c.firstTriangle; i < next; ++i) {
        EXPECT_EQ(kindOf(i), c.kind);
        for (const uint32_t v : g.triangles[i].v)
          EXPECT_LE(glm::distance(g.positions[v], c.centre), c.radius * 1.0001f + 1e-5f);
      }
    }
    EXPECT_EQ(next, kStatic);
  }
}

Camera randomCamera(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  Camera camera;
  camera.position = 8.0f * glm::vec3(uniform(random), uniform(random), uniform(random));
  camera.orientation = glm::normalize(glm::quat(uniform(random), uniform(random), uniform(random), 0.5f));
  camera.verticalFov = 0.8f + 0.5f * uniform(random);
  return camera;
}

// Points on a grid over the triangle, including its corners.
bool hasPointInView(const Geometry& g, const Triangle& t, const glm::mat4& worldToClip) {
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; i + j <= 4; ++j) {
      const glm::vec3 p = (float(i) * g.positions[t.v[0]] + float(j) * g.positions[t.v[1]] +
                           float(4 - i - j) * g.positions[t.v[2]]) /
                          4.0f;
      const glm::vec4 c = worldToClip * glm::vec4(p, 1);
      if (std::abs(c.x) <= c.w && std::abs(c.y) <= c.w && c.z >= 0 && c.z <= c.w) return true;
    }
  return false;
}

TEST(DrawClusters, WhatAViewShowsIsDrawnOnceAndInOrder) {
  std::mt19937 random(3);
  const Geometry g = soup(2);
  const std::vector<DrawCluster> clusters = drawClusters(kRuns, g, 32);
  std::vector<DrawRun> visible;
  uint64_t drawnInAll = 0, shownInAll = 0;
  for (int view = 0; view < 60; ++view) {
    const glm::mat4 worldToClip = makeView(randomCamera(random), {64, 48}, g).worldToClip;
    visibleRuns(clusters, kRuns, g.staticTriangles, worldToClip, visible);
    std::vector<bool> drawn(kAll);
    uint32_t next = 0;
    for (const DrawRun& run : visible) {
      ASSERT_GE(run.firstTriangle, next);
      ASSERT_GT(run.triangleCount, 0u);
      next = run.firstTriangle + run.triangleCount;
      ASSERT_LE(next, kAll);
      for (uint32_t i = run.firstTriangle; i < next; ++i) {
        EXPECT_EQ(run.kind, kindOf(i));
        drawn[i] = true;
      }
    }
    for (uint32_t i = 0; i < kAll; ++i) {
      const bool shown = hasPointInView(g, g.triangles[i], worldToClip);
      EXPECT_TRUE(drawn[i] || (i < kStatic && !shown)) << "view " << view << " triangle " << i;
      shownInAll += shown;
      drawnInAll += drawn[i];
    }
  }
  EXPECT_GT(shownInAll, 60u * 50);
  EXPECT_LT(drawnInAll, 60u * kAll / 2);  // most of the soup lies beside or behind the views
}

TEST(DrawClusters, RunsGrowTogetherWhereNothingIsLeftOut) {
  Geometry g = soup(4);
  Camera camera;
  camera.position = {0, 0, 200};
  const glm::mat4 worldToClip = makeView(camera, {64, 64}, g).worldToClip;
  std::vector<DrawRun> visible;
  visibleRuns(drawClusters(kRuns, g, 16), kRuns, g.staticTriangles, worldToClip, visible);
  ASSERT_EQ(visible.size(), kRuns.size());
  for (size_t i = 0; i < kRuns.size(); ++i) {
    EXPECT_EQ(visible[i].kind, kRuns[i].kind);
    EXPECT_EQ(visible[i].firstTriangle, kRuns[i].firstTriangle);
    EXPECT_EQ(visible[i].triangleCount, kRuns[i].triangleCount);
  }
}

TEST(DrawClusters, NothingToDraw) {
  std::vector<DrawRun> visible{{DrawKind::Masked, 0, 1}};
  const Geometry empty;
  EXPECT_TRUE(drawClusters({}, empty).empty());
  visibleRuns({}, {}, 0, glm::mat4(1), visible);
  EXPECT_TRUE(visible.empty());
}

}  // namespace
}  // namespace fovea::scene
