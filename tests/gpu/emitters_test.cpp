// Compares the choice of light sources on the device (shaders/rays/emitters.glsl) with that on the host.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/base/random.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/emitters.h"
#include "framework/session/test_device.h"
#include "tests/gpu/scene_queries.h"
#include "tests/support/shapes.h"

namespace fovea::scene {
namespace {

using test::addMaterial;
using test::addQuad;
using test::testDevice;

constexpr uint32_t kQueries = 4096;

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
  float density, otherDensity, mapDensity;
  glm::vec3 position;
  float mapDensityAgain;  // of the direction that was chosen
  glm::vec3 radiance;
  float unused0;
  glm::vec3 direction;
  float unused1;
  glm::vec3 mapRadiance;
  float unused2;
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
  float density, otherDensity, mapDensity;
  vec3 position;
  float mapDensityAgain;
  vec3 radiance;
  float unused0;
  vec3 direction;
  float unused1;
  vec3 mapRadiance;
  float unused2;
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
  a.otherDensity = emitterDensity(q.other, receiver);
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

// What rounding decides may differ for a few receivers: those at the edge of a cone, and choices between two emitters.
void compare(const Scene& scene, Geometry& geometry, GpuScene& device, const Frame& frame) {
  moveObjects(frame, geometry);
  Frame hostFrame = frame;
  hostFrame.geometry = &geometry;
  const Emitters emitters(hostFrame);
  std::vector<Query> queries(kQueries);
  for (uint32_t i = 0; i < kQueries; ++i) {
    Query& q = queries[i];
    q.position = 8.0f * vector(i, 11);
    q.normal = glm::normalize(vector(i, 14));
    q.choice = number(i, 17);
    q.other = i % uint32_t(geometry.triangles.size());
    q.u = {number(i, 18), number(i, 19)};
  }
  const std::vector<Answer> answers = askDevice(device, frame, queries);
  int different = 0, found = 0, densities = 0;
  for (uint32_t i = 0; i < kQueries; ++i) {
    const Query& q = queries[i];
    const Answer& got = answers[i];
    const EmitterPoint want = emitters.sample({q.position, q.normal}, q.choice, q.u.x, q.u.y);
    const float density = emitters.density(q.other, {q.position, q.normal});
    const auto near = [](float a, float b) { return std::abs(a - b) <= 2e-3f * std::max(a, b) + 1e-9f; };
    found += want.triangle != kNoIndex;
    densities += density > 0;
    different += !(got.triangle == want.triangle && near(got.density, want.density) &&
                   near(got.otherDensity, density) &&
                   (want.triangle == kNoIndex || (glm::distance(got.position, want.position) < 1e-3f &&
                                                  glm::distance(got.radiance, want.radiance) < 1e-3f)));
    if (!scene.environmentMap) continue;
    const EnvironmentMap::Sample s = scene.environmentMap->sample(q.u.x, q.u.y);
    EXPECT_LT(glm::distance(got.direction, s.direction), 1e-3f) << i;
    EXPECT_NEAR(got.mapDensity, s.density, 2e-3f * s.density) << i;
    EXPECT_LT(glm::distance(got.mapRadiance, s.radiance), 0.02f * glm::length(s.radiance)) << i;
    different += !near(got.mapDensityAgain, s.density);  // at the border of two texels
  }
  EXPECT_LE(different, int(kQueries) / 100);
  if (!geometry.emissive.empty()) {
    EXPECT_GT(found, int(kQueries) / 4);
    EXPECT_GT(densities, int(kQueries) / 10);
  }
}

TEST(DeviceEmitters, AreChosenAsOnTheHost) {
  for (const uint32_t count : {0u, 1u, 3u, 40u}) {
    Scene scene = panels(count, false);
    std::vector<glm::vec3> texels(64 * 32);
    for (uint32_t i = 0; i < texels.size(); ++i) texels[i] = glm::vec3(i % 37 == 0 ? 9 : number(i, 20));
    if (count != 1)
      scene.environmentMap = std::make_shared<const EnvironmentMap>(64, 32, std::move(texels), 0.7f);
    Geometry g = flatten(scene);
    GpuScene device(testDevice(), scene, g, 1, false, true);
    compare(scene, g, device, makeFrame(scene, g, {16, 16}, 0, 1));
  }
}

// The tree follows what moves, grows or appears.
TEST(DeviceEmitters, FollowWhatMoves) {
  const Scene scene = panels(13, true);
  Geometry g = flatten(scene);
  GpuScene device(testDevice(), scene, g, 1, false, true);
  Frame frame = makeFrame(scene, g, {16, 16}, 0, 1);
  for (const glm::vec4 step : {glm::vec4(1, -2, 0.5f, 1), glm::vec4(0, 1, 0, 1.5f)}) {
    for (size_t i = 1; i < frame.objects.size(); ++i)
      frame.objects[i].toWorld = glm::scale(glm::translate(glm::mat4(1), glm::vec3(step)), glm::vec3(step.w));
    compare(scene, g, device, frame);
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
