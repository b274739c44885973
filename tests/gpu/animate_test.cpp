// Compares the vertices that the device computes for a frame with moveObjects(): rigid objects, morph targets,
// joints, control cages, and the positions of the previous frame.
#include <gtest/gtest.h>

#include <cmath>

#include "fovea/error.h"
#include "framework/gpu/resources.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/frame.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "framework/scene/subdivision/subdivision.h"
#include "framework/session/test_device.h"
#include "tests/gpu/command_helpers.h"
#include "tests/gpu/scene_queries.h"
#include "tests/references/octahedral.h"
#include "tests/support/shapes.h"

namespace fovea::scene {
namespace {

using fovea::scene::octDecode;
using fovea::test::as;
using fovea::test::testDevice;
using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

struct Vertices {
  std::vector<glm::vec4> positions, attributes, previous;
};

Vertices evaluate(GpuScene& gpu, const Frame& frame, uint32_t slot) {
  gpu.update(frame, slot);
  testDevice().runOnce([&](VkCommandBuffer cmd) { gpu.recordMoves(cmd, slot); });
  return {as<glm::vec4>(gpu::download(testDevice(), gpu.positions())),
          as<glm::vec4>(gpu::download(testDevice(), gpu.attributes())),
          as<glm::vec4>(gpu::download(testDevice(), gpu.previous()))};
}

// Checks every vertex, its normal and its previous position over a row of frames that contains a jump.
void compare(const Scene& scene) {
  Geometry now = flatten(scene), before = now;
  const Geometry rest = now;
  ASSERT_LT(now.staticVertices(), now.positions.size());
  GpuScene gpu(testDevice(), scene, rest, 2);
  EXPECT_TRUE(gpu.moves());
  const float size = glm::length(now.boundsMax - now.boundsMin);
  const uint64_t indices[] = {0, 1, 2, 17, 18, 40};
  uint32_t slot = 0;
  for (uint64_t index : indices) {
    const Frame frame = makeFrame(scene, rest, {8, 8}, index, 1);
    moveObjects(frame, now);
    moveObjects(makeFrame(scene, rest, {8, 8}, index == 0 ? 0 : index - 1, 1), before);
    const Vertices v = evaluate(gpu, frame, slot ^= 1);
    for (size_t i = 0; i < now.positions.size(); ++i) {
      ASSERT_LT(glm::distance(glm::vec3(v.positions[i]), now.positions[i]), 1e-5f * size)
          << index << " " << i;
      ASSERT_LT(glm::distance(octDecode(glm::vec2(v.attributes[i])), now.normals[i]), 2e-5f)
          << index << " " << i;
      ASSERT_EQ(glm::vec2(v.attributes[i].z, v.attributes[i].w), now.uvs[i]);
      ASSERT_EQ(v.positions[i].w, now.colors.empty() ? 1.0f : now.colors[i].a);
    }
    for (size_t i = now.staticVertices(); i < now.positions.size(); ++i)
      ASSERT_LT(glm::distance(glm::vec3(v.previous[i - now.staticVertices()]), before.positions[i]),
                1e-5f * size)
          << index << " " << i;
  }
}

// A still floor, a mover that vanishes for a while, and a sheet on three joints with a morph target.
Scene handmade() {
  Scene s;
  test::addMaterial(s, glm::vec3(0.5f));
  test::addQuad(s, 0, {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
  test::addQuad(s, 0, {0, 1, 0}, {1, 0, 0}, {0, 1, 0});
  s.nodes[1].scale = {1, -2, 0.5f};
  s.movers = {{1,
               true,
               Repeat::Once,
               {{0, {0, 0, 0}, {1, 0, 0, 0}, true},
                {0.4f, {1, 2, 0}, {0, 0, 1, 0}, false},
                {0.9f, {2, 0, 0}, {1, 0, 0, 0}, true}}}};
  s.nodes[1].dynamic = true;
  Primitive p;
  MorphTarget bulge;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 4; ++x) {
      p.positions.emplace_back(x, y, 0);
      p.normals.emplace_back(0, 0, 1);
      p.uvs.emplace_back(0.25f * float(x), 0.2f * float(y));
      bulge.positions.emplace_back(0, 0, std::sin(float(x + y)));
      bulge.normals.emplace_back(0.1f * float(x), 0.1f * float(y), 0);
      p.joints.emplace_back(uint16_t(y / 2), uint16_t(y < 2 ? 1 : 0), 0, 0);
      p.weights.emplace_back(0.5f, 0.25f, 0, 0);
      p.colors.emplace_back(1, 1, 1, 0.05f * float(p.positions.size()));
    }
  for (int i = 0; i < 20; ++i) {  // a second set of joints
    p.joints.emplace_back(uint16_t(i % 3), uint16_t(2), 0, 0);
    p.weights.emplace_back(0.125f, 0.125f, 0, 0);
  }
  for (uint32_t y = 0; y < 4; ++y)
    for (uint32_t x = 0; x < 3; ++x) {
      const uint32_t v = 4 * y + x;
      p.indices.insert(p.indices.end(), {v, v + 1, v + 5, v, v + 5, v + 4});
    }
  p.targets = {bulge, {}};
  Primitive stiff = p;  // of the same mesh, without joints
  stiff.joints.clear();
  stiff.weights.clear();
  s.meshes.push_back({"sheet", {p, stiff}, {0.5f, 1}});
  s.skins.push_back({"skin", {}, {}});
  for (uint32_t j = 0; j < 3; ++j) {
    Node joint;
    joint.parent = j == 0 ? kNoIndex : uint32_t(s.nodes.size() - 1);
    joint.translation = {0, 1, 0.1f};
    s.skins[0].joints.push_back(uint32_t(s.nodes.size()));
    glm::mat4 bind(1.0f);
    bind[3] = glm::vec4(0, -float(j), 0.2f, 1);
    s.skins[0].inverseBind.push_back(bind);
    s.nodes.push_back(joint);
  }
  Node sheet;
  sheet.mesh = 2, sheet.skin = 0;
  sheet.translation = {5, 5, 5};
  s.nodes.push_back(sheet);
  Animation a;
  a.plays = true;
  a.channels = {{3, Path::Rotation, Interpolation::Linear, {0, 1}, {0, 0, 0, 1, 0, 0.6f, 0, 0.8f}},
                {4, Path::Scale, Interpolation::Linear, {0, 0.7f}, {1, 1, 1, 2, 0.5f, -1}},
                {5, Path::Weights, Interpolation::Linear, {0, 0.5f, 1}, {0, 0, 1, 0.5f, 0.2f, 1}}};
  s.animations = {a};
  s.cameras.emplace_back();
  return s;
}

TEST(Animate, EqualsTheCpuEvaluator) { compare(handmade()); }

TEST(Animate, CagesToo) {
  Scene s = handmade();
  auto cage = std::make_shared<SubdivisionCage>();
  MorphTarget wave;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) {
      cage->positions.emplace_back(x, y, 0);
      wave.positions.emplace_back(0, 0, std::cos(float(x * y)));
      cage->joints.emplace_back(uint16_t(y % 3), uint16_t(x % 3), 0, 0);
      cage->weights.emplace_back(0.6f, 0.4f, 0, 0);
    }
  for (uint32_t y = 0; y < 4; ++y)
    for (uint32_t x = 0; x < 4; ++x) {
      const uint32_t v = 5 * y + x;
      cage->faceSizes.push_back(4);
      cage->faceVertices.insert(cage->faceVertices.end(), {v, v + 1, v + 6, v + 5});
    }
  cage->targets = {wave};
  const uint32_t mesh = uint32_t(s.meshes.size()), node = uint32_t(s.nodes.size());
  s.meshes.push_back({"cloth", {}, {}, cage});
  s.nodes.push_back({});
  s.nodes.back().mesh = mesh;
  s.nodes.back().scale = {1, 1, -2};  // mirrored; no skin
  s.nodes.push_back({});
  s.nodes.back().mesh = mesh;
  s.nodes.back().skin = 0;
  for (uint32_t n : {node, node + 1})
    s.animations[0].channels.push_back({n, Path::Weights, Interpolation::Linear, {0, 1}, {0, 1}});
  try {
    refineCages(s);
  } catch (const Error& e) {
    GTEST_SKIP() << e.what();  // built without OpenSubdiv
  }
  compare(s);
}

TEST(Animate, ModelsOfOthers) {
  const char* files[] = {"conformance/valid/own/skin_two_arms.glb",
                         "conformance/valid/own/sparse_morph.gltf",
                         "conformance/valid/own/interpolation.gltf",
                         "conformance/valid/CesiumMan/glTF-Binary/CesiumMan.glb",
                         "pigman/pigman.glb",
                         "neko_diorama/neko_diorama.gltf"};
  size_t found = 0;
  for (const char* file : files)
    for (const auto& folder : modelSearchPath()) {
      if (!std::filesystem::exists(folder / file)) continue;
      SCOPED_TRACE(file);
      Diagnostics warnings;
      Scene s = loadGltf(folder / file, warnings);
      s.textures.clear();  // only the shape is looked at
      for (Material& m : s.materials) m.baseColorTexture = m.emissionTexture = {};
      if (s.cameras.empty()) s.cameras.emplace_back();
      compare(s);
      ++found;
      break;
    }
  if (found == 0) GTEST_SKIP() << "the shared test models are not here";
}

// What a frame does not mention stays where it is at time 0.
TEST(Animate, WithoutPosesThingsRest) {
  const Scene s = handmade();
  const Geometry g = flatten(s);
  GpuScene gpu(testDevice(), s, g, 1);
  const Vertices v = evaluate(gpu, Frame{}, 0);
  for (size_t i = 0; i < g.positions.size(); ++i)
    ASSERT_LT(glm::distance(glm::vec3(v.positions[i]), g.positions[i]), 1e-5f) << i;
}

// ---- Points attached to a triangle (scene/scene.glsl) ----------------------------------------------------

// Results of attach() and its relatives for points around the triangles that come after the static ones, among those
// that voxels see. With `coarse`, these differ from the triangles of the picture.
void attachAndCompare(bool coarse) {
  Scene s;
  test::addMaterial(s, glm::vec3(0.5f));
  test::addQuad(s, 0, {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
  Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0.2f}, {0.3f, 0.9f, 0}, {2, 1, 0.5f}};
  p.normals.assign(4, {0, 0, 1});
  p.uvs.assign(4, {0, 0});
  p.indices = {0, 1, 2, 2, 1, 3};
  if (coarse) p.lightIndices = {1, 3, 0, 3, 2, 0};
  MorphTarget bend;
  bend.positions = {{0, 0, 1}, {0.2f, 0.1f, 0}, {0, 0, -0.5f}, {0.5f, 0.5f, 0.5f}};
  p.targets = {bend};
  test::addPrimitive(s, p);
  Animation a;
  a.plays = true;
  a.channels = {{1, Path::Weights, Interpolation::Linear, {0, 1}, {0, 1}}};
  s.animations = {a};
  const Geometry g = flatten(s);
  ASSERT_EQ(g.objects.size(), 2u);
  Frame frame = makeFrame(s, g, {8, 8}, 20, 1);
  Geometry now = g;
  moveObjects(frame, now);
  GpuScene gpu(testDevice(), s, g, 1);
  std::vector<glm::vec4> queries;
  for (int i = 0; i < 400; ++i)
    queries.emplace_back(std::fmod(0.37f * float(i), 4.0f) - 1, std::fmod(0.73f * float(i), 3.0f) - 1,
                         std::fmod(0.91f * float(i), 2.0f) - 1, float(i % 2));
  const auto results = test::evaluate(gpu, frame, queries, R"(
    uint triangle = uint(q.w);
    vec3 place = attach(triangle, q.xyz);
    r[0] = vec4(place, objectDeforms(1u) && !objectDeforms(0u) ? 1.0 : 0.0);
    r[1] = vec4(attachedPosition(place), 0.0);
    mat3 axes = triangleAxes(triangle);
    r[2] = vec4(axes[2], length(transpose(axes) * axes[0] - vec3(1.0, 0.0, 0.0)));
  )");
  for (size_t i = 0; i < queries.size(); ++i) {
    const Triangle& t = now.triangle(now.light().firstMoving + uint32_t(queries[i].w));
    const glm::vec3 a0 = now.positions[t.v[0]], b = now.positions[t.v[1]], c = now.positions[t.v[2]];
    const glm::vec3 place(results[3 * i]), at(results[3 * i + 1]), point(queries[i]);
    EXPECT_EQ(results[3 * i].w, 1.0f);
    EXPECT_EQ(place.x, queries[i].w);
    EXPECT_TRUE(place.y >= 0 && place.z >= 0 && place.y + place.z <= 1 + 1e-5f) << i;
    EXPECT_LT(glm::distance(at, a0 + place.y * (b - a0) + place.z * (c - a0)), 1e-5f);
    float nearest = 1e9f;  // of a fine net of points in the triangle
    for (int u = 0; u <= 50; ++u)
      for (int v = 0; v + u <= 50; ++v)
        nearest =
            std::min(nearest, glm::distance(point, a0 + float(u) / 50 * (b - a0) + float(v) / 50 * (c - a0)));
    EXPECT_LT(glm::distance(point, at), nearest + 1e-5f) << i;
    EXPECT_LT(glm::distance(glm::vec3(results[3 * i + 2]), glm::normalize(glm::cross(b - a0, c - a0))),
              1e-5f);
    EXPECT_LT(results[3 * i + 2].w, 1e-5f);
  }
}

TEST(Attach, FindsTheNearestPointAndFollows) { attachAndCompare(false); }

TEST(Attach, ToTheCoarserTrianglesThatVoxelsSee) { attachAndCompare(true); }

}  // namespace
}  // namespace fovea::scene
