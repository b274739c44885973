// A closed garage that is lit only by fluorescent tubes, for choosing parameters that concern thin emissive surfaces
// close to walls. Battens hang under the ceiling, one of them in a reflector; others are on the walls, upright near a
// corner, and under the shelf above the workbench. A red car stands in the middle.
#include <cmath>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/car.h"
#include "samples/scenes/builtin/modelling/model.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr float kX = 3.0f, kZ = 3.0f, kHigh = 2.7f, kThick = 0.25f;  // the room is about the origin, m
constexpr float kTube = 1.2f;                                        // length of a tube
constexpr float kBench = -1.05f;                                     // the middle of the workbench along z

struct Palette {
  uint32_t blocks, dado, ceiling, concrete, slats, planks, steel, white, dark, blue, yellow, red, orange,
      brass, rubber, cloth, cardboard;
  uint32_t tube;  // emissive
  CarLook car;
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  MasonryLook blocks;
  blocks.columns = 4;
  blocks.rows = 8;
  blocks.joint = 0.05f;
  blocks.low = glm::vec3(0.60f, 0.59f, 0.55f);
  blocks.high = glm::vec3(0.70f, 0.69f, 0.65f);
  blocks.jointColor = glm::vec3(0.50f, 0.49f, 0.46f);
  const uint32_t wall = b.texture(masonry("blocks", blocks, 512, 512, 3001));
  p.blocks = b.material("painted blocks", {0.95f, 0.95f, 0.95f}, {.texture = wall, .metres = 1.76f});
  p.dado = b.material("green dado", {0.30f, 0.46f, 0.42f}, {.texture = wall, .metres = 1.76f});
  p.ceiling = b.material(
      "ceiling", glm::vec3(1),
      {.texture = b.texture(plaster("ceiling", glm::vec3(0.74f, 0.73f, 0.70f), 0.08f, 0, 512, 3002)),
       .metres = 3});
  const uint32_t floor = b.texture(ground("concrete", glm::vec3(0.26f), glm::vec3(0.40f), 0.08f, 512, 3003));
  p.concrete = b.material("concrete", glm::vec3(1), {.texture = floor, .metres = 3});
  p.slats = b.material("rolling door", {0.46f, 0.50f, 0.54f});
  p.planks = b.material(
      "planks", glm::vec3(1),
      {.texture = b.texture(boards("planks", 4, {0.40f, 0.26f, 0.14f}, {0.60f, 0.43f, 0.26f}, 512, 3004)),
       .metres = 0.6f,
       .metresHigh = 1.6f});
  p.steel = b.material("galvanised steel", {0.50f, 0.51f, 0.53f});
  p.white = b.material("white enamel", {0.80f, 0.80f, 0.78f});
  p.dark = b.material("black iron", {0.05f, 0.05f, 0.055f});
  p.blue = b.material("blue enamel", {0.09f, 0.20f, 0.42f});
  p.yellow = b.material("yellow paint", {0.78f, 0.55f, 0.05f});
  p.red = b.material("signal red", {0.62f, 0.06f, 0.04f});
  p.orange = b.material("orange cable", {0.80f, 0.30f, 0.04f});
  p.brass = b.material("brass", {0.60f, 0.44f, 0.18f});
  p.rubber = b.material("rubber", {0.045f, 0.045f, 0.045f});
  p.cloth = b.material("rag", {0.66f, 0.60f, 0.50f});
  p.cardboard = b.material("cardboard", {0.52f, 0.37f, 0.22f});
  p.tube = b.material("tube", {0.75f, 0.76f, 0.78f}, {.emission = {21, 23.5f, 25}});
  p.car = {.paint = b.material("dark red paint", {0.33f, 0.022f, 0.026f}),
           .glass = b.material("dark glass", {0.035f, 0.042f, 0.048f}),
           .rubber = p.rubber,
           .rim = b.material("rims", {0.58f, 0.58f, 0.59f}),
           .chrome = b.material("trim", {0.62f, 0.62f, 0.63f}),
           .dark = p.dark,
           .lens = b.material("lenses", {0.78f, 0.79f, 0.80f}),
           .tail = b.material("rear lamps", {0.42f, 0.02f, 0.02f}),
           .plate = b.material("number plates", {0.76f, 0.74f, 0.62f})};
  return p;
}

// A tube along x in a fitting on the plane z = 0, which it lights along +z. Its axis is `distance` from the plane.
void addBatten(MeshBuilder& m, const Palette& p, float distance, const glm::mat4& where) {
  const float half = 0.5f * kTube;
  m.add(p.tube, cylinder(0.013f, kTube, 14), where * at(-half, 0, distance) * turnZ(-90));
  m.add(p.white,
        box({-half - 0.03f, -0.028f, -0.01f}, {half + 0.03f, 0.028f, distance - 0.022f}, {.bevel = 0.003f}),
        where);
  for (const float side : {-1.0f, 1.0f})
    m.add(p.steel, box({-0.015f, -0.019f, 0.005f}, {0.015f, 0.019f, distance + 0.02f}, {.bevel = 0.004f}),
          where * at(side * (half + 0.013f), 0, 0));
}

// The reflector of a batten: two plates at its sides and one at each end.
void addHood(MeshBuilder& m, const Palette& p, const glm::mat4& where) {
  const float half = 0.5f * kTube + 0.045f;
  for (const float turn : {38.0f, 142.0f})
    m.add(p.white, box({-half, 0.024f, -0.001f}, {half, 0.125f, 0.001f}),
          where * at(0, 0, 0.002f) * turnX(turn));
  const Outline end({{-0.003f, -0.02f}, {-0.080f, -0.102f}, {-0.080f, 0.102f}, {-0.003f, 0.02f}});
  for (const float x : {-half - 0.001f, half - 0.001f})
    m.add(p.white, extrude(end, 0.002f), where * at(x, 0, 0) * turnY(90));
}

void addRoom(MeshBuilder& m, const Palette& p) {
  const float x = kX + kThick, z = kZ + kThick, e = 0.1f;
  m.add(p.concrete, box({-x, -kThick, -z}, {x, 0, z}));
  m.add(p.ceiling, box({-x, kHigh, -z}, {x, kHigh + kThick, z}));
  for (const float side : {-1.0f, 1.0f}) {
    m.add(p.blocks, box({-kThick, -e, -z}, {0, kHigh + e, z}), at(side > 0 ? x : -kX, 0, 0));
    m.add(p.blocks, box({-kX - e, -e, -kThick}, {kX + e, kHigh + e, 0}), at(0, 0, side > 0 ? z : -kZ));
    m.add(p.dado, box({-0.01f, -0.02f, -kZ - 0.02f}, {0.01f, 1.15f, kZ + 0.02f}), at(side * kX, 0, 0));
  }
  m.add(p.dado, box({-kX - 0.01f, -0.021f, -kZ - 0.01f}, {kX + 0.01f, 1.149f, -kZ + 0.009f}));
  m.add(p.dado, box({-kX - 0.01f, -0.021f, kZ - 0.009f}, {kX + 0.01f, 1.149f, kZ + 0.01f}));
  // The rolling door with its rails and the box of its drum.
  const float left = -1.45f, right = 1.75f;
  Outline wave({0, -0.04f});
  for (int i = 0; i < 22; ++i)
    wave.line(0.05f, 0.1f * float(i)).arc(0.05f, 0.1f * float(i) + 0.088f, 0.28f, 5);
  wave.line(0.05f, 2.25f).line(0, 2.25f);
  m.add(p.slats, extrude(wave, right - left), at(left, 0, -kZ + 0.012f) * turnY(90) * scaled(-1, 1, 1));
  for (const float edge : {left, right})
    m.add(p.steel,
          box({edge - 0.05f, -0.01f, -kZ - 0.01f}, {edge + 0.05f, 2.2f, -kZ + 0.11f}, {.bevel = 0.006f}));
  m.add(p.steel,
        box({left - 0.08f, 2.15f, -kZ - 0.01f}, {right + 0.08f, 2.52f, -kZ + 0.33f}, {.bevel = 0.01f}));
  m.add(p.dark, box({-0.12f, 0.86f, -kZ + 0.05f}, {0.32f, 0.90f, -kZ + 0.12f}, {.bevel = 0.008f}));
  m.add(p.rubber,
        box({left + 0.05f, -0.005f, -kZ + 0.02f}, {right - 0.05f, 0.05f, -kZ + 0.1f}, {.bevel = 0.01f}));
  // A door in the wall behind the first view, and yellow lines on the floor.
  m.add(p.blue, box({-2.2f, 0, kZ - 0.04f}, {-1.3f, 2.05f, kZ + 0.05f}, {.bevel = 0.004f}));
  for (const float line : {-1.05f, 1.75f})
    m.add(p.yellow, box({line, -0.01f, -2.6f}, {line + 0.08f, 0.0015f, 2.4f}));
}

void addLamps(MeshBuilder& m, const Palette& p) {
  const glm::mat4 down = turnX(90);  // from a wall z = 0 to a ceiling
  addBatten(m, p, 0.062f, at(-1.45f, kHigh, -0.35f) * turnY(90) * down);
  addBatten(m, p, 0.062f, at(1.75f, kHigh, 0.2f) * turnY(90) * down);
  const glm::mat4 hood = at(0.2f, kHigh, -1.6f) * down;
  addBatten(m, p, 0.055f, hood);
  addHood(m, p, hood);
  addBatten(m, p, 0.048f, at(kX, 1.98f, -0.75f) * turnY(-90));                 // along the right wall
  addBatten(m, p, 0.052f, at(-2.72f, 1.5f, -kZ) * turnZ(90));                  // upright in the corner
  addBatten(m, p, 0.045f, at(-kX + 0.065f, 1.5f, kBench) * turnY(90) * down);  // under the shelf
  // The pipes of the wiring.
  const float y = kHigh - 0.008f;
  m.add(p.steel, tube({{-1.45f, y, -0.35f}, {-kX, y, -0.35f}}, 0.011f, 10));
  m.add(p.steel, tube({{1.75f, y, 0.2f}, {-1.45f, y, 0.2f}}, 0.011f, 10));
  m.add(p.steel, tube({{0.2f, y, -1.6f}, {0.2f, y, 0.2f}}, 0.011f, 10));
  m.add(p.steel, tube({{kX - 0.008f, y, -0.75f}, {kX - 0.008f, 1.98f, -0.75f}}, 0.011f, 10));
  m.add(p.steel, tube({{1.75f, y, -0.75f}, {kX, y, -0.75f}}, 0.011f, 10));
  m.add(p.steel, tube({{-2.72f, y, -kZ + 0.008f}, {-2.72f, 2.0f, -kZ + 0.008f}}, 0.011f, 10));
  m.add(p.steel, tube({{-2.72f, y, -kZ}, {-2.72f, y, -0.35f}}, 0.011f, 10));
}

void addTools(MeshBuilder& m, const Palette& p);

void addBench(MeshBuilder& m, const Palette& p) {
  const float front = -kX + 0.66f, low = kBench - 1.1f, high = kBench + 1.1f;
  m.add(p.planks, box({-kX - 0.01f, 0.84f, low}, {front, 0.90f, high}, {.bevel = 0.006f}));
  for (const float z : {low + 0.06f, high - 0.06f})
    for (const float x : {-kX + 0.08f, front - 0.08f})
      m.add(p.steel, box({x - 0.03f, 0, z - 0.03f}, {x + 0.03f, 0.845f, z + 0.03f}));
  m.add(p.planks, box({-kX + 0.04f, 0.2f, low + 0.05f}, {front - 0.05f, 0.225f, high - 0.05f}));
  // A block of drawers below, and boxes beside it.
  m.add(p.red, box({-kX + 0.1f, 0.224f, kBench + 0.35f}, {front - 0.06f, 0.842f, kBench + 0.95f},
                   {.bevel = 0.004f}));
  for (int i = 0; i < 4; ++i) {
    const float y = 0.25f + 0.146f * float(i);
    m.add(p.red, box({front - 0.07f, y, kBench + 0.37f}, {front - 0.045f, y + 0.132f, kBench + 0.93f},
                     {.bevel = 0.004f}));
    m.add(p.steel, tube({{front - 0.03f, y + 0.1f, kBench + 0.5f}, {front - 0.03f, y + 0.1f, kBench + 0.8f}},
                        0.008f, 8));
    for (const float z : {0.51f, 0.79f})
      m.add(p.steel,
            tube({{front - 0.05f, y + 0.1f, kBench + z}, {front - 0.03f, y + 0.1f, kBench + z}}, 0.006f, 6));
  }
  m.add(p.cardboard, block(0.36f, 0.3f, 0.42f, {.bevel = 0.003f}),
        at(-2.68f, 0.2255f, kBench - 0.15f) * turnY(6));
  m.add(p.blue, block(0.3f, 0.24f, 0.36f, {.bevel = 0.01f}), at(-2.66f, 0.2255f, kBench - 0.7f) * turnY(-9));
  // The shelf, its brackets, and what stands on it.
  m.add(p.planks, box({-kX - 0.01f, 1.5f, low + 0.1f}, {-kX + 0.3f, 1.53f, high - 0.1f}));
  for (const float z : {-0.85f, 0.85f}) {
    m.add(p.dark,
          box({-kX - 0.01f, 1.472f, kBench + z - 0.015f}, {-kX + 0.26f, 1.5005f, kBench + z + 0.015f}));
    m.add(p.dark, tube({{-kX + 0.005f, 1.26f, kBench + z}, {-kX + 0.24f, 1.475f, kBench + z}}, 0.009f, 8));
  }
  const uint32_t cans[5] = {p.blue, p.steel, p.yellow, p.white, p.red};
  for (uint32_t i = 0; i < 8; ++i) {
    const float r = random(3021, i, 0.045f, 0.08f), h = random(3022, i, 0.11f, 0.24f);
    const glm::mat4 where = at(-kX + random(3023, i, 0.1f, 0.2f), 1.53f, kBench - 0.85f + 0.235f * float(i));
    m.add(cans[i % 5], cylinder(r, h, 24, 0.004f), where);
    m.add(p.steel, torus(r - 0.003f, 0.005f, 28, 6), where * at(0, h - 0.003f, 0));
    if (i % 3 == 0) m.add(p.dark, cylinder(0.018f, 0.03f, 14, 0.003f), where * at(0, h - 0.001f, 0));
  }
  addTools(m, p);
}

// On the workbench: a vice, a toolbox, a rag, jars; on the wall above it, spanners.
void addTools(MeshBuilder& m, const Palette& p) {
  const float top = 0.90f;
  const glm::mat4 vice = at(-kX + 0.5f, top, kBench + 0.75f) * turnY(90);
  m.add(p.blue, cylinder(0.09f, 0.05f, 28, 0.006f), vice);
  m.add(p.blue, box({-0.06f, 0.045f, -0.1f}, {0.06f, 0.15f, 0.03f}, {.bevel = 0.012f}), vice);
  m.add(p.blue, box({-0.055f, 0.05f, 0.065f}, {0.055f, 0.149f, 0.11f}, {.bevel = 0.01f}), vice);
  m.add(p.steel, box({-0.03f, 0.06f, -0.02f}, {0.03f, 0.1f, 0.1f}), vice);
  m.add(p.steel, tube({{0, 0.08f, 0.1f}, {0, 0.08f, 0.19f}}, 0.011f, 10), vice);
  m.add(p.steel, tube({{-0.09f, 0.055f, 0.178f}, {0.09f, 0.105f, 0.178f}}, 0.007f, 8), vice);
  const glm::mat4 chest = at(-kX + 0.36f, top, kBench - 0.7f) * turnY(76);
  m.add(p.red, block(0.42f, 0.16f, 0.2f, {.bevel = 0.008f}), chest);
  m.add(p.red, box({-0.212f, 0.155f, -0.102f}, {0.212f, 0.2f, 0.102f}, {.bevel = 0.012f}), chest);
  m.add(p.dark,
        tube(smoothPath({{-0.1f, 0.19f, 0}, {-0.09f, 0.235f, 0}, {0.09f, 0.235f, 0}, {0.1f, 0.19f, 0}}, 5),
             0.009f, 8),
        chest);
  for (const float x : {-0.12f, 0.12f})
    m.add(p.brass, box({x - 0.015f, 0.13f, 0.09f}, {x + 0.015f, 0.18f, 0.108f}), chest);
  m.add(p.cloth,
        surface(sheet(24, 18, {0.36f, 0.26f},
                      [](float u, float v) {
                        const float x = 0.36f * (u - 0.5f), z = 0.26f * (v - 0.5f);
                        return glm::vec3(
                            x, 0.012f + 0.014f * (1 + std::sin(23 * x + 9 * z) * std::cos(17 * z)), z);
                      }),
                0.004f),
        at(-kX + 0.42f, top, kBench - 0.1f) * turnY(30));
  for (uint32_t i = 0; i < 5; ++i) {
    const glm::mat4 jar = at(-kX + 0.12f, top, kBench - 0.35f + 0.14f * float(i));
    m.add(i % 2 == 0 ? p.brass : p.steel, cylinder(0.045f, 0.1f, 24, 0.006f), jar);
    m.add(p.dark, cylinder(0.047f, 0.018f, 24, 0.003f), jar * at(0, 0.098f, 0));
  }
  for (int i = 0; i < 7; ++i) {
    const float length = 0.14f + 0.022f * float(i), z = kBench - 0.3f + 0.085f * float(i);
    const glm::mat4 hook = at(-kX + 0.012f, 1.34f, z) * turnY(90);
    m.add(p.dark, tube({{0, 0, -0.02f}, {0, 0, 0.03f}}, 0.004f, 6), hook);
    m.add(p.steel, torus(0.014f + 0.001f * float(i), 0.005f, 20, 6),
          hook * at(0, -0.012f, 0.014f) * turnX(90));
    m.add(p.steel, box({-0.006f, -length, 0.010f}, {0.006f, -0.026f, 0.018f}), hook);
    for (const float side : {-1.0f, 1.0f})
      m.add(p.steel, box({-0.005f, -0.035f, 0.0095f}, {0.005f, 0.003f, 0.0185f}),
            hook * at(0, -length + 0.003f, 0) * turnZ(180 + 32 * side));
  }
}

// Along the right wall: a locker, a ladder, tyres, a fire extinguisher, a cable on a hook.
void addStores(MeshBuilder& m, const Palette& p) {
  const glm::mat4 locker = at(kX - 0.03f, 0, -2.35f) * turnY(-90);
  m.add(p.blue, box({-0.5f, 0.06f, 0}, {0.5f, 1.85f, 0.46f}, {.bevel = 0.006f}), locker);
  m.add(p.dark, box({-0.47f, -0.005f, 0.02f}, {0.47f, 0.062f, 0.43f}), locker);
  for (const float side : {-1.0f, 1.0f}) {
    const float inner = side * 0.012f, outer = side * 0.475f;
    m.add(p.blue,
          box({std::min(inner, outer), 0.1f, 0.45f}, {std::max(inner, outer), 1.81f, 0.475f},
              {.bevel = 0.005f}),
          locker);
    for (int i = 0; i < 5; ++i)
      m.add(p.dark,
            box({side * 0.25f - 0.1f, 1.5f + 0.04f * float(i), 0.46f},
                {side * 0.25f + 0.1f, 1.512f + 0.04f * float(i), 0.477f}),
            locker);
    m.add(p.steel, box({-0.009f, 0.9f, 0.47f}, {0.009f, 1.03f, 0.5f}, {.bevel = 0.004f}),
          locker * at(side * 0.06f, 0, 0));
  }
  m.add(p.cardboard, block(0.5f, 0.28f, 0.36f, {.bevel = 0.003f}),
        locker * at(-0.14f, 1.85f, 0.23f) * turnY(7));
  // A stack of tyres, and one that leans against the wall.
  for (int i = 0; i < 4; ++i)
    m.add(p.rubber, tyre(),
          at(2.55f + 0.02f * float(i % 2), 0.08f + 0.159f * float(i), 0.3f + 0.025f * float(i % 3)) *
              turnY(31 * float(i)));
  m.add(p.rubber, tyre(), at(2.842f, 0.302f, -0.42f) * turnZ(90 - 14));
  // A ladder.
  const glm::mat4 ladder = at(2.715f, 0, -1.15f) * turnY(-90) * turnX(-8);
  for (const float side : {-0.19f, 0.19f})
    m.add(p.planks, box({side - 0.018f, 0, -0.035f}, {side + 0.018f, 1.8f, 0.035f}, {.bevel = 0.004f}),
          ladder);
  for (int i = 0; i < 6; ++i)
    m.add(
        p.planks,
        box({-0.18f, 0.27f * float(i + 1) - 0.015f, -0.028f}, {0.18f, 0.27f * float(i + 1) + 0.015f, 0.028f}),
        ladder);
  // The fire extinguisher.
  const glm::mat4 extinguisher = at(kX - 0.1f, 1.0f, -0.35f);
  m.add(p.red, cylinder(0.075f, 0.42f, 32, 0.03f), extinguisher);
  m.add(p.dark, cylinder(0.022f, 0.06f, 16), extinguisher * at(0, 0.41f, 0));
  m.add(p.dark, box({-0.015f, 0.46f, -0.08f}, {0.015f, 0.485f, 0.03f}, {.bevel = 0.004f}), extinguisher);
  m.add(
      p.dark,
      tube(smoothPath(
               {{0, 0.44f, 0.02f}, {-0.02f, 0.45f, 0.1f}, {-0.03f, 0.3f, 0.11f}, {-0.03f, 0.1f, 0.085f}}, 6),
           0.011f, 8),
      extinguisher);
  m.add(p.steel, box({0.06f, 0.25f, -0.03f}, {0.11f, 0.3f, 0.03f}), extinguisher);
  // A coil of cable on a hook, whose end hangs down.
  const glm::vec3 hook(kX, 1.78f, 0.35f);
  m.add(p.dark, tube({hook + glm::vec3(0.01f, 0, 0), hook - glm::vec3(0.1f, -0.02f, 0)}, 0.01f, 8));
  std::vector<glm::vec3> coil;
  for (int i = 0; i <= 120; ++i) {
    const float a = 6.2831853f * float(i) / 24, r = 0.16f + 0.012f * std::sin(1.7f * a);
    coil.push_back(hook + glm::vec3(-0.03f - 0.003f * float(i) / 7, -1.25f * r * (1 - std::cos(a)) + 0.02f,
                                    r * std::sin(a)));
  }
  for (const glm::vec3& q :
       {glm::vec3(-0.11f, -0.1f, 0.2f), glm::vec3(-0.1f, -0.5f, 0.24f), glm::vec3(-0.06f, -0.8f, 0.21f)})
    coil.push_back(hook + q);
  m.add(p.orange, tube(coil, 0.008f, 7));
}

// On the floor and from the ceiling: cans, a bucket, a broom, axle stands, cables.
void addThings(MeshBuilder& m, const Palette& p) {
  // An oil drum and cans near the rolling door.
  const glm::mat4 drum = at(-2.1f, 0, -2.6f);
  m.add(p.blue, cylinder(0.28f, 0.86f, 40, 0.012f), drum);
  for (const float y : {0.29f, 0.58f}) m.add(p.blue, torus(0.281f, 0.013f, 44, 8), drum * at(0, y, 0));
  m.add(p.steel, torus(0.272f, 0.011f, 44, 8), drum * at(0, 0.858f, 0));
  m.add(p.dark, cylinder(0.03f, 0.015f, 18), drum * at(0.15f, 0.859f, 0.05f));
  const glm::mat4 jerry = at(-1.72f, 0, -2.25f) * turnY(35);
  m.add(p.yellow, block(0.34f, 0.4f, 0.16f, {.bevel = 0.03f, .bevelSteps = 2}), jerry);
  for (const float z : {-0.045f, 0.0f, 0.045f})
    m.add(p.yellow,
          tube({{-0.1f, 0.38f, z}, {-0.09f, 0.44f, z}, {0.06f, 0.44f, z}, {0.07f, 0.38f, z}}, 0.01f, 8),
          jerry);
  m.add(p.dark, cylinder(0.03f, 0.05f, 18), jerry * at(0.12f, 0.38f, 0) * turnZ(-20));
  // A bucket, and an axle stand on each side of it.
  Outline bucket({0, 0});
  bucket.line(0.11f, 0)
      .line(0.15f, 0.27f)
      .line(0.158f, 0.272f)
      .line(0.158f, 0.28f)
      .line(0.143f, 0.28f)
      .line(0.104f, 0.01f);
  bucket.line(0, 0.01f);
  m.add(p.white, lathe(bucket, {.segments = 36}), at(-1.55f, 0, 0.35f));
  m.add(
      p.steel,
      tube(smoothPath(
               {{-0.155f, 0.255f, 0}, {-0.12f, 0.17f, 0.16f}, {0.12f, 0.17f, 0.16f}, {0.155f, 0.255f, 0}}, 6),
           0.004f, 6),
      at(-1.55f, 0, 0.35f) * turnY(40));
  for (const glm::vec3& q : {glm::vec3(-1.5f, 0, -0.35f), glm::vec3(-1.78f, 0, -0.05f)}) {
    for (int i = 0; i < 4; ++i)
      m.add(p.red, tube({{0.11f, 0, 0}, {0.02f, 0.26f, 0}}, 0.014f, 8), at(q) * turnY(20 + 90 * float(i)));
    m.add(p.red, cylinder(0.034f, 0.1f, 20), at(q) * at(0, 0.2f, 0));
    m.add(p.steel, cylinder(0.02f, 0.14f, 18), at(q) * at(0, 0.25f, 0));
    m.add(p.steel, block(0.11f, 0.025f, 0.045f, {.bevel = 0.004f}), at(q) * at(0, 0.385f, 0));
  }
  // A broom against the left wall.
  m.add(p.planks, tube({{-2.5f, 0.06f, 0.62f}, {-kX + 0.015f, 1.5f, 0.55f}}, 0.013f, 10));
  m.add(p.brass, box({-0.05f, 0, -0.17f}, {0.05f, 0.09f, 0.17f}, {.bevel = 0.012f}),
        at(-2.49f, 0, 0.62f) * turnY(5));
  // A cable that sags from the ceiling to the bench, and one over the floor to a socket.
  m.add(p.dark, tube(smoothPath({{-1.45f, kHigh + 0.01f, -0.2f},
                                 {-1.5f, 2.42f, 0.15f},
                                 {-2.0f, 2.2f, 0.45f},
                                 {-2.7f, 2.35f, 0.5f},
                                 {-kX - 0.01f, 2.5f, 0.5f}},
                                8),
                     0.007f, 7));
  m.add(p.orange, tube(smoothPath({{-kX + 0.02f, 0.45f, 0.9f},
                                   {-2.9f, 0.36f, 0.9f},
                                   {-2.86f, 0.09f, 0.93f},
                                   {-2.8f, 0.025f, 0.96f},
                                   {-2.72f, 0.009f, 0.97f},
                                   {-2.5f, 0.007f, 0.9f},
                                   {-2.2f, 0.007f, 1.1f},
                                   {-2.08f, 0.01f, 1.13f},
                                   {-1.95f, 0.03f, 1.12f},
                                   {-1.79f, 0.1f, 1.05f}},
                                  10),
                       0.007f, 7));
  const glm::mat4 reel = at(-1.75f, 0.17f, 0.95f) * turnY(25);
  for (const float z : {-0.09f, 0.075f})
    m.add(p.dark, cylinder(0.15f, 0.015f, 32), reel * at(0, 0, z) * turnX(90));
  for (int i = 0; i < 9; ++i)
    m.add(p.orange, torus(0.115f + 0.003f * float(i % 2), 0.0085f, 22, 5),
          reel * at(0, 0, -0.07f + 0.0165f * float(i)) * turnX(90));
  for (const float z : {-0.11f, 0.11f})
    m.add(p.steel,
          tube({{-0.13f, -0.162f, z},
                {-0.06f, 0.2f, z},
                {0.06f, 0.2f, z},
                {0.13f, -0.162f, z},
                {-0.13f, -0.162f, z}},
               0.009f, 8),
          reel);
  for (const glm::vec2& q : {glm::vec2(0, 0.2f), glm::vec2(0, 0)})
    m.add(p.steel, tube({{q.x, q.y, -0.115f}, {q.x, q.y, 0.115f}}, 0.011f, 8), reel);
  m.add(p.white, box({-kX - 0.01f, 0.38f, 0.85f}, {-kX + 0.035f, 0.5f, 0.95f}, {.bevel = 0.006f}));
}

// A board on castors for lying under a car, with its head towards +x.
MeshBuilder creeper(const Palette& p) {
  MeshBuilder m;
  m.add(p.dark, box({-0.5f, 0.085f, -0.2f}, {0.5f, 0.125f, 0.2f}, {.bevel = 0.015f}));
  m.add(p.red, box({0.27f, 0.12f, -0.15f}, {0.47f, 0.165f, 0.15f}, {.bevel = 0.018f}));
  for (const float z : {-0.205f, 0.205f})
    m.add(p.steel, box({-0.46f, 0.075f, z - 0.014f}, {0.46f, 0.11f, z + 0.014f}, {.bevel = 0.004f}));
  for (const float x : {-0.42f, 0.0f, 0.42f})
    for (const float z : {-0.2f, 0.2f}) {
      m.add(p.steel, box({x - 0.013f, 0.04f, z - 0.022f}, {x + 0.013f, 0.08f, z + 0.022f}));
      m.add(p.rubber, cylinder(0.032f, 0.024f, 24, 0.004f), at(x, 0.032f, z - 0.012f) * turnX(90));
    }
  return m;
}

Scene garageScene() {
  SceneBuilder b("garage");
  const Palette p = makePalette(b);
  MeshBuilder room, lamps, things;
  addRoom(room, p);
  addLamps(lamps, p);
  addBench(things, p);
  addStores(things, p);
  addThings(things, p);
  b.place("room", b.mesh("room", std::move(room)));
  b.place("lamps", b.mesh("lamps", std::move(lamps)));
  b.place("things", b.mesh("things", std::move(things)));
  b.place("car", b.mesh("car", hatchback(p.car)), {0.42f, 0, -0.75f}, -7);
  b.place("creeper", b.mesh("creeper", creeper(p)), {-0.98f, 0, 0.95f}, 78);
  b.camera({1.55f, 1.6f, 2.6f}, {-0.6f, 0.95f, -1.6f}, 64);
  return b.finish(4.4f, {0.45f, 0.5f});
}

FOVEA_SCENE("garage", garageScene);

}  // namespace
}  // namespace fovea::scene
