// A launderette at night that is lit only by fluorescent tubes: pairs in recesses of the ceiling and on a wall, upright
// ones beside a mirror, and a row behind a cornice, of which only the light on the ceiling is seen. A row of machines
// with round doors, tiled walls, shelves of bottles, a clothes rail and a cart that rolls.
#include <cmath>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr float kX = 2.25f, kFront = 3.0f, kBack = -5.0f, kHigh = 3.0f, kThick = 0.25f;
constexpr float kTiles = 1.9f;  // up to where the walls are tiled

struct Palette {
  uint32_t plaster, tiles, edge, floor, enamel, steel, dark, glass, wood, canvas, wicker, mirror, brass;
  uint32_t bottle[4], cloth[4];
  uint32_t tube;  // emissive
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 3101);
  MasonryLook tiles;
  tiles.columns = 8;
  tiles.rows = 8;
  tiles.joint = 0.04f;
  tiles.low = {0.66f, 0.74f, 0.72f};
  tiles.high = {0.74f, 0.80f, 0.78f};
  tiles.jointColor = {0.45f, 0.46f, 0.45f};
  tiles.weathering = 0.05f;
  tiles.staggered = false;
  p.plaster = b.material("yellow plaster", {0.80f, 0.74f, 0.58f}, {.texture = s.plaster, .metres = 3});
  p.tiles = b.material("wall tiles", glm::vec3(1),
                       {.texture = b.texture(masonry("wall tiles", tiles, 512, 512, 3111)), .metres = 1.2f});
  p.edge = b.material("dark tiles", {0.06f, 0.20f, 0.24f});
  p.floor = b.material(
      "floor tiles", glm::vec3(1),
      {.texture = b.texture(bake("floor tiles", 256, 256,
                                 [](float u, float v) {
                                   const bool even = (u < 0.5f) == (v < 0.5f);
                                   const float grain = fractal({16 * u, 16 * v}, 3121, 3, 16);
                                   return (0.85f + 0.3f * grain) * (even ? glm::vec3(0.52f, 0.49f, 0.43f)
                                                                         : glm::vec3(0.16f, 0.17f, 0.18f));
                                 })),
       .metres = 0.9f});
  p.enamel = b.material("white enamel", {0.80f, 0.80f, 0.79f});
  p.steel = b.material("steel", {0.52f, 0.53f, 0.54f});
  p.dark = b.material("black plastic", {0.045f, 0.045f, 0.05f});
  p.glass = b.material("door glass", {0.06f, 0.09f, 0.11f});
  p.wood =
      b.material("beech", {0.66f, 0.46f, 0.28f}, {.texture = s.grain, .metres = 0.4f, .metresHigh = 1.4f});
  p.canvas = b.material("canvas", {0.70f, 0.64f, 0.52f}, {.texture = s.linen, .metres = 0.4f});
  p.wicker = b.material("wicker", {0.58f, 0.40f, 0.22f}, {.texture = s.linen, .metres = 0.15f});
  p.mirror = b.material("old mirror", {0.42f, 0.46f, 0.47f}, {.texture = s.mottled, .metres = 1});
  p.brass = b.material("brass", {0.58f, 0.42f, 0.17f});
  const glm::vec3 bottles[4] = {
      {0.10f, 0.28f, 0.58f}, {0.74f, 0.32f, 0.05f}, {0.72f, 0.72f, 0.70f}, {0.16f, 0.42f, 0.20f}};
  const glm::vec3 cloths[4] = {
      {0.52f, 0.10f, 0.13f}, {0.72f, 0.70f, 0.65f}, {0.14f, 0.22f, 0.42f}, {0.70f, 0.50f, 0.16f}};
  for (int i = 0; i < 4; ++i) {
    p.bottle[i] = b.material("bottle " + std::to_string(i + 1), bottles[i]);
    p.cloth[i] =
        b.material("cloth " + std::to_string(i + 1), cloths[i], {.texture = s.linen, .metres = 0.4f});
  }
  p.tube = b.material("tube", {0.76f, 0.76f, 0.74f}, {.emission = {15.5f, 14.6f, 12.2f}});
  return p;
}

// A fitting on the plane z = 0 with `count` tubes along x, side by side. They light what lies before it, along +z.
void addFitting(MeshBuilder& m, const Palette& p, float length, int count, const glm::mat4& where) {
  const float half = 0.5f * length, pitch = 0.08f, axis = 0.05f,
              wide = 0.5f * pitch * float(count - 1) + 0.035f;
  m.add(p.enamel, box({-half - 0.028f, -wide, -0.01f}, {half + 0.028f, wide, 0.026f}, {.bevel = 0.003f}),
        where);
  for (int i = 0; i < count; ++i)
    m.add(p.tube, cylinder(0.013f, length, 12),
          where * at(-half, pitch * (float(i) - 0.5f * float(count - 1)), axis) * turnZ(-90));
  for (const float side : {-1.0f, 1.0f})
    m.add(p.dark,
          box({-0.013f, -wide + 0.012f, 0}, {0.013f, wide - 0.012f, axis + 0.018f}, {.bevel = 0.003f}),
          where * at(side * (half + 0.011f), 0, 0));
}

// A recess of the ceiling along z, about x and z.
struct Recess {
  float x, z;
};
constexpr Recess kRecesses[2] = {{-0.45f, 0.1f}, {-0.45f, -2.6f}};
constexpr float kRecessX = 0.15f, kRecessZ = 0.84f, kRecessDeep = 0.09f;

void addRoom(MeshBuilder& m, const Palette& p) {
  const float x = kX + kThick, e = 0.1f, top = kHigh + kThick + 0.1f;
  m.add(p.floor, box({-x, -kThick, kBack - kThick}, {x, 0, kFront + kThick}));
  for (const float side : {-1.0f, 1.0f}) {
    m.add(p.plaster, box({-0.5f * kThick, -e, kBack - kThick}, {0.5f * kThick, top, kFront + kThick}),
          at(side * (kX + 0.5f * kThick), 0, 0));
    m.add(p.tiles, box({-0.01f, -0.02f, kBack - 0.02f}, {0.01f, kTiles, kFront + 0.02f}),
          at(side * kX, 0, 0));
    m.add(p.edge,
          box({-0.016f, kTiles - 0.01f, kBack - 0.02f}, {0.016f, kTiles + 0.06f, kFront + 0.02f},
              {.bevel = 0.004f}),
          at(side * kX, 0, 0));
    const float z = side > 0 ? kFront : kBack;
    m.add(p.plaster, box({-kX - e, -e, -0.5f * kThick}, {kX + e, top, 0.5f * kThick}),
          at(0, 0, z + side * 0.5f * kThick));
    m.add(p.tiles, box({-kX - 0.01f, -0.021f, -0.01f}, {kX + 0.01f, kTiles - 0.001f, 0.01f}), at(0, 0, z));
    m.add(p.edge,
          box({-kX - 0.01f, kTiles - 0.009f, -0.0155f}, {kX + 0.01f, kTiles + 0.0595f, 0.0155f},
              {.bevel = 0.004f}),
          at(0, 0, z));
  }
  // The ceiling, around the recesses and above them.
  const float left = kRecesses[0].x - kRecessX, right = kRecesses[0].x + kRecessX,
              above = kHigh + kRecessDeep;
  m.add(p.plaster, box({-kX - e, above, kBack - e}, {kX + e, above + kThick, kFront + e}));
  m.add(p.plaster, box({-kX - e, kHigh, kBack - e}, {left, above + 0.01f, kFront + e}));
  m.add(p.plaster, box({right, kHigh, kBack - e}, {kX + e, above + 0.01f, kFront + e}));
  const float ends[6] = {kFront + e,
                         kRecesses[0].z + kRecessZ,
                         kRecesses[0].z - kRecessZ,
                         kRecesses[1].z + kRecessZ,
                         kRecesses[1].z - kRecessZ,
                         kBack - e};
  for (int i = 0; i < 6; i += 2)
    m.add(p.plaster, box({left - 0.01f, kHigh, ends[i + 1]}, {right + 0.01f, above + 0.01f, ends[i]}));
  // Frames around the recesses.
  for (const Recess& r : kRecesses)
    for (const float side : {-1.0f, 1.0f}) {
      m.add(p.steel, box({r.x + side * kRecessX - 0.012f, kHigh - 0.008f, r.z - kRecessZ - 0.012f},
                         {r.x + side * kRecessX + 0.012f, kHigh + 0.03f, r.z + kRecessZ + 0.012f}));
      m.add(p.steel, box({r.x - kRecessX, kHigh - 0.0075f, r.z + side * kRecessZ - 0.012f},
                         {r.x + kRecessX, kHigh + 0.03f, r.z + side * kRecessZ + 0.012f}));
    }
  // A door in the wall behind the first view.
  m.add(p.wood, box({0.4f, 0, kFront - 0.05f}, {1.35f, 2.1f, kFront + 0.05f}, {.bevel = 0.004f}));
}

void addLamps(MeshBuilder& m, const Palette& p) {
  for (const Recess& r : kRecesses)
    addFitting(m, p, 1.5f, 2, at(r.x, kHigh + kRecessDeep, r.z) * turnY(90) * turnX(90));
  addFitting(m, p, 0.9f, 2, at(-kX, 2.3f, -1.5f) * turnY(90));
  addFitting(m, p, 0.9f, 2, at(-kX, 2.3f, -3.9f) * turnY(90));
  // Beside the mirror, which hangs above a basin.
  const glm::vec3 mirror(0.72f, 1.6f, kBack);
  m.add(framed(p.brass, p.mirror, 0.62f, 0.86f), at(mirror + glm::vec3(0, 0, 0.015f)));
  for (const float side : {-0.47f, 0.47f})
    addFitting(m, p, 0.9f, 1, at(mirror + glm::vec3(side, 0, 0.008f)) * turnZ(90));
  // The cornice along the right wall, whose lip hides the tubes on it.
  const float z0 = -4.75f, z1 = 0.65f;
  m.add(p.plaster, box({kX - 0.2f, 2.62f, z0}, {kX + 0.05f, 2.65f, z1}));
  m.add(p.plaster,
        box({kX - 0.225f, 2.60f, z0 - 0.005f}, {kX - 0.199f, 2.765f, z1 + 0.005f}, {.bevel = 0.006f}));
  for (const float z : {z0 - 0.012f, z1 - 0.012f})
    m.add(p.plaster, box({kX - 0.21f, 2.61f, z}, {kX + 0.05f, 2.76f, z + 0.024f}));
  for (const float z : {-3.8f, -2.05f, -0.3f})
    addFitting(m, p, 1.5f, 1, at(kX - 0.085f, 2.65f, z) * turnY(90) * turnX(-90));
}

// A machine with a round door, which stands on y = 0 with its back at z = 0 and looks along +z.
MeshBuilder machine(const Palette& p, uint32_t shell, float height, float door) {
  MeshBuilder m;
  const float front = 0.66f, half = 0.33f, middle = 0.47f * height;
  m.add(p.dark, box({-half + 0.03f, 0, 0.03f}, {half - 0.03f, 0.062f, front - 0.04f}));
  m.add(shell, box({-half, 0.06f, 0}, {half, height, front}, {.bevel = 0.014f}));
  m.add(shell,
        lathe(Outline({{door, 0}, {door + 0.055f, 0}, {door + 0.05f, 0.022f}, {door, 0.03f}}),
              {.segments = 40, .closed = true}),
        at(0, middle, front - 0.004f) * turnX(90));
  m.add(p.steel, torus(door, 0.02f, 36, 8), at(0, middle, front + 0.022f) * turnX(90));
  m.add(p.glass, sphere(door - 0.005f, 32, 12), at(0, middle, front + 0.004f) * scaled(1, 1, 0.3f));
  m.add(p.steel, box({-0.018f, -0.05f, 0}, {0.018f, 0.05f, 0.05f}, {.bevel = 0.007f}),
        at(door + 0.012f, middle, front + 0.005f));
  m.add(p.steel, box({-0.015f, -0.045f, 0}, {0.015f, 0.045f, 0.04f}, {.bevel = 0.005f}),
        at(-door - 0.018f, middle, front - 0.005f));
  // Controls.
  const float y = height - 0.11f;
  m.add(p.edge, box({-half + 0.03f, y - 0.06f, front - 0.01f}, {half - 0.03f, y + 0.065f, front + 0.006f},
                    {.bevel = 0.004f}));
  m.add(p.enamel, cylinder(0.034f, 0.03f, 24, 0.005f), at(0.18f, y, front) * turnX(90));
  m.add(p.dark, box({0.176f, y - 0.005f, front + 0.02f}, {0.184f, y + 0.03f, front + 0.0315f}));
  for (int i = 0; i < 3; ++i)
    m.add(p.steel, cylinder(0.011f, 0.016f, 14, 0.002f), at(-0.02f + 0.05f * float(i), y, front) * turnX(90));
  m.add(p.steel, box({-0.25f, y - 0.035f, front}, {-0.1f, y + 0.04f, front + 0.013f}, {.bevel = 0.003f}));
  m.add(p.dark, box({-0.18f, y - 0.012f, front + 0.005f}, {-0.172f, y + 0.02f, front + 0.0135f}));
  return m;
}

// A bottle of 0.3 m with a handle-less neck, and one with shoulders.
Shape bottle(bool round) {
  Outline o({0, 0});
  if (round)
    o.line(0.05f, 0)
        .through({{0.058f, 0.02f}, {0.056f, 0.15f}, {0.03f, 0.22f}, {0.018f, 0.25f}}, 3)
        .line(0.018f, 0.27f);
  else
    o.line(0.05f, 0).line(0.054f, 0.006f).line(0.054f, 0.17f).line(0.03f, 0.2f).line(0.022f, 0.24f);
  return lathe(o.line(0, o.points().back().y), {.segments = 16});
}

// Crumpled washing, about the origin.
Shape crumpled(float radius, float seed) {
  return bent(
      sphere(radius, 18, 10),
      [&](glm::vec3 q) {
        const glm::vec3 d = q / radius;
        return q *
               (0.92f + 0.10f * std::sin(6 * d.x + 3 * d.z + seed) * std::cos(5 * d.z - 4 * d.y + 2 * seed));
      },
      80);
}

// A basket that stands on y = 0, with washing in it.
MeshBuilder basket(const Palette& p, uint32_t cloth, float radius, float height, uint32_t seed) {
  MeshBuilder m;
  Outline o({0, 0});
  o.line(0.78f * radius, 0)
      .line(radius, height)
      .line(1.05f * radius, height)
      .line(1.05f * radius, height + 0.022f);
  o.line(0.95f * radius, height + 0.022f).line(0.74f * radius, 0.012f).line(0, 0.012f);
  m.add(p.wicker,
        lathe(o, {.segments = 36, .swell = [](float a, float) { return 1 + 0.012f * std::cos(18 * a); }}));
  for (uint32_t i = 0; i < 5; ++i) {
    const float a = 1.2566f * float(i) + random(seed, i), r = 0.42f * radius;
    m.add(cloth, crumpled(0.47f * radius, float(i)),
          at(r * std::cos(a), height - random(seed + 1, i, 0.01f, 0.07f), r * std::sin(a)) *
              turnY(70 * float(i)) * scaled(1, 0.6f, 0.85f));
  }
  return m;
}

void addMachines(MeshBuilder& m, const Palette& p) {
  for (int i = 0; i < 6; ++i)
    m.add(machine(p, p.enamel, 0.98f, 0.18f), at(-kX + 0.06f, 0, 0.55f - 0.7f * float(i)) * turnY(90));
  for (int level = 0; level < 2; ++level)
    m.add(machine(p, p.steel, 0.92f, 0.23f), at(-kX + 0.06f, 0.921f * float(level), -4.55f) * turnY(90));
  // A worktop over the washers, with baskets, boxes and a folded pile on it.
  const float top = 1.025f;
  m.add(p.wood, box({-kX - 0.01f, 0.979f, -3.3f}, {-kX + 0.76f, top, 0.91f}, {.bevel = 0.006f}));
  m.add(basket(p, p.cloth[1], 0.2f, 0.24f, 3131), at(-kX + 0.36f, top, 0.25f));
  m.add(basket(p, p.cloth[0], 0.17f, 0.18f, 3133), at(-kX + 0.4f, top, -2.3f));
  for (int i = 0; i < 5; ++i)
    m.add(p.cloth[(i * 3) % 4], block(0.3f, 0.034f, 0.36f, {.bevel = 0.015f}),
          at(-kX + 0.36f, top + 0.0335f * float(i), -0.6f) * turnY(4 * std::sin(2.3f * float(i))));
  for (int i = 0; i < 4; ++i)
    m.add(p.bottle[i], block(0.09f, 0.26f, 0.18f, {.bevel = 0.004f}),
          at(-kX + 0.2f, top, -1.3f - 0.21f * float(i)) * turnY(9 * float(i % 3) - 6));
  // The basin below the mirror.
  const glm::mat4 basin = at(0.72f, 0, kBack + 0.26f);
  Outline bowl({0, 0.68f});
  bowl.line(0.1f, 0.68f).curve({0.22f, 0.72f}, {0.25f, 0.8f}, {0.25f, 0.86f}, 6).line(0.225f, 0.862f);
  bowl.curve({0.22f, 0.8f}, {0.15f, 0.75f}, {0, 0.745f}, 6);
  m.add(p.enamel, lathe(bowl, {.segments = 40}), basin);
  m.add(p.enamel, cylinder(0.09f, 0.69f, 28), basin);
  m.add(p.enamel, box({-0.2f, 0.76f, -0.27f}, {0.2f, 0.86f, -0.15f}, {.bevel = 0.02f, .bevelSteps = 2}),
        basin);
  m.add(p.steel,
        tube(smoothPath({{0, 0.85f, -0.19f}, {0, 0.98f, -0.19f}, {0, 1.02f, -0.13f}, {0, 0.97f, -0.08f}}, 6),
             0.012f, 10),
        basin);
}

// Along the right wall: shelves of bottles, a bench, hooks.
void addShelves(MeshBuilder& m, const Palette& p) {
  const float z0 = -2.0f, z1 = -0.2f;
  for (int row = 0; row < 4; ++row) {
    const float y = 0.45f + 0.45f * float(row);
    m.add(p.wood, box({kX - 0.3f, y - 0.025f, z0}, {kX + 0.01f, y, z1}));
    float z = z0 + 0.12f;
    for (uint32_t i = 0; z < z1 - 0.08f; ++i) {
      const uint32_t n = 30 * uint32_t(row) + i;
      const glm::mat4 where = at(kX - random(3141, n, 0.1f, 0.21f), y, z);
      if (row == 3 && i % 4 == 1) {
        m.add(p.canvas, block(0.2f, 0.2f, 0.24f, {.bevel = 0.006f}), where * turnY(random(3142, n, -8, 8)));
        z += 0.27f;
      } else if (random(3143, n) < 0.85f) {
        const float size = random(3144, n, 0.75f, 1.1f);
        m.add(p.bottle[random(3145, n) < 0.5f ? row : n % 4], bottle((row + i / 3) % 2 == 0),
              where * scaled(size));
        m.add(p.bottle[(n + 2) % 4], cylinder(0.024f, 0.036f, 12),
              where * at(0, ((row + i / 3) % 2 == 0 ? 0.255f : 0.225f) * size, 0));
        z += 0.03f;
      }
      z += 0.13f;
    }
  }
  for (const float z : {z0 - 0.02f, z1 - 0.005f})
    m.add(p.steel, box({kX - 0.31f, 0, z}, {kX + 0.01f, 1.86f, z + 0.025f}));
  // A bench of laths.
  const glm::mat4 bench = at(kX - 0.32f, 0, 0.75f) * turnY(-90);
  for (int i = 0; i < 5; ++i)
    m.add(p.wood,
          box({-0.75f, 0.43f, -0.2f + 0.085f * float(i)}, {0.75f, 0.46f, -0.135f + 0.085f * float(i)},
              {.bevel = 0.006f}),
          bench);
  for (const float x : {-0.55f, 0.55f}) {
    m.add(p.steel, tube({{x, 0, -0.15f}, {x, 0.42f, -0.15f}, {x, 0.42f, 0.17f}, {x, 0, 0.17f}}, 0.018f, 10),
          bench);
    m.add(p.steel, box({x - 0.02f, 0.41f, -0.18f}, {x + 0.02f, 0.4315f, 0.2f}), bench);
  }
  m.add(basket(p, p.cloth[2], 0.18f, 0.2f, 3151), bench * at(-0.4f, 0.46f, 0));
  // Hooks above the bench, with a coat and a bag.
  m.add(p.wood, box({kX - 0.03f, 1.62f, 0.2f}, {kX, 1.7f, 1.5f}, {.bevel = 0.005f}));
  for (int i = 0; i < 5; ++i)
    m.add(p.brass,
          tube({{kX - 0.02f, 1.66f, 0.35f + 0.25f * float(i)}, {kX - 0.1f, 1.67f, 0.35f + 0.25f * float(i)}},
               0.009f, 8));
  m.add(p.cloth[2],
        surface(sheet(18, 20, {0.4f, 0.85f},
                      [](float u, float v) {
                        const float w = 0.05f + 0.17f * smoothstep(0, 0.3f, v) + 0.03f * v;
                        return glm::vec3(2 * w * (u - 0.5f), -0.85f * v,
                                         0.05f + 0.035f * std::sin(15 * u) * smoothstep(0.1f, 0.9f, v));
                      }),
                0.008f),
        at(kX - 0.03f, 1.7f, 0.85f) * turnY(-90));
}

// A rail on two feet along z, with cloths on hangers.
MeshBuilder rail(const Palette& p) {
  MeshBuilder m;
  for (const float x : {-0.75f, 0.75f}) {
    m.add(p.steel, tube({{x, 0.03f, 0}, {x, 1.62f, 0}}, 0.016f, 12));
    m.add(p.steel, tube({{x, 0.03f, -0.24f}, {x, 0.03f, 0.24f}}, 0.018f, 10));
    for (const float z : {-0.24f, 0.24f}) m.add(p.dark, sphere(0.028f, 16, 10), at(x, 0.027f, z));
  }
  m.add(p.steel, tube({{-0.76f, 1.61f, 0}, {0.76f, 1.61f, 0}}, 0.015f, 12));
  m.add(p.steel, tube({{-0.75f, 0.2f, 0}, {0.75f, 0.2f, 0}}, 0.012f, 10));
  for (int i = 0; i < 7; ++i) {
    const float x = -0.6f + 0.19f * float(i), drop = random(3161, uint32_t(i), 0.7f, 1.15f),
                wave = random(3162, uint32_t(i), 0, 6);
    const glm::mat4 hanger = at(x, 1.61f, 0) * turnY(90 + random(3163, uint32_t(i), -9, 9));
    m.add(p.steel,
          tube(smoothPath({{0.012f, 0.0f, 0},
                           {0.012f, 0.018f, 0},
                           {-0.012f, 0.018f, 0},
                           {-0.018f, -0.01f, 0},
                           {0, -0.07f, 0}},
                          4),
               0.003f, 6),
          hanger);
    m.add(p.wood, tube({{-0.2f, -0.13f, 0}, {0, -0.07f, 0}, {0.2f, -0.13f, 0}}, 0.009f, 8), hanger);
    m.add(p.cloth[(i * 5 + 1) % 4],
          surface(sheet(20, 12, {0.46f, drop},
                        [&](float u, float v) {
                          const float s = 2 * u - 1, shoulder = 0.06f * std::abs(s) + 0.07f;
                          const float fold = 0.026f * std::sin(11 * u + wave) * smoothstep(0.02f, 0.6f, v);
                          return glm::vec3(0.23f * s * (1 - 0.12f * smoothstep(0.2f, 0.8f, v)),
                                           -shoulder - drop * v, 0.012f + fold);
                        }),
                  0.006f),
          hanger);
  }
  return m;
}

// A canvas cart on castors, which rolls along x.
MeshBuilder cart(const Palette& p) {
  MeshBuilder m;
  const float x = 0.38f, z = 0.26f;
  for (const float sx : {-x, x})
    for (const float sz : {-z, z}) {
      m.add(p.steel, tube({{sx, 0.1f, sz}, {sx, 0.8f, sz}}, 0.012f, 10));
      m.add(p.dark, cylinder(0.045f, 0.026f, 26, 0.005f), at(sx, 0.045f, sz - 0.013f) * turnX(90));
      m.add(p.steel, box({sx - 0.014f, 0.05f, sz - 0.024f}, {sx + 0.014f, 0.11f, sz + 0.024f}));
    }
  for (const float y : {0.12f, 0.79f})
    m.add(p.steel, tube({{-x, y, -z}, {x, y, -z}, {x, y, z}, {-x, y, z}}, 0.012f, 10, true));
  const Shape bag =
      bent(box({-1, 0.13f, -1}, {1, 0.775f, 1}, {.bevel = 0.03f, .cells = {10, 8, 8}}), [&](glm::vec3 q) {
        const float v = (q.y - 0.13f) / 0.645f, bulge = 0.84f + 0.1f * std::sin(3.1416f * v);
        return glm::vec3(q.x * (x - 0.012f) * bulge, q.y, q.z * (z - 0.012f) * bulge);
      });
  m.add(p.canvas, bag);
  for (uint32_t i = 0; i < 6; ++i)
    m.add(p.cloth[i % 4], crumpled(0.16f, float(i)),
          at(-0.2f + 0.2f * float(i % 3), 0.755f, i < 3 ? -0.09f : 0.08f) * turnY(50 * float(i)) *
              scaled(1.1f, 0.55f, 0.9f));
  return m;
}

}  // namespace

static Scene laundryScene() {
  SceneBuilder b("laundry");
  const Palette p = makePalette(b);
  MeshBuilder room, lamps, things;
  addRoom(room, p);
  addLamps(lamps, p);
  addMachines(things, p);
  addShelves(things, p);
  things.add(rail(p), at(1.4f, 0, -3.2f) * turnY(38));
  b.place("room", b.mesh("room", std::move(room)));
  b.place("lamps", b.mesh("lamps", std::move(lamps)));
  b.place("things", b.mesh("things", std::move(things)));
  b.place("cart", b.mesh("cart", cart(p)), {0.1f, 0, -1.4f}, 70);
  b.camera({0.35f, 1.6f, 2.6f}, {-0.1f, 1.35f, -2.5f}, 60);
  return b.finish(3.3f, {0.5f, 0.5f});
}

FOVEA_SCENE("laundry", laundryScene);

}  // namespace fovea::scene
