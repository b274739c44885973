// The yard behind a house, of about 516k triangles: a playground on grass, a flag, and a hole in the paving
// surrounded by orange barriers. The low sun comes over the fence; the shadow of the fence ends at the barriers, so
// that these cast their colour on pale slabs and a white wall, which lie in the shade.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/yard_parts.h"

namespace fovea::scene {
namespace {

using namespace yard;
using namespace model;

// Faces of the walls around the yard, and the edge between lawn and paving.
constexpr float kLeft = -7.0f, kRight = 6.5f, kBack = -5.6f, kFront = 6.2f, kEdge = -0.20f;
constexpr float kStoreFront = -3.6f, kStoreLeft = 0.6f, kStoreWidth = 5.0f, kStoreHeight = 2.35f;
constexpr float kFence = 2.25f;
constexpr glm::vec3 kSwing{-3.7f, 0, -1.9f}, kTower{-2.4f, 0, -4.1f}, kSandbox{-1.6f, 0, -0.2f},
    kTree{-6.0f, 0, -2.4f}, kMast{-0.5f, 0, -4.5f};
constexpr float kSwingTurn = 22;

void addHouses(MeshBuilder& m, const Palette& p) {
  Front back = {.width = 14.3f, .height = 4.1f, .plaster = p.pale};
  back.windows = {{-5.2f, 1.05f, true}, {-1.6f, 1.05f, true}, {5.9f, 1.05f, false}};
  back.doors = {-3.35f};
  const glm::mat4 backAt = at(-0.25f, 0, kBack);
  m.add(front(p, back), backAt).add(eaves(p, 14.3f, 8), backAt * at(0, 4.1f, 0));
  m.add(downpipe(p, 4.06f), backAt * at(0.62f, 0, 0.06f));

  Front left = {.width = 12.7f, .height = 5.9f, .plaster = p.ochre};
  for (const float x : {-3.9f, -1.2f, 1.5f, 4.2f}) {
    left.windows.push_back({x, 3.65f, true});
    if (x < 0) left.windows.push_back({x, 1.05f, true});
  }
  left.windows.push_back({4.2f, 1.05f, true});
  left.doors = {1.5f};
  const glm::mat4 leftAt = at(kLeft, 0, 0.3f) * turnY(90);
  m.add(front(p, left), leftAt).add(eaves(p, 12.7f, 3), leftAt * at(0, 5.9f, 0));
  m.add(downpipe(p, 5.86f), leftAt * at(5.5f, 0, 0.06f));

  Front near = {.width = 14.3f, .height = 6.0f, .plaster = p.brick};
  for (const float x : {-5.4f, -2.7f, 0.0f, 2.7f, 5.4f}) {
    near.windows.push_back({x, 3.65f, false});
    if (x != 0) near.windows.push_back({x, 1.05f, false});
  }
  near.doors = {0.0f};
  const glm::mat4 nearAt = at(-0.25f, 0, kFront) * turnY(180);
  m.add(front(p, near), nearAt).add(eaves(p, 14.3f, 2), nearAt * at(0, 6.0f, 0));

  m.add(store(p, kStoreWidth, kStoreFront - kBack, kStoreHeight),
        at(kStoreLeft + 0.5f * kStoreWidth, 0, kStoreFront));
  m.add(fence(p, kFront - kBack + 0.7f, kFence), at(kRight + 0.1f, 0, 0.5f * (kFront + kBack)) * turnY(-90));
}

bool inHole(glm::vec2 q) { return q.x > 0.42f && q.x < 1.75f && q.y > -2.75f && q.y < -1.05f; }

void addPaving(MeshBuilder& m, const Palette& p) {
  m.add(p.mortar, box({kLeft - 0.5f, -0.5f, kBack - 0.5f}, {9.8f, -0.014f, kFront + 0.5f}));
  const glm::vec2 low(kEdge + 0.05f, kStoreFront + 0.02f), high(kRight + 0.03f, kFront);
  constexpr int kColumns = 16, kRows = 24;
  const glm::vec2 cell = (high - low) / glm::vec2(kColumns, kRows);
  for (int i = 0; i < kColumns; ++i)
    for (int j = 0; j < kRows; ++j) {
      const glm::vec2 c = low + cell * (glm::vec2(float(i), float(j)) + 0.5f);
      if (inHole(c)) continue;
      const uint32_t k = uint32_t(i * kRows + j);
      const float pick = random(801, k);
      Shape slab =
          extrude(rectangle(cell.x - 0.010f, cell.y - 0.010f), 0.06f, {.bevel = 0.005f, .back = false});
      for (glm::vec2& uv : slab.uvs) uv += glm::vec2(random(802, k, 0, 4), random(803, k, 0, 4));
      m.add(p.paving[pick < 0.55f   ? 0
                     : pick < 0.85f ? 1
                                    : 2],
            slab,
            at(c.x, -0.06f + random(804, k, -0.003f, 0.003f), c.y) *
                turnX(-90 + random(805, k, -0.25f, 0.25f)) * turnZ(random(806, k, -0.4f, 0.4f)));
    }
  for (int i = 0; i < 10; ++i) {  // kerbstones along the lawn
    const float z = kStoreFront + 0.98f * float(i), end = std::min(z + 0.972f, kFront);
    m.add(p.stone,
          box({kEdge - 0.05f, -0.15f, z}, {kEdge + 0.045f, 0.028f, end}, {.bevel = 0.012f, .bevelSteps = 2}));
  }
  // The bed of sand where slabs are missing, with a heap.
  m.add(p.sand, surface(sheet(48, 54, {1.9f, 2.2f}, [](float u, float v) {
          const glm::vec2 q(0.14f + 1.9f * u, -3.0f + 2.2f * v), d = q - glm::vec2(0.95f, -2.0f);
          const float rim = std::min(std::min(u, 1 - u), std::min(v, 1 - v));
          const float heap = 0.42f * std::exp(-5.5f * glm::dot(d, d)) * std::min(1.0f, 6 * rim);
          return glm::vec3(q.x,
                           -0.010f + 0.9f * heap * (0.85f + 0.3f * fractal(q * 5.0f, 811, 3)) +
                               0.010f * noise(q * 11.0f, 812),
                           q.y);
        })));
}

// 0 where the grass is worn off, 1 where it is dense.
float grassAt(glm::vec2 q) {
  float g = 1.7f * fractal(q * 0.9f, 821, 3) - 0.28f;
  const auto worn = [&](glm::vec3 c, float radius) {
    const float d = glm::length(q - glm::vec2(c.x, c.z)) / radius;
    g -= 1.3f * std::exp(-d * d * d);
  };
  worn(kSwing + glm::vec3(0.65f, 0, -0.25f), 0.75f);
  worn(kSwing + glm::vec3(-0.65f, 0, 0.25f), 0.75f);
  worn({-0.75f, 0, -2.05f}, 0.7f);
  worn(kTower, 0.9f);
  worn({-3.6f, 0, -5.0f}, 0.7f);
  return std::clamp(g, 0.0f, 1.0f);
}

float lawnHeight(glm::vec2 q) {
  const float edge = std::min(1.0f, 2.0f * std::max(0.0f, kEdge - 0.05f - q.x));
  return 0.004f + 0.05f * edge * fractal(q * 0.7f, 831, 4);
}

void addLawn(MeshBuilder& m, const Palette& p) {
  const auto lawn = [&](glm::vec2 low, glm::vec2 high, uint32_t columns, uint32_t rows) {
    m.add(p.lawn, surface(sheet(columns, rows, high - low, [&](float u, float v) {
            const glm::vec2 q = glm::mix(low, high, glm::vec2(u, v));
            return glm::vec3(q.x, lawnHeight(q), q.y);
          })));
  };
  lawn({kLeft - 0.02f, kBack - 0.02f}, {kEdge - 0.04f, kFront + 0.02f}, 48, 80);
  lawn({kEdge - 0.04f, kBack - 0.02f}, {kStoreLeft + 0.02f, kStoreFront}, 8, 16);
  // Stepping stones to the door.
  const glm::vec2 steps[6] = {{-0.62f, 1.55f}, {-1.3f, 1.62f},  {-2.0f, 1.58f},
                              {-2.72f, 1.5f},  {-3.45f, 1.52f}, {-4.2f, 1.62f}};
  for (uint32_t i = 0; i < 6; ++i)
    m.add(p.paving[2], extrude(Outline(circle(0.26f, 20)), 0.08f, {.bevel = 0.012f, .back = false}),
          at(steps[i].x, lawnHeight(steps[i]) - 0.055f, steps[i].y) * turnX(-90));

  // Tufts of grass: blades of three triangles.
  constexpr int kTufts = 10, kBlades = 9;
  Shape tufts[kTufts];
  for (uint32_t t = 0; t < kTufts; ++t) {
    for (uint32_t i = 0; i < kBlades; ++i) {
      const uint32_t k = t * 64 + i;
      const float a = random(841, k, 0, glm::two_pi<float>()), h = random(842, k, 0.035f, 0.085f),
                  lean = random(843, k, 0.1f, 0.7f) * h, w = random(844, k, 0.0022f, 0.004f);
      const glm::vec3 root(random(845, k, -0.035f, 0.035f), -0.006f, random(846, k, -0.035f, 0.035f)),
          out(std::cos(a), 0, std::sin(a)), side = w * glm::vec3(-out.z, 0, out.x);
      const glm::vec3 middle = root + glm::vec3(0, 0.6f * h, 0) + 0.3f * lean * out,
                      tip = root + glm::vec3(0, h, 0) + lean * out;
      Shape& s = tufts[t];
      const uint32_t base = uint32_t(s.positions.size());
      const glm::vec3 n = glm::normalize(glm::cross(side, middle - root));
      for (const glm::vec3& q : {root + side, root - side, middle + 0.8f * side, middle - 0.8f * side, tip}) {
        s.positions.push_back(q);
        s.normals.push_back(n);
        s.uvs.push_back({0, 0});
      }
      for (uint32_t v : {0u, 2u, 1u, 1u, 2u, 3u, 2u, 4u, 3u}) s.indices.push_back(base + v);
    }
    smooth(tufts[t], 180);
  }
  constexpr uint32_t kTries = 9200;
  for (uint32_t i = 0; i < kTries; ++i) {
    // Denser near the middle of the yard than in its far corner behind the viewer.
    const glm::vec2 q(random(851, i, kLeft + 0.05f, kEdge - 0.07f),
                      kBack + 0.05f + (kFront - kBack - 0.1f) * std::pow(random(852, i), 2.0f));
    const glm::vec2 box = glm::abs(q - glm::vec2(kSandbox.x, kSandbox.z));
    if (std::max(box.x, box.y) < 0.98f || random(853, i) > grassAt(q)) continue;
    m.add(p.blade[random(854, i) < 0.25f ? 1 : 0], tufts[i % kTufts],
          at(q.x, lawnHeight(q), q.y) * turnY(random(855, i, 0, 360)) * scaled(random(856, i, 0.7f, 1.35f)));
  }
}

void addPlants(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  const Plant apple =
      tree({.trunkHeight = 1.75f,
            .trunkRadius = 0.12f,
            .crown = {1.75f, 1.35f, 1.75f},
            .boughs = 9,
            .twigs = 1150,
            .leavesPerTwig = 10,
            .twigLength = 0.42f,
            .leaf = {.length = 0.095f, .width = 0.055f, .fold = 0.3f, .droop = 0.2f, .steps = 1},
            .fruits = 36,
            .fruitRadius = 0.036f,
            .seed = 861});
  m.add(p.bark, apple.wood, at(kTree))
      .add(p.leaf[0], apple.leaves, at(kTree))
      .add(p.red, apple.fruits, at(kTree));
  // The neighbour's tree, whose crown looks over the fence.
  const Plant lime =
      tree({.trunkHeight = 2.2f,
            .trunkRadius = 0.13f,
            .crown = {1.5f, 1.5f, 1.9f},
            .boughs = 9,
            .twigs = 620,
            .leavesPerTwig = 10,
            .twigLength = 0.42f,
            .leaf = {.length = 0.11f, .width = 0.085f, .fold = 0.2f, .droop = 0.2f, .steps = 1},
            .seed = 862});
  m.add(p.bark, lime.wood, at(8.35f, -0.02f, 2.9f)).add(p.leaf[2], lime.leaves, at(8.35f, -0.02f, 2.9f));
  const Leaf small = {.length = 0.06f, .width = 0.035f, .fold = 0.25f, .droop = 0.2f, .steps = 1};
  const struct {
    glm::vec3 at, dome;
    int stems, leaf;
  } bushes[] = {{{-1.35f, 0, -5.05f}, {0.62f, 0.75f, 0.42f}, 95, 1},
                {{-0.15f, 0, -5.15f}, {0.48f, 0.95f, 0.38f}, 85, 0},
                {{-6.55f, 0, -0.9f}, {0.40f, 0.70f, 0.65f}, 85, 1},
                {{-6.6f, 0, 0.55f}, {0.36f, 0.60f, 0.55f}, 70, 2},
                {{6.15f, 0, -1.2f}, {0.30f, 0.8f, 0.6f}, 80, 1},
                {{6.15f, 0, 0.2f}, {0.30f, 0.65f, 0.6f}, 80, 0},
                {{6.15f, 0, 4.6f}, {0.30f, 0.8f, 0.7f}, 80, 1},
                {{-6.5f, 0, 4.9f}, {0.45f, 0.8f, 0.6f}, 80, 0}};
  uint32_t seed = 870;
  for (const auto& bush : bushes) {
    const Plant plant = model::bush(bush.dome, bush.stems * 3 / 5, 24, small, seed++);
    m.add(p.leaf[bush.leaf], plant.leaves, at(bush.at)).add(p.bark, plant.wood, at(bush.at));
    Outline bed({0, -0.02f});
    bed.line(1.05f, -0.02f).line(1.05f, 0.02f).curve({0.8f, 0.05f}, {0.4f, 0.07f}, {0, 0.075f}, 6);
    m.add(p.soil, lathe(bed, {.segments = 32}), at(bush.at) * scaled(bush.dome.x, 1, bush.dome.z));
  }
  // A climber on the back house, up from the ground beside the store and over the wall.
  const Leaf ivy = {.length = 0.085f, .width = 0.075f, .fold = 0.2f, .droop = 0.25f, .steps = 1};
  const Plant climber = trailing(46, 3.3f, 1.9f, ivy, 881);
  const glm::mat4 wall = at(-0.15f, 0.02f, kBack + 0.20f) * turnX(180) * scaled(1, 1, 1);
  m.add(p.leaf[1], climber.leaves, wall * turnY(0)).add(p.bark, climber.wood, wall);
  const struct {
    float x, z, size;
  } pots[] = {{1.0f, -3.3f, 1.0f},
              {1.42f, -3.36f, 0.72f},
              {5.75f, -3.2f, 1.1f},
              {-3.35f + 0.95f - 0.25f, -5.25f, 0.85f}};
  for (const auto& pot : pots)
    m.add(flower(p, seed++), at(pot.x, pot.z < -5 ? 0.015f : -0.002f, pot.z) * scaled(pot.size));
  b.place("plants", b.mesh("plants", std::move(m)));
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  m.add(shed(p), at(-6.0f, 0.0f, -4.65f) * turnY(38));
  m.add(slideTower(p), at(kTower) * turnY(38));
  m.add(swingFrame(p), at(kSwing) * turnY(kSwingTurn));
  m.add(swingSeat(p), at(kSwing) * turnY(kSwingTurn) * at(-0.7f, kSwingBar, 0) * turnX(2));
  m.add(sandbox(p, 1.7f), at(kSandbox) * turnY(0));
  m.add(climbingDome(p, 1.25f), at(-4.6f, 0, 3.9f));
  m.add(mast(p, 4.75f), at(kMast));
  b.place("playground", b.mesh("playground", std::move(m)));

  MeshBuilder works;
  works.add(barrier(p, 1.1f, true), at(2.02f, -0.001f, -1.38f) * turnY(70));
  works.add(barrier(p, 1.1f, false), at(2.42f, -0.001f, -2.48f) * turnY(70));
  works.add(barrier(p, 1.1f, false), at(1.16f, -0.001f, -0.70f) * turnY(8));
  works.add(barrier(p, 1.1f, true), at(0.10f, -0.001f, -1.10f) * turnY(35));
  works.add(wheelbarrow(p), at(0.75f, 0, 0.55f) * turnY(-28));
  works.add(shovel(p), at(1.05f, 0.20f, -1.92f) * turnY(50) * turnX(-14));
  works.add(slabStack(p), at(3.62f, 0, -2.45f) * turnY(24));
  works.add(bicycle(p), at(3.08f, -0.002f, -3.28f) * turnY(3) * turnX(-9));
  works.add(bench(p), at(5.0f, 0, 5.6f) * turnY(180));
  works.add(bucket(p, p.steel, 0.27f), at(2.85f, 0, -1.85f) * turnY(40));
  b.place("works", b.mesh("works", std::move(works)));
}

// A game of hopscotch in chalk, fallen leaves.
void addTraces(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  const glm::mat4 game = at(4.25f, 0, 1.05f) * turnY(14);
  constexpr float kCell = 0.37f, kLow = -0.004f, kHigh = 0.0055f, kLine = 0.014f;
  const auto line = [&](float x0, float z0, float x1, float z1) {
    m.add(p.reflex,
          box({x0 - kLine, kLow, z0 - kLine}, {x1 + kLine, kHigh, z1 + kLine},
              {.bevel = 0.002f, .bottom = false}),
          game);
  };
  float z = 0;
  for (const bool pair : {false, true, false, true, false}) {
    const float half = kCell * (pair ? 1.0f : 0.5f), end = z - kCell;
    line(-half, z, half, z);
    line(-half, end, -half, z);
    line(half, end, half, z);
    if (pair) line(0, end, 0, z);
    z = end;
  }
  m.add(p.reflex,
        sweep({{-0.5f * kCell, 0, z}, {0.5f * kCell, 0, z}}, rectangle(2 * kLine, 0.010f),
              {.up = glm::vec3(0, 1, 0)}),
        game);
  const Shape blade =
      leafBlade({.length = 0.085f, .width = 0.06f, .fold = 0.35f, .droop = -0.2f, .steps = 1});
  for (uint32_t i = 0; i < 110; ++i)
    m.add(i % 3 == 0 ? p.leaf[2] : p.fallen, blade,
          at(random(891, i, 0.0f, 6.3f), 0.008f, random(892, i, -3.4f, 4.5f)) *
              turnY(random(893, i, 0, 360)) * scaled(random(894, i, 0.7f, 1.2f)));
  b.place("traces", b.mesh("traces", std::move(m)));
}

void addMovers(SceneBuilder& b, const Palette& p) {
  MeshBuilder seat;
  seat.add(swingSeat(p));
  b.place("swing", b.mesh("swing", std::move(seat)),
          glm::vec3(at(kSwing) * turnY(kSwingTurn) * glm::vec4(0.7f, kSwingBar, 0, 1)), kSwingTurn);
  MeshBuilder round;
  round.add(ball(p, 0.11f));
  b.place("ball", b.mesh("ball", std::move(round)), {3.6f, 0.111f, 0.35f}, 0);

  // The flag: a wave that travels to the fly (made of two waves a quarter of a period apart), and gusts that lift it.
  const auto shape = [](float droop, float wave, float phase, float flutter) {
    return flag({.droop = droop, .wave = wave, .phase = phase, .flutter = flutter}, 28, 14);
  };
  const float quarter = 0.5f * glm::pi<float>();
  const uint32_t mesh = b.mesh("flag",
                               cage(shape(0.20f, 0, 0, 0), 2,
                                    {shape(0.02f, 0, 0, 0), shape(0.20f, 0.13f, 0, 0),
                                     shape(0.20f, 0.13f, quarter, 0), shape(0.20f, 0, 0, 0.035f)}),
                               p.flag);
  const uint32_t node = b.place("flag", mesh, kMast + glm::vec3(-0.03f, 4.62f, 0.02f), 215);
  b.swing(node,
          {{.amplitude = 0.8f, .period = 4},
           {.amplitude = 1, .period = 2, .phase = 0.25f},
           {.amplitude = 1, .period = 2},
           {.amplitude = 1, .period = 1.6f}},
          8);
}

}  // namespace

static Scene yardScene() {
  SceneBuilder b("yard");
  const Palette p = makePalette(b);
  MeshBuilder building, ground;
  addHouses(building, p);
  b.place("houses", b.mesh("houses", std::move(building)));
  addPaving(ground, p);
  addLawn(ground, p);
  b.place("ground", b.mesh("ground", std::move(ground)));
  furnish(b, p);
  addPlants(b, p);
  addTraces(b, p);
  addMovers(b, p);
  b.sun("sun", {1.0f, 0.90f, 0.76f}, 20, {-0.82f, -0.42f, 0.12f});
  b.camera({5.2f, 1.68f, 2.4f}, {0.35f, 0.95f, -2.4f}, 58);
  b.scene.environment = {0.30f, 0.50f, 0.80f};
  return b.finish(0.8f, {0.62f, 0.6f});
}

FOVEA_SCENE("yard", yardScene);

}  // namespace fovea::scene
