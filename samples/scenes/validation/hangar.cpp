// A hangar of 44 m by 28 m with a small aeroplane. The sun comes in through the door, and every fourth strip of the
// roof is a translucent sheet that passes on the light of the sky: in this scene it is an emitter.
#include <cmath>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr float kX = 22, kZ = 14, kEave = 8.5f, kRidge = 13, kWall = 0.3f;
constexpr float kDoorWidth = 17, kDoorHeight = 6.8f;

struct Palette {
  uint32_t wall, roof, sky, concrete, asphalt, steel, red, white, blue, glass, rubber, wood, line, barrel[2],
      facade, chrome;
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 1101);
  const uint32_t ribs = b.texture(stripes("corrugated sheet",
                                          {{{0.78f, 0.80f, 0.80f}, 2},
                                           {{0.60f, 0.63f, 0.64f}, 0.5f},
                                           {{0.88f, 0.89f, 0.88f}, 0.6f},
                                           {{0.70f, 0.72f, 0.73f}, 0.5f}},
                                          256, 1111));
  p.wall = b.material("corrugated wall", {0.70f, 0.76f, 0.74f}, {.texture = ribs, .metres = 1.2f});
  p.roof = b.material("corrugated roof", {0.62f, 0.66f, 0.68f}, {.texture = ribs, .metres = 1.2f});
  p.sky = b.material("translucent sheet", {0.70f, 0.72f, 0.74f}, {.emission = {0.55f, 0.72f, 0.95f}});
  p.concrete = b.material(
      "concrete", {0.52f, 0.51f, 0.49f},
      {.texture = b.texture(plaster("concrete", glm::vec3(0.85f), 0.25f, 0.1f, 512, 1112)), .metres = 9});
  p.asphalt = b.material("apron", {0.36f, 0.36f, 0.35f}, {.texture = s.mottled, .metres = 6});
  p.steel = b.material("painted steel", {0.26f, 0.34f, 0.40f});
  p.red = b.material("red paint", {0.66f, 0.06f, 0.04f});
  p.white = b.material("white paint", {0.80f, 0.80f, 0.78f});
  p.blue = b.material("blue paint", {0.06f, 0.16f, 0.46f});
  p.glass = b.material("dark glass", {0.05f, 0.06f, 0.07f});
  p.rubber = b.material("rubber", {0.035f, 0.035f, 0.035f});
  p.wood =
      b.material("crate wood", {0.66f, 0.47f, 0.27f}, {.texture = s.planks, .metres = 0.9f, .metresHigh = 2});
  p.line = b.material("yellow line", {0.78f, 0.56f, 0.04f});
  p.barrel[0] = b.material("blue barrel", {0.05f, 0.20f, 0.42f});
  p.barrel[1] = b.material("rusty barrel", {0.42f, 0.17f, 0.07f}, {.texture = s.mottled, .metres = 0.8f});
  p.facade = b.material("facade over the apron", {0.72f, 0.62f, 0.48f}, {.texture = s.plaster, .metres = 6});
  p.chrome = b.material("bare metal", {0.56f, 0.56f, 0.58f});
  return p;
}

// From section to building: the section's x becomes -z, and what is extruded runs along x.
glm::mat4 along(float x) { return at(x, 0, 0) * turnY(90); }

void addBuilding(MeshBuilder& m, const Palette& p) {
  const float z = kZ + kWall;
  m.add(p.concrete, box({-kX - 0.4f, -0.5f, -z}, {kX + 0.4f, 0, z}));
  m.add(p.asphalt, box({-kX - 24, -0.5f, -30}, {-kX - 0.3f, -0.02f, 30}));
  for (const float side : {-1.0f, 1.0f})
    m.add(p.wall,
          box({-kX - kWall, -0.1f, side > 0 ? kZ : -z}, {kX + kWall, kEave + 0.1f, side > 0 ? z : -kZ}));
  const Outline gable({{-z, -0.1f}, {z, -0.1f}, {z, kEave}, {0, kRidge + 0.1f}, {-z, kEave}});
  const Outline door = rectangle(kDoorWidth, kDoorHeight).moved({0, 0.5f * kDoorHeight + 0.001f});
  m.add(p.wall, extrude(gable, {door}, kWall), along(-kX - kWall));
  m.add(p.wall, extrude(gable, kWall), along(kX));
  // The roof in strips of 2 m.
  const float e = 0.25f;
  const Outline slope({{0, kRidge}, {z + 0.3f, kEave - 0.1f}, {z + 0.3f, kEave - 0.1f + e}, {0, kRidge + e}});
  const int strips = 22;
  for (int i = 0; i < strips; ++i) {
    const float x = -kX - kWall + (2 * kX + 2 * kWall) * float(i) / strips, w = (2 * kX + 2 * kWall) / strips;
    for (const float side : {-1.0f, 1.0f})
      m.add(i % 4 == 2 ? p.sky : p.roof, extrude(slope, w), along(x) * scaled(side, 1, 1));
  }
  // Leaves of the door, slid aside, and a frame.
  for (const float side : {-1.0f, 1.0f}) {
    m.add(p.blue, box({-kX + 0.05f, 0.05f, side * 11.1f - 2.6f},
                      {-kX + 0.17f, kDoorHeight + 0.2f, side * 11.1f + 2.6f}));
    for (int i = 0; i < 5; ++i)
      m.add(p.steel, box({-kX + 0.16f, 0.05f, side * 11.1f - 2.6f + 1.25f * float(i)},
                         {-kX + 0.24f, kDoorHeight + 0.2f, side * 11.1f - 2.5f + 1.25f * float(i)}));
  }
  m.add(p.steel,
        box({-kX + 0.02f, kDoorHeight + 0.2f, -kZ + 0.1f}, {-kX + 0.3f, kDoorHeight + 0.5f, kZ - 0.1f}));
  // The building on the other side of the apron.
  m.add(p.facade, box({-kX - 26, -0.5f, -32}, {-kX - 23, 9, 32}));
  for (int i = 0; i < 9; ++i)
    m.add(p.glass, box({-kX - 23.05f, 3, -24.0f + 6 * float(i)}, {-kX - 22.95f, 5, -21.0f + 6 * float(i)}));
}

void addTrusses(MeshBuilder& m, const Palette& p) {
  for (int i = 0; i <= 8; ++i) {
    const float x = -kX + 0.3f + (2 * kX - 0.6f) * float(i) / 8;
    for (const float side : {-1.0f, 1.0f}) {
      m.add(p.steel, box({x - 0.15f, 0, side * kZ - 0.32f}, {x + 0.15f, kEave - 0.2f, side * kZ + 0.01f}));
      const auto top = [&](float t) {
        return glm::vec3(x, kEave - 0.35f + (kRidge - kEave) * t, side * (kZ - 0.1f) * (1 - t));
      };
      const auto low = [&](float t) {
        return glm::vec3(x, kEave - 0.8f + 0.6f * t, side * (kZ - 0.1f) * (1 - t));
      };
      m.add(p.steel, tube({top(0), top(1)}, 0.11f, 8));
      m.add(p.steel, tube({low(0), low(1)}, 0.09f, 8));
      for (int k = 0; k < 6; ++k) {
        m.add(p.steel, tube({low(float(k) / 6), top((float(k) + 0.5f) / 6)}, 0.05f, 6));
        m.add(p.steel, tube({top((float(k) + 0.5f) / 6), low(float(k + 1) / 6)}, 0.05f, 6));
      }
    }
  }
  for (const float t : {0.25f, 0.5f, 0.75f})
    for (const float side : {-1.0f, 1.0f})
      m.add(p.steel, tube({{-kX, kEave - 0.15f + (kRidge - kEave) * t, side * kZ * (1 - t)},
                           {kX, kEave - 0.15f + (kRidge - kEave) * t, side * kZ * (1 - t)}},
                          0.07f, 6));
}

Outline aerofoil(float chord, float thick) {
  Outline o({0, 0});
  o.curve({0.02f * chord, -0.4f * thick}, {0.4f * chord, -0.35f * thick}, {chord, 0}, 10);
  o.curve({0.55f * chord, 0.75f * thick}, {-0.06f * chord, 1.15f * thick}, {0, 0}, 14);
  return o;
}

// A light aeroplane that flies along +x: 9 m long, 11 m span, standing on its wheels.
MeshBuilder aeroplane(const Palette& p) {
  MeshBuilder m;
  Outline body({0, 0});
  body.through({{0.13f, 0.1f},
                {0.20f, 1.2f},
                {0.36f, 3.2f},
                {0.66f, 5.2f},
                {0.74f, 6.6f},
                {0.62f, 7.9f},
                {0.40f, 8.45f}},
               8)
      .curve({0.30f, 8.56f}, {0.12f, 8.6f}, {0, 8.6f}, 6);
  const glm::mat4 fuselage = at(-5.4f, 1.55f, 0) * turnZ(-90) * scaled(1.05f, 1, 0.86f);
  m.add(p.white, lathe(body, {.segments = 48, .creaseDegrees = 70}), fuselage);
  Outline band({0.55f, 4.62f});
  band.through({{0.682f, 5.25f}, {0.757f, 6.1f}, {0.757f, 6.6f}}, 5).line(0.55f, 6.6f);
  m.add(p.red, lathe(band, {.segments = 48, .creaseDegrees = 70}), fuselage * scaled(1.003f, 1, 1.003f));
  m.add(p.glass, sphere(1, 40, 24), at(0.35f, 2.18f, 0) * scaled(1.35f, 0.52f, 0.56f));
  const Shape wing = extrude(aerofoil(1.62f, 0.24f), 11, {.creaseDegrees = 40});
  m.add(p.white, wing, at(1.05f, 2.62f, -5.5f) * scaled(-1, 1, 1));
  for (const float side : {-1.0f, 1.0f}) {
    m.add(p.red, extrude(aerofoil(1.63f, 0.25f), 1.2f, {.creaseDegrees = 40}),
          at(1.055f, 2.618f, side > 0 ? 4.31f : -5.51f) * scaled(-1, 1, 1));
    m.add(p.chrome, tube({{0.5f, 1.0f, side * 0.5f}, {0.35f, 2.66f, side * 2.9f}}, 0.045f, 10));
    m.add(p.chrome, tube({{0.6f, 1.05f, side * 0.35f}, {0.55f, 0.34f, side * 1.25f}}, 0.05f, 10));
    m.add(p.rubber, torus(0.23f, 0.10f, 36, 14), at(0.55f, 0.33f, side * 1.28f) * turnX(90));
    m.add(p.chrome, cylinder(0.15f, 0.16f, 24, 0.02f), at(0.55f, 0.33f, side * 1.28f - 0.08f) * turnX(90));
    m.add(p.white, extrude(aerofoil(0.95f, 0.10f), 1.7f, {.creaseDegrees = 40}),
          at(-4.35f, 1.75f, side > 0 ? 0.02f : -1.72f) * scaled(-1, 1, 1));
  }
  const Outline fin({{0, 0}, {1.35f, 0}, {0.85f, 0.35f}, {0.35f, 1.45f}, {-0.05f, 1.5f}});
  m.add(p.red, extrude(fin, 0.09f, {.bevel = 0.02f}), at(-5.45f, 1.72f, -0.045f));
  m.add(p.rubber, torus(0.17f, 0.08f, 32, 12), at(2.35f, 0.25f, 0) * turnX(90));
  m.add(p.chrome, tube({{2.35f, 0.25f, 0}, {2.3f, 1.1f, 0}}, 0.05f, 10));
  m.add(p.red, lathe(Outline({0.24f, 0}).curve({0.22f, 0.2f}, {0.1f, 0.36f}, {0, 0.4f}, 8), {.segments = 32}),
        at(3.1f, 1.55f, 0) * turnZ(-90));
  m.add(p.red, cylinder(0.24f, 0.1f, 32), at(3.01f, 1.55f, 0) * turnZ(-90));
  for (int i = 0; i < 2; ++i)
    m.add(p.rubber,
          bent(box({-0.02f, 0.12f, -0.1f}, {0.02f, 0.98f, 0.1f}, {.bevel = 0.01f, .cells = {1, 8, 1}}),
               [](glm::vec3 q) {
                 const float a = 0.9f - 0.6f * q.y, w = 1.0f - 0.4f * q.y;
                 return glm::vec3(q.x * std::cos(a) - w * q.z * std::sin(a), q.y,
                                  q.x * std::sin(a) + w * q.z * std::cos(a));
               }),
          at(3.16f, 1.55f, 0) * turnX(35 + 180 * float(i)));
  return m;
}

void addCrate(MeshBuilder& m, const Palette& p, float size, const glm::mat4& where) {
  const float h = 0.5f * size, t = 0.05f * size;
  m.add(p.wood, box({-h + t, 0.3f * t, -h + t}, {h - t, size - t, h - t}), where);
  for (const float a : {-1.0f, 1.0f})
    for (const float c : {-1.0f, 1.0f}) {
      m.add(p.wood, box({a * (h - t) - t, 0, c * (h - t) - t}, {a * (h - t) + t, size, c * (h - t) + t}),
            where);
      const float y = c > 0 ? size - 2.02f * t : 0.02f * t;
      m.add(p.wood, box({-h + t, y, a * (h - t) - 0.9f * t}, {h - t, y + 2 * t, a * (h - t) + 0.9f * t}),
            where);
      m.add(p.wood, box({a * (h - t) - 0.9f * t, y, -h + t}, {a * (h - t) + 0.9f * t, y + 1.98f * t, h - t}),
            where);
    }
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  m.add(aeroplane(p), at(-3.4f, 0, -1.0f) * turnY(8));
  const struct {
    float x, z, size, turn;
    int high;
  } crates[7] = {{2.2f, -5.4f, 1.3f, 8, 2},  {3.9f, -5.9f, 1.3f, -6, 1}, {2.6f, -7.4f, 1.5f, 3, 2},
                 {0.2f, -7.6f, 1.1f, 30, 1}, {7.4f, -0.4f, 0.9f, 20, 1}, {-11, 9.6f, 1.4f, 12, 2},
                 {-9.3f, 10.2f, 1.2f, -9, 1}};
  for (const auto& c : crates)
    for (int i = 0; i < c.high; ++i)
      addCrate(m, p, c.size * (i == 0 ? 1.0f : 0.85f),
               at(c.x, i == 0 ? 0.0f : c.size + 0.001f, c.z) * turnY(c.turn + 17 * float(i)));
  Outline drum({0, 0});
  drum.line(0.29f, 0)
      .line(0.29f, 0.28f)
      .arc(0.29f, 0.32f, 0.7f, 4)
      .line(0.29f, 0.56f)
      .arc(0.29f, 0.60f, 0.7f, 4)
      .line(0.29f, 0.88f)
      .line(0, 0.87f);
  const glm::vec3 drums[7] = {{5.4f, 0, -3.4f},  {6.05f, 0, -3.55f}, {5.6f, 0, -4.05f},    {-6.5f, 0, 7.2f},
                              {-0.9f, 0, -8.6f}, {-1.6f, 0, -8.3f},  {5.8f, 0.881f, -3.7f}};
  for (int i = 0; i < 7; ++i)
    m.add(p.barrel[i % 3 == 1 ? 1 : 0], lathe(drum, {.segments = 40}), at(drums[i]));
  // A gallery along the back wall, with a railing and a stair.
  m.add(p.steel, box({2, 3.4f, -kZ - 0.1f}, {kX + 0.1f, 3.6f, -9.6f}));
  for (int i = 0; i < 5; ++i)
    m.add(p.steel, box({2.1f + 4.8f * float(i), 0, -9.9f}, {2.3f + 4.8f * float(i), 3.41f, -9.7f}));
  m.add(p.line, railing(kX - 2.1f, 1.1f, 90, 0.014f), at(2.05f, 3.6f, -9.68f));
  m.add(p.line, railing(4.2f, 1.1f, 20, 0.014f), at(2.05f, 3.6f, -13.9f) * turnY(-90));
  for (int i = 0; i < 17; ++i)
    m.add(p.steel, box({2.2f - 0.27f * float(i + 1), 3.38f - 0.2f * float(i) - 0.04f, -11.9f},
                       {2.25f - 0.27f * float(i), 3.38f - 0.2f * float(i), -10.6f}));
  for (const float z : {-11.92f, -10.58f}) {
    m.add(p.steel, tube({{2.1f, 3.36f, z}, {-2.45f, 0.02f, z}}, 0.06f, 8));
    m.add(p.line, tube({{2.1f, 4.5f, z}, {-2.45f, 1.13f, z}, {-2.45f, 0.02f, z}}, 0.03f, 8));
    for (int i = 0; i < 9; ++i) {
      const float t = (float(i) + 0.5f) / 9;
      m.add(p.line, tube({{2.1f - 4.55f * t, 3.36f - 3.34f * t, z}, {2.1f - 4.55f * t, 4.5f - 3.37f * t, z}},
                         0.014f, 6));
    }
  }
  // A step ladder beside the aeroplane, a bench with tools, lines on the floor.
  for (const float z : {-0.35f, 0.35f}) {
    m.add(p.red, tube({{0, 0, z}, {0.75f, 2.1f, 0.8f * z}}, 0.03f, 8), at(-0.6f, 0, 2.6f) * turnY(50));
    m.add(p.red, tube({{1.5f, 0, z}, {0.78f, 2.1f, 0.8f * z}}, 0.03f, 8), at(-0.6f, 0, 2.6f) * turnY(50));
  }
  for (int i = 1; i < 8; ++i)
    m.add(p.red,
          box({0.09f * float(i) - 0.09f, 0.26f * float(i), -0.33f},
              {0.09f * float(i) + 0.09f, 0.26f * float(i) + 0.03f, 0.33f}),
          at(-0.6f, 0, 2.6f) * turnY(50));
  m.add(rectTable(p.wood, 2.4f, 0.8f, 0.9f), at(9.2f, 0, -3.4f));
  m.add(p.red, box({-0.5f, 0.9f, -0.25f}, {0.2f, 1.35f, 0.2f}, {.bevel = 0.02f}), at(9.2f, 0, -3.4f));
  m.add(p.blue, box({-0.45f, 0.02f, -0.3f}, {0.45f, 1.05f, 0.3f}, {.bevel = 0.03f, .bevelSteps = 2}),
        at(2.9f, 0, 1.2f) * turnY(-25));
  for (const float z : {-6.0f, 6.0f})
    m.add(p.line, box({-kX + 0.4f, -0.01f, z - 0.1f}, {15, 0.006f, z + 0.1f}));
  b.place("things", b.mesh("things", std::move(m)));
  // A crane: its bridge stands, its trolley runs along it.
  MeshBuilder bridge;
  for (const float x : {-9.0f, -7.8f})
    bridge.add(p.line, box({x - 0.2f, 6.7f, -kZ + 0.5f}, {x + 0.2f, 7.4f, kZ - 0.5f}));
  for (const float z : {-kZ + 0.45f, kZ - 0.45f})
    bridge.add(p.steel, box({-kX + 0.5f, 6.2f, z - 0.25f}, {kX - 0.1f, 6.7f, z + 0.25f}));
  b.place("bridge of the crane", b.mesh("bridge of the crane", std::move(bridge)));
  MeshBuilder trolley;
  trolley.add(p.blue, box({-1.0f, 0, -0.7f}, {1.0f, 0.55f, 0.7f}, {.bevel = 0.05f}));
  for (const float z : {-0.12f, 0.12f}) trolley.add(p.rubber, tube({{0, -3.4f, z}, {0, 0.1f, z}}, 0.025f, 6));
  trolley.add(p.red, box({-0.22f, -3.9f, -0.22f}, {0.22f, -3.35f, 0.22f}, {.bevel = 0.05f, .bevelSteps = 2}));
  trolley.add(
      p.chrome,
      tube(smoothPath(
               {{0, -3.88f, 0}, {0.02f, -4.1f, 0}, {0.2f, -4.3f, 0}, {0.05f, -4.48f, 0}, {-0.16f, -4.36f, 0}},
               6),
           0.055f, 10));
  b.place("trolley", b.mesh("trolley", std::move(trolley)), {-8.4f, 7.41f, 2.5f});
}

}  // namespace

static Scene hangarScene() {
  SceneBuilder b("hangar");
  const Palette p = makePalette(b);
  MeshBuilder building;
  addBuilding(building, p);
  addTrusses(building, p);
  b.place("building", b.mesh("building", std::move(building)));
  furnish(b, p);
  b.sun("sun", {1.0f, 0.91f, 0.78f}, 18, {0.80f, -0.42f, -0.28f});
  b.camera({8.8f, 2.1f, 8.4f}, {-3.2f, 2.7f, -2.4f}, 57);
  b.scene.environment = {0.42f, 0.66f, 1.0f};
  return b.finish(1.7f, {0.45f, 0.55f});
}

FOVEA_SCENE("hangar", hangarScene);

}  // namespace fovea::scene
