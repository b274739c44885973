// An alley at night between two rows of timber houses. The only light comes from ten small paper lanterns; the sky is
// nearly black. Lattices of thin bars, cloths over the doors, and bamboo stand before the walls.
#include <cmath>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr float kX = 1.65f, kFront = 3.2f, kBack = -10.5f, kHigh = 5.6f;

struct Palette {
  uint32_t plaster, timber, lattice, paper, setts, stone, tiles, cloth[2], glow, band, clay, soil, leaf, cane,
      red, barrel, cat;
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 1401);
  MasonryLook setts;
  setts.columns = 5;
  setts.rows = 8;
  setts.low = {0.24f, 0.23f, 0.22f};
  setts.high = {0.44f, 0.42f, 0.39f};
  p.plaster = b.material("clay plaster", {0.66f, 0.55f, 0.40f}, {.texture = s.plaster, .metres = 2.5f});
  p.timber =
      b.material("timber", {0.32f, 0.18f, 0.10f}, {.texture = s.grain, .metres = 0.3f, .metresHigh = 1.8f});
  p.lattice =
      b.material("lattice", {0.46f, 0.27f, 0.14f}, {.texture = s.grain, .metres = 0.2f, .metresHigh = 1.2f});
  p.paper = b.material("paper screen", {0.78f, 0.74f, 0.64f});
  p.setts = b.material("setts", glm::vec3(1),
                       {.texture = b.texture(masonry("setts", setts, 512, 512, 1411)), .metres = 1.6f});
  p.stone = b.material("stone", {0.46f, 0.45f, 0.42f}, {.texture = s.mottled, .metres = 1});
  p.tiles = b.material("roof tiles", {0.16f, 0.17f, 0.19f}, {.texture = s.mottled, .metres = 0.7f});
  p.cloth[0] = b.material("indigo cloth", {0.07f, 0.12f, 0.38f},
                          {.texture = s.linen, .metres = 0.4f, .doubleSided = true});
  p.cloth[1] = b.material("red cloth", {0.62f, 0.08f, 0.05f},
                          {.texture = s.linen, .metres = 0.4f, .doubleSided = true});
  p.glow = b.material("paper lantern", {0.60f, 0.45f, 0.28f}, {.emission = {7.0f, 3.3f, 1.1f}});
  p.band = b.material("black lacquer", {0.04f, 0.03f, 0.03f});
  p.clay = b.material("glazed clay", {0.18f, 0.26f, 0.28f});
  p.soil = b.material("soil", {0.07f, 0.05f, 0.035f});
  p.leaf = b.material("bamboo leaves", {0.16f, 0.34f, 0.08f}, {.doubleSided = true});
  p.cane = b.material("bamboo canes", {0.34f, 0.42f, 0.16f});
  p.red = b.material("vermilion", {0.72f, 0.12f, 0.05f}, {.texture = s.mottled, .metres = 1});
  p.barrel =
      b.material("cask", {0.58f, 0.40f, 0.22f}, {.texture = s.planks, .metres = 0.5f, .metresHigh = 1.2f});
  p.cat = b.material("white fur", {0.78f, 0.74f, 0.68f});
  return p;
}

// A paper lantern that hangs from the origin.
MeshBuilder lantern(const Palette& p, float size) {
  MeshBuilder m;
  Outline o({0, -0.36f});
  o.line(0.07f, -0.36f).curve({0.17f, -0.34f}, {0.17f, -0.10f}, {0.07f, -0.08f}, 20).line(0, -0.08f);
  std::vector<glm::vec2> ribs = o.points();
  for (size_t i = 2; i + 2 < ribs.size(); i += 2) ribs[i].x *= 0.965f;
  Outline ribbed;
  for (const glm::vec2& q : ribs) ribbed.line(q.x, q.y);
  m.add(p.glow, lathe(ribbed, {.segments = 28, .creaseDegrees = 60}), scaled(size));
  for (const float y : {-0.385f, -0.085f})
    m.add(p.band, cylinder(0.075f, 0.03f, 24, 0.005f), scaled(size) * at(0, y, 0));
  m.add(p.band, tube({{0, 0, 0}, {0, -0.06f, 0}}, 0.004f, 6), scaled(size));
  m.add(p.red,
        tube(
            {{0, -0.38f, 0}, {0, -0.46f, 0}}, [](float t) { return 0.008f + 0.006f * t; }, 8),
        scaled(size));
  return m;
}

// A lattice of upright bars before a paper screen, from (0, 0) to (width, height), looking along +z.
MeshBuilder lattice(const Palette& p, float width, float height) {
  MeshBuilder m;
  m.add(p.paper, box({0, 0, -0.05f}, {width, height, 0.0f}));
  const int bars = int(width / 0.065f);
  for (int i = 0; i < bars; ++i) {
    const float x = width * (float(i) + 0.5f) / float(bars);
    m.add(p.lattice, box({x - 0.010f, 0, 0.04f}, {x + 0.010f, height, 0.065f}));
  }
  for (const float f : {0.3f, 0.62f})
    m.add(p.lattice, box({0, f * height - 0.012f, 0.025f}, {width, f * height + 0.012f, 0.0405f}));
  for (const float x : {0.0f, width})
    m.add(p.timber, box({x - 0.05f, -0.05f, -0.06f}, {x + 0.05f, height + 0.05f, 0.09f}, {.bevel = 0.004f}));
  for (const float y : {0.0f, height})
    m.add(p.timber,
          box({-0.049f, y - 0.045f, -0.058f}, {width + 0.049f, y + 0.045f, 0.085f}, {.bevel = 0.004f}));
  return m;
}

// Four strips of cloth that hang from a pole along x, from y = 0 down.
MeshBuilder doorCloth(const Palette& p, uint32_t cloth, float width, float drop) {
  MeshBuilder m;
  m.add(p.lattice, tube({{-0.08f, 0.01f, 0}, {width + 0.08f, 0.01f, 0}}, 0.016f, 10));
  for (int i = 0; i < 4; ++i) {
    const float w = width / 4 - 0.012f, x = width * float(i) / 4;
    m.add(cloth, surface(sheet(12, 10, {w, drop},
                               [&](float u, float v) {
                                 return glm::vec3(
                                     x + w * u, -drop * v,
                                     0.02f + 0.03f * v * std::sin(6 * u + 2.1f * float(i)) + 0.015f * v);
                               }),
                         0.004f));
  }
  return m;
}

// One side of the alley, looking along +z with its wall at z = 0; x runs from 0 to `length`.
MeshBuilder houses(const Palette& p, float length, uint32_t seed) {
  MeshBuilder m;
  const float bay = length / 5;
  m.add(p.plaster, box({-0.3f, -0.3f, -0.3f}, {length + 0.3f, kHigh, 0}));
  m.add(p.stone, box({-0.2f, -0.2f, -0.1f}, {length + 0.2f, 0.22f, 0.05f}, {.bevel = 0.01f}));
  for (int i = 0; i <= 5; ++i) {
    const float x = bay * float(i);
    m.add(p.timber, box({x - 0.08f, 0.1f, -0.1f}, {x + 0.08f, kHigh + 0.01f, 0.11f}, {.bevel = 0.006f}));
  }
  for (const float y : {2.35f, 2.95f, 4.9f})
    m.add(p.timber, box({-0.2f, y - 0.07f, -0.1f}, {length + 0.2f, y + 0.07f, 0.10f}, {.bevel = 0.006f}));
  for (int i = 0; i < 5; ++i) {
    const float x = bay * float(i);
    if ((uint32_t(i) + seed) % 2 == 0) {  // a door, half open behind its cloth
      m.add(p.timber, box({x + 0.4f, 0, -0.05f}, {x + bay - 0.4f, 2.1f, 0.03f}));
      for (int k = 0; k < 6; ++k)
        m.add(p.lattice, box({x + 0.45f + (bay - 0.9f) * float(k) / 6 + 0.02f, 0.1f, 0.02f},
                             {x + 0.45f + (bay - 0.9f) * float(k + 1) / 6 - 0.02f, 2.05f, 0.045f}));
      m.add(doorCloth(p, p.cloth[(uint32_t(i) / 2 + seed) % 2], bay - 0.9f, 0.72f),
            at(x + 0.45f, 2.08f, 0.16f));
      m.add(p.stone, box({x + 0.3f, -0.05f, 0.02f}, {x + bay - 0.3f, 0.16f, 0.38f},
                         {.bevel = 0.015f, .bevelSteps = 2}));
    } else {
      m.add(lattice(p, bay - 0.7f, 1.35f), at(x + 0.35f, 0.72f, 0.055f));
    }
    m.add(lattice(p, bay - 0.8f, 1.2f), at(x + 0.4f, 3.3f, 0.055f));
  }
  // Eaves over the ground floor and under the sky.
  for (const float y : {2.62f, kHigh - 0.02f}) {
    const glm::mat4 slope = at(-0.25f, y + 0.3f, -0.05f) * turnX(24);
    m.add(p.timber, box({0, -0.06f, 0}, {length + 0.5f, 0, 0.74f}), slope);
    const int tiles = int((length + 0.5f) / 0.22f);
    for (int i = 0; i < tiles; ++i)
      m.add(p.tiles,
            tube({{0.11f + 0.22f * float(i), 0.015f, 0.01f}, {0.11f + 0.22f * float(i), 0.015f, 0.77f}},
                 0.062f, 10),
            slope);
    m.add(p.tiles, box({0, -0.002f, -0.01f}, {length + 0.5f, 0.03f, 0.755f}), slope);
    for (int i = 0; i < int(length / 0.45f); ++i)
      m.add(p.timber, box({0.3f + 0.45f * float(i), -0.13f, 0}, {0.36f + 0.45f * float(i), -0.055f, 0.70f}),
            slope);
  }
  return m;
}

void addGate(MeshBuilder& m, const Palette& p) {
  m.add(p.plaster, box({-kX - 0.3f, -0.3f, kBack - 0.4f}, {kX + 0.3f, kHigh, kBack}));
  for (const float x : {-1.05f, 1.05f}) {
    m.add(p.red, cylinder(0.13f, 3.0f, 32), at(x, 0, kBack + 0.9f));
    m.add(p.stone, cylinder(0.2f, 0.16f, 32, 0.02f), at(x, 0, kBack + 0.9f));
  }
  m.add(p.red, box({-1.3f, 2.35f, kBack + 0.82f}, {1.3f, 2.52f, kBack + 0.98f}, {.bevel = 0.01f}));
  const Shape lintel =
      bent(box({-1.6f, 2.9f, -0.14f}, {1.6f, 3.1f, 0.14f}, {.bevel = 0.02f, .cells = {16, 1, 1}}),
           [](glm::vec3 q) { return q + glm::vec3(0, 0.05f * q.x * q.x, 0); });
  m.add(p.red, lintel, at(0, 0, kBack + 0.9f));
  // Steps up to a door behind the gate.
  for (int i = 0; i < 3; ++i)
    m.add(p.stone, box({-0.9f, -0.1f, kBack - 0.1f},
                       {0.9f, 0.15f * float(i + 1), kBack + 0.95f - 0.3f * float(i)}, {.bevel = 0.01f}));
  m.add(lattice(p, 1.1f, 1.9f), at(-0.55f, 0.5f, kBack + 0.06f));
}

void addBamboo(MeshBuilder& m, const Palette& p, float height, int canes, uint32_t seed,
               const glm::mat4& where) {
  addPot(m, p.clay, p.soil, 0.22f, 0.38f, where);
  const Shape blade = leafBlade({.length = 0.13f, .width = 0.02f, .fold = 0.2f, .droop = 0.25f, .steps = 2});
  uint32_t k = 0;
  for (int i = 0; i < canes; ++i) {
    const float a = random(seed, uint32_t(i), 0, 6.28f), lean = random(seed + 1, uint32_t(i), 0.05f, 0.3f),
                h = height * random(seed + 2, uint32_t(i), 0.7f, 1.0f);
    const glm::vec3 foot(0.1f * std::cos(a), 0.3f, 0.1f * std::sin(a)),
        top = foot + glm::vec3(lean * std::cos(a), h, lean * std::sin(a));
    m.add(p.cane,
          tube(
              {foot, top}, [](float t) { return 0.011f - 0.006f * t; }, 7),
          where);
    for (int j = 0; j < 34; ++j, ++k) {
      const float t = random(seed + 3, k, 0.3f, 1.0f), turn = random(seed + 4, k, 0, 6.28f);
      const glm::vec3 twig =
          0.12f * glm::vec3(std::cos(turn), 0.35f, std::sin(turn)) * random(seed + 5, k, 0.2f, 1.0f);
      m.add(p.leaf, blade,
            where * facing(glm::mix(foot, top, t) + twig,
                           {std::cos(turn), random(seed + 6, k, -0.9f, 0.3f), std::sin(turn)}));
    }
  }
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  addBamboo(m, p, 1.7f, 9, 1421, at(-1.28f, 0, -1.5f));
  addBamboo(m, p, 1.3f, 7, 1431, at(1.3f, 0, -4.3f));
  addBamboo(m, p, 1.5f, 8, 1441, at(-1.25f, 0, -7.0f));
  // Casks, a bench, a stone basin.
  Outline cask({0, 0});
  cask.line(0.2f, 0)
      .curve({0.27f, 0.15f}, {0.27f, 0.4f}, {0.2f, 0.55f}, 8)
      .line(0.185f, 0.55f)
      .line(0.185f, 0.53f)
      .line(0, 0.53f);
  for (const glm::vec3& q :
       {glm::vec3(1.3f, 0, -0.2f), glm::vec3(1.33f, 0, -0.75f), glm::vec3(1.31f, 0.551f, -0.46f)}) {
    m.add(p.barrel, lathe(cask, {.segments = 40}), at(q));
    for (const float y : {0.1f, 0.42f})
      m.add(p.band, torus(y < 0.2f ? 0.235f : 0.238f, 0.009f, 40, 8), at(q) * at(0, y, 0));
  }
  m.add(rectTable(p.lattice, 1.3f, 0.38f, 0.42f), at(-1.2f, 0, 0.4f) * turnY(90));
  Outline basin({0, 0});
  basin.line(0.24f, 0)
      .curve({0.36f, 0.1f}, {0.34f, 0.4f}, {0.32f, 0.5f}, 8)
      .line(0.26f, 0.5f)
      .curve({0.25f, 0.4f}, {0.2f, 0.36f}, {0, 0.35f}, 6);
  m.add(p.stone, lathe(basin, {.segments = 40}), at(1.25f, 0, -7.2f));
  // A cat sits on the bench.
  const glm::mat4 cat = at(-1.2f, 0.42f, 0.15f) * turnY(70);
  m.add(p.cat, sphere(0.1f, 28, 18), cat * at(0, 0.1f, 0) * scaled(1, 1.05f, 1.2f))
      .add(p.cat, sphere(0.075f, 28, 18), cat * at(0, 0.17f, 0.05f) * scaled(0.95f, 1.4f, 0.9f));
  m.add(p.cat, sphere(0.062f, 28, 18), cat * at(0, 0.29f, 0.085f));
  for (const float x : {-0.035f, 0.035f})
    m.add(p.cat, lathe(Outline({0.022f, 0}).line(0.001f, 0.05f).line(0, 0.05f), {.segments = 12}),
          cat * at(x, 0.325f, 0.08f) * scaled(1, 1, 0.6f));
  m.add(p.cat,
        tube(
            smoothPath(
                {{0.02f, 0.03f, -0.1f}, {0.12f, 0.02f, -0.14f}, {0.2f, 0.02f, -0.06f}, {0.19f, 0.02f, 0.05f}},
                6),
            [](float t) { return 0.02f - 0.008f * t; }, 10),
        cat);
  b.place("things", b.mesh("things", std::move(m)));
  // Lanterns on both sides and on a cord across the alley; the first one swings.
  const struct {
    glm::vec3 where;
    float size;
  } lanterns[10] = {{{-0.35f, 2.62f, -1.3f}, 1.0f},       {{0.45f, 2.66f, -1.3f}, 0.85f},
                    {{1.18f, 2.36f, -2.6f}, 1.0f},        {{-1.18f, 2.36f, -3.3f}, 1.0f},
                    {{0.25f, 2.72f, -4.6f}, 0.9f},        {{-0.5f, 2.66f, -4.6f}, 0.8f},
                    {{1.18f, 2.36f, -6.2f}, 1.0f},        {{-1.18f, 2.36f, -6.6f}, 1.0f},
                    {{-0.6f, 2.36f, kBack + 0.9f}, 0.9f}, {{0.6f, 2.36f, kBack + 0.9f}, 0.9f}};
  for (int i = 0; i < 10; ++i) {
    const std::string name = "lantern " + std::to_string(i + 1);
    b.place(name, b.mesh(name, lantern(p, lanterns[i].size)), lanterns[i].where, 37 * float(i));
  }
  MeshBuilder cords;
  for (const float z : {-1.3f, -4.6f})
    cords.add(p.band, tube(smoothPath({{-kX - 0.02f, 2.85f, z},
                                       {-0.45f, z < -2 ? 2.665f : 2.635f, z},
                                       {0.35f, z < -2 ? 2.705f : 2.65f, z},
                                       {kX + 0.02f, 2.9f, z}},
                                      8),
                           0.005f, 6));
  for (int i = 2; i < 8; ++i)
    if (i != 4 && i != 5) {
      const glm::vec3 q = lanterns[i].where;
      cords.add(p.timber,
                tube({{q.x > 0 ? kX : -kX, q.y + 0.004f, q.z}, {q.x * 0.97f, q.y + 0.004f, q.z}}, 0.014f, 8));
    }
  b.place("cords", b.mesh("cords", std::move(cords)));
}

}  // namespace

static Scene alleyScene() {
  SceneBuilder b("alley");
  const Palette p = makePalette(b);
  MeshBuilder street;
  street.add(p.setts, box({-kX - 0.3f, -0.4f, kBack - 0.4f}, {kX + 0.3f, 0, kFront + 0.4f}));
  const float length = kFront - kBack;
  street.add(houses(p, length, 0), at(-kX, 0, kFront) * turnY(90));
  street.add(houses(p, length, 1), at(kX, 0, kBack) * turnY(-90));
  street.add(p.plaster, box({-kX - 0.3f, -0.3f, kFront}, {kX + 0.3f, kHigh, kFront + 0.4f}));
  addGate(street, p);
  b.place("street", b.mesh("street", std::move(street)));
  furnish(b, p);
  b.camera({0.25f, 1.55f, 2.6f}, {-0.05f, 1.5f, -3.0f}, 58);
  b.scene.environment = {0.004f, 0.007f, 0.016f};
  return b.finish(5.0f, {0.45f, 0.5f});
}

FOVEA_SCENE("alley", alleyScene);

}  // namespace fovea::scene
