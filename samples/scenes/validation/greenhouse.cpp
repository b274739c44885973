// A small greenhouse on a sunny morning: a frame of thin white bars without panes, benches of slats with many pots, and
// leaves everywhere. The leaves near the viewer are modelled; the hedge around the garden has masked cards.
#include <cmath>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr float kX = 2.1f, kBack = -4.2f, kFront = 3.0f, kSill = 0.62f, kEave = 2.15f, kRidge = 3.25f;

struct Palette {
  uint32_t brick, paint, path, gravel, lawn, slat, clay, soil, leaf[3], bark, card, hedge, bloom[3], zinc,
      lemon, wicker;
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 1201);
  MasonryLook bricks;
  bricks.columns = 4;
  bricks.rows = 12;
  bricks.low = {0.38f, 0.15f, 0.09f};
  bricks.high = {0.58f, 0.28f, 0.17f};
  bricks.jointColor = {0.55f, 0.51f, 0.45f};
  p.brick = b.material("bricks", glm::vec3(1),
                       {.texture = b.texture(masonry("bricks", bricks, 512, 512, 1211)), .metres = 0.92f});
  MasonryLook flags;
  flags.columns = 3;
  flags.rows = 4;
  flags.low = {0.44f, 0.41f, 0.36f};
  flags.high = {0.60f, 0.56f, 0.49f};
  p.path = b.material("flags", glm::vec3(1),
                      {.texture = b.texture(masonry("flags", flags, 512, 512, 1212)), .metres = 1.5f});
  p.gravel =
      b.material("gravel", {0.62f, 0.57f, 0.49f},
                 {.texture = b.texture(ground("gravel", glm::vec3(0.6f), glm::vec3(0.95f), 0.3f, 512, 1213)),
                  .metres = 1.6f});
  p.lawn = b.material(
      "lawn", glm::vec3(1),
      {.texture = b.texture(ground("lawn", {0.10f, 0.20f, 0.04f}, {0.20f, 0.33f, 0.08f}, 0.2f, 512, 1214)),
       .metres = 2.5f});
  p.paint = b.material("white paint", {0.80f, 0.80f, 0.77f});
  p.slat = b.material("grey slats", {0.52f, 0.47f, 0.40f},
                      {.texture = s.grain, .metres = 0.4f, .metresHigh = 1.4f});
  p.clay = b.material("terracotta", {0.66f, 0.31f, 0.18f}, {.texture = s.mottled, .metres = 0.4f});
  p.soil = b.material("soil", {0.07f, 0.05f, 0.035f});
  p.leaf[0] = b.material("leaves", {0.12f, 0.31f, 0.07f}, {.doubleSided = true});
  p.leaf[1] = b.material("pale leaves", {0.27f, 0.40f, 0.15f}, {.doubleSided = true});
  p.leaf[2] = b.material("dark leaves", {0.06f, 0.20f, 0.08f}, {.doubleSided = true});
  p.bark = b.material("bark", {0.27f, 0.20f, 0.13f});
  p.card = b.material("hedge cards", glm::vec3(1),
                      {.texture = b.texture(foliage("hedge leaves", {0.07f, 0.17f, 0.04f},
                                                    {0.20f, 0.34f, 0.08f}, 0.55f, 512, 1215)),
                       .metres = 1.2f,
                       .doubleSided = true,
                       .alphaCutoff = 0.5f});
  p.hedge = b.material("inside of the hedge", {0.05f, 0.11f, 0.03f});
  const glm::vec3 blooms[3] = {{0.78f, 0.06f, 0.08f}, {0.82f, 0.30f, 0.52f}, {0.84f, 0.62f, 0.10f}};
  for (int i = 0; i < 3; ++i)
    p.bloom[i] = b.material("petals " + std::to_string(i + 1), blooms[i], {.doubleSided = true});
  p.zinc = b.material("zinc", {0.46f, 0.48f, 0.49f});
  p.lemon = b.material("lemons", {0.86f, 0.68f, 0.06f});
  p.wicker = b.material("wicker", {0.56f, 0.38f, 0.20f}, {.texture = s.mottled, .metres = 0.2f});
  return p;
}

void addGarden(MeshBuilder& m, const Palette& p) {
  m.add(p.lawn, box({-9, -0.4f, -11}, {9, -0.04f, 9}));
  m.add(p.gravel, box({-kX + 0.05f, -0.3f, kBack + 0.05f}, {kX - 0.05f, 0, kFront - 0.05f}));
  m.add(p.path, box({-0.55f, -0.2f, kBack + 0.12f}, {0.55f, 0.012f, kFront + 5}, {.bevel = 0.004f}));
  const struct {
    glm::vec2 low, high;
  } hedges[4] = {
      {{-9, -11}, {9, -10}}, {{-9, 8}, {9, 9}}, {{-9, -10.5f}, {-8, 8.5f}}, {{8, -10.5f}, {9, 8.5f}}};
  uint32_t k = 0;
  for (const auto& h : hedges) {
    m.add(p.hedge, box({h.low.x, -0.1f, h.low.y}, {h.high.x, 2.3f, h.high.y}));
    const glm::vec2 size = h.high - h.low;
    for (int i = 0; i < 260; ++i, ++k) {
      const glm::vec2 q = h.low - 0.12f + (size + 0.24f) * glm::vec2(random(1221, k), random(1222, k));
      const Sheet card = sheet(1, 1, {0.9f, 0.9f}, [&](float u, float v) {
        return glm::vec3(0.9f * (u - 0.5f), 0.9f * (0.5f - v), 0);
      });
      Shape one = surface(card);
      for (glm::vec2& uv : one.uvs) uv += glm::vec2(random(1223, k), random(1224, k));
      m.add(p.card, one,
            at(q.x, random(1225, k, 0.3f, 2.5f), q.y) * turnY(random(1226, k, 0, 180)) *
                turnX(random(1227, k, -35, 35)));
    }
  }
}

// A bar of `width` from a to b whose ends are hidden in other bars.
void addBar(MeshBuilder& m, const Palette& p, glm::vec3 a, glm::vec3 b, float width) {
  m.add(p.paint, sweep({a, b}, rectangle(width, 1.6f * width)));
}

void addFrame(MeshBuilder& m, const Palette& p) {
  const float t = 0.11f;
  for (const float side : {-1.0f, 1.0f})
    m.add(p.brick, box({side * kX - t, -0.3f, kBack - t}, {side * kX + t, kSill, kFront + t}));
  m.add(p.brick, box({-kX, -0.3f, kBack - t + 0.002f}, {kX, kSill - 0.001f, kBack + t}));
  for (const float side : {-1.0f, 1.0f})
    m.add(p.brick, box({std::min(side * 0.55f, side * kX), -0.3f, kFront - t},
                       {std::max(side * 0.55f, side * kX), kSill - 0.001f, kFront + t - 0.002f}));
  for (const float side : {-1.0f, 1.0f}) {
    const float x = side * kX;
    m.add(p.paint, box({x - 0.14f, kSill - 0.002f, kBack - 0.14f},
                       {x + 0.14f, kSill + 0.035f, kFront + 0.14f}, {.bevel = 0.006f}));
    m.add(p.paint,
          box({x - 0.045f, kEave - 0.05f, kBack - 0.05f}, {x + 0.045f, kEave + 0.05f, kFront + 0.05f}));
    addBar(m, p, {x, 1.45f, kBack}, {x, 1.45f, kFront}, 0.022f);
    const int bars = 12;
    for (int i = 0; i <= bars; ++i) {
      const float z = kBack + (kFront - kBack) * float(i) / bars, w = i % 4 == 0 ? 0.05f : 0.022f;
      addBar(m, p, {x, kSill, z}, {x, kEave, z}, w);
      addBar(m, p, {x, kEave, z}, {0, kRidge, z}, w);
    }
    for (const float f : {0.33f, 0.67f}) {
      const glm::vec3 q(x * (1 - f), glm::mix(kEave, kRidge, f), 0);
      addBar(m, p, q + glm::vec3(0, 0, kBack), q + glm::vec3(0, 0, kFront), 0.022f);
    }
  }
  addBar(m, p, {0, kRidge, kBack - 0.05f}, {0, kRidge, kFront + 0.05f}, 0.07f);
  for (const float z : {kBack, kFront}) {
    m.add(p.paint, box({-kX, kEave - 0.03f, z - 0.03f}, {kX, kEave + 0.03f, z + 0.03f}));
    for (int i = 1; i < 8; ++i) {
      const float x = -kX + 2 * kX * float(i) / 8, top = glm::mix(kRidge, kEave, std::abs(x) / kX);
      addBar(m, p, {x, z == kFront && std::abs(x) < 0.3f ? kEave : 0.6f, z}, {x, top, z}, 0.022f);
    }
  }
  m.add(p.paint, box({-kX, kSill - 0.001f, kBack - 0.138f}, {kX, kSill + 0.033f, kBack + 0.138f}));
}

void addBench(MeshBuilder& m, const Palette& p, float x, float low, float high, float y) {
  for (int i = 0; i < 7; ++i)
    m.add(p.slat, box({x - 0.36f + 0.105f * float(i), y - 0.025f, low},
                      {x - 0.29f + 0.105f * float(i), y, high}, {.bevel = 0.004f}));
  const int legs = 4;
  for (int i = 0; i < legs; ++i) {
    const float z = low + 0.2f + (high - low - 0.4f) * float(i) / float(legs - 1);
    m.add(p.slat, box({x - 0.36f, y - 0.09f, z - 0.03f}, {x + 0.34f, y - 0.024f, z + 0.03f}));
    for (const float s : {-0.32f, 0.30f})
      m.add(p.slat, box({x + s - 0.025f, -0.05f, z - 0.025f}, {x + s + 0.025f, y - 0.089f, z + 0.025f}));
  }
}

// One of six kinds of potted plants.
void addPlant(MeshBuilder& m, const Palette& p, int kind, float size, uint32_t seed, const glm::mat4& where) {
  const float r = 0.11f * size, h = 0.20f * size;
  addPot(m, p.clay, p.soil, r, h, where);
  const glm::mat4 top = where * at(0, 0.88f * h, 0) * scaled(size);
  if (kind == 0) {
    m.add(p.leaf[0],
          rosette(22, {.length = 0.42f, .width = 0.05f, .fold = 0.5f, .droop = 0.45f, .steps = 4}, 65, seed),
          top);
  } else if (kind == 1) {
    const Plant q = bush({0.20f, 0.26f, 0.20f}, 26, 12, {.length = 0.075f, .width = 0.04f}, seed);
    m.add(p.leaf[1], q.leaves, top).add(p.bark, q.wood, top);
  } else if (kind == 2) {
    const Plant q = flowers({0.17f, 0.24f, 0.17f}, 12, 0.035f, 26, seed);
    m.add(p.leaf[0], q.leaves, top).add(p.leaf[2], q.wood, top).add(p.bloom[seed % 3], q.fruits, top);
  } else if (kind == 3) {
    m.add(p.leaf[2],
          rosette(34, {.length = 0.24f, .width = 0.07f, .fold = 0.6f, .droop = 0.1f, .steps = 3}, 70, seed),
          top);
  } else if (kind == 4) {
    const Plant q = bush({0.14f, 0.42f, 0.14f}, 22, 14, {.length = 0.055f, .width = 0.035f}, seed);
    m.add(p.leaf[2], q.leaves, top).add(p.bark, q.wood, top);
  } else {
    const Plant q = tree({.trunkHeight = 0.38f,
                          .trunkRadius = 0.014f,
                          .crown = {0.20f, 0.19f, 0.20f},
                          .boughs = 5,
                          .twigs = 60,
                          .leavesPerTwig = 6,
                          .twigLength = 0.09f,
                          .leaf = {.length = 0.055f, .width = 0.028f},
                          .fruits = 7,
                          .fruitRadius = 0.022f,
                          .seed = seed});
    m.add(p.leaf[0], q.leaves, top).add(p.bark, q.wood, top).add(p.lemon, q.fruits, top);
  }
}

MeshBuilder basket(const Palette& p) {  // hangs from the origin
  MeshBuilder m;
  Outline bowl({0, -0.78f});
  bowl.arc(0.19f, -0.62f, 0.45f, 8).line(0.175f, -0.61f).line(0, -0.64f);
  m.add(p.wicker, lathe(bowl, {.segments = 40}));
  for (int i = 0; i < 3; ++i)
    m.add(p.zinc, tube({{0, 0, 0}, {0.183f, -0.615f, 0}}, 0.0035f, 6), turnY(120 * float(i)));
  const Plant fall = trailing(14, 0.55f, 0.2f, {.length = 0.05f, .width = 0.035f}, 1241);
  for (int i = 0; i < 4; ++i)
    m.add(p.leaf[1], fall.leaves, turnY(90 * float(i)) * at(0, -0.62f, 0.14f))
        .add(p.bark, fall.wood, turnY(90 * float(i)) * at(0, -0.62f, 0.14f));
  const Plant bloom = flowers({0.2f, 0.2f, 0.2f}, 18, 0.035f, 26, 1242);
  m.add(p.leaf[0], bloom.leaves, at(0, -0.63f, 0))
      .add(p.leaf[2], bloom.wood, at(0, -0.63f, 0))
      .add(p.bloom[1], bloom.fruits, at(0, -0.63f, 0));
  return m;
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  addBench(m, p, -1.48f, kBack + 0.3f, kFront - 0.5f, 0.74f);
  addBench(m, p, 1.45f, kBack + 0.3f, kFront - 1.6f, 0.74f);
  uint32_t k = 0;
  for (const float side : {-1.0f, 1.0f})
    for (int row = 0; row < 2; ++row)
      for (int i = 0; i < (side < 0 ? 13 : 10); ++i, ++k) {
        if (random(1231, k) < 0.14f) continue;
        const float x = side * (row == 0 ? 1.62f : 1.30f) + random(1232, k, -0.04f, 0.04f);
        const float z = kBack + 0.55f + 0.47f * float(i) + random(1233, k, -0.08f, 0.08f);
        addPlant(m, p, int(random(1234, k) * 5.99f),
                 random(1235, k, row == 0 ? 1.0f : 0.75f, row == 0 ? 1.35f : 1.0f), 1300 + k,
                 at(x, 0.74f, z) * turnY(random(1236, k, 0, 360)));
      }
  // Large plants at the end of the path and under the benches.
  for (const float x : {-0.85f, 0.9f}) {
    addPot(m, p.clay, p.soil, 0.24f, 0.4f, at(x, 0, kBack + 0.55f));
    m.add(p.leaf[x < 0 ? 0 : 2],
          rosette(26, {.length = 1.5f, .width = 0.26f, .fold = 0.3f, .droop = 0.4f, .steps = 7}, 48,
                  x < 0 ? 1251u : 1252u),
          at(x, 0.35f, kBack + 0.55f));
  }
  addPlant(m, p, 5, 2.3f, 1253, at(0.02f, 0.012f, kBack + 0.75f));
  for (int i = 0; i < 6; ++i)
    addPlant(m, p, i % 4, 1.2f, 1260 + uint32_t(i),
             at(i % 2 == 0 ? -1.35f : 1.3f, 0, -3.2f + 0.9f * float(i)));
  const Plant vine = climber(smoothPath({{-1.9f, 0.7f, kBack + 0.1f},
                                         {-1.6f, 1.6f, kBack + 0.1f},
                                         {-0.8f, 2.5f, kBack + 0.1f},
                                         {0.1f, 2.95f, kBack + 0.12f},
                                         {1.0f, 2.6f, kBack + 0.1f}},
                                        8),
                             {0, 0, 1}, 0.28f, 110, 7, {.length = 0.08f, .width = 0.05f}, 0.25f, 1271);
  m.add(p.leaf[1], vine.leaves).add(p.bark, vine.wood).add(p.bloom[1], vine.fruits);
  // A can on the path.
  const glm::mat4 can = at(0.34f, 0.012f, 0.75f) * turnY(35);
  m.add(p.zinc, cylinder(0.11f, 0.24f, 40, 0.01f), can);
  m.add(p.zinc, tube({{0.09f, 0.05f, 0}, {0.22f, 0.16f, 0}, {0.36f, 0.30f, 0}}, 0.016f, 12), can);
  m.add(p.zinc, lathe(Outline({0, 0}).line(0.02f, 0).line(0.05f, 0.05f).line(0, 0.055f), {.segments = 24}),
        can * at(0.35f, 0.29f, 0) * turnZ(-48));
  m.add(p.zinc,
        tube(smoothPath({{-0.11f, 0.06f, 0},
                         {-0.21f, 0.16f, 0},
                         {-0.14f, 0.32f, 0},
                         {0.02f, 0.33f, 0},
                         {0.08f, 0.235f, 0}},
                        6),
             0.009f, 8),
        can);
  b.place("plants", b.mesh("plants", std::move(m)));
  b.place("basket", b.mesh("basket", basket(p)), {-0.35f, kRidge - 0.15f, -0.4f});
  MeshBuilder hook;
  hook.add(p.zinc, tube({{-0.35f, kRidge - 0.16f, -0.4f}, {-0.35f, kRidge - 0.1f, -0.4f}, {0, kRidge, -0.4f}},
                        0.008f, 6));
  b.place("hook", b.mesh("hook", std::move(hook)));
}

}  // namespace

static Scene greenhouseScene() {
  SceneBuilder b("greenhouse");
  const Palette p = makePalette(b);
  MeshBuilder frame;
  addGarden(frame, p);
  addFrame(frame, p);
  b.place("frame", b.mesh("frame", std::move(frame)));
  furnish(b, p);
  b.sun("sun", {1.0f, 0.92f, 0.80f}, 17, {-0.62f, -0.72f, -0.30f});
  b.camera({0.28f, 1.62f, 2.75f}, {-0.1f, 1.12f, -2.0f}, 60);
  b.scene.environment = {0.45f, 0.72f, 1.1f};
  return b.finish(0.5f, {0.4f, 0.55f});
}

FOVEA_SCENE("greenhouse", greenhouseScene);

}  // namespace fovea::scene
