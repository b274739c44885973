// Follows VPLs over the frames of a moving scene: on a rigid box they keep their place in the box, and on a waving
// cloth they keep their place in a triangle and so stay on the surface.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "framework/base/paths.h"
#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "shaders/records/vpl.h"
#include "tests/passes/ray_reference.h"
#include "tests/support/graph_run.h"
#include "tests/support/shapes.h"
#include "tests/unit/graph_support.h"

namespace fovea::test {
namespace {

using scene::VplState;

constexpr uint32_t kFrames = 24;

// Two triangles for each square of `step` x `step` quads of a net of side x side vertices.
std::vector<uint32_t> net(uint32_t side, uint32_t step) {
  std::vector<uint32_t> indices;
  for (uint32_t y = 0; y + step < side; y += step)
    for (uint32_t x = 0; x + step < side; x += step) {
      const uint32_t v = side * y + x, up = step * side;
      indices.insert(indices.end(), {v, v + step, v + up + step, v, v + up + step, v + up});
    }
  return indices;
}

// A cloth of 16 x 16 quads that waves in front of a wall. If `coarse`, voxels and VPL maps see 4 x 4 of them.
void addCloth(scene::Scene& s, uint32_t material, bool coarse) {
  scene::Primitive p;
  p.material = material;
  scene::MorphTarget wave[2];
  constexpr int kSide = 17;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const float u = float(x) / (kSide - 1), v = float(y) / (kSide - 1);
      p.positions.emplace_back(1.6f * u - 1.7f, 1.6f * v + 0.2f, -0.6f);
      p.normals.emplace_back(0, 0, 1);
      p.uvs.emplace_back(u, v);
      wave[0].positions.emplace_back(0.1f * v, 0, 0.25f * std::sin(7 * u + 2 * v));
      wave[1].positions.emplace_back(0, 0.1f * u, 0.25f * std::cos(6 * u - 3 * v));
    }
  p.indices = net(kSide, 1);
  if (coarse) p.lightIndices = net(kSide, 4);
  p.targets = {wave[0], wave[1]};
  addPrimitive(s, std::move(p));
  scene::Animation a;
  a.plays = true;
  a.channels = {{uint32_t(s.nodes.size() - 1),
                 scene::AnimationChannel::Path::Weights,
                 scene::AnimationChannel::Interpolation::Linear,
                 {0, 0.4f, 0.8f, 1.2f},
                 {0, 0, 1, 0.2f, -0.2f, 1, 0, 0}}};
  s.animations = {a};
}

// A room without its front wall, with the cloth on the left and a box that slides and turns on the right.
scene::Scene waving(bool coarse = false) {
  scene::Scene s;
  s.materials.clear();
  uint32_t m[6];
  for (uint32_t& material : m) material = addMaterial(s, glm::vec3(0.6f));
  addRoom(s, m, 2);
  s.nodes.pop_back();  // +z is open
  const uint32_t root = uint32_t(s.nodes.size());
  scene::Node node;
  node.dynamic = true;
  s.nodes.push_back(node);
  addBox(s, addMaterial(s, {0.8f, 0.6f, 0.1f}), {-0.6f, -0.6f, -0.6f}, {0.6f, 0.6f, 0.6f});
  for (size_t i = root + 1; i < s.nodes.size(); ++i) s.nodes[i].parent = root;
  const auto turned = [](float deg) {
    return glm::angleAxis(glm::radians(deg), glm::vec3(0.2f, 0.9f, 0.3f));
  };
  s.movers = {{root,
               true,
               scene::Repeat::Once,
               {{0, {0.9f, -0.6f, 0}, glm::normalize(turned(0)), true},
                {1, {0.4f, 0.2f, 0.3f}, glm::normalize(turned(50)), true}}}};
  addCloth(s, addMaterial(s, {0.2f, 0.5f, 0.8f}), coarse);
  s.materials.back().doubleSided = true;
  scene::Light lamp;
  lamp.type = scene::LightType::Point;
  lamp.position = {0, 1.5f, 1.5f};
  lamp.intensity = 20;
  s.lights = {lamp};
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 0, 5};
  return s;
}

// `ours` with the state that it keeps of its VPLs as one more output.
std::string graphWithState() {
  static const graph::test::TempFolder folder;  // tests run in parallel, so each has its own
  for (const auto& graphs : dataFolders("graphs")) {
    std::error_code ec;
    if (!std::filesystem::exists(graphs / "ours.json", ec)) continue;
    return folder
        .write("ours_state.json",
               R"({"extends": ")" + (graphs / "ours.json").string() + R"(", "outputs": {"state": "manage"}})")
        .string();
  }
  return {};
}

double distanceToTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                          const glm::dvec3& c) {
  const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
  const glm::dvec3 q = p - glm::dot(p - a, n) * n;
  const auto inside = [&](const glm::dvec3& u, const glm::dvec3& v) {
    return glm::dot(glm::cross(v - u, q - u), n) >= 0;
  };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(glm::dot(p - a, n));
  const auto toEdge = [&](const glm::dvec3& u, const glm::dvec3& v) {
    const double t = glm::clamp(glm::dot(p - u, v - u) / glm::dot(v - u, v - u), 0.0, 1.0);
    return glm::distance(p, u + t * (v - u));
  };
  return std::min({toEdge(a, b), toEdge(b, c), toEdge(c, a)});
}

void expectVplsToFollow(const scene::Scene& s) {
  scene::Geometry g = scene::flatten(s);
  std::vector<scene::Frame> frames;
  GraphRunOptions options;
  options.size = {64, 64};
  options.frames = kFrames;
  options.everyFrame = true;
  options.outputs = {"state"};
  options.set = {"vpl_count=300", "voxels=32", "attempts=1500", "region=image"};
  options.beforeFrame = [&](scene::Frame& frame) { frames.push_back(frame); };
  const GraphRun run = runGraph(graphWithState(), s, options);
  ASSERT_EQ(run.frames.size(), kFrames);
  std::vector<VplState> before;
  size_t onBox = 0, onCloth = 0, kept[2] = {0, 0};
  float oldest[2] = {0, 0};
  for (uint32_t f = 0; f < kFrames; ++f) {
    frames[f].scene = &s;  // the run had a copy of it
    scene::moveObjects(frames[f], g);
    const auto& bytes = run.frames[f].outputs.at("state").bytes;
    std::vector<VplState> now(bytes.size() / sizeof(VplState));
    std::memcpy(now.data(), bytes.data(), bytes.size());
    for (size_t i = 0; i < now.size(); ++i) {
      const VplState& v = now[i];
      if (v.life == 0 || v.object == 0) continue;
      const size_t object = size_t(v.object);
      const bool cloth = g.objects[object].deforms;
      (cloth ? onCloth : onBox) += 1;
      oldest[cloth] = std::max(oldest[cloth], v.life);
      if (cloth) {
        ASSERT_LT(v.localPosition.x, float(g.light().end - g.light().firstMoving));
        const scene::Triangle& t = g.triangle(g.light().firstMoving + uint32_t(v.localPosition.x));
        ASSERT_EQ(t.object(), object) << f << " " << i;
        const glm::dvec3 a(g.positions[t.v[0]]), b(g.positions[t.v[1]]), c(g.positions[t.v[2]]);
        ASSERT_LT(distanceToTriangle(glm::dvec3(v.position), a, b, c), 1e-4) << f << " " << i;
      } else {
        const glm::vec3 local = frames[f].objects[object].intoObject(v.position);
        ASSERT_LT(glm::distance(local, v.localPosition), 1e-4f) << f << " " << i;
      }
      if (before.empty() || v.life != before[i].life + 1 || before[i].object != v.object) continue;
      ++kept[cloth];
      ASSERT_EQ(v.localPosition, before[i].localPosition) << f << " " << i;
      ASSERT_EQ(v.localNormal, before[i].localNormal) << f << " " << i;
    }
    before = std::move(now);
  }
  for (const bool cloth : {false, true}) {
    EXPECT_GT(kept[cloth], (cloth ? onCloth : onBox) / 2) << (cloth ? "cloth" : "box");
    EXPECT_GE(oldest[cloth], 8) << (cloth ? "cloth" : "box");
  }
  EXPECT_GT(onBox, 20u * kFrames / 4);
  EXPECT_GT(onCloth, 20u * kFrames / 4);
  std::printf("VPLs a frame: %.1f on the box (%.0f%% of them older), %.1f on the cloth (%.0f%%)\n",
              double(onBox) / kFrames, 100.0 * double(kept[0]) / double(onBox), double(onCloth) / kFrames,
              100.0 * double(kept[1]) / double(onCloth));
}

TEST(Follow, VplsStayOnWhatMoves) { expectVplsToFollow(waving()); }

TEST(Follow, VplsStayOnTheCoarserSurfaceThatVoxelsSee) { expectVplsToFollow(waving(true)); }

// The values that light-inject keeps from the previous frame equal those that it would compute again, also in the
// shadow of a cloth.
TEST(Follow, LightAroundAClothIsKeptOnlyWhereItStays) {
  GraphRunOptions options;
  options.size = {48, 48};
  options.frames = 8;
  options.everyFrame = true;
  options.set = {"vpl_count=64", "attempts=128", "voxels=32", "map_size=16", "shadow_map_size=256"};
  const GraphRun kept = runGraph("ours", waving(), options);
  options.set.push_back("light-inject.keep=false");
  const GraphRun anew = runGraph("ours", waving(), options);
  for (uint32_t i = 0; i < options.frames; ++i)
    for (const auto& [name, data] : kept.frames[i].outputs)
      EXPECT_TRUE(toFloats(data) == toFloats(anew.frames[i].outputs.at(name))) << name << ", frame " << i;
}

}  // namespace
}  // namespace fovea::test
