// A garden on a slope, in five terraces with walls of masonry, in the sun: 2 million triangles, most of which are the
// same three plants in 420 pots.
#include <cmath>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr int kTerraces = 5, kPlants = 420;
constexpr float kStep = 1.5f, kDepth = 4, kX = 14;  // of a terrace; they run along x

struct Palette {
  uint32_t wall, paving, stone, clay, glazed, soil, wood, leaf[3], bloom[2], cloth;
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 2401);
  MasonryLook look;
  look.columns = 5, look.rows = 7;
  look.low = {0.46f, 0.40f, 0.32f}, look.high = {0.68f, 0.61f, 0.49f};
  p.wall = b.material("masonry", glm::vec3(1),
                      {.texture = b.texture(masonry("masonry", look, 512, 512, 2411)), .metres = 1.8f});
  p.paving = b.material("paving", {0.62f, 0.56f, 0.47f}, {.texture = s.mottled, .metres = 2});
  p.stone = b.material("coping", {0.70f, 0.67f, 0.60f}, {.texture = s.mottled, .metres = 1.1f});
  p.clay = b.material("terracotta", {0.60f, 0.28f, 0.15f}, {.texture = s.mottled, .metres = 0.7f});
  p.glazed = b.material("blue glaze", {0.10f, 0.24f, 0.42f});
  p.soil = b.material("soil", {0.08f, 0.055f, 0.04f});
  p.wood = b.material("stems", {0.26f, 0.18f, 0.10f});
  const glm::vec3 leaves[3] = {{0.14f, 0.32f, 0.08f}, {0.24f, 0.36f, 0.16f}, {0.10f, 0.26f, 0.10f}};
  for (int i = 0; i < 3; ++i)
    p.leaf[i] = b.material("leaves " + std::to_string(i + 1), leaves[i], {.doubleSided = true});
  p.bloom[0] = b.material("pink petals", {0.80f, 0.22f, 0.36f}, {.doubleSided = true});
  p.bloom[1] = b.material("white petals", {0.82f, 0.80f, 0.74f}, {.doubleSided = true});
  p.cloth = b.material("yellow cloth", {0.80f, 0.55f, 0.10f},
                       {.texture = s.linen, .metres = 0.6f, .doubleSided = true});
  return p;
}

void addTerraces(MeshBuilder& m, const Palette& p) {
  for (int i = 0; i < kTerraces; ++i) {
    const float y = kStep * float(i), z = -kDepth * float(i);
    m.add(p.paving, box({-kX, y - 0.3f, z - kDepth}, {kX, y, z}));
    // A wall behind, up to the next terrace, with a coping that is a little higher than the paving above.
    m.add(p.wall, box({-kX, y - 0.2f, z - kDepth - 0.4f}, {kX, y + kStep + 0.3f, z - kDepth + 0.02f}));
    m.add(p.stone, box({-kX - 0.1f, y + kStep + 0.3f, z - kDepth - 0.45f},
                       {kX + 0.1f, y + kStep + 0.38f, z - kDepth + 0.08f}, {.bevel = 0.015f}));
  }
  m.add(p.paving, box({-kX - 30, -0.4f, -0.5f}, {kX + 30, -0.01f, 30}));
  // Walls at both ends, and a house at the top.
  for (const float side : {-1.0f, 1.0f})
    m.add(p.wall, box({side * kX - 0.3f, -0.3f, -kDepth * kTerraces - 1},
                      {side * kX + 0.3f, kStep * kTerraces + 1.2f, 0.3f}));
  m.add(p.wall,
        box({-kX, -0.3f, -kDepth * kTerraces - 6}, {kX, kStep * kTerraces + 5, -kDepth * kTerraces - 2}));
}

// Three kinds of pots with plants, of about 4,600 triangles each.
MeshBuilder plant(const Palette& p, int kind) {
  MeshBuilder m;
  addPot(m, kind == 1 ? p.glazed : p.clay, p.soil, 0.22f, 0.36f, glm::mat4(1));
  const uint32_t seed = 2420 + uint32_t(kind);
  const glm::mat4 top = at(0, 0.31f, 0);
  if (kind == 0) {
    const Plant round = bush({0.42f, 0.62f, 0.42f}, 24, 38, {.length = 0.09f, .width = 0.05f}, seed);
    m.add(p.leaf[0], round.leaves, top).add(p.wood, round.wood, top);
  } else if (kind == 1) {
    const Plant bloom = flowers({0.4f, 0.5f, 0.4f}, 16, 0.08f, 60, seed);
    m.add(p.leaf[1], bloom.leaves, top).add(p.wood, bloom.wood, top).add(p.bloom[0], bloom.fruits, top);
  } else {
    m.add(p.leaf[2],
          rosette(60, {.length = 0.9f, .width = 0.07f, .fold = 0.3f, .droop = 0.5f, .steps = 18}, 62, seed),
          top);
  }
  return m;
}

}  // namespace

static Scene terracesScene() {
  SceneBuilder b("terraces");
  const Palette p = makePalette(b);
  MeshBuilder ground;
  addTerraces(ground, p);
  b.place("terraces", b.mesh("terraces", std::move(ground)));
  uint32_t kinds[3];
  for (int i = 0; i < 3; ++i) {
    const std::string name = "plant " + std::to_string(i + 1);
    kinds[i] = b.mesh(name, plant(p, i));
  }
  // Two rows on each terrace, before and behind the way.
  for (uint32_t i = 0; i < uint32_t(kPlants); ++i) {
    const uint32_t terrace = i % kTerraces, row = i / kTerraces % 2, column = i / (2 * kTerraces);
    const float x =
        -kX + 0.8f +
        (2 * kX - 1.6f) * (float(column) + random(2431, i, 0.2f, 0.8f)) / (kPlants / (2 * kTerraces));
    const float z =
        -kDepth * float(terrace) - (row == 0 ? 0.5f : kDepth - 0.75f) + random(2432, i, -0.15f, 0.15f);
    b.place("plant", kinds[uint32_t(random(2433, i) * 2.99f)], {x, kStep * float(terrace), z},
            random(2434, i, 0, 360), glm::vec3(random(2435, i, 0.75f, 1.35f)));
  }
  MeshBuilder flag;
  flag.add(p.cloth, surface(sheet(14, 10, {1.3f, 0.9f},
                                  [](float u, float v) {
                                    return glm::vec3(1.3f * u, -0.9f * v, 0.10f * u * std::sin(7 * u + v));
                                  }),
                            0.004f));
  b.place("flag", b.mesh("flag", std::move(flag)), {-1.6f, 4.1f, -3.2f});
  MeshBuilder pole;
  pole.add(p.wood, tube({{-1.63f, 0, -3.2f}, {-1.63f, 4.3f, -3.2f}}, 0.03f, 12));
  b.place("pole", b.mesh("pole", std::move(pole)));
  b.sun("sun", {1.0f, 0.92f, 0.80f}, 17, {-0.55f, -0.62f, -0.56f});
  b.camera({2.6f, 2.1f, 5.2f}, {-1.2f, 2.4f, -6}, 60);
  b.scene.environment = {0.45f, 0.72f, 1.1f};
  return b.finish(0.5f, {0.45f, 0.5f});
}

FOVEA_SCENE("terraces", terracesScene);

}  // namespace fovea::scene
