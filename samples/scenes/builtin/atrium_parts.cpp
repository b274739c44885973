#include "samples/scenes/builtin/atrium_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene::atrium {

using namespace model;

namespace {

constexpr float kQuarter = 0.41421356f;  // bulge of a quarter circle

// A leaf of a capital, which rises along +y from the origin, leans against +z and curls over at its tip.
Shape capitalLeaf(float width, float height, float curl) {
  const Sheet s = sheet(4, 3, {width, height}, [&](float u, float v) {
    const float t = 1 - v, x = 2 * u - 1;
    const float half =
        0.5f * width * (0.85f + 0.35f * std::sin(t * 2.6f)) * (1 - 0.6f * smoothstep(0.7f, 1, t));
    const float over = smoothstep(0.55f, 1, t);
    const float rib = 0.12f * width * (1 - std::abs(x)) + 0.05f * width * std::cos(9 * x);
    return glm::vec3(x * half, height * (t - 0.22f * over * over),
                     rib + 0.10f * height * t + curl * over * over);
  });
  return surface(s, 0.009f);
}

// Moulded foot of a column: two rolls with a hollow between them.
void atticBase(Outline& o, float radius, float y, float height) {
  const float r = radius, h = height;
  o.line(r * 1.36f, y).arc(r * 1.36f, y + 0.38f * h, 1, 5).line(r * 1.24f, y + 0.40f * h);
  o.arc(r * 1.16f, y + 0.64f * h, -0.5f, 3).line(r * 1.2f, y + 0.66f * h).arc(r * 1.2f, y + 0.88f * h, 1, 4);
  o.line(r * 1.06f, y + 0.90f * h).arc(r, y + 1.15f * h, -0.25f, 2);
}

}  // namespace

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const uint32_t stone =
      b.texture(plaster("limestone", glm::vec3(0.80f, 0.78f, 0.74f), 0.30f, 0.18f, 512, 11));
  const uint32_t wall = b.texture(plaster("wall", glm::vec3(0.82f, 0.80f, 0.78f), 0.22f, 0.16f, 512, 12));
  MasonryLook blocks;
  blocks.columns = 4;
  blocks.rows = 7;
  blocks.low = {0.66f, 0.63f, 0.58f};
  blocks.high = {0.80f, 0.78f, 0.74f};
  blocks.jointColor = {0.45f, 0.42f, 0.38f};
  blocks.joint = 0.045f;
  blocks.weathering = 0.22f;
  const uint32_t ashlar = b.texture(masonry("ashlar", blocks, 512, 512, 13));
  MasonryLook tile;
  tile.columns = tile.rows = 8;
  tile.staggered = false;
  tile.low = {0.60f, 0.56f, 0.52f};
  tile.high = {0.85f, 0.82f, 0.80f};
  tile.jointColor = {0.40f, 0.38f, 0.36f};
  tile.joint = 0.05f;
  const uint32_t tiles = b.texture(masonry("tiles", tile, 512, 512, 14));
  const uint32_t grain = b.texture(boards("oak", 5, {0.45f, 0.40f, 0.34f}, {0.85f, 0.80f, 0.74f}, 512, 15));
  const uint32_t cloth = b.texture(weave("weave", glm::vec3(0.95f), 96, 512, 16));
  const uint32_t striped = b.texture(stripes("carpet",
                                             {{{0.62f, 0.09f, 0.06f}, 3},
                                              {{0.80f, 0.62f, 0.24f}, 0.5f},
                                              {{0.10f, 0.14f, 0.33f}, 1.6f},
                                              {{0.80f, 0.62f, 0.24f}, 0.5f},
                                              {{0.62f, 0.09f, 0.06f}, 3},
                                              {{0.72f, 0.66f, 0.52f}, 1}},
                                             256, 17));
  const uint32_t striped2 = b.texture(stripes("kilim",
                                              {{{0.07f, 0.24f, 0.24f}, 2},
                                               {{0.78f, 0.70f, 0.52f}, 0.8f},
                                               {{0.55f, 0.20f, 0.07f}, 1.4f},
                                               {{0.78f, 0.70f, 0.52f}, 0.8f}},
                                              256, 18));
  p.limestone = b.material("limestone", {0.80f, 0.73f, 0.61f}, {.texture = stone, .metres = 2.6f});
  p.ashlar =
      b.material("ashlar", {0.80f, 0.72f, 0.59f}, {.texture = ashlar, .metres = 3.2f, .metresHigh = 2.45f});
  p.plaster = b.material("plaster", {0.84f, 0.62f, 0.38f}, {.texture = wall, .metres = 5});
  p.dado = b.material("red plaster", {0.62f, 0.24f, 0.15f}, {.texture = wall, .metres = 3.7f});
  p.tiles = b.material("floor tiles", {0.66f, 0.36f, 0.23f}, {.texture = tiles, .metres = 2.4f});
  p.roofTiles = b.material("roof tiles", {0.66f, 0.30f, 0.17f}, {.texture = stone, .metres = 1.1f});
  p.floorPale = b.material("pale paving", {0.48f, 0.42f, 0.34f}, {.texture = stone, .metres = 3.1f});
  p.floorWarm = b.material("warm paving", {0.42f, 0.33f, 0.245f}, {.texture = stone, .metres = 2.7f});
  p.floorDark = b.material("red paving", {0.32f, 0.14f, 0.10f}, {.texture = stone, .metres = 2.2f});
  p.mortar = b.material("mortar", {0.30f, 0.27f, 0.23f});
  p.wood = b.material("beams", {0.36f, 0.22f, 0.12f}, {.texture = grain, .metres = 0.9f});
  p.door = b.material("doors", {0.26f, 0.33f, 0.27f}, {.texture = grain, .metres = 0.8f});
  p.iron = b.material("iron", {0.05f, 0.05f, 0.055f});
  p.clay = b.material("terracotta", {0.70f, 0.34f, 0.19f}, {.texture = stone, .metres = 0.9f});
  p.glaze = b.material("blue glaze", {0.09f, 0.20f, 0.48f});
  p.white = b.material("white glaze", {0.80f, 0.79f, 0.76f});
  p.soil = b.material("soil", {0.10f, 0.07f, 0.05f});
  p.bark = b.material("bark", {0.24f, 0.17f, 0.11f}, {.texture = stone, .metres = 0.3f});
  p.leaf = b.material("leaves", {0.11f, 0.27f, 0.05f}, {.doubleSided = true});
  p.darkLeaf = b.material("dark leaves", {0.06f, 0.17f, 0.04f}, {.doubleSided = true});
  p.orange = b.material("oranges", {0.88f, 0.36f, 0.03f});
  p.paper = b.material("paper", {0.88f, 0.30f, 0.12f}, {.doubleSided = true});
  const glm::vec3 colors[4] = {
      {0.66f, 0.06f, 0.045f}, {0.07f, 0.14f, 0.44f}, {0.84f, 0.50f, 0.07f}, {0.10f, 0.32f, 0.11f}};
  const char* names[4] = {"madder cloth", "indigo cloth", "ochre cloth", "green cloth"};
  for (int i = 0; i < 4; ++i)
    p.cloth[i] = b.material(names[i], colors[i], {.texture = cloth, .metres = 0.8f, .doubleSided = true});
  p.carpet[0] = b.material("carpet", glm::vec3(1), {.texture = striped, .metres = 0.9f, .doubleSided = true});
  p.carpet[1] = b.material("kilim", glm::vec3(1),
                           {.texture = striped2, .metres = 0.55f, .turnDegrees = 90, .doubleSided = true});
  return p;
}

MeshBuilder column(uint32_t stone, float height) {
  constexpr float kRadius = 0.185f, kPlinth = 0.12f, kCapital = 0.46f, kAbacus = 0.09f;
  MeshBuilder m;
  m.add(stone, block(0.56f, kPlinth, 0.56f, {.bevel = 0.012f, .bottom = false}));
  const float top = height - kAbacus - kCapital;
  Outline o;
  o.line(0, kPlinth);
  atticBase(o, kRadius, kPlinth, 0.17f);
  for (int i = 1; i <= 6; ++i) {  // entasis: widest at a third of the height
    const float t = float(i) / 6;
    o.line(kRadius * (1 + 0.03f * std::sin(t * 2.4f) - 0.16f * t * t), glm::mix(0.33f, top - 0.07f, t));
  }
  const float neck = o.points().back().x;
  o.line(neck + 0.025f, top - 0.05f).arc(neck + 0.025f, top - 0.005f, 1, 4).line(neck - 0.005f, top);
  o.curve({neck - 0.01f, top + 0.5f * kCapital}, {neck + 0.03f, top + 0.75f * kCapital},
          {neck + 0.10f, top + kCapital}, 6);
  m.add(stone, lathe(o, {.segments = 18}));
  const Shape low = capitalLeaf(0.125f, 0.20f, 0.05f), high = capitalLeaf(0.12f, 0.34f, 0.07f);
  for (int i = 0; i < 8; ++i) {
    m.add(stone, low, turnY(45.0f * float(i)) * at(0, top, neck - 0.012f));
    m.add(stone, high, turnY(45.0f * float(i) + 22.5f) * at(0, top + 0.02f, neck - 0.02f));
  }
  // Scrolls below the abacus' corners.
  std::vector<glm::vec3> spiral;
  for (int i = 0; i <= 9; ++i) {
    const float t = float(i) / 9, a = 1.2f - 8.2f * t, r = 0.062f * (1 - 0.75f * t);
    spiral.push_back({0, r * std::sin(a), r * std::cos(a)});
  }
  const Shape scroll =
      sweep(spiral, rectangle(0.03f, 0.07f),
            {.up = glm::vec3(1, 0, 0), .creaseDegrees = 60, .scale = [](float t) { return 1 - 0.45f * t; }});
  for (int i = 0; i < 4; ++i)
    m.add(stone, scroll, turnY(90.0f * float(i) + 45) * at(0, height - kAbacus - 0.075f, neck + 0.13f));
  // Abacus: a square with hollow sides and cut corners.
  Outline plan({-0.26f, -0.30f});
  for (int i = 0; i < 4; ++i) {
    const auto turned = [&](glm::vec2 p) {
      for (int k = 0; k < i; ++k) p = {-p.y, p.x};
      return p;
    };
    const glm::vec2 end = turned({0.26f, -0.30f}), cut = turned({0.30f, -0.26f});
    plan.arc(end.x, end.y, -0.16f, 4);
    if (i < 3)
      plan.line(cut.x, cut.y);
    else
      plan.line(-0.30f, -0.26f);
  }
  m.add(stone, extrude(plan, kAbacus, {.bevel = 0.015f}), at(0, height - kAbacus, 0) * turnX(-90));
  return m;
}

MeshBuilder colonnette(uint32_t stone, float height) {
  constexpr float kRadius = 0.075f;
  MeshBuilder m;
  m.add(stone, block(0.25f, 0.06f, 0.25f, {.bottom = false}));
  Outline o;
  o.line(0, 0.06f);
  atticBase(o, kRadius, 0.06f, 0.09f);
  const float top = height - 0.30f, neck = kRadius * 0.86f;
  o.line(kRadius * 1.01f, 0.5f * height).line(neck, top - 0.02f).arc(neck, top + 0.02f, 1, 3);
  o.curve({neck, top + 0.12f}, {neck + 0.02f, top + 0.19f}, {neck + 0.065f, height - 0.07f}, 6);
  m.add(stone, lathe(o, {.segments = 12}));
  m.add(stone, block(0.29f, 0.075f, 0.29f, {.bevel = 0.012f}), at(0, height - 0.075f, 0));
  return m;
}

Shape baluster(float height) {
  const float h = height;
  Outline o({0.062f, 0});
  o.line(0.062f, 0.06f * h).line(0.045f, 0.10f * h);
  o.through({{0.034f, 0.16f * h}, {0.070f, 0.36f * h}, {0.030f, 0.66f * h}, {0.027f, 0.80f * h}}, 2);
  o.line(0.046f, 0.85f * h).line(0.046f, 0.89f * h).line(0.060f, 0.93f * h).line(0.060f, h);
  return lathe(o, {.segments = 8});
}

Shape groinVault(float side, float rise) {
  const float half = 0.5f * side;
  // A quarter of the vault, denser where it is steep; the groin runs along the diagonals of its cells.
  const Sheet quarter = sheet(6, 6, {half, half}, [&](float u, float v) {
    const float a = 0.5f * glm::pi<float>() * u, b = 0.5f * glm::pi<float>() * v;
    return glm::vec3(half * std::sin(a), rise * std::max(std::cos(a), std::cos(b)), half * std::sin(b));
  });
  Shape s = surface(quarter);
  for (size_t i = 0; i < s.indices.size(); i += 3)
    std::swap(s.indices[i + 1], s.indices[i + 2]);  // seen from below
  Shape whole;
  for (const float x : {1.0f, -1.0f})
    for (const float z : {1.0f, -1.0f}) append(whole, s, scaled(x, 1, z));
  smooth(whole, 25);
  return whole;
}

MeshBuilder tondo(uint32_t rim, uint32_t glaze, uint32_t relief) {
  MeshBuilder m;
  Outline ring({0.24f, 0});
  ring.line(0.30f, 0).line(0.30f, 0.03f).arc(0.25f, 0.05f, 0.6f, 4).line(0.235f, 0.02f);
  m.add(rim, lathe(ring, {.segments = 18, .closed = true}), turnX(90));
  m.add(glaze, lathe(Outline({{0.245f, 0.012f}, {0.12f, 0.018f}, {0, 0.02f}}), {.segments = 20}), turnX(90));
  // A flower of eight petals.
  const Outline bud = Outline({0.17f, 0.015f})
                          .curve({0.16f, 0.05f}, {0.07f, 0.055f}, {0.05f, 0.03f}, 2)
                          .curve({0.045f, 0.05f}, {0.02f, 0.06f}, {0, 0.06f}, 2);
  m.add(relief,
        lathe(bud, {.segments = 32,
                    .swell = [](float a, float) { return 0.62f + 0.38f * std::abs(std::cos(4 * a)); }}),
        turnX(90));
  return m;
}

MeshBuilder archDoor(uint32_t wood, uint32_t iron, float width, float spring) {
  MeshBuilder m;
  for (const float side : {-1.0f, 1.0f}) {
    Outline leaf({0.012f, 0});
    leaf.line(0.5f * width, 0).line(0.5f * width, spring).arc(0.012f, spring + 0.5f * width, kQuarter, 10);
    m.add(wood, extrude(leaf, 0.06f, {.bevel = 0.006f}), scaled(side, 1, 1));
    for (int i = 0; i < 3; ++i) {
      const float y = 0.18f + 0.30f * spring * float(i), h = 0.25f * spring;
      m.add(wood, box({0.10f * width, y, 0.05f}, {0.42f * width, y + h, 0.085f}, {.bevel = 0.018f}),
            scaled(side, 1, 1));
    }
    for (const float y : {0.12f, 0.88f})
      m.add(iron, box({0.06f * width, y * spring, 0.055f}, {0.49f * width, y * spring + 0.045f, 0.095f}),
            scaled(side, 1, 1));
  }
  m.add(iron, torus(0.055f, 0.010f, 14, 6), at(0.09f, 0.5f * spring, 0.08f) * turnX(90));
  return m;
}

MeshBuilder shutters(uint32_t wood, float width, float height) {
  MeshBuilder m;
  for (const float side : {-1.0f, 1.0f}) {
    const float w = 0.5f * width - 0.006f, x = side * (0.5f * w + 0.006f);
    MeshBuilder leaf;
    leaf.add(wood, box({-0.5f * w, 0, 0}, {0.5f * w, height, 0.02f}));
    leaf.add(wood, box({-0.5f * w, 0, 0.02f}, {-0.5f * w + 0.06f, height, 0.05f}));
    leaf.add(wood, box({0.5f * w - 0.06f, 0, 0.02f}, {0.5f * w, height, 0.05f}));
    for (const float y : {0.0f, 0.47f, 0.94f})
      leaf.add(wood,
               box({-0.5f * w + 0.06f, y * height, 0.02f}, {0.5f * w - 0.06f, (y + 0.06f) * height, 0.05f}));
    for (int i = 0; i < 12; ++i) {
      const float y = (0.085f + 0.070f * float(i) + (i >= 6 ? 0.02f : 0.0f)) * height;
      leaf.add(wood, box({-0.5f * w + 0.06f, -0.016f, -0.004f}, {0.5f * w - 0.06f, 0.016f, 0.004f}),
               at(0, y, 0.033f) * turnX(35));
    }
    m.add(leaf, at(x, 0, 0));
  }
  return m;
}

MeshBuilder wellHead(const Palette& p) {
  MeshBuilder m;
  m.add(p.limestone, extrude(circle(1.25f, 8), 0.16f, {.bevel = 0.02f, .back = false}),
        turnX(-90) * turnZ(22.5f));
  m.add(p.limestone, extrude(circle(1.0f, 8), 0.16f, {.bevel = 0.02f, .back = false}),
        at(0, 0.155f, 0) * turnX(-90) * turnZ(22.5f));
  Outline o({0.50f, 0.31f});
  o.line(0.72f, 0.31f).line(0.72f, 0.37f).arc(0.72f, 0.45f, 1, 5).line(0.64f, 0.47f);
  o.curve({0.56f, 0.60f}, {0.60f, 0.85f}, {0.70f, 1.00f}, 8).line(0.73f, 1.02f).arc(0.73f, 1.09f, 1, 5);
  o.line(0.78f, 1.10f).line(0.78f, 1.17f).line(0.76f, 1.19f).line(0.56f, 1.19f).line(0.54f, 1.17f);
  o.line(0.50f, 0.95f);
  m.add(p.limestone, lathe(o, {.segments = 36, .closed = true, .swell = [](float a, float y) {
                                 const float t = smoothstep(0.5f, 0.6f, y) * (1 - smoothstep(0.92f, 1.0f, y));
                                 return 1 + 0.035f * t * std::cos(12 * a);
                               }}));
  m.add(p.soil, cylinder(0.52f, 0.02f, 24), at(0, 0.36f, 0));
  // Wrought iron: two posts that bend to a finial, a pulley and a bucket.
  for (const float side : {-1.0f, 1.0f})
    m.add(p.iron, tube(
                      smoothPath({{side * 0.66f, 1.15f, 0},
                                  {side * 0.66f, 1.8f, 0},
                                  {side * 0.55f, 2.25f, 0},
                                  {side * 0.25f, 2.45f, 0},
                                  {0, 2.62f, 0}},
                                 6),
                      [](float t) { return 0.026f - 0.008f * t; }, 8));
  m.add(p.iron, tube({{-0.60f, 2.12f, 0}, {0.60f, 2.12f, 0}}, 0.018f, 8));
  m.add(p.iron, sphere(0.05f, 12, 8), at(0, 2.66f, 0));
  m.add(p.iron, torus(0.10f, 0.022f, 20, 8), at(0, 2.0f, 0) * turnX(90));
  m.add(p.wood, tube({{0.1f, 2.0f, 0}, {0.1f, 1.52f, 0}}, 0.009f, 5));
  Outline bucket({0, 0});
  bucket.line(0.105f, 0).line(0.14f, 0.27f).line(0.125f, 0.27f).line(0.095f, 0.02f).line(0, 0.02f);
  m.add(p.wood, lathe(bucket, {.segments = 18}), at(0.1f, 1.20f, 0));
  for (const float y : {1.24f, 1.41f})
    m.add(p.iron, torus(y > 1.3f ? 0.135f : 0.113f, 0.007f, 18, 6), at(0.1f, y, 0));
  m.add(p.iron, tube(smoothPath({{-0.035f, 1.46f, 0}, {0.1f, 1.56f, 0}, {0.235f, 1.46f, 0}}, 5), 0.006f, 5));
  return m;
}

MeshBuilder pot(uint32_t clay, uint32_t soil, float radius, float height) {
  const float r = radius, h = height;
  Outline o({0, 0});
  o.line(0.66f * r, 0).curve({0.80f * r, 0.3f * h}, {0.90f * r, 0.6f * h}, {0.92f * r, 0.80f * h}, 5);
  o.line(r, 0.82f * h)
      .arc(r, 0.97f * h, 0.35f, 4)
      .line(0.95f * r, h)
      .line(0.84f * r, h)
      .line(0.82f * r, 0.88f * h);
  MeshBuilder m;
  m.add(clay, lathe(o, {.segments = 24}));
  m.add(clay, torus(0.885f * r, 0.022f * r, 24, 5), at(0, 0.55f * h, 0));
  m.add(soil,
        lathe(Outline({{0.83f * r, 0.885f * h}, {0.4f * r, 0.90f * h}, {0, 0.91f * h}}), {.segments = 20}));
  return m;
}

MeshBuilder orangeTree(const Palette& p, uint32_t seed) {
  TreeForm f;
  f.trunkHeight = 0.75f;
  f.trunkRadius = 0.055f;
  f.crown = {0.72f, 0.66f, 0.72f};
  f.boughs = 6;
  f.twigs = 140;
  f.leavesPerTwig = 8;
  f.twigLength = 0.24f;
  f.leaf = {.length = 0.115f, .width = 0.058f, .fold = 0.35f, .droop = 0.25f, .steps = 1};
  f.fruits = 24;
  f.fruitRadius = 0.038f;
  f.seed = seed;
  const Plant t = tree(f);
  MeshBuilder m = pot(p.clay, p.soil, 0.42f, 0.62f);
  const glm::mat4 up = at(0, 0.56f, 0);
  m.add(p.bark, t.wood, up).add(p.darkLeaf, t.leaves, up).add(p.orange, t.fruits, up);
  return m;
}

MeshBuilder lantern(const Palette& p) {
  MeshBuilder m;
  m.add(p.iron, tube({{0, 0, 0}, {0, -0.62f, 0}}, 0.008f, 5));
  m.add(p.iron,
        lathe(Outline({{0.15f, -0.80f}, {0.16f, -0.78f}, {0.05f, -0.66f}, {0.02f, -0.60f}, {0, -0.60f}}),
              {.segments = 6, .creaseDegrees = 20}));
  m.add(p.iron, lathe(Outline({{0, -1.16f}, {0.02f, -1.16f}, {0.10f, -1.10f}, {0.10f, -1.07f}, {0, -1.07f}}),
                      {.segments = 6, .creaseDegrees = 20}));
  for (int i = 0; i < 6; ++i) {
    const float a = glm::two_pi<float>() * float(i) / 6, c = std::cos(a), s = std::sin(a);
    m.add(p.iron, tube({{0.095f * c, -1.08f, 0.095f * s}, {0.145f * c, -0.79f, 0.145f * s}}, 0.007f, 4));
  }
  m.add(p.white, cylinder(0.025f, 0.14f, 10), at(0, -1.07f, 0));
  return m;
}

MeshBuilder bench(uint32_t stone, float width) {
  MeshBuilder m;
  m.add(stone, box({-0.5f * width, 0.40f, -0.22f}, {0.5f * width, 0.48f, 0.22f}, {.bevel = 0.015f}));
  for (const float side : {-1.0f, 1.0f}) {
    Outline foot({-0.18f, 0});
    foot.line(0.18f, 0)
        .curve({0.10f, 0.10f}, {0.10f, 0.28f}, {0.19f, 0.40f}, 6)
        .line(-0.19f, 0.40f)
        .curve({-0.10f, 0.28f}, {-0.10f, 0.10f}, {-0.18f, 0}, 6);
    m.add(stone, extrude(foot, 0.10f), at(side * 0.38f * width - 0.05f, 0, 0) * turnY(90));
  }
  return m;
}

MeshBuilder jar(uint32_t clay, float height) {
  const float h = height;
  Outline o({0, 0});
  o.line(0.14f * h, 0).curve({0.34f * h, 0.22f * h}, {0.34f * h, 0.62f * h}, {0.15f * h, 0.80f * h}, 12);
  o.curve({0.11f * h, 0.84f * h}, {0.11f * h, 0.90f * h}, {0.13f * h, 0.93f * h}, 4)
      .line(0.17f * h, 0.96f * h)
      .line(0.17f * h, h);
  o.line(0.13f * h, h).line(0.10f * h, 0.90f * h).line(0.11f * h, 0.80f * h).line(0, 0.70f * h);
  MeshBuilder m;
  m.add(clay, lathe(o, {.segments = 22}));
  for (const float side : {-1.0f, 1.0f})
    m.add(clay, tube(smoothPath({{side * 0.125f * h, 0.90f * h, 0},
                                 {side * 0.24f * h, 0.88f * h, 0},
                                 {side * 0.27f * h, 0.76f * h, 0},
                                 {side * 0.215f * h, 0.68f * h, 0}},
                                4),
                     0.022f * h, 7));
  return m;
}

Shape paperPlane() {
  Shape s;
  const auto triangle = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    for (const glm::vec3& p : {a, b, c}) {
      s.indices.push_back(uint32_t(s.positions.size()));
      s.positions.push_back(p);
      s.uvs.push_back({p.x, p.z});
      s.normals.push_back({0, 1, 0});
    }
  };
  const glm::vec3 nose(0, 0, -0.62f), keelLow(0, -0.17f, 0.44f), keelNose(0, -0.02f, -0.60f);
  for (const float side : {1.0f, -1.0f}) {
    const glm::vec3 root(side * 0.018f, 0, 0.48f), tip(side * 0.5f, 0.07f, 0.50f),
        fold(side * 0.30f, 0.045f, 0.49f), lip(side * 0.505f, 0.135f, 0.47f),
        mid(side * 0.22f, 0.04f, -0.05f);
    const auto put = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) {
      side > 0 ? triangle(a, b, c) : triangle(a, c, b);
    };
    put(nose, root, fold);
    put(nose, fold, mid);
    put(mid, fold, tip);
    put(mid, tip, lip);
    put(keelNose, keelLow, root);
    put(keelNose, root, nose);
  }
  smooth(s, 15);
  return s;
}

Sheet drape(const DrapeForm& f, uint32_t columns, uint32_t rows) {
  return sheet(columns, rows, {1.5f * f.width, f.height}, [&](float u, float v) {
    const float pi2 = glm::two_pi<float>();
    // Gathered on the rod and, where it is tied back, a third as wide.
    const float tied = std::abs(f.drawn) * std::exp(-std::pow((v - 0.60f) / 0.30f, 2.0f));
    const float fall = std::abs(f.drawn) * smoothstep(0.05f, 0.6f, v);
    const float wide = 1 - 0.72f * tied - 0.18f * fall * (1 - tied);
    const float centre =
        0.5f * f.drawn * f.width * (1 - wide) * (0.35f + 0.65f * std::min(1.0f, fall + tied));
    const float wander = 0.18f * (2 * noise({u * 5, v * 1.5f}, f.seed) - 1);
    const float turn = pi2 * (f.folds * u + wander + 0.25f * std::sin(pi2 * (u + 0.3f * v)));
    const float deep =
        (0.045f + 0.035f * v) * (0.7f + 0.6f * noise({u * f.folds, 3}, f.seed + 1)) * (0.75f + 0.25f / wide);
    const float x = centre + (u - 0.5f) * f.width * wide + 0.3f * deep * std::sin(2 * turn) * wide;
    const float swag = std::abs(f.drawn) * 0.10f * f.height * smoothstep(0.0f, 1.0f, v) *
                       (1 - std::abs(u - 0.5f - 0.5f * f.drawn));
    const float free = smoothstep(0.0f, 0.9f, v);
    const float z = deep * std::cos(turn) +
                    f.billow * std::sin(pi2 * 0.5f * u) * free *
                        (0.4f + 0.6f * std::sin(0.5f * pi2 * std::min(v * 1.1f, 1.0f))) +
                    f.wave * free * std::sin(pi2 * (1.1f * v + 0.6f * u) - f.phase);
    return glm::vec3(x + 0.25f * f.wave * free * std::cos(pi2 * v - f.phase), -f.height * v - 0.0f * swag, z);
  });
}

}  // namespace fovea::scene::atrium
