// Scenes of many triangles get coarser meshes for voxels and VPL maps; others stay as they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "framework/scene/load.h"

namespace fovea::scene {
namespace {

// A ball of 5,000 triangles with radius 1. Without shared vertices it is flat-shaded.
Primitive ball(bool shared) {
  constexpr uint32_t kSide = 50;
  Primitive p;
  for (uint32_t y = 0; y <= kSide; ++y)
    for (uint32_t x = 0; x <= kSide; ++x) {
      const float polar = 0.02f + float(y) / kSide * 3.1f, around = 6.2831853f * float(x) / kSide;
      p.positions.push_back(
          {std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around)});
      p.uvs.push_back({float(x) / kSide, float(y) / kSide});
    }
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x) {
      const uint32_t a = y * (kSide + 1) + x, b = a + kSide + 1;
      p.indices.insert(p.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  if (!shared) {
    Primitive all;
    for (const uint32_t i : p.indices) {
      all.indices.push_back(uint32_t(all.positions.size()));
      all.positions.push_back(p.positions[i]);
      all.uvs.push_back(p.uvs[i]);
    }
    p = all;
  }
  p.normals = p.positions;
  return p;
}

Scene balls(const Primitive& p, uint32_t nodes) {
  Scene s;
  s.materials.resize(1);
  s.meshes.push_back({"ball", {p}});
  s.nodes.resize(nodes);
  for (Node& n : s.nodes) n.mesh = 0;
  return s;
}

double area(const Primitive& p, const std::vector<uint32_t>& indices) {
  double sum = 0;
  for (size_t i = 0; i < indices.size(); i += 3) {
    const glm::dvec3 a(p.positions[indices[i]]), b(p.positions[indices[i + 1]]),
        c(p.positions[indices[i + 2]]);
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

TEST(LightLevels, AMillionTrianglesAreNotTooMany) {
  Scene s = balls(ball(true), 209);  // 1,045,000
  EXPECT_FALSE(addLightLevels(s));
  EXPECT_TRUE(s.meshes[0].primitives[0].lightIndices.empty());
}

TEST(LightLevels, OneMeshOfManyNodesIsReducedOnce) {
  for (const bool shared : {true, false}) {
    Scene s = balls(ball(shared), 1000);
    EXPECT_TRUE(addLightLevels(s));
    const Primitive& p = s.meshes[0].primitives[0];
    EXPECT_EQ(p.indices.size(), 3u * 5000);
    const size_t triangles = p.lightIndices.size() / 3;
    EXPECT_LE(triangles, 525u) << shared;  // 2^19 of all the nodes
    EXPECT_GT(triangles, 400u) << shared;
    for (const uint32_t i : p.lightIndices) ASSERT_LT(i, p.positions.size());
    // All vertices lie on the ball, so the surface between them lies inside: by 0.3% where edges have 0.16.
    EXPECT_NEAR(area(p, p.lightIndices) / area(p, p.indices), 1, 0.02) << shared;
    for (size_t i = 0; i < p.lightIndices.size(); i += 3) {
      const glm::vec3 centre = (p.positions[p.lightIndices[i]] + p.positions[p.lightIndices[i + 1]] +
                                p.positions[p.lightIndices[i + 2]]) /
                               3.0f;
      EXPECT_GT(glm::length(centre), 0.95f);
    }
  }
}

TEST(LightLevels, TheLevelIsPartOfTheHashAndAlwaysTheSame) {
  Scene first = balls(ball(true), 1000), second = first;
  const uint64_t before = contentHash(first);
  addLightLevels(first);
  addLightLevels(second);
  EXPECT_NE(contentHash(first), before);
  EXPECT_EQ(contentHash(first), contentHash(second));
}

TEST(LightLevels, TexturesKeepTheirSeams) {
  Scene s = balls(ball(true), 1000);
  s.textures.resize(1);
  s.materials[0].baseColorTexture.texture = 0;
  EXPECT_TRUE(addLightLevels(s));
  const Primitive& p = s.meshes[0].primitives[0];
  EXPECT_LT(p.lightIndices.size() / 3, 1000u);
  // A triangle over the seam at u = 0 and 1 would show the whole texture.
  for (size_t i = 0; i < p.lightIndices.size(); i += 3) {
    float low = 1, high = 0;
    for (size_t k = 0; k < 3; ++k) {
      const float u = p.uvs[p.lightIndices[i + k]].x;
      low = std::min(low, u), high = std::max(high, u);
    }
    EXPECT_LT(high - low, 0.6f) << i;
  }
}

TEST(LightLevels, WhatHasHolesOrDeformsStaysWhole) {
  Scene s = balls(ball(true), 1000);
  s.materials[0].masked = true;
  EXPECT_FALSE(addLightLevels(s));
  s.materials[0].masked = false;
  s.meshes[0].primitives[0].targets.emplace_back();
  EXPECT_FALSE(addLightLevels(s));
  s.meshes[0].primitives[0].targets.clear();
  EXPECT_TRUE(addLightLevels(s));
  EXPECT_FALSE(addLightLevels(s));  // it has its level now
}

}  // namespace
}  // namespace fovea::scene
