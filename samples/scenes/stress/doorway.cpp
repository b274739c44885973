// Two rooms with a door between them. The lamp is in the other room, so that all light in this one comes in through the
// door, which opens.
#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

// The rooms lie along x, on both sides of a wall from -kWall / 2 to kWall / 2; this one is at x > 0.
constexpr float kX = 4.2f, kHeight = 2.6f, kZ = 2.1f, kWall = 0.2f;
constexpr float kDoorWidth = 0.95f, kDoorHeight = 2.05f, kHinge = -0.75f;  // along z

struct Palette {
  uint32_t wall, warm, floor, ceiling, paint, door, wood, fabric, cushion[3], shade, brass, clay, soil, leaf,
      book[3], paper;
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 2301);
  p.wall = b.material("pale wall", {0.70f, 0.69f, 0.66f}, {.texture = s.plaster, .metres = 2.6f});
  p.warm = b.material("ochre wall", {0.70f, 0.47f, 0.20f}, {.texture = s.plaster, .metres = 2.6f});
  p.floor = b.material("oak floor", {0.52f, 0.36f, 0.21f}, {.texture = s.planks, .metres = 1.2f});
  p.ceiling = b.material("ceiling", {0.78f, 0.78f, 0.76f}, {.texture = s.plaster, .metres = 3});
  p.paint = b.material("white paint", {0.80f, 0.79f, 0.76f});
  p.door = b.material("blue paint", {0.14f, 0.26f, 0.42f}, {.texture = s.grain, .metres = 0.6f});
  p.wood = b.material("walnut", {0.36f, 0.20f, 0.11f}, {.texture = s.grain, .metres = 0.4f});
  p.fabric = b.material("green wool", {0.20f, 0.36f, 0.22f}, {.texture = s.linen, .metres = 0.4f});
  p.cushion[0] = b.material("cream wool", {0.78f, 0.71f, 0.58f}, {.texture = s.linen, .metres = 0.4f});
  p.cushion[1] = b.material("rose cloth", {0.66f, 0.24f, 0.22f}, {.texture = s.linen, .metres = 0.4f});
  p.cushion[2] = b.material("ochre cloth", {0.76f, 0.46f, 0.10f}, {.texture = s.linen, .metres = 0.4f});
  p.shade = b.material("lamp shade", {0.70f, 0.62f, 0.46f}, {.doubleSided = true});
  p.brass = b.material("brass", {0.62f, 0.43f, 0.16f});
  p.clay = b.material("white pot", {0.74f, 0.72f, 0.68f});
  p.soil = b.material("soil", {0.08f, 0.055f, 0.04f});
  p.leaf = b.material("leaves", {0.10f, 0.28f, 0.07f}, {.doubleSided = true});
  const glm::vec3 covers[3] = {{0.45f, 0.10f, 0.08f}, {0.12f, 0.24f, 0.34f}, {0.60f, 0.50f, 0.30f}};
  for (int i = 0; i < 3; ++i) p.book[i] = b.material("book " + std::to_string(i + 1), covers[i]);
  p.paper = b.material("paper", {0.80f, 0.77f, 0.68f});
  return p;
}

void addHouse(MeshBuilder& m, const Palette& p) {
  const float e = 0.5f * kWall, low = -kWall, high = kHeight + kWall, end = kHinge + kDoorWidth;
  for (const float side : {-1.0f, 1.0f}) {
    const uint32_t wall = side < 0 ? p.warm : p.wall;
    const float from = side < 0 ? -kX : e, to = side < 0 ? -e : kX;  // of the room
    m.add(wall, box({from - kWall, low, -kZ - kWall}, {to + kWall, high, -kZ}));
    m.add(wall, box({from - kWall, low, kZ}, {to + kWall, high, kZ + kWall}));
    m.add(wall,
          box({side < 0 ? -kX - kWall : kX, low, -kZ - e}, {side < 0 ? -kX : kX + kWall, high, kZ + e}));
    // Half of the wall between the rooms: on both sides of the door and above it.
    const float a = side < 0 ? -e : 0, b = side < 0 ? 0 : e;
    m.add(wall, box({a, low, -kZ - e}, {b, high, kHinge}));
    m.add(wall, box({a, low, end}, {b, high, kZ + e}));
    m.add(wall, box({a, kDoorHeight, kHinge - e}, {b, high, end + e}));
  }
  m.add(p.floor, box({-kX - e, low + 0.01f, -kZ - e}, {kX + e, 0, kZ + e}));
  m.add(p.ceiling, box({-kX - e, kHeight, -kZ - e}, {kX + e, high - 0.01f, kZ + e}));
  // The frame of the door.
  const float t = 0.06f, out = e + 0.02f;
  for (const float z : {kHinge, end})
    m.add(p.paint,
          box({-out, -0.01f, z - t}, {out, kDoorHeight + t, z + (z < 0 ? 0.012f : t)}, {.bevel = 0.004f}));
  m.add(p.paint, box({-0.99f * out, kDoorHeight - 0.012f, kHinge - 0.9f * t},
                     {0.99f * out, kDoorHeight + 0.99f * t, end + 0.9f * t}, {.bevel = 0.004f}));
}

// The leaf of the door, with its hinge at the origin and along +z when closed.
MeshBuilder door(const Palette& p) {
  MeshBuilder m;
  const float w = kDoorWidth - 0.04f, h = kDoorHeight - 0.035f;
  m.add(p.door, box({-0.02f, 0.008f, 0.005f}, {0.02f, h, w}, {.bevel = 0.003f}));
  for (const float side : {-1.0f, 1.0f}) {
    for (const float y : {0.15f, 1.1f})
      m.add(p.door, box({side * 0.024f - 0.006f, y, 0.12f}, {side * 0.024f + 0.006f, y + 0.8f, w - 0.12f},
                        {.bevel = 0.005f}));
    m.add(p.brass, sphere(0.028f, 24, 14), at(side * 0.07f, 1.02f, w - 0.07f));
    m.add(p.brass, tube({{0, 1.02f, w - 0.07f}, {side * 0.07f, 1.02f, w - 0.07f}}, 0.01f, 10));
  }
  return m;
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  m.add(sofa({p.fabric, p.wood, {p.cushion[0], p.cushion[1], p.cushion[2]}}, 1.9f, 2),
        at(2.5f, 0, -kZ + 0.1f));
  m.add(roundTable(p.wood, 0.42f, 0.42f), at(2.2f, 0, -0.35f));
  m.add(pouffe(p.cushion[1], p.wood, 0.28f, 0.38f), at(1.25f, 0, 0.6f));
  m.add(p.book[1], block(0.2f, 0.025f, 0.14f, {.bevel = 0.003f}), at(2.1f, 0.42f, -0.3f) * turnY(25));
  m.add(p.clay, vase(), at(2.35f, 0.42f, -0.4f));
  addPot(m, p.clay, p.soil, 0.17f, 0.3f, at(0.55f, 0, -1.65f));
  const Plant bushy = bush({0.34f, 0.6f, 0.34f}, 16, 22, {.length = 0.13f, .width = 0.06f}, 2322);
  m.add(p.leaf, bushy.leaves, at(0.55f, 0.27f, -1.65f)).add(p.wood, bushy.wood, at(0.55f, 0.27f, -1.65f));
  const uint32_t picture = painting(b, "painting", 0.9f, 0.65f, 2331);
  m.add(framed(p.wood, picture, 0.9f, 0.65f), at(2.5f, 1.6f, -kZ));
  // The other room: a table with books, and the lamp that hangs over it.
  m.add(rectTable(p.wood, 1.3f, 0.8f, 0.75f), at(-2.1f, 0, -0.3f));
  addBooks(m, p.book, p.paper, 7, 0.26f, 2341, at(-2.5f, 0.751f, -0.35f));
  m.add(p.brass, tube({{-2.1f, 1.92f, -0.3f}, {-2.1f, kHeight + 0.01f, -0.3f}}, 0.008f, 8));
  m.add(p.shade, shade(0.24f, 0.1f, 0.2f), at(-2.1f, 1.72f, -0.3f));
  b.place("things", b.mesh("things", std::move(m)));
  b.place("door", b.mesh("door", door(p)), {0, 0, kHinge + 0.02f});
}

}  // namespace

static Scene doorwayScene() {
  SceneBuilder b("doorway");
  const Palette p = makePalette(b);
  MeshBuilder house;
  addHouse(house, p);
  b.place("house", b.mesh("house", std::move(house)));
  furnish(b, p);
  addPoint(b, "lamp", {1.0f, 0.86f, 0.66f}, 60, {-2.1f, 1.78f, -0.3f});
  b.camera({3.9f, 1.5f, 1.75f}, {0.7f, 0.95f, -0.75f}, 60);
  return b.finish(1.6f, {0.35f, 0.5f});
}

FOVEA_SCENE("doorway", doorwayScene);

}  // namespace fovea::scene
