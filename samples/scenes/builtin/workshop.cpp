// The yard of a workshop at night and its office behind it, for choosing parameters that concern emissive surfaces. The
// yard has lamps of very different size: bulbs close to a wall and under a shelf, a tube along a wall, a sign, two
// globes that hang behind bars, and small lights in the ground. The office has one panel in its ceiling, and a lamp
// that lights a small patch of the ceiling above it.
#include <cmath>
#include <glm/trigonometric.hpp>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/model.h"
#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr float kX = 3.4f, kFront = 4.4f, kBack = -4.2f, kHigh = 4.2f;     // the yard, m
constexpr float kOfficeX = 2.6f, kOfficeBack = -9.4f, kOfficeHigh = 2.7f;  // the office, behind the yard
constexpr float kDoorLeft = -0.9f, kDoorRight = 0.35f, kDoorHigh = 2.15f;  // the way between them
constexpr float kThick = 0.25f;                                            // of walls

struct Palette {
  uint32_t brick, render, concrete, planks, steel, dark, paint, white, cloth, terracotta, leaf, paper[3];
  uint32_t bulb, tube, sign, globe, ground, panel;  // emissive
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  MasonryLook bricks;
  bricks.columns = 4;
  bricks.rows = 12;
  bricks.low = {0.36f, 0.16f, 0.10f};
  bricks.high = {0.55f, 0.28f, 0.19f};
  bricks.jointColor = {0.52f, 0.49f, 0.44f};
  p.brick = b.material("brick", glm::vec3(1),
                       {.texture = b.texture(masonry("brick", bricks, 512, 512, 2001)), .metres = 0.96f});
  p.render = b.material(
      "render", glm::vec3(1),
      {.texture = b.texture(plaster("render", {0.68f, 0.64f, 0.56f}, 0.1f, 0.1f, 512, 2002)), .metres = 3});
  p.concrete = b.material(
      "concrete", glm::vec3(1),
      {.texture = b.texture(ground("concrete", glm::vec3(0.34f), glm::vec3(0.46f), 0.1f, 512, 2003)),
       .metres = 2});
  p.planks = b.material(
      "planks", glm::vec3(1),
      {.texture = b.texture(boards("planks", 5, {0.34f, 0.22f, 0.12f}, {0.58f, 0.42f, 0.25f}, 512, 2004)),
       .metres = 0.6f,
       .metresHigh = 1.5f});
  p.steel = b.material("galvanised steel", {0.52f, 0.54f, 0.56f});
  p.dark = b.material("black iron", {0.05f, 0.05f, 0.055f});
  p.paint = b.material("green paint", {0.10f, 0.30f, 0.20f});
  p.white = b.material("white paint", {0.80f, 0.79f, 0.76f});
  p.cloth = b.material("tarpaulin", {0.62f, 0.20f, 0.07f});
  p.terracotta = b.material("terracotta", {0.58f, 0.28f, 0.17f});
  p.leaf = b.material("leaves", {0.15f, 0.34f, 0.09f}, {.doubleSided = true});
  p.paper[0] = b.material("red binder", {0.60f, 0.09f, 0.07f});
  p.paper[1] = b.material("blue binder", {0.10f, 0.18f, 0.50f});
  p.paper[2] = b.material("grey binder", {0.45f, 0.44f, 0.42f});
  p.bulb = b.material("bulb", {0.70f, 0.68f, 0.62f}, {.emission = {130, 88, 48}});
  p.tube = b.material("tube", {0.75f, 0.76f, 0.78f}, {.emission = {17, 20, 23}});
  p.sign = b.material("sign", {0.30f, 0.45f, 0.62f}, {.emission = {0.9f, 2.4f, 4.6f}});
  p.globe = b.material("globe", {0.70f, 0.62f, 0.48f}, {.emission = {11, 6.2f, 2.4f}});
  p.ground = b.material("light in the ground", {0.70f, 0.70f, 0.66f}, {.emission = {34, 36, 30}});
  p.panel = b.material("panel", {0.80f, 0.80f, 0.80f}, {.emission = {7.5f, 7.8f, 8.2f}});
  return p;
}

// Upright bars with square sections from (0, 0) to (width, height), about z = 0, between two rails.
Shape bars(float width, float height, int count, float thick) {
  Shape s;
  for (int i = 0; i < count; ++i) {
    const float x = width * (float(i) + 0.5f) / float(count);
    append(s, box({x - 0.5f * thick, 0, -0.5f * thick}, {x + 0.5f * thick, height, 0.5f * thick}));
  }
  for (const float y : {0.06f, 0.94f})
    append(s, box({0, y * height - thick, -0.8f * thick}, {width, y * height + thick, -0.45f * thick}));
  return s;
}

// A table about the origin, along x.
void addTable(MeshBuilder& m, uint32_t top, uint32_t legs, glm::vec3 size, const glm::mat4& where) {
  const float x = 0.5f * size.x, z = 0.5f * size.z;
  m.add(top, box({-x, size.y - 0.05f, -z}, {x, size.y, z}, {.bevel = 0.006f}), where);
  for (const float sx : {-1.0f, 1.0f})
    for (const float sz : {-1.0f, 1.0f})
      m.add(legs, block(0.06f, size.y - 0.05f, 0.06f), where * at(sx * (x - 0.07f), 0, sz * (z - 0.07f)));
  m.add(legs, box({-x + 0.08f, 0.14f, -z + 0.05f}, {x - 0.08f, 0.17f, z - 0.05f}), where);
}

// An open crate of boards, standing on y = 0.
void addCrate(MeshBuilder& m, uint32_t wood, float size, const glm::mat4& where) {
  const float h = 0.5f * size, t = 0.018f;
  m.add(wood, box({-h, 0, -h}, {h, t, h}), where);
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < 3; ++i) {
      const float y = 0.03f + size * 0.32f * float(i);
      m.add(wood, box({-h + 0.001f, y, h - t}, {h - t - 0.001f, y + 0.24f * size, h}),
            where * turnY(90 * float(side)));
    }
  for (const float x : {-1.0f, 1.0f})
    for (const float z : {-1.0f, 1.0f})
      m.add(wood, block(0.04f, 0.95f * size, 0.04f), where * at(x * (h - 0.04f), t, z * (h - 0.04f)));
}

void addYard(MeshBuilder& m, const Palette& p) {
  m.add(p.concrete, box({-kX - kThick, -0.3f, kOfficeBack - kThick}, {kX + kThick, 0, kFront + kThick}));
  m.add(p.brick, box({-kX - kThick, -0.2f, kBack - kThick}, {-kX, kHigh, kFront + kThick}));
  m.add(p.render, box({kX, -0.2f, kBack - kThick}, {kX + kThick, kHigh, kFront + kThick}));
  m.add(p.brick, box({-kX - 0.1f, -0.2f, kFront}, {kX + 0.1f, kHigh, kFront + kThick}));
  // The wall of the office with its door.
  m.add(p.render, box({-kX - 0.1f, -0.2f, kBack - kThick}, {kDoorLeft, kHigh, kBack}));
  m.add(p.render, box({kDoorRight, -0.2f, kBack - kThick}, {kX + 0.1f, kHigh, kBack}));
  m.add(p.render, box({kDoorLeft - 0.1f, kDoorHigh, kBack - kThick + 0.001f},
                      {kDoorRight + 0.1f, kHigh, kBack - 0.001f}));
  for (const float x : {kDoorLeft, kDoorRight})
    m.add(p.paint,
          box({x - 0.05f, 0, kBack - 0.1f}, {x + 0.05f, kDoorHigh, kBack + 0.03f}, {.bevel = 0.004f}));
  m.add(p.paint, box({kDoorLeft - 0.05f, kDoorHigh - 0.05f, kBack - 0.099f},
                     {kDoorRight + 0.05f, kDoorHigh + 0.05f, kBack + 0.031f}, {.bevel = 0.004f}));
  m.add(p.planks, box({0, 0.02f, -0.02f}, {1.1f, kDoorHigh - 0.08f, 0.02f}),
        at(kDoorLeft + 0.06f, 0, kBack + 0.04f) * turnY(-100) * scaled(1, 1, -1));
  // A canopy on brackets, a rain pipe, a kerb.
  m.add(p.planks, box({-2.0f, 2.75f, kBack - 0.02f}, {1.5f, 2.80f, kBack + 1.1f}));
  for (const float x : {-1.7f, -0.3f, 1.2f}) {
    m.add(p.dark, box({x - 0.03f, 2.69f, kBack}, {x + 0.03f, 2.749f, kBack + 1.0f}));
    m.add(p.dark, tube({{x, 2.1f, kBack + 0.01f}, {x, 2.70f, kBack + 0.8f}}, 0.018f, 8));
  }
  m.add(p.steel,
        tube({{kX - 0.09f, 0.1f, kBack + 0.25f}, {kX - 0.09f, kHigh - 0.1f, kBack + 0.25f}}, 0.05f, 16));
  m.add(p.concrete, box({-kX - 0.05f, -0.05f, kBack - 0.1f}, {-kX + 0.32f, 0.14f, kFront}, {.bevel = 0.01f}));
  // A shelf above a workbench along the right wall, with tools and jars.
  const float bench = -2.3f;
  addTable(m, p.planks, p.planks, {2.2f, 0.9f, 0.62f}, at(kX - 0.34f, 0, bench) * turnY(90));
  m.add(p.planks, box({kX - 0.36f, 1.52f, bench - 1.0f}, {kX + 0.02f, 1.55f, bench + 1.0f}));
  for (const float z : {-0.8f, 0.8f})
    m.add(p.dark, box({kX - 0.3f, 1.44f, bench + z - 0.02f}, {kX + 0.01f, 1.521f, bench + z + 0.02f}));
  for (int i = 0; i < 9; ++i) {
    const float r = random(2021, uint32_t(i), 0.035f, 0.075f), h = random(2022, uint32_t(i), 0.08f, 0.2f);
    m.add(i % 3 == 0   ? p.paint
          : i % 3 == 1 ? p.steel
                       : p.terracotta,
          cylinder(r, h, 20, 0.006f),
          at(kX - random(2023, uint32_t(i), 0.11f, 0.25f), i < 6 ? 1.55f : 0.9f,
             bench - 0.85f + 0.21f * float(i)));
  }
  m.add(p.dark, box({kX - 0.5f, 0.9f, bench + 0.1f}, {kX - 0.34f, 1.06f, bench + 0.44f}, {.bevel = 0.02f}));
  // A fence of narrow bars before the left wall, crates, a drum under a cloth, pots.
  m.add(p.dark, bars(2.6f, 2.0f, 26, 0.022f), at(-1.9f, 0.14f, -0.6f) * turnY(90));
  addCrate(m, p.planks, 0.6f, at(-0.9f, 0, 1.0f) * turnY(20));
  addCrate(m, p.planks, 0.5f, at(-0.98f, 0.605f, 0.96f) * turnY(-12));
  addCrate(m, p.planks, 0.55f, at(1.5f, 0, -3.4f) * turnY(5));
  m.add(p.paint, cylinder(0.29f, 0.88f, 36, 0.015f), at(2.3f, 0, -3.3f));
  for (const float y : {0.3f, 0.6f}) m.add(p.paint, torus(0.292f, 0.014f, 40, 8), at(2.3f, y, -3.3f));
  m.add(p.cloth,
        surface(sheet(40, 30, {1.3f, 1.0f},
                      [](float u, float v) {
                        const float x = 1.3f * (u - 0.5f), z = 1.0f * (v - 0.5f);
                        const float fall = smoothstep(0.22f, 0.62f, std::hypot(x, z));
                        return glm::vec3(x * (1 - 0.35f * fall),
                                         -0.55f * fall + 0.03f * fall * std::sin(14 * std::atan2(z, x)),
                                         z * (1 - 0.35f * fall));
                      }),
                0.006f),
        at(2.3f, 0.90f, -3.3f));
  Outline pot({0, 0});
  pot.line(0.14f, 0)
      .line(0.2f, 0.3f)
      .line(0.23f, 0.3f)
      .line(0.23f, 0.36f)
      .line(0.19f, 0.36f)
      .line(0.19f, 0.31f)
      .line(0, 0.31f);
  for (const glm::vec3& q :
       {glm::vec3(-1.25f, 0, -3.6f), glm::vec3(0.85f, 0, -3.75f), glm::vec3(2.6f, 0, 1.6f)}) {
    m.add(p.terracotta, lathe(pot, {.segments = 36}), at(q));
    m.add(p.leaf,
          rosette(34, {.length = 0.55f, .width = 0.05f, .fold = 0.3f, .droop = 0.4f, .steps = 4}, 62, 2031),
          at(q + glm::vec3(0, 0.3f, 0)));
  }
}

// All emissive surfaces of the yard, with their mounts.
void addLamps(MeshBuilder& m, const Palette& p) {
  // A caged bulb 11 cm from the brick wall, another one 9 cm under the shelf.
  const auto bulb = [&](glm::vec3 q, float radius) { m.add(p.bulb, sphere(radius, 20, 12), at(q)); };
  const glm::vec3 caged(-kX + 0.11f, 1.95f, -2.4f);
  bulb(caged, 0.035f);
  m.add(p.dark, cylinder(0.05f, 0.05f, 20), at(-kX - 0.005f, caged.y, caged.z) * turnZ(-90));
  for (int i = 0; i < 6; ++i) {
    const glm::mat4 turn = at(caged) * turnZ(-90) * turnY(60 * float(i));
    m.add(p.dark, tube({{0.055f, -0.065f, 0}, {0.065f, 0, 0}, {0.05f, 0.06f, 0}, {0, 0.085f, 0}}, 0.003f, 5),
          turn);
  }
  const glm::vec3 under(kX - 0.2f, 1.43f, -2.15f);
  bulb(under, 0.028f);
  m.add(p.dark, cylinder(0.02f, 0.07f, 14), at(under + glm::vec3(0, 0.026f, 0)));
  // A tube along the right wall, a sign above the canopy.
  m.add(p.tube, cylinder(0.013f, 1.2f, 14), at(kX - 0.055f, 2.5f, -2.6f) * turnX(90));
  m.add(p.steel, box({kX - 0.03f, 2.46f, -2.65f}, {kX + 0.01f, 2.54f, -1.35f}));
  for (const float z : {-2.64f, -1.40f})
    m.add(p.steel, box({kX - 0.08f, 2.475f, z}, {kX, 2.525f, z + 0.04f}));
  m.add(p.sign, box({0, 0, 0}, {1.5f, 0.34f, 0.06f}), at(-1.0f, 3.05f, kBack + 0.35f));
  m.add(p.dark, box({-0.03f, -0.03f, -0.05f}, {1.53f, 0.37f, 0.001f}), at(-1.0f, 3.05f, kBack + 0.35f));
  for (const float x : {-0.7f, 0.2f})
    m.add(p.dark, box({x - 0.015f, 3.2f, kBack - 0.01f}, {x + 0.015f, 3.24f, kBack + 0.31f}));
  // Two globes that hang behind the bars, and lights in the ground.
  const struct {
    glm::vec3 where;
    float radius;
  } globes[2] = {{{-2.6f, 1.55f, -1.6f}, 0.13f}, {{-2.45f, 1.2f, -0.9f}, 0.08f}};
  for (const auto& g : globes) {
    m.add(p.globe, sphere(g.radius, 28, 16), at(g.where));
    m.add(p.dark, tube({g.where + glm::vec3(0, g.radius - 0.004f, 0), {g.where.x, kHigh - 0.1f, g.where.z}},
                       0.006f, 6));
  }
  m.add(p.dark, box({-kX, kHigh - 0.16f, -1.7f}, {-2.2f, kHigh - 0.1f, -0.8f}));
  for (const float z : {-2.6f, -0.4f, 1.8f}) {
    const glm::vec3 q(0.75f, 0.0f, z);
    m.add(p.steel, cylinder(0.062f, 0.012f, 28, 0.002f), at(q));
    m.add(p.ground, cylinder(0.042f, 0.016f, 24), at(q));
  }
}

void addOffice(MeshBuilder& m, const Palette& p) {
  const float front = kBack - kThick;
  for (const float side : {-1.0f, 1.0f})
    m.add(p.white,
          box({std::min(side * kOfficeX, side * (kOfficeX + kThick)), -0.2f, kOfficeBack - kThick},
              {std::max(side * kOfficeX, side * (kOfficeX + kThick)), kOfficeHigh + kThick, front + 0.01f}));
  m.add(p.white, box({-kOfficeX - 0.1f, -0.2f, kOfficeBack - kThick},
                     {kOfficeX + 0.1f, kOfficeHigh + kThick, kOfficeBack}));
  m.add(p.white, box({-kOfficeX - 0.1f, kOfficeHigh, kOfficeBack - 0.1f},
                     {kOfficeX + 0.1f, kOfficeHigh + kThick, front + 0.011f}));
  m.add(p.planks,
        box({-kOfficeX - 0.05f, -0.1f, kOfficeBack - 0.05f}, {kOfficeX + 0.05f, 0.012f, front + 0.05f}));
  // The panel in its frame, close below the ceiling.
  m.add(p.panel, box({-0.6f, kOfficeHigh - 0.05f, -7.3f}, {0.6f, kOfficeHigh - 0.02f, -6.7f}));
  for (const float x : {-0.615f, 0.615f})
    m.add(p.steel, box({x - 0.016f, kOfficeHigh - 0.06f, -7.33f}, {x + 0.016f, kOfficeHigh + 0.01f, -6.67f}));
  for (const float z : {-7.315f, -6.685f})
    m.add(p.steel,
          box({-0.63f, kOfficeHigh - 0.061f, z - 0.016f}, {0.63f, kOfficeHigh + 0.009f, z + 0.016f}));
  addTable(m, p.planks, p.steel, {1.6f, 0.74f, 0.8f}, at(0.3f, 0.012f, -7.1f) * turnY(8));
  addTable(m, p.white, p.steel, {0.45f, 0.46f, 0.45f}, at(-0.5f, 0.012f, -6.3f) * turnY(-20));  // a stool
  // Shelves with binders on the back wall.
  for (int row = 0; row < 4; ++row) {
    const float y = 0.35f + 0.45f * float(row);
    m.add(p.planks, box({-2.2f, y - 0.03f, kOfficeBack - 0.01f}, {-0.1f, y, kOfficeBack + 0.32f}));
    float x = -2.12f;
    for (uint32_t i = 0; x < -0.3f; ++i) {
      const uint32_t n = 40 * uint32_t(row) + i;
      const float w = random(2041, n, 0.035f, 0.075f), h = random(2042, n, 0.24f, 0.34f);
      if (random(2043, n) < 0.82f)
        m.add(p.paper[n % 3],
              box({x, y, kOfficeBack + 0.03f}, {x + w, y + h, kOfficeBack + 0.27f}, {.bevel = 0.003f}));
      x += w + 0.004f;
    }
  }
  for (const float x : {-2.23f, -0.1f})
    m.add(p.planks, box({x, 0, kOfficeBack - 0.011f}, {x + 0.03f, 1.9f, kOfficeBack + 0.33f}));
  m.add(p.cloth,
        surface(sheet(30, 20, {0.9f, 0.7f},
                      [](float u, float v) {
                        return glm::vec3(0.9f * u, -0.7f * v, 0.03f * std::sin(19 * u) * v);
                      }),
                0.005f),
        at(0.9f, 1.75f, kOfficeBack + 0.06f));
  // The lamp in the corner: a deep cup that throws its light up.
  Outline cup({0, 0});
  cup.line(0.03f, 0).line(0.13f, 0.2f).line(0.122f, 0.2f).line(0.024f, 0.01f).line(0, 0.01f);
  const glm::mat4 corner = at(2.05f, 0.012f, -8.8f);
  m.add(p.dark, cylinder(0.15f, 0.03f, 32, 0.005f), corner).add(p.dark, cylinder(0.014f, 1.8f, 14), corner);
  m.add(p.white, lathe(cup, {.segments = 40}), corner * at(0, 1.79f, 0));
}

Scene workshopScene() {
  SceneBuilder b("workshop");
  const Palette p = makePalette(b);
  MeshBuilder yard, lamps, office;
  addYard(yard, p);
  addLamps(lamps, p);
  addOffice(office, p);
  b.place("yard", b.mesh("yard", std::move(yard)));
  b.place("lamps", b.mesh("lamps", std::move(lamps)));
  b.place("office", b.mesh("office", std::move(office)));
  MeshBuilder drum;
  drum.add(p.steel, cylinder(0.16f, 0.5f, 28, 0.01f), turnX(90) * at(0, -0.25f, 0));
  b.place("drum", b.mesh("drum", std::move(drum)), {0.9f, 0.16f, 0.4f});
  Light lamp;
  lamp.name = "uplighter";
  lamp.type = LightType::Spot;
  lamp.color = {1, 0.82f, 0.58f};
  lamp.intensity = 25;
  lamp.position = {2.05f, 1.92f, -8.8f};
  lamp.direction = {0, 1, 0};
  lamp.innerConeAngle = glm::radians(20.0f);
  lamp.outerConeAngle = glm::radians(32.0f);
  b.scene.lights.push_back(lamp);
  b.camera({0.35f, 1.6f, 3.6f}, {-0.15f, 1.3f, -3.0f}, 62);
  b.scene.environment = {0.006f, 0.008f, 0.014f};
  return b.finish(3.0f, {0.45f, 0.5f});
}

FOVEA_SCENE("workshop", workshopScene);

}  // namespace
}  // namespace fovea::scene
