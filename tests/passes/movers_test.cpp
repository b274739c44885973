// Every pass sees moving objects where the frame has them; compared with rays through the frame's own geometry.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>
#include <optional>
#include <set>

#include "fovea/test.h"
#include "framework/scene/rays/ray_scene.h"
#include "shaders/records/reservoir.h"
#include "shaders/records/vpl.h"
#include "tests/passes/deferred_reference.h"
#include "tests/passes/ray_reference.h"
#include "tests/passes/shadow_view.h"
#include "tests/references/octahedral.h"
#include "tests/references/paraboloid.h"
#include "tests/references/voxel_grid.h"

namespace fovea::test {
namespace {

constexpr int kSize = 40;
// At 42 Hz the box stands still at first, then slides and turns; it is absent around frame 12.
constexpr uint32_t kFrames[] = {0, 1, 6, 12, 15, 20};
constexpr uint32_t kAway = 12;

scene::MotionKey key(float frame, glm::vec3 at, float turnDeg, bool visible = true) {
  return {frame / 42, at, glm::angleAxis(glm::radians(turnDeg), glm::vec3(0, 1, 0)), visible};
}

// Morph targets that shear and stretch the box, more and more until frame 16.
void bend(scene::Scene& s) {
  scene::Animation bending;
  bending.plays = true;
  for (uint32_t i = 3; i < s.nodes.size(); ++i) {
    for (scene::Primitive& p : s.meshes[s.nodes[i].mesh].primitives) {
      scene::MorphTarget shear;
      for (const glm::vec3& v : p.positions)
        shear.positions.emplace_back(0.5f * v.y, 0.4f * v.y, -0.2f * v.x);
      p.targets = {shear};
    }
    bending.channels.push_back({i,
                                scene::AnimationChannel::Path::Weights,
                                scene::AnimationChannel::Interpolation::Linear,
                                {0, 16.0f / 42, 1},
                                {0, 1, 1}});
  }
  s.animations = {bending};
}

// A floor, a wall, a box that moves and may also deform, a sun, and a lamp that moves.
scene::Scene movingScene(bool deforms) {
  scene::Scene s;
  s.name = "moving";
  s.materials.resize(2);
  s.materials[1].baseColor = {0.8f, 0.6f, 0.1f, 1};
  addQuad(s, 0, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3});
  addQuad(s, 0, {-3, 0, -3}, {3, 0, -3}, {3, 4, -3}, {-3, 4, -3});
  scene::Node root;
  root.dynamic = true;
  s.nodes.push_back(root);
  addBox(s, 1, {-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f});
  for (size_t i = 3; i < s.nodes.size(); ++i) s.nodes[i].parent = 2;
  s.movers = {{2,
               true,
               scene::Repeat::Once,
               {key(0, {-1.5f, 0, 0}, 0), key(1.5f, {-1.5f, 0, 0}, 0), key(11.5f, {1, 0.5f, 0.5f}, 70, false),
                key(12.5f, {1, 0.5f, 0.5f}, 70), key(20, {1.5f, 0, -1}, 120)}}};
  if (deforms) bend(s);
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 1.5f, 7};
  scene::Light sun;
  sun.direction = glm::normalize(glm::vec3(0.3f, -1, -0.4f));
  scene::Light lamp;
  lamp.name = "lamp";
  lamp.type = scene::LightType::Spot;
  lamp.position = {0, 4, 1};
  lamp.direction = {0, -1, 0};
  lamp.intensity = 50;
  s.lights = {sun, lamp};
  s.lightMotions = {
      {1, true, scene::Repeat::Once, {{0, {0, 4, 1}, {0, -1, 0}}, {0.5f, {1, 4, 0}, {0.2f, -1, 0}}}}};
  return s;
}

template <class Check>
void atFrames(PassTest& test, const Check& check) {
  uint32_t done = 0;
  for (const uint32_t index : kFrames) {
    test.run(index + 1 - done);
    done = index + 1;
    ASSERT_EQ(test.lastFrame().index, index);
    check(index);
  }
}

class Movers : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Movers, testing::Bool(),
                         [](const auto& kind) { return kind.param ? "Deforming" : "Rigid"; });

bool isBox(const scene::Geometry& g, uint32_t triangle) { return g.triangles[triangle].object() > 0; }

TEST_P(Movers, GBuffer) {
  const scene::Scene s = movingScene(GetParam());
  PassTest test("gbuffer");
  test.scene(s).viewSize(kSize, kSize);
  std::set<size_t> counts;
  atFrames(test, [&](uint32_t index) {
    const auto id = test.values<uint32_t>("gbuffer.id");
    const std::vector<glm::vec4> surfaces = surfacesOf(test, "gbuffer", int(kSize));
    const scene::View& view = test.lastFrame().views[0];
    size_t box = 0, wrong = 0;
    for (uint32_t i = 0; i < id.size(); ++i) {
      const glm::dvec3 ray(view.rayDirection({i % kSize + 0.5f, i / kSize + 0.5f}));
      const RayHit hit = castRay(s, test.geometry(), glm::dvec3(view.eye), ray, {.cullSingleSided = true});
      box += hit && isBox(test.geometry(), hit.triangle);
      const uint32_t expected = hit ? test.geometry().triangles[hit.triangle].materialAndObject : ~0u;
      const glm::dvec3 got(surfaces[i]);
      wrong += id[i] != expected || (hit && glm::distance(got, glm::dvec3(view.eye) + hit.t * ray) > 1e-3);
    }
    EXPECT_LT(wrong, 12u) << "frame " << index;  // pixels on an edge
    EXPECT_EQ(box > 0, index != kAway) << "frame " << index;
    counts.insert(box);
  });
  EXPECT_GE(counts.size(), 4u);  // the object has moved
}

// What the eye sees through the centres of the pixels, found with rays.
struct Seen {
  Seen(const scene::Scene& s, const scene::Frame& frame) : geometry(*frame.geometry), view(frame.views[0]) {
    scene::moveObjects(frame, geometry);
    for (int i = 0; i < kSize * kSize; ++i) {
      const glm::dvec3 ray(view.rayDirection({float(i % kSize) + 0.5f, float(i / kSize) + 0.5f}));
      const RayHit hit = castRay(s, geometry, glm::dvec3(view.eye), ray, {.cullSingleSided = true});
      const glm::dvec3 at = hit ? glm::dvec3(view.eye) + hit.t * ray : glm::dvec3(0);
      const glm::dvec3 n = hit ? faceNormal(geometry, hit.triangle) : glm::dvec3(0);
      position.emplace_back(at, hit ? glm::distance(at, glm::dvec3(view.eye)) : 0);
      normal.push_back(glm::packHalf4x16(glm::vec4(glm::dot(n, ray) > 0 ? -n : n, 1)));
      triangle.push_back(hit ? hit.triangle : ~0u);
      id.push_back(hit ? geometry.triangles[hit.triangle].materialAndObject : ~0u);
    }
  }

  std::vector<float> distances() const { return distancesOf(scene::pixelRays(view), int(kSize), position); }

  scene::Geometry geometry;
  scene::View view;
  std::vector<glm::vec4> position;
  std::vector<uint64_t> normal;
  std::vector<uint32_t> triangle, id;
};

// Where a point of a triangle of one geometry lies in another one.
glm::dvec3 placeIn(const scene::Geometry& to, const scene::Geometry& from, uint32_t triangle,
                   glm::dvec3 point) {
  const uint32_t* v = from.triangles[triangle].v;
  const auto corner = [&](const scene::Geometry& g, int i) { return glm::dvec3(g.positions[v[i]]); };
  const glm::dvec3 a = corner(from, 0), b = corner(from, 1) - a, c = corner(from, 2) - a, p = point - a,
                   n = glm::cross(b, c);
  const double second = glm::dot(glm::cross(p, c), n) / glm::dot(n, n),
               third = glm::dot(glm::cross(b, p), n) / glm::dot(n, n);
  return (1 - second - third) * corner(to, 0) + second * corner(to, 1) + third * corner(to, 2);
}

// The pixel, between whole numbers, that showed a point of `now` before.
glm::dvec2 placeBefore(const Seen& now, const Seen& before, size_t pixel) {
  const glm::dvec3 point =
      placeIn(before.geometry, now.geometry, now.triangle[pixel], glm::dvec3(now.position[pixel]));
  const glm::dvec4 clip = glm::dmat4(before.view.worldToClip) * glm::dvec4(point, 1);
  return (0.5 * glm::dvec2(clip) / clip.w + 0.5) * double(kSize) - 0.5;
}

TEST_P(Movers, MotionVectors) {
  const scene::Scene s = movingScene(GetParam());
  std::optional<Seen> now, before;
  PassTest test("motion-vectors");
  test.scene(s).viewSize(kSize, kSize);
  const std::vector<uint64_t> normals(kSize * kSize);
  const std::vector<uint32_t> numbers(kSize * kSize);
  const std::vector<float> distances(kSize * kSize);
  for (const std::string bundle : {"gbuffer", "previous"}) {
    test.image(bundle + ".distance", VK_FORMAT_R32_SFLOAT, kSize, kSize, 1, distances);
    test.buffer(bundle + ".camera", std::vector<scene::PixelRays>(1), "PixelRays");
    test.image(bundle + ".normal", VK_FORMAT_R16G16B16A16_SFLOAT, kSize, kSize, 1, normals);
  }
  test.image("gbuffer.id", VK_FORMAT_R32_UINT, kSize, kSize, 1, numbers);
  test.image("gbuffer.triangle", VK_FORMAT_R32_UINT, kSize, kSize, 1, numbers);
  test.beforeFrame([&](PassTest& t, scene::Frame& frame) {
    before = now;
    now.emplace(s, frame);
    if (!before) before = now;
    t.set("gbuffer.distance", now->distances());
    t.set("gbuffer.camera", std::vector{scene::pixelRays(now->view)});
    t.set("gbuffer.normal", now->normal);
    t.set("gbuffer.id", now->id);
    t.set("gbuffer.triangle", now->triangle);
    t.set("previous.distance", before->distances());
    t.set("previous.camera", std::vector{scene::pixelRays(before->view)});
    t.set("previous.normal", before->normal);
  });
  atFrames(test, [&](uint32_t index) {
    const auto origin = test.values<uint32_t>("origin");
    int box = 0, lost = 0;
    double moved = 0;
    for (size_t i = 0; i < origin.size(); ++i) {
      if (now->triangle[i] == ~0u || !isBox(now->geometry, now->triangle[i])) continue;
      ++box;
      if (origin[i] == ~0u) {
        ++lost;
        continue;
      }
      const glm::dvec2 place = placeBefore(*now, *before, i), from(origin[i] & 0xffff, origin[i] >> 16);
      EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(from - place), glm::dvec2(1.01))))
          << "frame " << index << ", pixel " << i % kSize << ", " << i / kSize;
      moved = std::max(moved, glm::distance(place, glm::dvec2(i % kSize, i / kSize)));
    }
    if (index == kAway) return;
    EXPECT_GT(box, 30) << index;
    EXPECT_LT(lost, box / 4) << index;  // edges that the box has uncovered
    if (index > kAway) {
      EXPECT_GT(moved, 0.5) << index;
    }
  });
}

// A sample for each pixel. It lies on the surface that another pixel showed, and its normal is on either side of that
// surface.
std::vector<passes::Reservoir> samplesOn(const Seen& seen) {
  std::vector<passes::Reservoir> samples(kSize * kSize);
  for (size_t i = 0; i < samples.size(); ++i) {
    const size_t j = i * 37 % samples.size();
    if (seen.triangle[j] == ~0u) continue;
    passes::Reservoir& r = samples[i];
    r.position = glm::vec3(seen.position[j]);
    r.normal = (i % 2 == 0 ? 1.0f : -1.0f) * glm::vec3(faceNormal(seen.geometry, seen.triangle[j]));
    r.radiance = {1, 2, 3};
    r.count = 4;
    r.weight = 5;
    const uint32_t first = seen.geometry.staticTriangles;
    r.mover = seen.triangle[j] >= first ? float(seen.triangle[j] - first + 1) : 0;
  }
  return samples;
}

TEST_P(Movers, ReservoirsMotion) {
  const scene::Scene s = movingScene(GetParam());
  std::optional<Seen> now, before;
  std::vector<passes::Reservoir> samples(kSize * kSize);
  PassTest test("reservoirs-motion");
  test.scene(s).viewSize(kSize, kSize);
  const std::vector<uint32_t> numbers(kSize * kSize);
  test.image("previous.distance", VK_FORMAT_R32_SFLOAT, kSize, kSize, 1, numbers);
  test.buffer("previous.camera", std::vector<scene::PixelRays>(1), "PixelRays");
  test.image("previous.normal", VK_FORMAT_R16G16B16A16_SFLOAT, kSize, kSize, 1,
             std::vector<uint64_t>(kSize * kSize));
  test.image("previous.face", VK_FORMAT_R16G16_SNORM, kSize, kSize, 1, numbers);
  test.image("previous.id", VK_FORMAT_R32_UINT, kSize, kSize, 1, numbers);
  test.image("previous.triangle", VK_FORMAT_R32_UINT, kSize, kSize, 1, numbers);
  test.buffer("samples", samples, "Reservoir");
  test.beforeFrame([&](PassTest& t, scene::Frame& frame) {
    before = now;
    now.emplace(s, frame);
    if (!before) before = now;
    std::vector<uint32_t> faces;
    for (const uint64_t n : before->normal)
      faces.push_back(glm::packSnorm2x16(octEncode(glm::vec3(glm::unpackHalf4x16(n)))));
    samples = samplesOn(*before);
    t.set("previous.distance", before->distances());
    t.set("previous.camera", std::vector{scene::pixelRays(before->view)});
    t.set("previous.normal", before->normal);
    t.set("previous.face", faces);
    t.set("previous.id", before->id);
    t.set("previous.triangle", before->triangle);
    t.set("samples", samples);
  });
  atFrames(test, [&](uint32_t index) {
    const auto position = test.values<glm::vec4>("moved.position");
    const auto normal = test.values<uint64_t>("moved.normal");
    const auto face = test.values<uint32_t>("moved.face");
    const auto reservoirs = test.values<passes::Reservoir>("reservoirs");
    double moved = 0;
    // The point of a triangle and a normal there, before and now.
    const auto check = [&](uint32_t triangle, glm::vec3 from, glm::vec3 up, glm::vec3 to, glm::vec3 nowUp) {
      const glm::dvec3 place = placeIn(now->geometry, before->geometry, triangle, glm::dvec3(from)),
                       n = faceNormal(now->geometry, triangle);
      const bool same = glm::dot(glm::dvec3(up), faceNormal(before->geometry, triangle)) > 0;
      EXPECT_LT(glm::distance(place, glm::dvec3(to)), 1e-4) << "frame " << index;
      EXPECT_LT(glm::distance(same ? n : -n, glm::dvec3(nowUp)), 2e-3) << "frame " << index;
      moved = std::max(moved, glm::distance(place, glm::dvec3(from)));
    };
    int hidden = 0;
    for (size_t i = 0; i < position.size(); ++i) {
      const uint32_t triangle = before->triangle[i], sampled = before->triangle[i * 37 % position.size()];
      const bool away = index == kAway && triangle != ~0u && isBox(now->geometry, triangle);
      EXPECT_FLOAT_EQ(position[i].w, away ? 0 : before->position[i].w);
      if (triangle != ~0u && !away) {
        const glm::vec3 up(glm::unpackHalf4x16(before->normal[i]));
        check(triangle, glm::vec3(before->position[i]), up, glm::vec3(position[i]),
              glm::vec3(glm::unpackHalf4x16(normal[i])));
        check(triangle, glm::vec3(before->position[i]), up, glm::vec3(position[i]),
              scene::octDecode(glm::unpackSnorm2x16(face[i])));
      }
      const passes::Reservoir &r = reservoirs[i], &was = samples[i];
      EXPECT_EQ(r.count, was.count);
      EXPECT_EQ(r.radiance, was.radiance);
      EXPECT_EQ(r.mover, was.mover);
      const bool gone = index == kAway && was.mover > 0;
      EXPECT_EQ(r.weight, gone ? 0 : was.weight);
      hidden += gone;
      if (was.count > 0 && !gone) check(sampled, was.position, was.normal, r.position, r.normal);
    }
    EXPECT_EQ(hidden > 0, index == kAway);
    if (index > kAway) {
      EXPECT_GT(moved, 0.01) << index;
    }
  });
}

TEST_P(Movers, ShadowMap) {
  const scene::Scene s = movingScene(GetParam());
  PassTest test("shadow-map");
  test.scene(s).param("size", kSize);
  atFrames(test, [&](uint32_t index) {
    const auto depth = test.floats("maps.depth");
    const auto views = test.values<ShadowView>("maps.views");
    EXPECT_EQ(test.lastFrame().lights[1].position == s.lights[1].position, index == 0);
    for (int layer = 0; layer < 2; ++layer) {
      const glm::dmat4 worldToClip(views[size_t(layer)].worldToClip), clipToWorld = glm::inverse(worldToClip);
      size_t box = 0, wrong = 0;
      for (int i = 0; i < kSize * kSize; ++i) {
        const glm::dvec2 ndc((2 * (i % kSize) + 1.0) / kSize - 1, (2 * (i / kSize) + 1.0) / kSize - 1);
        const auto at = [&](double z) {
          const glm::dvec4 p = clipToWorld * glm::dvec4(ndc, z, 1);
          return glm::dvec3(p) / p.w;
        };
        const glm::dvec3 from = at(1), direction = at(0.001) - from;
        const RayHit hit = castRay(s, test.geometry(), from, direction);
        box += hit && isBox(test.geometry(), hit.triangle);
        const glm::dvec4 clip = worldToClip * glm::dvec4(from + (hit ? hit.t : 0) * direction, 1);
        const double expected = hit ? clip.z / clip.w : 0;
        wrong += std::abs(double(depth[size_t(layer * kSize * kSize + i)]) - expected) > 1e-3;
      }
      EXPECT_LT(wrong, size_t(kSize * kSize / 50)) << "frame " << index << " layer " << layer;
      EXPECT_EQ(box > 0, index != kAway) << "frame " << index << " layer " << layer;
    }
  });
}

TEST_P(Movers, ShadowAtlas) {
  const scene::Scene s = movingScene(GetParam());
  std::vector<scene::Vpl> vpls(2);
  vpls[0].position = {0, 0.01f, 1.5f};
  vpls[0].normal = {0, 1, 0};
  vpls[1].position = {0.2f, 1, -2.9f};
  vpls[1].normal = {0, 0, 1};
  for (scene::Vpl& v : vpls) v.intensity = glm::vec3(1);
  PassTest test("shadow-atlas");
  test.scene(s).param("size", kSize).param("refresh", "all").buffer("vpls", vpls, "Vpl");
  atFrames(test, [&](uint32_t index) {
    const auto atlas = test.values<float>("atlas");
    size_t box = 0, wrong = 0;
    for (size_t v = 0; v < vpls.size(); ++v)
      for (int i = 0; i < kSize * kSize; ++i) {
        const glm::vec3 local = scene::paraboloidTexelDirection({i % kSize, i / kSize}, kSize);
        if (local.z <= 0.02f) continue;
        const glm::vec3 direction = scene::toWorld(scene::orthonormalFrame(vpls[v].normal), local);
        const RayHit hit = castRay(s, test.geometry(), glm::dvec3(vpls[v].position), glm::dvec3(direction));
        box += hit && isBox(test.geometry(), hit.triangle);
        const float got = atlas[v * kSize * kSize + size_t(i)];
        wrong += hit ? !(std::abs(got - float(hit.t)) < 1e-3f * float(hit.t)) : !std::isinf(got);
      }
    EXPECT_LT(wrong, 8u) << "frame " << index;
    EXPECT_EQ(box > 0, index != kAway) << "frame " << index;
  });
}

TEST_P(Movers, Emit) {
  const scene::Scene s = movingScene(GetParam());
  PassTest test("emit");
  test.scene(s).param("count", 300);
  atFrames(test, [&](uint32_t index) {
    const scene::Geometry& g = test.geometry();
    const scene::RayScene rays(s, g);
    size_t box = 0;
    for (const scene::Vpl& v : test.values<scene::Vpl>("vpls")) {
      if (v.intensity == glm::vec3(0)) continue;
      // The surface it lies on is just behind it.
      const scene::RayHit hit = rays.intersect({v.position + 1e-3f * v.normal, -v.normal, 0, 2e-3f});
      ASSERT_TRUE(hit) << "frame " << index;
      box += isBox(g, hit.triangle);
    }
    EXPECT_EQ(box > 0, index != kAway) << "frame " << index;
  });
}

TEST_P(Movers, Voxels) {
  PassTest test("voxelize");
  test.scene(movingScene(GetParam())).param("resolution", 24);
  const scene::Geometry& g = test.geometry();
  atFrames(test, [&](uint32_t index) {
    const auto info = test.values<scene::VoxelInfo>("voxels.info").at(0);
    const auto sides = test.values<scene::VoxelSide>("voxels.surface");
    EXPECT_EQ(info.voxels > info.staticVoxels, index != kAway) << "frame " << index;
    glm::vec3 low(1e9f), high(-1e9f), moved(0);
    const float cell = scene::voxelGrid(g.boundsMin, g.boundsMax, 24).cell;
    for (uint32_t v = g.staticVertices(); v < g.positions.size(); ++v)
      low = glm::min(low, g.positions[v]), high = glm::max(high, g.positions[v]);
    double area = 0, expected = 0;
    for (uint32_t t = g.staticTriangles; t < g.triangles.size(); ++t) {
      const uint32_t* v = g.triangles[t].v;
      expected += 0.5 * glm::length(glm::cross(g.positions[v[1]] - g.positions[v[0]],
                                               g.positions[v[2]] - g.positions[v[0]]));
    }
    for (size_t i = 2 * size_t(info.staticVoxels); i < 2 * size_t(info.voxels); ++i) {
      if (sides[i].area == 0) continue;
      area += sides[i].area;
      EXPECT_GT(sides[i].object, 0);
      moved = glm::min(sides[i].position - low + 1e-3f, high + 1e-3f - sides[i].position);
      EXPECT_TRUE(moved.x >= 0 && moved.y >= 0 && moved.z >= 0) << "frame " << index;
      if (!GetParam()) {
        EXPECT_EQ(sides[i].triangle, 0);
        continue;
      }
      // The triangle that a VPL here is attached to belongs to the object and passes through the cell.
      const scene::Triangle& t = g.triangles.at(g.staticTriangles + size_t(sides[i].triangle));
      EXPECT_EQ(float(t.object()), sides[i].object);
      const glm::vec3 n = glm::normalize(
          glm::cross(g.positions[t.v[1]] - g.positions[t.v[0]], g.positions[t.v[2]] - g.positions[t.v[0]]));
      EXPECT_LT(std::abs(glm::dot(n, sides[i].position - g.positions[t.v[0]])), cell) << "frame " << index;
    }
    EXPECT_NEAR(area, expected, 0.01) << "frame " << index;
  });
}

}  // namespace
}  // namespace fovea::test
