// A dark room at night. All light comes through one window, from a bright sign on the other side of the street and from
// a street lamp, and it first hits a small part of the room.
#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr float kX = 2.4f, kHeight = 2.6f, kBack = -2.2f, kFront = 2.4f, kWall = 0.25f;
// The window in the wall at -kX, along z and y.
constexpr float kLeft = -1.15f, kRight = -0.15f, kSill = 0.85f, kHead = 2.05f;

struct Palette {
  uint32_t wall, floor, ceiling, paint, wood, fabric, cushion[3], rug, leather, paper, book[3], clay, soil,
      leaf, street, sign;
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 2201);
  p.wall = b.material("wallpaper", {0.60f, 0.58f, 0.50f}, {.texture = s.plaster, .metres = 2.4f});
  p.floor = b.material("oak floor", {0.50f, 0.34f, 0.20f}, {.texture = s.planks, .metres = 1.1f});
  p.ceiling = b.material("ceiling", {0.76f, 0.76f, 0.74f}, {.texture = s.plaster, .metres = 3});
  p.paint = b.material("white paint", {0.78f, 0.77f, 0.74f});
  p.wood = b.material("walnut", {0.34f, 0.19f, 0.10f}, {.texture = s.grain, .metres = 0.4f});
  p.fabric = b.material("grey wool", {0.42f, 0.43f, 0.46f}, {.texture = s.linen, .metres = 0.4f});
  p.cushion[0] = b.material("ochre cloth", {0.76f, 0.46f, 0.10f}, {.texture = s.linen, .metres = 0.4f});
  p.cushion[1] = b.material("teal cloth", {0.08f, 0.38f, 0.40f}, {.texture = s.linen, .metres = 0.4f});
  p.cushion[2] = b.material("rose cloth", {0.66f, 0.26f, 0.24f}, {.texture = s.linen, .metres = 0.4f});
  p.rug = b.material("red rug", {0.52f, 0.12f, 0.09f}, {.texture = s.linen, .metres = 0.6f});
  p.leather = b.material("leather", {0.42f, 0.18f, 0.09f}, {.texture = s.mottled, .metres = 0.8f});
  p.paper = b.material("paper", {0.80f, 0.77f, 0.68f});
  const glm::vec3 covers[3] = {{0.45f, 0.10f, 0.08f}, {0.12f, 0.24f, 0.34f}, {0.60f, 0.50f, 0.30f}};
  for (int i = 0; i < 3; ++i) p.book[i] = b.material("book " + std::to_string(i + 1), covers[i]);
  p.clay = b.material("white pot", {0.74f, 0.72f, 0.68f});
  p.soil = b.material("soil", {0.08f, 0.055f, 0.04f});
  p.leaf = b.material("leaves", {0.10f, 0.28f, 0.07f}, {.doubleSided = true});
  p.street = b.material("facade", {0.40f, 0.36f, 0.33f}, {.texture = s.plaster, .metres = 4});
  p.sign = b.material("sign", {0.5f, 0.2f, 0.3f}, {.emission = {34, 9, 15}});
  return p;
}

void addRoom(MeshBuilder& m, const Palette& p) {
  const float x = kX + kWall, low = -kWall, high = kHeight + kWall, e = 0.5f * kWall;
  m.add(p.wall, box({-x, low, kBack - kWall}, {x, high, kBack}));
  m.add(p.wall, box({-x, low, kFront}, {x, high, kFront + kWall}));
  m.add(p.wall, box({kX, low, kBack - e}, {x, high, kFront + e}));
  m.add(p.floor, box({-kX - e, low + 0.01f, kBack - e}, {kX + e, 0, kFront + e}));
  m.add(p.ceiling, box({-kX - e, kHeight, kBack - e}, {kX + e, high - 0.01f, kFront + e}));
  // The wall with the window: beside, above and below it.
  m.add(p.wall, box({-x, low, kBack - e}, {-kX, high, kLeft}));
  m.add(p.wall, box({-x, low, kRight}, {-kX, high, kFront + e}));
  m.add(p.wall, box({-x + 0.001f, low, kLeft - e}, {-kX, kSill, kRight + e}));
  m.add(p.wall, box({-x + 0.001f, kHead, kLeft - e}, {-kX, high, kRight + e}));
  const float t = 0.03f, bar = -kX - 0.12f;
  for (const float z : {kLeft + t, 0.5f * (kLeft + kRight), kRight - t})
    m.add(p.paint, box({bar - t, kSill, z - t}, {bar + t, kHead, z + t}, {.bevel = 0.004f}));
  for (const float y : {kSill + t, kSill + 0.8f, kHead - t})
    m.add(p.paint, box({bar - 0.9f * t, y - t, kLeft}, {bar + 0.9f * t, y + t, kRight}, {.bevel = 0.004f}));
  m.add(p.paint, box({-kX - 0.2f, kSill - 0.01f, kLeft - 0.08f}, {-kX + 0.16f, kSill + 0.02f, kRight + 0.08f},
                     {.bevel = 0.006f}));
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  m.add(sofa({p.fabric, p.wood, {p.cushion[0], p.cushion[1], p.cushion[2]}}, 1.9f, 2),
        at(0.35f, 0, kBack + 0.12f));
  m.add(sofa({p.leather, p.wood, {p.cushion[1], p.cushion[0], p.cushion[2]}}, 0.95f, 1),
        at(kX - 0.35f, 0, 0.25f) * turnY(-75));
  m.add(p.rug, box({-1.3f, -0.002f, -1.1f}, {1.4f, 0.012f, 0.7f}, {.bevel = 0.005f}));
  m.add(roundTable(p.wood, 0.42f, 0.42f), at(0.2f, 0.012f, -0.35f));
  m.add(pouffe(p.cushion[1], p.wood, 0.28f, 0.38f), at(-0.95f, 0.012f, 0.35f));
  m.add(p.book[0], block(0.2f, 0.025f, 0.14f, {.bevel = 0.003f}), at(0.1f, 0.432f, -0.3f) * turnY(20));
  m.add(p.clay, vase(), at(0.36f, 0.432f, -0.42f));
  m.add(rectTable(p.wood, 1.1f, 0.45f, 0.75f), at(-1.6f, 0, 1.9f));
  addBooks(m, p.book, p.paper, 8, 0.26f, 2211, at(-2.0f, 0.751f, 1.95f));
  addPot(m, p.clay, p.soil, 0.17f, 0.3f, at(-2.0f, 0, -1.75f));
  const Plant bushy = bush({0.38f, 0.6f, 0.38f}, 16, 22, {.length = 0.13f, .width = 0.06f}, 2221);
  m.add(p.leaf, bushy.leaves, at(-2.0f, 0.27f, -1.75f)).add(p.wood, bushy.wood, at(-2.0f, 0.27f, -1.75f));
  const uint32_t picture = painting(b, "painting", 0.9f, 0.65f, 2231);
  m.add(framed(p.wood, picture, 0.9f, 0.65f), at(0.35f, 1.6f, kBack));
  b.place("things", b.mesh("things", std::move(m)));
  // A toy truck, which drives through the light on the floor.
  MeshBuilder truck;
  truck.add(p.cushion[0], box({-0.16f, 0.05f, -0.08f}, {0.06f, 0.15f, 0.08f}, {.bevel = 0.01f}));
  truck.add(p.cushion[2], box({0.07f, 0.05f, -0.075f}, {0.16f, 0.19f, 0.075f}, {.bevel = 0.015f}));
  for (const float x : {-0.1f, 0.1f})
    for (const float z : {-0.105f, 0.07f})
      truck.add(p.wood, cylinder(0.045f, 0.035f, 24, 0.005f), at(x, 0.045f, z) * turnX(90));
  b.place("truck", b.mesh("truck", std::move(truck)), {-0.6f, 0.012f, -0.6f});
}

// What is outside: the pavement and the house opposite, with its sign.
void addStreet(MeshBuilder& m, const Palette& p) {
  m.add(p.street, box({-9, -3.2f, -8}, {-kX - kWall - 0.01f, -3, 8}));
  m.add(p.street, box({-9.3f, -3.2f, -8}, {-9, 6, 8}));
  m.add(p.sign, box({-8.95f, 1.6f, -2.6f}, {-8.8f, 2.9f, 1.4f}, {.bevel = 0.02f}));
}

}  // namespace

static Scene nightWindowScene() {
  SceneBuilder b("night_window");
  const Palette p = makePalette(b);
  MeshBuilder house;
  addRoom(house, p);
  addStreet(house, p);
  b.place("house", b.mesh("house", std::move(house)));
  furnish(b, p);
  addSpot(b, "street lamp", {0.86f, 0.93f, 1.0f}, 420, {-6.2f, 3.9f, -1.5f},
          glm::vec3(-0.6f, 0, -0.4f) - glm::vec3(-6.2f, 3.9f, -1.5f), 14, 24);
  b.camera({1.7f, 1.5f, 2.05f}, {-0.75f, 0.75f, -1.1f}, 60);
  b.scene.environment = {0.004f, 0.006f, 0.012f};
  return b.finish(2.0f, {0.4f, 0.6f});
}

FOVEA_SCENE("night_window", nightWindowScene);

}  // namespace fovea::scene
