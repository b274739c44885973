// Compares rays through the triangles on the device (shaders/rays/trace.glsl) with RayScene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/base/random.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/frame.h"
#include "framework/scene/load.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/session/test_device.h"
#include "tests/gpu/scene_queries.h"
#include "tests/references/passage.h"
#include "tests/support/ray_soup.h"

namespace fovea::scene {
namespace {

using test::randomVector;
using test::raySoup;

using test::testDevice;

// As in the shader below.
struct Query {
  glm::vec3 origin;
  float near;
  glm::vec3 direction;
  float far;
};
struct Answer {
  uint32_t triangle;
  float distance, u, v;
  glm::vec3 share;  // of the light that passes
  uint32_t occluded;
};

std::vector<Answer> traceOnDevice(GpuScene& scene, const Frame& frame, const std::vector<Query>& queries,
                                  bool passage) {
  const std::string source = std::string("#version 460\n") +
                             "#extension GL_GOOGLE_include_directive : require\n#define RAY_PASSAGE " +
                             (passage ? "1" : "0") + R"(
#include "rays/visibility.glsl"
layout(local_size_x = 64) in;
struct Query { vec3 origin; float near; vec3 direction; float far; };
struct Answer { uint triangle; float distance, u, v; vec3 share; uint occluded; };
layout(std430) readonly buffer Queries { Query queries[]; };
layout(std430) writeonly buffer Answers { Answer answers[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= queries.length()) return;
  Query q = queries[i];
  Ray ray = Ray(q.origin, q.direction, q.near, q.far);
  RayHit hit = intersect(ray);
  answers[i] = Answer(hit.triangle, hit.distance, hit.weights.x, hit.weights.y, visibility(ray),
                      occluded(ray) ? 1u : 0u);
}
)";
  return test::askScene<Answer>(scene, frame, source, queries);
}

// Rays from everywhere within the scene's box; some within planes of the axes, some cut short, and every second one
// towards a point of a triangle, each of which has its turn.
std::vector<Query> raysThrough(const Geometry& g, uint32_t count) {
  const glm::vec3 middle = 0.5f * (g.boundsMin + g.boundsMax), size = g.boundsMax - g.boundsMin;
  std::vector<Query> list(count);
  for (uint32_t i = 0; i < count; ++i) {
    Query& q = list[i];
    q = {middle + 0.5f * size * randomVector(i, 10), 0, randomVector(i, 11), 1e30f};
    if (i % 4 == 0) q.direction[int(i / 4 % 3)] = 0;
    if (i % 16 == 0) q.direction = {0, i % 32 == 0 ? 1 : -1, 0};
    if (i % 5 == 0) q.near = 0.1f * glm::length(size);
    if (i % 7 == 0) q.far = 0.3f * glm::length(size);
    if (i % 2 == 1) {
      const Triangle& t = g.triangles[i / 2 % g.triangles.size()];
      const glm::vec3 w = glm::abs(randomVector(i, 12)) + 1e-3f;
      const glm::vec3 at =
          (w.x * g.positions[t.v[0]] + w.y * g.positions[t.v[1]] + w.z * g.positions[t.v[2]]) /
          (w.x + w.y + w.z);
      q = {q.origin, 0, at - q.origin, 1e30f};
    }
  }
  return list;
}

// At edges, and where two triangles meet, either answer is right. allowed: share of the hits that may differ.
void compare(const Scene& scene, Geometry& geometry, GpuScene& device, const Frame& frame, uint32_t count,
             uint32_t fewestHits, bool passage = false, double allowed = 1e-3) {
  moveObjects(frame, geometry);
  const std::vector<Query> queries = raysThrough(geometry, count);
  const std::vector<Answer> answers = traceOnDevice(device, frame, queries, passage);
  const RayScene rays(scene, geometry, passage ? Passing::Met : Passing::Never);
  Frame hostFrame = frame;
  hostFrame.geometry = &geometry;
  uint32_t hits = 0, different = 0, passed = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const Query& q = queries[i];
    const Ray ray{q.origin, q.direction, q.near, q.far};
    const RayHit want = rays.intersect(ray);
    const Answer& got = answers[i];
    const glm::vec3 share = visibility(hostFrame, rays, ray);
    hits += bool(want);
    passed += want && share != glm::vec3(0);
    EXPECT_EQ(got.occluded == 1, got.triangle != kNoIndex) << "ray " << i;
    bool same = bool(want) == (got.triangle != kNoIndex) &&
                (!want || std::abs(want.distance - got.distance) < 1e-4f * (1 + want.distance));
    if (want && want.triangle == got.triangle) {
      const Triangle& t = geometry.triangles[want.triangle];
      const glm::vec3 a = geometry.positions[t.v[0]];
      const glm::vec3 off = (got.u - want.u) * (geometry.positions[t.v[1]] - a) +
                            (got.v - want.v) * (geometry.positions[t.v[2]] - a);
      same = same && glm::length(off) < 1e-3f * (1 + want.distance);
    }
    const glm::vec3 error = glm::abs(share - got.share);
    different += !same || !(std::max({error.x, error.y, error.z}) <= 2e-3f);
  }
  EXPECT_GT(hits, fewestHits);
  EXPECT_LE(different, allowed * hits);
  if (passage) {
    EXPECT_GT(passed, fewestHits / 20);
  }
}

Texture holes() {
  Texture t{"holes", 8, 8, true, std::vector<uint8_t>(8 * 8 * 4, 255)};
  for (uint32_t i = 0; i < 64; ++i) t.rgba[4 * i + 3] = uint8_t(hashCombine(5, i));
  return t;
}

Scene threeMaterials() {
  Scene scene;
  scene.cameras.emplace_back();
  scene.textures.push_back(holes());
  scene.materials.resize(3);
  return scene;
}

TEST(DeviceRays, MeetWhatRaysOnTheHostMeet) {
  const Scene scene = threeMaterials();
  for (const uint32_t count : {1u, 4u, 5u, 3000u}) {
    Geometry g = raySoup(count);
    GpuScene device(testDevice(), scene, g, 1, false, {.device = true});
    compare(scene, g, device, makeFrame(scene, g, {16, 16}, 0, 1), 20000, 5000);
  }
}

// A box around the origin, and strips of a floor that share the edges x = -3, -2, ..., 3.
Geometry boxAndFloor() {
  Geometry g;
  const auto quad = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    const uint32_t v = uint32_t(g.positions.size());
    g.positions.insert(g.positions.end(), {a, b, c, d});
    g.triangles.push_back({{v, v + 1, v + 2}, 0});
    g.triangles.push_back({{v + 1, v + 3, v + 2}, 0});
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-5.0f, 5.0f}) {
      const auto at = [&](float u, float v) {
        glm::vec3 p(side);
        p[(axis + 1) % 3] = u, p[(axis + 2) % 3] = v;
        return p;
      };
      quad(at(-5, -5), at(5, -5), at(-5, 5), at(5, 5));
    }
  for (int x = -4; x < 4; ++x) quad({x, -2, -1}, {x + 1, -2, -1}, {x, -2, 1}, {x + 1, -2, 1});
  g.normals.assign(g.positions.size(), {0, 1, 0});
  g.uvs.assign(g.positions.size(), {0, 0});
  g.boundsMin = glm::vec3(-5);
  g.boundsMax = glm::vec3(5);
  g.staticTriangles = uint32_t(g.triangles.size());
  return g;
}

TEST(DeviceRays, SlipThroughNoSharedEdge) {
  const Scene scene = threeMaterials();
  const Geometry g = boxAndFloor();
  GpuScene device(testDevice(), scene, g, 1, false, {.device = true});
  std::vector<Query> queries;
  for (uint32_t i = 0; i < 20000; ++i) {
    glm::vec3 direction = randomVector(i, 4);
    if (i % 2 == 0) direction = glm::round(direction * 2.0f);  // straight at edges, corners and diagonals
    if (direction != glm::vec3(0)) queries.push_back({glm::vec3(0), 0, direction, 1e30f});
  }
  for (int x = -3; x <= 3; ++x)  // at the floor alone, whose box they touch from within a face
    for (const float zero : {0.0f, -0.0f}) queries.push_back({{x, 0, 0.25f}, 0, {zero, -1, zero}, 3});
  const std::vector<Answer> answers =
      traceOnDevice(device, makeFrame(scene, g, {16, 16}, 0, 1), queries, false);
  for (size_t i = 0; i < answers.size(); ++i) EXPECT_EQ(answers[i].occluded, 1u) << "ray " << i;
}

// In the middle of an edge the normals of its ends cancel; that of the triangle takes their place.
TEST(DeviceRays, LightPassesGlassWhoseNormalsCancel) {
  Scene scene = threeMaterials();
  scene.fullMaterials = true;
  scene.materials[0].transmission = 0.8f;
  Geometry g;
  g.positions = {{0, 0, 0}, {2, 0, 0}, {0, 0, 2}};
  g.normals = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}};
  g.uvs.assign(3, {0, 0});
  g.triangles.push_back({{0, 1, 2}, 0});
  g.boundsMax = glm::vec3(2);
  g.staticTriangles = 1;
  GpuScene device(testDevice(), scene, g, 1, true, {.device = true});
  Frame frame = makeFrame(scene, g, {16, 16}, 0, 1);
  const std::vector<Answer> answers = traceOnDevice(device, frame, {{{1, 1, 0}, 0, {0, -1, 0}, 2}}, true);
  frame.geometry = &g;
  const glm::vec3 want = visibility(frame, RayScene(scene, g, Passing::Met), {{1, 1, 0}, {0, -1, 0}, 0, 2});
  EXPECT_EQ(answers[0].triangle, 0u);
  EXPECT_NEAR(answers[0].share.g, want.g, 2e-3);
}

TEST(DeviceRays, PassHolesOfMasks) {
  Scene scene = threeMaterials();
  for (int i : {1, 2}) {
    scene.materials[size_t(i)].masked = true;
    scene.materials[size_t(i)].alphaCutoff = 0.3f * float(i);
    scene.materials[size_t(i)].baseColorTexture = {0};
  }
  Geometry g = raySoup(3000);
  GpuScene device(testDevice(), scene, g, 1, false, {.device = true});
  compare(scene, g, device, makeFrame(scene, g, {16, 16}, 0, 1), 20000, 7000);
}

TEST(DeviceRays, LightPassesGlassAndBlending) {
  Scene scene = threeMaterials();
  scene.fullMaterials = true;
  scene.materials[1].masked = scene.materials[1].blended = true;
  scene.materials[1].baseColor.a = 0.7f;
  scene.materials[1].baseColorTexture = {0};
  scene.materials[2].transmission = 0.9f;
  scene.materials[2].baseColor = {0.9f, 0.5f, 0.2f, 1};
  Geometry g = raySoup(400);
  GpuScene device(testDevice(), scene, g, 1, true, {.device = true});
  compare(scene, g, device, makeFrame(scene, g, {16, 16}, 0, 1), 20000, 3000, true);
}

// The tree of what moves follows it: rigid objects here, which at the end no longer show.
TEST(DeviceRays, FollowWhatMoves) {
  const Scene scene = builtin("cornellbox_moving");
  Geometry g = flatten(scene);
  GpuScene device(testDevice(), scene, g, 1, false, {.device = true});
  for (const uint64_t frame : {0, 25, 90})
    compare(scene, g, device, makeFrame(scene, g, {16, 16}, frame, 1), 20000, 5000);
  Frame hidden = makeFrame(scene, g, {16, 16}, 120, 1);
  for (ObjectTransform& o : hidden.objects) o.visible = false;
  compare(scene, g, device, hidden, 20000, 5000);
}

// A second into their paths.
TEST(LongDeviceRays, MeetWhatRaysOnTheHostMeetInScenes) {
  for (const char* name : {"room", "yard", "atrium", "cornellbox_moving", "cornellbox_walk"}) {
    SCOPED_TRACE(name);
    Diagnostics warnings;
    const Scene scene = load(name, warnings);
    Geometry g = flatten(scene);
    GpuScene device(testDevice(), scene, g, 1, false, {.device = true});
    compare(scene, g, device, makeFrame(scene, g, {16, 16}, 42, 1), 1'000'000, 300'000, false, 1e-4);
  }
}

TEST(DeviceRays, MeetNothingUnlessAskedFor) {
  const Scene scene = threeMaterials();
  const Geometry g = raySoup(100);
  GpuScene device(testDevice(), scene, g, 1);
  for (const Answer& a :
       traceOnDevice(device, makeFrame(scene, g, {16, 16}, 0, 1), raysThrough(g, 500), false)) {
    EXPECT_EQ(a.triangle, kNoIndex);
    EXPECT_EQ(a.share, glm::vec3(1));
  }
}

}  // namespace
}  // namespace fovea::scene
