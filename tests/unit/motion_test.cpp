// Tests moving things: paths, objects, lights, and the geometry of a frame.
#include "framework/scene/motion/motion.h"
#include "framework/scene/frame.h"
#include "framework/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/shapes.h"

namespace fovea::scene {
namespace {

using test::addMaterial;
using test::addQuad;

MotionKey key(float time, glm::vec3 at, float turnDeg = 0, bool visible = true) {
  return {time, at, glm::angleAxis(glm::radians(turnDeg), glm::vec3(0, 1, 0)), visible};
}

// A still floor, and a separate quad under a moving node that hangs below a turned and scaled one.
Scene movingScene() {
  Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  Node frame;
  frame.rotation = glm::angleAxis(glm::radians(90.0f), glm::vec3(0, 1, 0));
  frame.scale = glm::vec3(2);
  s.nodes.push_back(frame);
  addQuad(s, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  s.nodes[2].parent = 1;
  s.nodes[2].name = "mover";
  s.nodes[2].scale = {1, 3, 1};
  s.nodes[2].dynamic = true;
  s.cameras.emplace_back();
  s.movers = {{2,
               true,
               Repeat::Once,
               {key(0, {0, 0, 0}), key(1, {1, 0, 0}, 90), key(2, {1, 0, 0}, 90), key(3, {4, 1, 0}, 0)}}};
  return s;
}

TEST(Motion, GoesThroughItsKeysWithoutOvershooting) {
  const Mover m = movingScene().movers[0];
  for (const MotionKey& k : m.keys) {
    const MotionKey pose = poseAt(m, k.time);
    EXPECT_LT(glm::distance(pose.translation, k.translation), 1e-6f) << k.time;
    EXPECT_NEAR(std::abs(glm::dot(pose.rotation, k.rotation)), 1, 1e-6f) << k.time;
  }
  glm::vec3 last(0);
  for (double t = 0; t <= 3; t += 0.01) {
    const glm::vec3 p = poseAt(m, t).translation;
    EXPECT_GE(p.x, last.x) << t;  // the keys only go forward, and so does the path
    if (t > 1 && t < 2) {
      EXPECT_EQ(p, glm::vec3(1, 0, 0)) << t;
    }
    EXPECT_LT(glm::distance(p, last), 0.06f) << t;
    last = p;
  }
  EXPECT_EQ(poseAt(m, 99).translation, glm::vec3(4, 1, 0));
}

TEST(Motion, LinearLoopAndBackAndForth) {
  Mover m{0, false, Repeat::Loop, {key(1, {0, 0, 0}), key(3, {2, 0, 0}, 80)}};
  EXPECT_EQ(poseAt(m, 0).translation.x, 0);  // before the first key
  EXPECT_NEAR(poseAt(m, 1.5).translation.x, 0.5f, 1e-6);
  EXPECT_NEAR(std::abs(glm::dot(poseAt(m, 1.5).rotation, key(0, {}, 20).rotation)), 1, 1e-6);
  EXPECT_NEAR(poseAt(m, 3.5).translation.x, 0.5f, 1e-6);
  EXPECT_NEAR(poseAt(m, 1001.5).translation.x, 0.5f, 1e-4);
  m.repeat = Repeat::PingPong;
  EXPECT_NEAR(poseAt(m, 3.5).translation.x, 1.5f, 1e-6);
  EXPECT_NEAR(poseAt(m, 5.5).translation.x, 0.5f, 1e-6);
  m.keys.resize(1);
  EXPECT_EQ(poseAt(m, 7).translation.x, 0);
}

TEST(Motion, ObjectsFollowTheirNodes) {
  const Scene s = movingScene();
  Geometry g = flatten(s);
  ASSERT_EQ(g.objects.size(), 2u);
  const Geometry still = g;
  for (const uint64_t index : {uint64_t(0), uint64_t(5), uint64_t(25)}) {
    const Frame f = makeFrame(s, g, {8, 8}, index, 0, 10.0);
    ASSERT_EQ(f.objects.size(), 2u);
    EXPECT_EQ(f.objects[0].toWorld, glm::mat4(1));
    EXPECT_EQ(f.objects[0].toObject, glm::mat4(1));
    const ObjectTransform& o = f.objects[1];
    const MotionKey pose = poseAt(s.movers[0], f.time);
    glm::mat4 expected = glm::translate(glm::mat4(1), pose.translation) * glm::mat4_cast(pose.rotation);
    expected = localTransform(s.nodes[1]) * glm::scale(expected, {1, 3, 1});
    for (int c = 0; c < 4; ++c) EXPECT_LT(glm::distance(o.toWorld[c], expected[c]), 1e-5f);
    const glm::mat4 before =
        index ? makeFrame(s, g, {8, 8}, index - 1, 0, 10.0).objects[1].toWorld : o.toWorld;
    EXPECT_EQ(o.previousToWorld, before);
    moveObjects(f, g);
    for (uint32_t v = 0; v < g.positions.size(); ++v) {
      if (v < g.staticVertices()) {
        EXPECT_EQ(g.positions[v], still.positions[v]);
        continue;
      }
      const glm::vec3 local = s.meshes[1].primitives[0].positions[v - g.staticVertices()];
      EXPECT_LT(glm::distance(g.positions[v], o.fromObject(local)), 1e-5f);
      EXPECT_LT(glm::distance(o.intoObject(g.positions[v]), local), 1e-5f);
      EXPECT_LT(glm::distance(g.normals[v], o.normalFromObject({0, 0, 1})), 1e-5f);
      EXPECT_LT(glm::distance(o.normalIntoObject(g.normals[v]), glm::vec3(0, 0, 1)), 1e-5f);
    }
    const Triangle& t = g.triangles[g.staticTriangles];
    const glm::vec3 face =
        glm::cross(g.positions[t.v[1]] - g.positions[t.v[0]], g.positions[t.v[2]] - g.positions[t.v[0]]);
    EXPECT_GT(glm::dot(face, g.normals[t.v[0]]), 0);
  }
}

TEST(Motion, FlattenShowsTimeZeroAndItsBoundsHoldEveryFrame) {
  Scene s = movingScene();
  s.movers[0].keys[0].translation = {0.5f, 0, 0};
  Geometry g = flatten(s);
  const Geometry start = g;
  for (uint64_t i = 0; i < 40; ++i) {
    moveObjects(makeFrame(s, g, {8, 8}, i, 0, 10.0), g);
    if (i == 0) {
      EXPECT_EQ(g.positions, start.positions);
    }
    for (const glm::vec3& p : g.positions)
      for (int c = 0; c < 3; ++c) {
        EXPECT_GE(p[c], g.boundsMin[c]) << "frame " << i;
        EXPECT_LE(p[c], g.boundsMax[c]) << "frame " << i;
      }
  }
  EXPECT_EQ(g.boundsMin, start.boundsMin);
  EXPECT_LT(g.boundsMax.y, 8.1f);  // tight: 2 (1 + 3)
  // The last key counts also if the path starts anew at its time.
  s.movers[0].repeat = Repeat::Loop;
  EXPECT_NEAR(flatten(s).boundsMax.y, g.boundsMax.y, 1e-3f);
}

TEST(Motion, WhatIsInvisibleHasNoArea) {
  Scene s = movingScene();
  s.movers[0].keys = {key(0, {0, 0, 0}, 0, false), key(1, {1, 0, 0}), key(2, {2, 0, 0}, 0, false)};
  Geometry g = flatten(s);
  const auto area = [&] {
    double sum = 0;
    for (uint32_t i = g.staticTriangles; i < g.triangles.size(); ++i) {
      const Triangle& t = g.triangles[i];
      sum += glm::length(
          glm::cross(g.positions[t.v[1]] - g.positions[t.v[0]], g.positions[t.v[2]] - g.positions[t.v[0]]));
    }
    return sum;
  };
  EXPECT_EQ(area(), 0);
  bool last = false;
  for (uint64_t i = 0; i < 30; ++i) {
    const Frame f = makeFrame(s, g, {8, 8}, i, 0, 10.0);
    moveObjects(f, g);
    const bool visible = i >= 10 && i < 20;
    EXPECT_EQ(f.objects[1].visible, visible) << i;
    if (i > 0) {
      EXPECT_EQ(f.objects[1].previousVisible, last) << i;
    }
    EXPECT_EQ(area() > 0, visible) << i;
    for (const glm::vec3& n : g.normals) EXPECT_NEAR(glm::length(n), 1, 1e-5f);
    last = visible;
  }
}

TEST(Motion, Lights) {
  Scene s;
  s.lights = {test::sun({0, -1, 0}, glm::vec3(1)), test::pointLight({0, 1, 0}, {1, 2, 3})};
  LightMotion m{1, true, Repeat::Loop, {}};
  m.keys = {{0, {0, 1, 0}, {0, -1, 0}, {1, 2, 3}, 1},
            {1, {2, 1, 0}, {1, 0, 0}, {0, 0, 0}, 5},
            {2, {2, 3, 0}, {1, 0, 0}, {1, 1, 1}, 0}};
  s.lightMotions = {m};
  EXPECT_EQ(lightsAt(s, 0)[1].color, glm::vec3(1, 2, 3));
  EXPECT_EQ(lightsAt(s, 1)[1].position, glm::vec3(2, 1, 0));
  EXPECT_EQ(lightsAt(s, 1)[1].intensity, 5);
  for (double t = 0; t < 4; t += 0.05) {
    const Light l = lightsAt(s, t)[1];
    EXPECT_NEAR(glm::length(l.direction), 1, 1e-5f);
    EXPECT_GE(l.intensity, 0);
    EXPECT_GE(l.color.x, 0);
    EXPECT_EQ(l.type, LightType::Point);
    EXPECT_EQ(lightsAt(s, t)[0].direction, s.lights[0].direction);
  }
  const Frame f = makeFrame(s, Geometry{}, {8, 8}, 12, 0, 10.0);
  EXPECT_EQ(f.lights[1].position, lightsAt(s, 1.2)[1].position);
}

TEST(Motion, HashSeesEveryPartOfIt) {
  const Scene base = movingScene();
  const uint64_t hash = contentHash(base);
  const auto differs = [&](auto&& change) {
    Scene s = base;
    change(s);
    return contentHash(s) != hash;
  };
  EXPECT_TRUE(differs([](Scene& s) { s.movers.clear(); }));
  EXPECT_TRUE(differs([](Scene& s) { s.movers[0].keys[1].translation.y = 1; }));
  EXPECT_TRUE(differs([](Scene& s) { s.movers[0].keys[1].visible = false; }));
  EXPECT_TRUE(differs([](Scene& s) { s.movers[0].smooth = false; }));
  EXPECT_TRUE(differs([](Scene& s) { s.movers[0].repeat = Repeat::Loop; }));
  EXPECT_TRUE(differs([](Scene& s) { s.ipd = 0; }));
  EXPECT_TRUE(differs([](Scene& s) { s.lens = Lens{1, 1, 1, 1}; }));
  EXPECT_TRUE(differs([](Scene& s) { s.lightMotions.push_back({0, true, Repeat::Once, {{}}}); }));
}

}  // namespace
}  // namespace fovea::scene
