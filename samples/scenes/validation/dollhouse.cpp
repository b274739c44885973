// A dolls' house at a scale of 1:12, half a metre wide, on a table: two storeys that are open to the front. A bulb the
// size of a pea hangs in the parlour, and a desk lamp shines in from the front and above.
#include <cmath>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/textures.h"
#include "samples/scenes/builtin/modelling/upholstery.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr float kSmall = 1.0f / 12;
// Inside of one storey.
constexpr float kX = 0.25f, kBack = -0.16f, kFront = 0.14f, kStorey = 0.23f, kThick = 0.010f, kTable = 0.0f;
constexpr float kGround = kTable + 0.014f, kUpper = kGround + kStorey + kThick, kTop = kUpper + kStorey;

struct Palette {
  uint32_t paper[2], floor[2], white, outside, roof, table, wood, velvet, quilt, linen, rose, ochre, brass,
      bulb, clay, red, blue, cover[3], picture[2];
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 1001);
  const uint32_t blueStripes = b.texture(stripes("striped wallpaper",
                                                 {{{0.62f, 0.68f, 0.66f}, 3},
                                                  {{0.36f, 0.50f, 0.52f}, 1.6f},
                                                  {{0.62f, 0.68f, 0.66f}, 0.5f},
                                                  {{0.70f, 0.58f, 0.30f}, 0.25f}},
                                                 256, 1011));
  const uint32_t dots = b.texture(bake("dotted wallpaper", 256, 256, [](float u, float v) {
    const glm::vec2 g(u * 4 + (int(std::floor(v * 8)) % 2 == 0 ? 0.5f : 0.0f), v * 8);
    const glm::vec2 in = glm::fract(g) - 0.5f;
    return glm::length(in * glm::vec2(2, 1)) < 0.25f ? glm::vec3(0.64f, 0.28f, 0.26f)
                                                     : glm::vec3(0.80f, 0.72f, 0.58f);
  }));
  const uint32_t checks = b.texture(bake("chequered floor", 256, 256, [](float u, float v) {
    const bool dark = (int(u * 4) + int(v * 4)) % 2 == 0;
    return (dark ? glm::vec3(0.12f, 0.10f, 0.10f) : glm::vec3(0.76f, 0.73f, 0.66f)) *
           (0.9f + 0.15f * fractal({9 * u, 9 * v}, 1012, 3, 9));
  }));
  p.paper[0] = b.material("striped wallpaper", glm::vec3(1), {.texture = blueStripes, .metres = 0.04f});
  p.paper[1] = b.material("dotted wallpaper", glm::vec3(1), {.texture = dots, .metres = 0.06f});
  p.floor[0] = b.material("chequered floor", glm::vec3(1), {.texture = checks, .metres = 0.14f});
  p.floor[1] = b.material("small boards", {0.66f, 0.45f, 0.26f},
                          {.texture = s.planks, .metres = 0.07f, .metresHigh = 0.4f});
  p.white = b.material("white paint", {0.80f, 0.79f, 0.76f});
  p.outside = b.material("pink paint", {0.72f, 0.38f, 0.34f}, {.texture = s.mottled, .metres = 0.3f});
  p.roof = b.material("slate paint", {0.20f, 0.23f, 0.28f}, {.texture = s.mottled, .metres = 0.2f});
  p.table = b.material("table top", {0.46f, 0.28f, 0.15f},
                       {.texture = s.planks, .metres = 0.6f, .metresHigh = 1.6f, .turnDegrees = 90});
  p.wood =
      b.material("walnut", {0.36f, 0.20f, 0.11f}, {.texture = s.grain, .metres = 0.05f, .metresHigh = 0.2f});
  p.velvet = b.material("green velvet", {0.08f, 0.26f, 0.16f});
  p.quilt = b.material("quilt", {0.16f, 0.28f, 0.56f}, {.texture = s.linen, .metres = 0.05f});
  p.linen = b.material("linen", {0.80f, 0.79f, 0.76f});
  p.rose = b.material("rose cloth", {0.70f, 0.24f, 0.26f});
  p.ochre = b.material("ochre cloth", {0.80f, 0.50f, 0.10f});
  p.brass = b.material("brass", {0.62f, 0.43f, 0.16f});
  p.bulb = b.material("bulb", {0.30f, 0.28f, 0.24f}, {.emission = {3.0f, 2.2f, 1.2f}});
  p.clay = b.material("terracotta", {0.62f, 0.28f, 0.15f});
  p.red = b.material("red enamel", {0.72f, 0.06f, 0.04f});
  p.blue = b.material("blue enamel", {0.06f, 0.18f, 0.54f});
  const glm::vec3 covers[3] = {{0.45f, 0.10f, 0.08f}, {0.12f, 0.24f, 0.34f}, {0.60f, 0.50f, 0.30f}};
  for (int i = 0; i < 3; ++i) p.cover[i] = b.material("book " + std::to_string(i + 1), covers[i]);
  for (uint32_t i = 0; i < 2; ++i)
    p.picture[i] = painting(b, "painting " + std::to_string(i + 1), 0.9f, 0.7f, 1021 + 20 * i);
  return p;
}

void addHouse(MeshBuilder& m, const Palette& p) {
  m.add(p.table,
        box({-0.42f, kTable - 0.03f, -0.26f}, {0.42f, kTable, 0.34f}, {.bevel = 0.004f, .bevelSteps = 2}));
  const float e = 0.5f * kThick;
  for (int storey = 0; storey < 2; ++storey) {
    const float low = storey == 0 ? kGround : kUpper, high = low + kStorey;
    // Papered linings stand before the outer walls.
    m.add(p.paper[storey], box({-kX - e, low - e, kBack - e}, {kX + e, high + e, kBack}));
    for (const float side : {-1.0f, 1.0f})
      m.add(p.paper[storey], box({std::min(side * kX, side * (kX + e)), low - e, kBack - e},
                                 {std::max(side * kX, side * (kX + e)), high + e, kFront}));
    m.add(p.floor[storey], box({-kX - e, low - kThick + 0.002f, kBack - e}, {kX + e, low, kFront - 0.001f}));
    m.add(p.white, box({-kX - e, high, kBack - e}, {kX + e, high + 0.004f, kFront - 0.0015f}));
    // Skirting and a rail.
    m.add(p.white,
          box({-kX - 0.001f, low - 0.001f, kBack - 0.001f}, {kX + 0.001f, low + 0.010f, kBack + 0.0014f}));
    for (const float side : {-1.0f, 1.0f})
      m.add(p.white, box({side * kX - 0.0014f, low - 0.001f, kBack},
                         {side * kX + 0.0014f, low + 0.010f, kFront - 0.002f}));
  }
  m.add(p.outside,
        box({-kX - kThick, kTable, kBack - kThick}, {kX + kThick, kTop + kThick, kBack - 0.8f * e}));
  for (const float side : {-1.0f, 1.0f})
    m.add(p.outside,
          box({std::min(side * (kX + 0.8f * e), side * (kX + kThick)), kTable, kBack - e},
              {std::max(side * (kX + 0.8f * e), side * (kX + kThick)), kTop + kThick, kFront + 0.002f}));
  for (const float y : {kGround - 0.007f, kUpper - 0.007f, kTop + 0.004f})
    m.add(p.white, box({-kX - kThick, y - 0.006f, kFront - 0.002f},
                       {kX + kThick, y + 0.006f, kFront + 0.005f}, {.bevel = 0.001f}));
  // The roof: two slopes and a gable.
  const float ridge = kTop + 0.14f, eave = kTop + 0.008f, x = kX + 0.03f;
  const Outline gable({{-kX - kThick, eave}, {kX + kThick, eave}, {0, ridge - 0.012f}});
  m.add(p.outside, extrude(gable, kFront - kBack + kThick), at(0, 0, kBack - kThick));
  for (const float side : {-1.0f, 1.0f}) {
    const Outline slope({{0, ridge - 0.010f}, {x, eave - 0.014f}, {x, eave - 0.002f}, {0, ridge + 0.002f}});
    m.add(p.roof, extrude(slope, kFront - kBack + 0.05f), at(0, 0, kBack - 0.025f) * scaled(side, 1, 1));
  }
  m.add(p.red, box({0.10f, ridge - 0.10f, -0.05f}, {0.14f, ridge + 0.035f, -0.01f}, {.bevel = 0.002f}));
}

MeshBuilder bed(const Palette& p) {  // life size, along z with its head at z = 0
  MeshBuilder m;
  for (const float z : {0.0f, 2.0f}) {
    const float h = z == 0 ? 1.15f : 0.75f;
    for (const float x : {-0.68f, 0.68f}) {
      m.add(p.brass, tube({{x, 0, z}, {x, h, z}}, 0.03f, 10));
      m.add(p.brass, sphere(0.05f, 14, 10), at(x, h + 0.03f, z));
    }
    for (const float y : {0.35f, h - 0.03f}) m.add(p.brass, tube({{-0.68f, y, z}, {0.68f, y, z}}, 0.022f, 8));
    for (int i = 0; i < 7; ++i) {
      const float x = -0.51f + 0.17f * float(i);
      m.add(p.brass, tube({{x, 0.35f, z}, {x, h - 0.03f, z}}, 0.012f, 6));
    }
  }
  m.add(p.linen, box({-0.65f, 0.3f, 0.04f}, {0.65f, 0.52f, 1.96f}, {.bevel = 0.06f, .bevelSteps = 3}));
  m.add(p.quilt, buttonedPad({1.42f, 0.16f, 1.35f}, 5, 9), at(0, 0.44f, 1.28f));
  for (const float x : {-0.32f, 0.32f})
    m.add(p.linen, cushion(0.56f, 0.42f, 0.17f, x > 0 ? 1051u : 1052u), at(x, 0.62f, 0.28f) * turnX(-62));
  return m;
}

MeshBuilder wardrobe(const Palette& p) {  // life size, back at z = 0
  MeshBuilder m;
  m.add(p.wood, box({-0.6f, 0.08f, 0}, {0.6f, 1.9f, 0.5f}, {.bevel = 0.01f}));
  m.add(p.wood, box({-0.66f, 1.88f, -0.01f}, {0.66f, 1.98f, 0.56f}, {.bevel = 0.03f, .bevelSteps = 3}));
  m.add(p.wood, box({-0.63f, 0, 0.0f}, {0.63f, 0.1f, 0.53f}, {.bevel = 0.01f}));
  for (const float side : {-1.0f, 1.0f}) {
    for (const float y : {0.2f, 1.05f})
      m.add(p.wood, box({side * 0.29f - 0.2f, y, 0.48f}, {side * 0.29f + 0.2f, y + 0.74f, 0.53f},
                        {.bevel = 0.02f, .bevelSteps = 2}));
    m.add(p.brass, sphere(0.025f, 12, 8), at(side * 0.04f, 1.0f, 0.52f));
  }
  return m;
}

void furnish(SceneBuilder& b, const Palette& p) {
  const auto place = [](float x, float y, float z, float turn = 0) {
    return at(x, y, z) * turnY(turn) * scaled(kSmall);
  };
  MeshBuilder m;
  // The parlour.
  const SeatLook seats = {p.velvet, p.wood, {p.ochre, p.rose, p.linen}};
  m.add(sofa(seats, 1.9f, 2), place(-0.075f, kGround, kBack + 0.008f));
  m.add(sofa(seats, 0.95f, 1), place(-0.185f, kGround, 0.045f, 70));
  m.add(p.rose, block(0.21f, 0.0012f, 0.13f, {.bevel = 0.0005f}), at(-0.075f, kGround - 0.0002f, 0.005f));
  m.add(roundTable(p.wood, 0.42f, 0.48f), place(-0.065f, kGround + 0.001f, 0.0f));
  Outline pot({0, 0});
  pot.line(0.08f, 0).through({{0.13f, 0.08f}, {0.10f, 0.17f}, {0.04f, 0.2f}}, 5).line(0, 0.22f);
  m.add(p.blue, lathe(pot, {.segments = 28}), place(-0.065f, kGround + 0.0405f, 0.0f));
  m.add(framed(p.brass, p.picture[0], 0.9f, 0.7f), place(-0.075f, kGround + 0.135f, kBack));
  m.add(pouffe(p.ochre, p.wood, 0.3f, 0.4f), place(0.03f, kGround, 0.055f));
  // A shelf with books and a stair with a thin railing.
  m.add(p.wood, box({0.07f, kGround, kBack}, {0.155f, kGround + 0.09f, kBack + 0.025f}, {.bevel = 0.0006f}));
  addBooks(m, p.cover, p.linen, 9, 0.3f, 1061, place(0.075f, kGround + 0.0902f, kBack + 0.02f));
  for (int i = 0; i < 10; ++i) {
    const float y = kGround + 0.021f * float(i), z = 0.10f - 0.021f * float(i);
    m.add(p.wood, box({0.19f, y - (i == 0 ? 0.0f : 0.012f), z - 0.024f}, {0.246f, y + 0.021f, z + 0.001f},
                      {.bevel = 0.0006f}));
    m.add(p.white, tube({{0.192f, y + 0.02f, z - 0.011f}, {0.192f, y + 0.092f, z - 0.011f}}, 0.0012f, 6));
  }
  m.add(p.wood,
        tube({{0.192f, kGround + 0.09f, 0.11f}, {0.192f, kGround + 0.28f - 0.001f * 59, -0.10f + 0.02f}},
             0.0026f, 8));
  // The bedroom.
  m.add(bed(p), place(-0.155f, kUpper, kBack + 0.012f, 0));
  m.add(wardrobe(p), place(0.165f, kUpper, kBack + 0.002f));
  m.add(p.ochre, block(0.15f, 0.0012f, 0.09f, {.bevel = 0.0005f}), at(0.04f, kUpper - 0.0002f, 0.07f));
  m.add(rectTable(p.wood, 0.5f, 0.4f, 0.55f), place(-0.055f, kUpper, kBack + 0.022f));
  m.add(p.clay, cylinder(0.008f, 0.014f, 20, 0.001f), at(-0.055f, kUpper + 0.0458f, kBack + 0.022f));
  m.add(framed(p.white, p.picture[1], 0.9f, 0.7f), place(0.03f, kUpper + 0.14f, kBack));
  m.add(sofa(seats, 0.95f, 1), place(0.19f, kUpper, 0.055f, -65));
  // The lamp of the parlour hangs from a cord; its bulb ends above the point light.
  m.add(p.brass, tube({{0.02f, kGround + 0.19f, -0.02f}, {0.02f, kGround + kStorey, -0.02f}}, 0.0008f, 6));
  m.add(p.bulb, sphere(0.007f, 20, 12), at(0.02f, kGround + 0.188f, -0.02f));
  // On the table: three marbles and a pencil.
  m.add(p.blue, sphere(0.011f, 28, 18), at(-0.17f, kTable + 0.011f, 0.165f));
  m.add(p.red, sphere(0.009f, 28, 18), at(0.13f, kTable + 0.009f, 0.17f));
  m.add(p.ochre, cylinder(0.0036f, 0.15f, 6), at(0.20f, kTable + 0.0036f, 0.18f) * turnY(65) * turnZ(90));
  b.place("furniture", b.mesh("furniture", std::move(m)));
  // A ball that children left upstairs.
  MeshBuilder ball;
  for (int i = 0; i < 6; ++i)
    ball.add(i % 2 == 0 ? p.red : p.linen,
             lathe(Outline({0, -0.011f}).arc(0, 0.011f, 1, 16),
                   {.segments = 6, .fromDegrees = 60.0f * float(i), .toDegrees = 60.0f * float(i + 1)}));
  b.place("ball", b.mesh("ball", std::move(ball)), {0.02f, kUpper + 0.0122f, 0.085f});
}

}  // namespace

static Scene dollhouseScene() {
  SceneBuilder b("dollhouse");
  const Palette p = makePalette(b);
  MeshBuilder house;
  addHouse(house, p);
  b.place("house", b.mesh("house", std::move(house)));
  furnish(b, p);
  addPoint(b, "pea bulb", {1.0f, 0.74f, 0.44f}, 0.055f, {0.02f, kGround + 0.165f, -0.02f});
  const glm::vec3 lamp(0.42f, 0.78f, 0.75f);
  addSpot(b, "desk lamp", {1.0f, 0.93f, 0.82f}, 4.5f, lamp, glm::vec3(-0.04f, 0.30f, -0.06f) - lamp, 14, 22);
  b.camera({-0.10f, 0.33f, 0.94f}, {0.0f, 0.25f, 0.0f}, 42, 0.02f);
  return b.finish(1.5f, {0.45f, 0.65f});
}

FOVEA_SCENE("dollhouse", dollhouseScene);

}  // namespace fovea::scene
