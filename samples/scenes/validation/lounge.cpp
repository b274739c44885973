// A lounge in the evening: a buttoned sofa and an armchair, a floor lamp whose bulb is a point light, and three spots
// under the ceiling that light pictures and the table. The walls are dark, so that the light near the lamps counts.
#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/modelling/textures.h"
#include "samples/scenes/builtin/modelling/upholstery.h"

namespace fovea::scene {
namespace {

using namespace model;

struct Palette {
  uint32_t wall, ceiling, floor, paint, wood, dark, brass, shade, rug, leather, velvet, wool, ochre, rose,
      clay, soil, leaf, paper, orange, white, picture[3], book[3];
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 801);
  p.wall = b.material("green wall", {0.16f, 0.26f, 0.22f}, {.texture = s.plaster, .metres = 3});
  p.ceiling = b.material("ceiling", {0.82f, 0.80f, 0.76f}, {.texture = s.plaster, .metres = 4});
  p.floor =
      b.material("floor", {0.52f, 0.33f, 0.19f}, {.texture = s.planks, .metres = 0.8f, .metresHigh = 2.6f});
  p.paint = b.material("white paint", {0.76f, 0.74f, 0.70f});
  p.wood =
      b.material("walnut", {0.36f, 0.20f, 0.11f}, {.texture = s.grain, .metres = 0.4f, .metresHigh = 1.4f});
  p.dark = b.material("dark metal", {0.06f, 0.055f, 0.05f});
  p.brass = b.material("brass", {0.62f, 0.43f, 0.16f});
  // The lining is dark, because a bright one would be a small source that paths find only by chance.
  p.shade = b.material("lamp shade", {0.06f, 0.05f, 0.04f}, {.emission = {0.42f, 0.27f, 0.13f}});
  const uint32_t bands = b.texture(stripes("rug",
                                           {{{0.62f, 0.52f, 0.38f}, 5},
                                            {{0.16f, 0.17f, 0.22f}, 0.7f},
                                            {{0.62f, 0.52f, 0.38f}, 0.6f},
                                            {{0.46f, 0.15f, 0.10f}, 1.6f},
                                            {{0.62f, 0.52f, 0.38f}, 0.6f},
                                            {{0.16f, 0.17f, 0.22f}, 0.7f}},
                                           256, 811));
  p.rug = b.material("rug", glm::vec3(1), {.texture = bands, .metres = 0.72f});
  p.leather = b.material("leather", {0.40f, 0.16f, 0.08f}, {.texture = s.mottled, .metres = 0.8f});
  p.velvet = b.material("blue velvet", {0.08f, 0.17f, 0.36f}, {.texture = s.mottled, .metres = 0.5f});
  p.wool = b.material("cream wool", {0.78f, 0.71f, 0.58f}, {.texture = s.linen, .metres = 0.4f});
  p.ochre = b.material("ochre cloth", {0.78f, 0.46f, 0.09f}, {.texture = s.linen, .metres = 0.4f});
  p.rose = b.material("rose cloth", {0.66f, 0.24f, 0.22f}, {.texture = s.linen, .metres = 0.4f});
  p.clay = b.material("white pot", {0.74f, 0.72f, 0.68f});
  p.soil = b.material("soil", {0.08f, 0.055f, 0.04f});
  p.leaf = b.material("leaves", {0.10f, 0.28f, 0.07f}, {.doubleSided = true});
  p.paper = b.material("paper", {0.80f, 0.77f, 0.68f});
  p.orange = b.material("oranges", {0.84f, 0.36f, 0.04f});
  p.white = b.material("enamel", {0.78f, 0.78f, 0.77f});
  for (uint32_t i = 0; i < 3; ++i)
    p.picture[i] = painting(b, "painting " + std::to_string(i + 1), i == 1 ? 1.1f : 0.6f, 0.8f, 821 + 20 * i);
  const glm::vec3 covers[3] = {{0.45f, 0.10f, 0.08f}, {0.12f, 0.24f, 0.34f}, {0.60f, 0.50f, 0.30f}};
  for (int i = 0; i < 3; ++i) p.book[i] = b.material("book " + std::to_string(i + 1), covers[i]);
  return p;
}

constexpr Shell kRoom = {.x = 2.9f, .height = 2.7f, .back = -2.2f, .front = 3.0f};
constexpr glm::vec3 kLamp{-1.95f, 0, -1.55f};

MeshBuilder floorLamp(const Palette& p) {
  MeshBuilder m;
  Outline foot({0, 0});
  foot.line(0.15f, 0)
      .line(0.15f, 0.012f)
      .curve({0.1f, 0.03f}, {0.03f, 0.03f}, {0.014f, 0.06f}, 6)
      .line(0, 0.06f);
  m.add(p.brass, lathe(foot, {.segments = 40}));
  m.add(p.brass, tube({{0, 0.05f, 0}, {0, 1.36f, 0}}, 0.011f, 12));
  m.add(p.shade, shade(0.24f, 0.16f, 0.30f), at(0, 1.36f, 0));
  for (int i = 0; i < 3; ++i)
    m.add(p.brass, tube({{0, 1.355f, 0}, {0.236f, 1.362f, 0}}, 0.003f, 6), turnY(120 * float(i)));
  return m;
}

// Shelves on the right wall, looking along +z.
MeshBuilder shelves(const Palette& p) {
  MeshBuilder m;
  for (const float x : {-0.6f, 0.575f})
    m.add(p.wood, box({x, 0, 0}, {x + 0.025f, 2.0f, 0.28f}, {.bevel = 0.002f}));
  for (int i = 0; i < 6; ++i) {
    const float y = 0.06f + 0.384f * float(i);
    m.add(p.wood, box({-0.576f, y, 0.002f}, {0.576f, y + 0.022f, 0.278f}));
    if (i == 5) break;
    const int count = i == 2 ? 4 : 9;
    addBooks(m, p.book, p.paper, count, 0.27f, 841 + 10 * uint32_t(i),
             at(i == 2 ? -0.1f : -0.56f, y + 0.0225f, 0.24f));
  }
  m.add(p.wood, box({-0.58f, 0.05f, -0.004f}, {0.58f, 1.998f, 0.004f}));
  Outline vase({0, 0});
  vase.line(0.05f, 0)
      .through({{0.085f, 0.08f}, {0.05f, 0.18f}, {0.03f, 0.22f}, {0.04f, 0.25f}}, 5)
      .line(0.034f, 0.25f);
  vase.through({{0.025f, 0.22f}, {0.044f, 0.18f}, {0.078f, 0.08f}}, 5).line(0, 0.02f);
  m.add(p.rose, lathe(vase, {.segments = 40}), at(-0.36f, 0.851f, 0.15f));
  return m;
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  const SeatLook leather = {p.leather, p.wood, {p.ochre, p.wool, p.rose}};
  m.add(sofa(leather, 2.1f, 2), at(-0.25f, 0, kRoom.back + 0.12f));
  const SeatLook velvet = {p.velvet, p.wood, {p.ochre, p.wool, p.rose}};
  m.add(sofa(velvet, 0.98f, 1), at(1.8f, 0, -0.85f) * turnY(-58));
  m.add(p.rug, box({-1.55f, -0.002f, -1.0f}, {1.35f, 0.012f, 1.0f}, {.bevel = 0.005f, .bevelSteps = 2}));
  m.add(roundTable(p.wood, 0.42f, 0.42f), at(-0.05f, 0.012f, -0.15f));
  m.add(pouffe(p.ochre, p.wood, 0.29f, 0.38f), at(-1.35f, 0.012f, 0.25f));
  m.add(floorLamp(p), at(kLamp));
  m.add(shelves(p), at(kRoom.x, 0, 0.95f) * turnY(-90));
  m.add(framed(p.brass, p.picture[0], 0.6f, 0.8f), at(-1.25f, 1.62f, kRoom.back));
  m.add(framed(p.wood, p.picture[1], 1.1f, 0.8f), at(0.0f, 1.62f, kRoom.back));
  m.add(framed(p.brass, p.picture[2], 0.6f, 0.8f), at(1.25f, 1.62f, kRoom.back));
  // A bowl of oranges and two books on the table.
  Outline bowl({0, 0});
  bowl.line(0.05f, 0).through({{0.10f, 0.03f}, {0.14f, 0.075f}}, 6).line(0.134f, 0.077f);
  bowl.through({{0.095f, 0.037f}, {0.045f, 0.012f}}, 6).line(0, 0.010f);
  const glm::mat4 table = at(-0.05f, 0.432f, -0.15f);
  m.add(p.white, lathe(bowl, {.segments = 48}), table * at(0.12f, 0, -0.05f));
  const glm::vec3 oranges[5] = {{0.05f, 0.052f, 0},
                                {-0.03f, 0.053f, 0.045f},
                                {-0.03f, 0.053f, -0.045f},
                                {0.0f, 0.105f, 0},
                                {0.06f, 0.09f, 0.05f}};
  for (const glm::vec3& o : oranges)
    m.add(p.orange, sphere(0.038f, 24, 14), table * at(0.12f, 0, -0.05f) * at(o));
  m.add(p.book[1], block(0.2f, 0.025f, 0.14f, {.bevel = 0.003f}), table * at(-0.18f, 0, 0.08f) * turnY(20));
  m.add(p.book[0], block(0.17f, 0.02f, 0.12f, {.bevel = 0.003f}),
        table * at(-0.18f, 0.0255f, 0.08f) * turnY(42));
  // A plant in the right corner.
  const glm::mat4 corner = at(2.35f, 0, kRoom.back + 0.5f);
  addPot(m, p.clay, p.soil, 0.2f, 0.36f, corner);
  m.add(p.leaf,
        rosette(34, {.length = 0.95f, .width = 0.11f, .fold = 0.4f, .droop = 0.35f, .steps = 6}, 62, 851),
        corner * at(0, 0.31f, 0));
  b.place("furniture", b.mesh("furniture", std::move(m)));
  // The housings of the spots.
  MeshBuilder spots;
  for (const float x : {-1.25f, 0.0f, 1.25f})
    spots.add(p.dark, cylinder(0.05f, 0.03f, 24, 0.004f), at(x, kRoom.height - 0.03f, -0.9f));
  b.place("spots", b.mesh("spots", std::move(spots)));
  // A robot that cleans the floor.
  MeshBuilder robot;
  Outline body({0, 0.012f});
  body.line(0.155f, 0.012f).arc(0.155f, 0.072f, 0.35f, 6).line(0.14f, 0.08f).line(0, 0.082f);
  robot.add(p.white, lathe(body, {.segments = 64}));
  robot.add(p.dark, cylinder(0.045f, 0.018f, 32, 0.004f), at(-0.05f, 0.08f, 0));
  for (const float z : {-0.09f, 0.09f})
    robot.add(p.dark, cylinder(0.03f, 0.02f, 20), at(0, 0.03f, z - 0.01f) * turnX(90));
  b.place("robot", b.mesh("robot", std::move(robot)), {0.75f, 0.0f, 1.35f});
}

}  // namespace

static Scene loungeScene() {
  SceneBuilder b("lounge");
  const Palette p = makePalette(b);
  MeshBuilder room;
  Shell shell = kRoom;
  shell.wall = p.wall;
  shell.floor = p.floor;
  shell.ceiling = p.ceiling;
  addShell(room, shell);
  addSkirting(room, shell, p.paint, 0.11f);
  b.place("room", b.mesh("room", std::move(room)));
  furnish(b, p);
  addPoint(b, "floor lamp", {1.0f, 0.72f, 0.42f}, 10, kLamp + glm::vec3(0, 1.50f, 0));
  const glm::vec3 warm(1.0f, 0.84f, 0.64f);
  for (const float x : {-1.25f, 0.0f, 1.25f})
    addSpot(b, "picture spot", warm, 9, {x, kRoom.height - 0.04f, -0.9f}, {0, -1.05f, -1.2f}, 12, 24);
  b.camera({0.95f, 1.42f, 2.3f}, {-0.2f, 0.82f, -1.2f}, 58);
  return b.finish(2.8f, {0.5f, 0.55f});
}

FOVEA_SCENE("lounge", loungeScene);

}  // namespace fovea::scene
