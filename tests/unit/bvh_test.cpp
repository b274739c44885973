#include "framework/scene/rays/bvh.h"

#include <gtest/gtest.h>

#include <random>

namespace fovea::scene {
namespace {

Geometry scatteredTriangles(uint32_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(0, 1);
  Geometry geometry;
  for (uint32_t t = 0; t < count; ++t) {
    // Half of them lie in an ever smaller corner, so that the tree is deep there.
    const float scale = t % 2 ? 1.0f : std::ldexp(1.0f, -int(t % 24));
    const glm::vec3 corner(place(random) * scale, place(random) * scale, place(random) * scale);
    const auto first = uint32_t(geometry.positions.size());
    geometry.positions.insert(geometry.positions.end(),
                              {corner, corner + glm::vec3(0.01f, 0, 0), corner + glm::vec3(0, 0.01f, 0)});
    Triangle triangle{};
    for (uint32_t k = 0; k < 3; ++k) triangle.v[k] = first + k;
    geometry.triangles.push_back(triangle);
  }
  return geometry;
}

TEST(RefitOrder, HasEachNodeOnceAndItsChildrenBefore) {
  for (const uint32_t triangles : {0u, 1u, 5u, 1000u, 20000u})
    for (const uint32_t most : {1u, 2u, 64u}) {
      SCOPED_TRACE(std::to_string(triangles) + " triangles, parts of " + std::to_string(most));
      const Bvh bvh = buildBvh(scatteredTriangles(triangles));
      const RefitOrder order = refitOrder(bvh, most);
      ASSERT_EQ(order.nodes.size(), bvh.nodes.size());
      ASSERT_EQ(order.parts.back(), order.nodes.size());
      ASSERT_EQ(order.rounds.back() + 1, order.parts.size());
      std::vector<size_t> position(bvh.nodes.size(), ~size_t(0)), part = position, round = position;
      for (size_t r = 0; r + 1 < order.rounds.size(); ++r)
        for (size_t p = order.rounds[r]; p < order.rounds[r + 1]; ++p) {
          EXPECT_LE(order.parts[p + 1] - order.parts[p], most);
          for (size_t i = order.parts[p]; i < order.parts[p + 1]; ++i) {
            ASSERT_EQ(position[order.nodes[i]], ~size_t(0)) << "twice";
            position[order.nodes[i]] = i, part[order.nodes[i]] = p, round[order.nodes[i]] = r;
          }
        }
      if (triangles == 0) continue;
      for (size_t node = 0; node < bvh.nodes.size(); ++node) {
        if (bvh.nodes[node].count > 0) continue;
        for (const size_t child : {bvh.nodes[node].first, bvh.nodes[node].first + 1}) {
          if (part[child] == part[node])
            EXPECT_LT(position[child], position[node]);
          else
            EXPECT_LT(round[child], round[node]);
        }
      }
    }
}

TEST(RefitOrder, NeedsFewRounds) {
  const Bvh bvh = buildBvh(scatteredTriangles(100000));
  EXPECT_LE(refitOrder(bvh, 64).rounds.size() - 1, 4u);
}

}  // namespace
}  // namespace fovea::scene
