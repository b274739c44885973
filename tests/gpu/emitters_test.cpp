// Tests the choice of light sources on the device (shaders/rays/emitters.glsl): samples have the density that is said of
// them, lie on what they say, and are worth the light that there is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "framework/base/random.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/frame.h"
#include "framework/session/test_device.h"
#include "tests/gpu/scene_queries.h"
#include "tests/support/shapes.h"

namespace fovea::scene {
namespace {

using test::addMaterial;
using test::addQuad;
using test::testDevice;

constexpr uint32_t kReceivers = 8, kDraws = 16384, kQueries = kReceivers * kDraws;

float number(uint32_t i, uint32_t what) { return uniformFloat(randomStream(7, what, 0, i)); }
glm::vec3 vector(uint32_t i, uint32_t what) {
  return glm::vec3(number(i, what), number(i, what + 1), number(i, what + 2)) - 0.5f;
}

// As in the shader below.
struct Query {
  glm::vec3 position;
  float choice;
  glm::vec3 normal;
  uint32_t other;  // a triangle whose density is asked for, too
  glm::vec2 u, unused{0};
};
struct Answer {
  uint32_t triangle;
  float density, densityAgain;  // of the point, when it was chosen and asked for
  float otherDensity;
  glm::vec3 position;
  float mapDensity;
  glm::vec3 radiance;
  float mapDensityAgain;
  glm::vec3 direction;
  float unused0;
  glm::vec3 mapRadiance;
  float unused1;
};

std::vector<Answer> askDevice(GpuScene& scene, const Frame& frame, const std::vector<Query>& queries) {
  const char* source = R"(#version 460
#extension GL_GOOGLE_include_directive : require
#define RAY_PASSAGE 0
#include "rays/emitters.glsl"
layout(local_size_x = 64) in;
struct Query { vec3 position; float choice; vec3 normal; uint other; vec2 u, unused; };
struct Answer {
  uint triangle;
  float density, densityAgain, otherDensity;
  vec3 position;
  float mapDensity;
  vec3 radiance;
  float mapDensityAgain;
  vec3 direction;
  float unused0;
  vec3 mapRadiance;
  float unused1;
};
layout(std430) readonly buffer Queries { Query queries[]; };
layout(std430) writeonly buffer Answers { Answer answers[]; };
void main() {
  if (gl_GlobalInvocationID.x >= queries.length()) return;
  Query q = queries[gl_GlobalInvocationID.x];
  Receiver receiver = Receiver(q.position, q.normal);
  EmitterPoint p = sampleEmitters(receiver, q.choice, q.u);
  Answer a;
  a.triangle = p.triangle;
  a.density = p.density;
  a.densityAgain = p.triangle == kNoTriangle ? 0.0 : emitterDensity(p.triangle, p.weights, receiver);
  float root = sqrt(q.u.x);
  a.otherDensity = emitterDensity(q.other, root * vec2(1.0 - q.u.y, q.u.y), receiver);
  a.position = p.position;
  a.radiance = p.radiance;
  MapSample s = hasEnvironmentMap() ? sampleMap(q.u) : MapSample(vec3(0.0), vec3(0.0), 0.0);
  a.mapDensity = s.density;
  a.mapDensityAgain = s.density > 0.0 ? mapDensity(s.direction) : 0.0;
  a.direction = s.direction;
  a.mapRadiance = s.radiance;
  answers[gl_GlobalInvocationID.x] = a;
}
)";
  return test::askScene<Answer>(scene, frame, source, queries);
}

// Panels in different places, of different size, power and orientation, above a floor that is not emissive; all of them
// may move together.
Scene panels(uint32_t count, bool dynamic) {
  Scene s;
  s.cameras.emplace_back();
  addQuad(s, addMaterial(s, glm::vec3(0.5f)), {-10, 0, -10}, {0, 0, 20}, {20, 0, 0});
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t m = addMaterial(s, glm::vec3(0.5f));
    s.materials[m].emission = glm::vec3(0.1f + 10 * number(i, 0), 1, 2);
    s.materials[m].doubleSided = i % 3 == 0;
    addQuad(s, m, 8.0f * vector(i, 1), vector(i, 4), vector(i, 7));
    s.nodes.back().dynamic = dynamic;
  }
  return s;
}

glm::vec3 crossOf(const Geometry& g, uint32_t triangle) {
  const Triangle& t = g.triangles[triangle];
  const glm::vec3 a = g.positions[t.v[0]];
  return glm::cross(g.positions[t.v[1]] - a, g.positions[t.v[2]] - a);
}

std::vector<Query> queriesIn(const Geometry& geometry) {
  std::vector<Query> queries(kQueries);
  for (uint32_t i = 0; i < kQueries; ++i) {
    Query& q = queries[i];
    q.position = 8.0f * vector(i / kDraws, 11);
    q.normal = glm::normalize(vector(i / kDraws, 14));
    q.choice = number(i, 17);
    q.other = i % uint32_t(geometry.triangles.size());
    q.u = {number(i, 18), number(i, 19)};
  }
  return queries;
}

// The points that one receiver is given: each triangle as often as its density says. Where a part of the tree turns out
// to send no light, there is none.
void checkPoints(const Geometry& g, const std::vector<Query>& queries, const std::vector<Answer>& answers) {
  std::map<uint32_t, double> chosen, densities, asked;
  for (uint32_t i = 0; i < kDraws; ++i) {
    const Answer& got = answers[i];
    densities[queries[i].other] += double(answers[i].otherDensity);
    ++asked[queries[i].other];
    if (got.triangle == kNoIndex) continue;
    ++chosen[got.triangle];
    ASSERT_NEAR(got.density, got.densityAgain, 1e-3 * got.density);
    const glm::vec3 cross = crossOf(g, got.triangle), normal = glm::normalize(cross),
                    a = g.positions[g.triangles[got.triangle].v[0]];
    EXPECT_NEAR(glm::dot(got.position - a, normal), 0, 1e-4f);
    EXPECT_LE(glm::distance(got.position, a), 2 * std::sqrt(glm::length(cross)) + 2);
    EXPECT_EQ(got.radiance.g, 1);
  }
  double sum = 0, found = 0;
  for (const auto& [triangle, densitySum] : densities) {
    const double area = 0.5 * double(glm::length(crossOf(g, triangle))),
                 share = densitySum / asked[triangle] * area, want = share * kDraws;
    EXPECT_NEAR(chosen[triangle], want, 5 * std::sqrt(want) + 0.02 * want + 1e-6) << triangle;
    found += chosen[triangle] / kDraws;
    sum += share;
  }
  EXPECT_NEAR(sum, found, 0.03);
}

// The mean of the radiance over the density is the light of the map, as the sum over its texels says. Devices may
// interpolate with weights of 8 bits.
void checkMap(const EnvironmentMap& map, const std::vector<Answer>& answers) {
  glm::dvec3 got(0), want(0);
  for (const Answer& a : answers) {
    ASSERT_NEAR(glm::length(a.direction), 1, 1e-4f);
    const glm::vec3 radiance = map.radiance(a.direction);
    EXPECT_LT(glm::distance(a.mapRadiance, radiance), 0.02f * glm::length(radiance) + 0.06f);
    got += glm::dvec3(a.mapRadiance) / double(a.mapDensity) / double(answers.size());
  }
  const double step = glm::pi<double>() / map.height();
  for (uint32_t y = 0; y < map.height(); ++y)
    for (uint32_t x = 0; x < map.width(); ++x)
      want += glm::dvec3(map.texels()[y * map.width() + x]) * step * step * std::sin((y + 0.5) * step);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 0.01 * want[c]);
  const auto other = std::ranges::count_if(answers, [](const Answer& a) {  // at the border of two texels
    return std::abs(a.mapDensity - a.mapDensityAgain) > 2e-3f * a.mapDensity;
  });
  EXPECT_LE(other, int(answers.size()) / 100);
}

std::vector<Answer> check(const Scene& scene, const Geometry& geometry, GpuScene& device,
                          const Frame& frame) {
  const std::vector<Query> queries = queriesIn(geometry);
  const std::vector<Answer> answers = askDevice(device, frame, queries);
  for (uint32_t r = 0; r < kReceivers; ++r) {
    const auto begin = ptrdiff_t(r * kDraws);
    checkPoints(geometry, {queries.begin() + begin, queries.begin() + begin + kDraws},
                {answers.begin() + begin, answers.begin() + begin + kDraws});
  }
  if (scene.environmentMap) checkMap(*scene.environmentMap, answers);
  return answers;
}

TEST(DeviceEmitters, SamplesHaveTheirDensity) {
  for (const uint32_t count : {0u, 1u, 3u, 40u}) {
    Scene scene = panels(count, false);
    std::vector<glm::vec3> texels(64 * 32);
    for (uint32_t i = 0; i < texels.size(); ++i) texels[i] = glm::vec3(i % 37 == 0 ? 9 : number(i, 20));
    if (count != 1)
      scene.environmentMap = std::make_shared<const EnvironmentMap>(64, 32, std::move(texels), 0.7f);
    const Geometry g = flatten(scene);
    GpuScene device(testDevice(), scene, g, 1, false, {.device = true});
    const std::vector<Answer> answers = check(scene, g, device, makeFrame(scene, g, {16, 16}, 0, 1));
    const auto found = std::ranges::count_if(answers, [](const Answer& a) { return a.triangle != kNoIndex; });
    EXPECT_GE(found, count == 0 ? 0 : count == 1 ? 1 : int(kQueries) / 2);
    EXPECT_TRUE(count > 0 || found == 0);
  }
}

// The nearer of two equal panels is chosen more often, and one whose back is seen never.
TEST(DeviceEmitters, WhatSendsMoreLightIsChosenMoreOften) {
  Scene scene;
  scene.cameras.emplace_back();
  const uint32_t m = addMaterial(scene, glm::vec3(0.5f));
  scene.materials[m].emission = glm::vec3(1);
  addQuad(scene, m, {-3, 2, -0.5f}, {1, 0, 0}, {0, 0, 1});  // faces down
  addQuad(scene, m, {2, 6, -0.5f}, {1, 0, 0}, {0, 0, 1});   // farther away
  addQuad(scene, m, {-0.5f, 1, -3}, {0, 0, 1}, {1, 0, 0});  // faces up
  const Geometry g = flatten(scene);
  GpuScene device(testDevice(), scene, g, 1, false, {.device = true});
  std::vector<Query> queries(kDraws);
  for (uint32_t i = 0; i < kDraws; ++i)
    queries[i] = {{0, 0, 0}, number(i, 1), {0, 1, 0}, 0, {number(i, 2), number(i, 3)}};
  std::map<uint32_t, int> chosen;
  for (const Answer& a : askDevice(device, makeFrame(scene, g, {16, 16}, 0, 1), queries))
    ++chosen[a.triangle];
  EXPECT_GT(chosen[0] + chosen[1], 2 * (chosen[2] + chosen[3]));
  EXPECT_GT(chosen[2] + chosen[3], 0);
  EXPECT_EQ(chosen[4] + chosen[5], 0);
}

// The light of a long narrow panel that hangs before a wall comes, at the wall, from a short piece of the panel, at which
// rays are aimed. Aimed at the panel as a whole, the light of one ray would vary by five to seven times its mean.
TEST(DeviceEmitters, LongPanelIsAimedAtWhereItIsNear) {
  Scene scene;
  scene.cameras.emplace_back();
  const uint32_t m = addMaterial(scene, glm::vec3(0.5f));
  scene.materials[m].emission = glm::vec3(1);
  constexpr float kLength = 4, kWidth = 0.02f, kHeight = 0.05f;
  addQuad(scene, m, {-0.5f * kLength, kHeight, -0.5f * kWidth}, {kLength, 0, 0},
          {0, 0, kWidth});  // faces down
  const Geometry g = flatten(scene);
  GpuScene device(testDevice(), scene, g, 1, false, {.device = true});
  for (const float x : {0.0f, 0.7f, 1.99f}) {
    const auto lightFrom = [&](glm::vec3 point) {
      const glm::vec3 to = point - glm::vec3(x, 0, 0);
      return double(to.y) * double(to.y) / std::pow(double(glm::dot(to, to)), 2) / glm::pi<double>();
    };
    double want = 0;
    constexpr int kAlong = 4000, kAcross = 8;
    for (int i = 0; i < kAlong; ++i)
      for (int j = 0; j < kAcross; ++j) {
        const glm::vec2 at((float(i) + 0.5f) / kAlong - 0.5f, (float(j) + 0.5f) / kAcross - 0.5f);
        want += lightFrom({kLength * at.x, kHeight, kWidth * at.y}) * double(kLength * kWidth) /
                (kAlong * kAcross);
      }
    std::vector<Query> queries(kDraws);
    for (uint32_t i = 0; i < kDraws; ++i)
      queries[i] = {{x, 0, 0}, number(i, 1), {0, 1, 0}, 0, {number(i, 2), number(i, 3)}};
    double sum = 0, squares = 0;
    for (const Answer& a : askDevice(device, makeFrame(scene, g, {16, 16}, 0, 1), queries)) {
      const double light = a.triangle == kNoIndex ? 0 : lightFrom(a.position) / double(a.density);
      sum += light / kDraws;
      squares += light * light / kDraws;
    }
    EXPECT_NEAR(sum, want, 0.02 * want) << x;
    EXPECT_LT(std::sqrt(squares - sum * sum), want) << x;
  }
}

// The tree follows what moves, grows or appears: it chooses as that of a scene that always was like this.
TEST(DeviceEmitters, FollowWhatMoves) {
  const Scene scene = panels(13, true);
  Geometry g = flatten(scene);
  GpuScene device(testDevice(), scene, g, 1, false, {.device = true});
  Frame frame = makeFrame(scene, g, {16, 16}, 0, 1);
  for (const glm::vec4 step : {glm::vec4(1, -2, 0.5f, 1), glm::vec4(0, 1, 0, 1.5f)}) {
    for (size_t i = 1; i < frame.objects.size(); ++i)
      frame.objects[i].toWorld = glm::scale(glm::translate(glm::mat4(1), glm::vec3(step)), glm::vec3(step.w));
    moveObjects(frame, g);
    const std::vector<Answer> moved = check(scene, g, device, frame);
    Scene still = panels(13, false);
    for (size_t i = 1; i < still.nodes.size(); ++i) {
      still.nodes[i].translation = glm::vec3(step);
      still.nodes[i].scale = glm::vec3(step.w);
    }
    const Geometry h = flatten(still);
    GpuScene other(testDevice(), still, h, 1, false, {.device = true});
    const std::vector<Answer> want = askDevice(other, makeFrame(still, h, {16, 16}, 0, 1), queriesIn(h));
    double sum = 0, wantSum = 0;
    for (uint32_t i = 0; i < kQueries; ++i) {
      sum += double(moved[i].otherDensity) / kQueries;
      wantSum += double(want[i].otherDensity) / kQueries;
    }
    EXPECT_GT(wantSum, 0);
    EXPECT_NEAR(sum, wantSum, 0.02 * wantSum);
  }
}

TEST(DeviceEmitters, AreNoneUnlessRaysAreAskedFor) {
  const Scene scene = panels(3, false);
  const Geometry g = flatten(scene);
  GpuScene device(testDevice(), scene, g, 1);
  for (const Answer& a :
       askDevice(device, makeFrame(scene, g, {16, 16}, 0, 1), std::vector<Query>(64, Query{}))) {
    EXPECT_EQ(a.triangle, kNoIndex);
    EXPECT_EQ(a.otherDensity, 0);
  }
}

}  // namespace
}  // namespace fovea::scene
