// Road works and the smaller things of the yard.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/yard_parts.h"

namespace fovea::scene::yard {

using namespace model;

namespace {

constexpr float kPi = glm::pi<float>(), kQuarter = 0.41421356f;

}  // namespace

Shape pole(glm::vec3 a, glm::vec3 b, float radius, int sides) { return tube({a, b}, radius, sides); }

MeshBuilder barrier(const Palette& p, float length, bool lamp) {
  MeshBuilder m;
  const float half = 0.5f * length;
  // A broad foot that holds the water ...
  Outline foot({-0.20f, 0});
  foot.line(0.20f, 0)
      .line(0.215f, 0.02f)
      .line(0.215f, 0.10f)
      .curve({0.20f, 0.17f}, {0.075f, 0.20f}, {0.062f, 0.42f}, 8);
  foot.line(-0.062f, 0.42f)
      .curve({-0.075f, 0.20f}, {-0.20f, 0.17f}, {-0.215f, 0.10f}, 8)
      .line(-0.215f, 0.02f);
  m.add(p.orange, extrude(foot, length - 0.05f, {.bevel = 0.02f, .creaseDegrees = 40}),
        at(-half + 0.025f, 0, 0) * turnY(90));
  // ... and a panel with two slots.
  Outline panel = Outline(roundedRectangle(length - 0.04f, 0.60f, 0.05f, 5)).moved({0, 0.68f});
  std::vector<Outline> slots;
  for (const float x : {-0.25f, 0.25f})
    slots.push_back(Outline(roundedRectangle(0.36f * length, 0.09f, 0.044f, 6)).moved({x * length, 0.88f}));
  m.add(p.orange, extrude(panel, slots, 0.11f, {.bevel = 0.016f}), at(0, 0, -0.055f));
  for (const float s : {-1.0f, 1.0f}) {
    const float z = s > 0 ? 0.045f : -0.063f;
    m.add(p.reflex, box({-0.42f * length, 0.60f, z}, {0.42f * length, 0.76f, z + 0.018f}, {.bevel = 0.004f}));
    for (const float x : {-0.30f, -0.10f, 0.10f, 0.30f})
      m.add(p.red, extrude(Outline({{-0.085f, 0}, {0.0f, 0}, {0.085f, 0.16f}, {0.0f, 0.16f}}), 0.004f),
            at(x * length, 0.60f, s > 0 ? 0.0615f : -0.0655f));
    for (const float x : {-0.32f, 0.0f, 0.32f})  // stiffening ribs of the foot
      m.add(p.orange,
            box({x * length - 0.04f, 0.03f, s * 0.12f - 0.085f},
                {x * length + 0.04f, 0.235f, s * 0.12f + 0.085f}, {.bevel = 0.03f, .bevelSteps = 3}));
    m.add(p.orange, cylinder(0.042f, 0.20f, 20, 0.012f), at(s * half, s > 0 ? 0.50f : 0.71f, 0));
  }
  m.add(p.rubber, cylinder(0.035f, 0.02f, 18, 0.006f), at(0.28f * length, 0.97f, 0));
  if (lamp) {
    m.add(p.steel, block(0.16f, 0.11f, 0.09f, {.bevel = 0.012f, .bevelSteps = 2}),
          at(-0.25f * length, 0.975f, 0));
    Outline lens({0, 0});
    lens.line(0.085f, 0).line(0.09f, 0.03f).curve({0.085f, 0.06f}, {0.04f, 0.075f}, {0, 0.078f}, 8);
    for (const float s : {-1.0f, 1.0f})
      m.add(p.yellow, lathe(lens, {.segments = 32}),
            at(-0.25f * length, 1.16f, 0) * turnX(s * 90) * scaled(1, 0.75f, 1));
    m.add(p.steel, torus(0.092f, 0.014f, 32, 8), at(-0.25f * length, 1.16f, 0) * turnX(90));
  }
  return m;
}

MeshBuilder wheelbarrow(const Palette& p) {
  MeshBuilder m;
  // The tray: a rounded rectangle that leans forwards.
  Outline profile({0, 0.30f});
  profile.line(0.20f, 0.30f)
      .arc(0.235f, 0.325f, kQuarter, 4)
      .line(0.345f, 0.565f)
      .arc(0.365f, 0.575f, 0.6f, 3)
      .arc(0.335f, 0.575f, 0.8f, 4);
  profile.line(0.225f, 0.34f).line(0.20f, 0.318f).line(0, 0.318f);
  const auto shape = [](glm::vec3 q) {
    const float r = std::sqrt(q.x * q.x + q.z * q.z);
    if (r < 1e-5f) return q;
    const float c = q.x / r, s = q.z / r, square = 1 / std::pow(c * c * c * c + s * s * s * s, 0.25f);
    const float k = glm::mix(1.0f, square, 0.9f);
    return glm::vec3(q.x * k * 1.30f + 0.35f * (q.y - 0.3f) * (q.x > 0 ? 1.0f : 0.35f) + 0.06f, q.y,
                     q.z * k * 0.88f);
  };
  m.add(p.tray, bent(lathe(profile, {.segments = 72}), shape, 40));
  Outline load({0, 0.45f});
  load.line(0.285f, 0.455f).curve({0.20f, 0.50f}, {0.10f, 0.62f}, {0, 0.64f}, 10);
  m.add(p.sand, bent(
                    lathe(load, {.segments = 56}),
                    [&](glm::vec3 q) {
                      return shape(q + glm::vec3(0,
                                                 0.03f * (fractal({q.x * 9, q.z * 9}, 971, 3) - 0.5f) *
                                                     (q.y > 0.456f ? 1.0f : 0.0f),
                                                 0));
                    },
                    60));
  for (const float s : {-1.0f, 1.0f}) {
    m.add(p.steel, tube(smoothPath({{0.70f, 0.205f, s * 0.05f},
                                    {0.42f, 0.25f, s * 0.17f},
                                    {0.05f, 0.285f, s * 0.22f},
                                    {-0.35f, 0.40f, s * 0.25f},
                                    {-0.80f, 0.58f, s * 0.27f}},
                                   7),
                        0.016f, 12));
    m.add(p.rubber, pole({-0.70f, 0.54f, s * 0.266f}, {-0.86f, 0.604f, s * 0.272f}, 0.021f));
    m.add(p.steel, tube(smoothPath({{0.02f, 0.29f, s * 0.215f},
                                    {-0.16f, 0.02f, s * 0.225f},
                                    {-0.28f, 0.016f, s * 0.225f},
                                    {-0.30f, 0.37f, s * 0.24f}},
                                   7),
                        0.014f, 12));
  }
  m.add(p.steel, pole({-0.22f, 0.03f, -0.225f}, {-0.22f, 0.03f, 0.225f}, 0.012f, 10));
  const glm::mat4 wheel = at(0.70f, 0.20f, 0) * turnX(90);
  m.add(p.rubber, torus(0.155f, 0.045f, 48, 16), wheel);
  m.add(p.red,
        lathe(Outline({{0.03f, -0.035f},
                       {0.045f, -0.035f},
                       {0.06f, -0.012f},
                       {0.118f, -0.02f},
                       {0.118f, 0.02f},
                       {0.06f, 0.012f},
                       {0.045f, 0.035f},
                       {0.03f, 0.035f}}),
              {.segments = 36, .closed = true}),
        wheel);
  m.add(p.steel, pole({0.70f, 0.20f, -0.07f}, {0.70f, 0.20f, 0.07f}, 0.014f, 12));
  return m;
}

namespace {

MeshBuilder bicycleWheel(const Palette& p) {
  MeshBuilder m;
  m.add(p.rubber, torus(0.332f, 0.019f, 72, 12)).add(p.steel, torus(0.306f, 0.010f, 64, 8));
  m.add(p.steel, cylinder(0.02f, 0.09f, 16, 0.004f), at(0, -0.045f, 0));
  for (int i = 0; i < 28; ++i) {
    const float a = 2 * kPi * float(i) / 28, b = a + (i % 4 < 2 ? 0.9f : -0.9f),
                y = i % 2 == 0 ? 0.03f : -0.03f;
    m.add(p.steel, sweep({{0.02f * std::cos(b), y, 0.02f * std::sin(b)},
                          {0.306f * std::cos(a), 0, 0.306f * std::sin(a)}},
                         circle(0.0018f, 4), {.caps = false, .creaseDegrees = 180}));
  }
  return m;
}

}  // namespace

MeshBuilder bicycle(const Palette& p) {
  MeshBuilder m;
  const glm::vec3 rear(-0.52f, 0.35f, 0), frontHub(0.53f, 0.35f, 0), crank(-0.06f, 0.29f, 0),
      seat(-0.22f, 0.82f, 0), headLow(0.36f, 0.66f, 0), headHigh(0.31f, 0.86f, 0);
  const MeshBuilder wheel = bicycleWheel(p);
  m.add(wheel, at(rear) * turnX(90)).add(wheel, at(frontHub) * turnX(90) * turnY(20));
  m.add(p.teal, pole(crank, seat, 0.017f))
      .add(p.teal, pole(crank, headLow, 0.019f))
      .add(p.teal, pole(headLow, headHigh, 0.021f));
  m.add(p.teal,
        tube(smoothPath({headHigh - glm::vec3(0, 0.05f, 0), {0.10f, 0.66f, 0}, {-0.13f, 0.52f, 0}}, 8),
             0.016f, 14));
  for (const float s : {-1.0f, 1.0f}) {
    m.add(p.teal, pole(crank + glm::vec3(0, 0, s * 0.03f), rear + glm::vec3(0, 0, s * 0.055f), 0.010f, 12));
    m.add(p.teal,
          pole(seat - glm::vec3(-0.02f, 0.07f, -s * 0.018f), rear + glm::vec3(0, 0, s * 0.055f), 0.009f, 12));
    m.add(p.teal, tube(smoothPath({headLow + glm::vec3(0, 0, s * 0.03f),
                                   {0.42f, 0.52f, s * 0.045f},
                                   frontHub + glm::vec3(0, 0, s * 0.05f)},
                                  6),
                       0.011f, 12));
    // Handlebar, grip, pedal, and the stays of the mudguards.
    m.add(p.steel, tube(smoothPath({{0.29f, 0.98f, 0},
                                    {0.31f, 1.0f, s * 0.08f},
                                    {0.33f, 1.03f, s * 0.20f},
                                    {0.22f, 1.02f, s * 0.28f},
                                    {0.08f, 0.99f, s * 0.29f}},
                                   7),
                        0.011f, 12));
    m.add(p.leather, pole({0.20f, 1.015f, s * 0.283f}, {0.07f, 0.988f, s * 0.29f}, 0.017f));
    m.add(p.steel, pole(crank + glm::vec3(0, 0, s * 0.05f),
                        crank + glm::vec3(s * 0.13f, -s * 0.10f, s * 0.06f), 0.009f, 10));
    m.add(p.rubber, box(crank + glm::vec3(s * 0.13f - 0.045f, -s * 0.10f - 0.012f, s * 0.10f - 0.04f),
                        crank + glm::vec3(s * 0.13f + 0.045f, -s * 0.10f + 0.012f, s * 0.10f + 0.04f),
                        {.bevel = 0.005f}));
  }
  m.add(p.steel, pole(seat, seat + glm::vec3(-0.03f, 0.10f, 0), 0.013f, 12))
      .add(p.steel, pole(headHigh, {0.29f, 0.98f, 0}, 0.013f, 12));
  m.add(p.leather, bent(
                       sphere(1, 28, 18),
                       [&](glm::vec3 q) {
                         const float wide =
                             glm::mix(0.035f, 0.10f, std::clamp(0.5f - 0.5f * q.x, 0.0f, 1.0f));
                         return seat + glm::vec3(-0.02f + 0.14f * q.x,
                                                 0.125f + 0.028f * q.y + 0.015f * q.x * q.x, wide * q.z);
                       },
                       80));
  m.add(p.steel,
        lathe(Outline({{0.02f, -0.004f}, {0.088f, -0.003f}, {0.088f, 0.003f}, {0.02f, 0.004f}}),
              {.segments = 40, .closed = true}),
        at(crank + glm::vec3(0, 0, 0.045f)) * turnX(90));
  Outline guard({-0.028f, 0});
  guard.curve({-0.02f, 0.012f}, {0.02f, 0.012f}, {0.028f, 0}, 6)
      .line(0.026f, -0.003f)
      .curve({0.018f, 0.008f}, {-0.018f, 0.008f}, {-0.026f, -0.003f}, 6);
  const auto mudguard = [&](glm::vec3 hub, float from, float to) {
    std::vector<glm::vec3> path;
    for (int i = 0; i <= 24; ++i) {
      const float a = glm::radians(glm::mix(from, to, float(i) / 24));
      path.push_back(hub + 0.368f * glm::vec3(std::cos(a), std::sin(a), 0));
    }
    m.add(p.teal, sweep(path, guard));
  };
  mudguard(rear, 20, 195);
  mudguard(frontHub, 25, 165);
  // Only a rack, because a basket on it would hide the wheel.
  for (const float s : {-1.0f, 1.0f})
    m.add(p.steel, tube({{-0.24f, 0.76f, s * 0.05f},
                         {-0.45f, 0.765f, s * 0.06f},
                         {-0.82f, 0.765f, s * 0.06f},
                         rear + glm::vec3(-0.02f, 0.01f, s * 0.06f)},
                        0.006f, 10));
  for (int i = 0; i < 4; ++i)
    m.add(p.steel, pole({-0.45f - 0.115f * float(i), 0.766f, -0.06f},
                        {-0.45f - 0.115f * float(i), 0.766f, 0.06f}, 0.005f, 8));
  return m;
}

MeshBuilder shovel(const Palette& p) {
  MeshBuilder m;
  m.add(p.timber, pole({0, 0.26f, 0}, {0, 1.35f, 0.05f}, 0.017f, 14));
  Outline blade({-0.11f, 0.28f});
  blade.line(-0.11f, 0.10f)
      .curve({-0.10f, 0.03f}, {-0.03f, -0.01f}, {0, -0.02f}, 8)
      .curve({0.03f, -0.01f}, {0.10f, 0.03f}, {0.11f, 0.10f}, 8)
      .line(0.11f, 0.28f)
      .line(0.03f, 0.31f)
      .line(-0.03f, 0.31f);
  m.add(p.steel, extrude(blade, 0.006f, {.bevel = 0.001f}), at(0, 0, -0.003f));
  m.add(p.steel, tube({{0, 0.22f, 0.002f}, {0, 0.42f, 0.008f}}, 0.021f, 14));
  return m;
}

MeshBuilder bucket(const Palette& p, uint32_t material, float height) {
  MeshBuilder m;
  const float r = 0.38f * height, top = 0.55f * height, t = 0.025f * height;
  m.add(material, lathe(Outline({{0, 0},
                                 {r, 0},
                                 {top, height},
                                 {top + 1.5f * t, height},
                                 {top + 1.5f * t, height + 2 * t},
                                 {top - t, height + 2 * t},
                                 {r - t, 2 * t},
                                 {0, 2 * t}}),
                        {.segments = 40}));
  std::vector<glm::vec3> handle;
  for (int i = 0; i <= 14; ++i) {
    const float a = kPi * float(i) / 14;
    handle.push_back(
        {top * std::cos(a), height - 0.15f * top * std::sin(a), 1.02f * top * std::sin(a) + 0.02f * height});
  }
  m.add(p.steel, tube(handle, 0.014f * height + 0.002f, 8));
  return m;
}

MeshBuilder ball(const Palette& p, float radius) {
  MeshBuilder m;
  Outline half({0, -radius});
  half.arc(0, radius, 1, 24);
  std::vector<glm::vec2> points = half.points();
  Outline exact;
  for (const glm::vec2& q : points) exact.line(q.x < 1e-5f ? 0 : q.x, q.y);
  const uint32_t paint[3] = {p.red, p.cream, p.blue};
  for (int i = 0; i < 6; ++i)
    m.add(paint[i % 3], lathe(exact, {.segments = 8,
                                      .creaseDegrees = 180,
                                      .fromDegrees = 60.0f * float(i),
                                      .toDegrees = 60.0f * float(i + 1)}));
  return m;
}

MeshBuilder slabStack(const Palette& p) {
  MeshBuilder m;
  for (int i = 0; i < 7; ++i) {
    const uint32_t k = uint32_t(i);
    Shape slab = block(0.40f, 0.05f, 0.40f, {.bevel = 0.005f});
    for (glm::vec2& uv : slab.uvs) uv += glm::vec2(random(981, k, 0, 3), random(982, k, 0, 3));
    m.add(p.paving[i % 3], slab,
          at(random(983, k, -0.02f, 0.02f), 0.0505f * float(i), random(984, k, -0.02f, 0.02f)) *
              turnY(random(985, k, -5, 5)));
  }
  Shape leaning = block(0.40f, 0.05f, 0.40f, {.bevel = 0.005f});
  m.add(p.paving[1], leaning, at(0.30f, 0.19f, 0.02f) * turnY(4) * turnZ(-66) * at(0, -0.025f, 0));
  return m;
}

MeshBuilder bench(const Palette& p) {
  MeshBuilder m;
  for (const float s : {-1.0f, 1.0f}) {
    m.add(p.rubber, tube(smoothPath({{s * 0.62f, 0, 0.24f},
                                     {s * 0.62f, 0.40f, 0.20f},
                                     {s * 0.62f, 0.42f, 0.0f},
                                     {s * 0.62f, 0.40f, -0.20f},
                                     {s * 0.62f, 0.85f, -0.30f}},
                                    6),
                         0.020f, 12));
    m.add(p.rubber,
          tube(smoothPath({{s * 0.62f, 0.40f, -0.16f}, {s * 0.62f, 0.2f, -0.22f}, {s * 0.62f, 0, -0.30f}}, 6),
               0.020f, 12));
  }
  for (int i = 0; i < 4; ++i)
    m.add(p.timberAcross,
          box({-0.75f, 0.435f, -0.17f + 0.105f * float(i)}, {0.75f, 0.465f, -0.075f + 0.105f * float(i)},
              {.bevel = 0.007f, .bevelSteps = 2}));
  for (int i = 0; i < 3; ++i)
    m.add(p.timberAcross,
          box({-0.75f, -0.045f, 0}, {0.75f, 0.045f, 0.028f}, {.bevel = 0.007f, .bevelSteps = 2}),
          at(0, 0.56f + 0.115f * float(i), -0.215f - 0.025f * float(i)) * turnX(-12));
  return m;
}

MeshBuilder flower(const Palette& p, uint32_t seed) {
  MeshBuilder m;
  Outline pot({0, 0});
  pot.line(0.13f, 0)
      .line(0.18f, 0.27f)
      .line(0.20f, 0.28f)
      .line(0.20f, 0.34f)
      .arc(0.18f, 0.34f, 0.8f, 4)
      .line(0.165f, 0.29f)
      .line(0, 0.29f);
  m.add(p.clay, lathe(pot, {.segments = 40}));
  m.add(p.soil,
        lathe(Outline({{0, 0.292f}, {0.166f, 0.292f}, {0.1f, 0.312f}, {0, 0.318f}}), {.segments = 24}));
  const Plant plant =
      bush({0.30f, 0.36f, 0.30f}, 34, 9, {.length = 0.085f, .width = 0.05f, .fold = 0.2f, .steps = 1}, seed);
  m.add(p.leaf[seed % 2 == 0 ? 0 : 2], plant.leaves, at(0, 0.30f, 0))
      .add(p.bark, plant.wood, at(0, 0.30f, 0));
  const Shape petals =
      rosette(6, {.length = 0.038f, .width = 0.028f, .fold = 0.1f, .droop = 0.2f, .steps = 1}, 70, seed);
  for (uint32_t i = 0; i < 16; ++i) {
    const float y = random(seed + 3, i, 0.35f, 1), a = 2.39996f * float(i), r = std::sqrt(1 - y * y) + 0.05f;
    m.add(seed % 2 == 0 ? p.clover : p.red, petals,
          facing({0.29f * r * std::cos(a), 0.31f + 0.36f * y, 0.29f * r * std::sin(a)},
                 {std::cos(a), 0.1f, std::sin(a)}, {0, 1, 0}) *
              turnX(50));
  }
  return m;
}

MeshBuilder mast(const Palette& p, float height) {
  MeshBuilder m;
  Outline pole({0, 0});
  pole.line(0.055f, 0).line(0.055f, 0.3f).line(0.045f, 0.32f).line(0.028f, height).line(0, height);
  m.add(p.mast, lathe(pole, {.segments = 24}));
  m.add(p.yellow, sphere(0.055f, 24, 14), at(0, height + 0.04f, 0));
  m.add(p.stone, block(0.42f, 0.14f, 0.42f, {.bevel = 0.03f, .bevelSteps = 2}), at(0, -0.05f, 0));
  m.add(p.rope,
        tube(smoothPath({{0.05f, height - 0.04f, 0}, {0.085f, 0.6f * height, 0.01f}, {0.075f, 1.15f, 0.0f}},
                        10),
             0.005f, 6));
  m.add(p.rope,
        tube(smoothPath(
                 {{0.05f, height - 0.04f, 0.02f}, {0.075f, 0.5f * height, 0.03f}, {0.07f, 1.15f, 0.0f}}, 10),
             0.005f, 6));
  m.add(p.steel, tube({{0.06f, 1.05f, 0}, {0.07f, 1.25f, 0}}, 0.012f, 10))
      .add(p.steel, box({0.03f, 1.13f, -0.012f}, {0.07f, 1.17f, 0.012f}));
  return m;
}

Sheet flag(const FlagForm& f, uint32_t columns, uint32_t rows) {
  return sheet(columns, rows, {f.width, f.height}, [&](float u, float v) {
    const float grow = u * (0.35f + 0.65f * u);  // held at the hoist
    const float run = 2 * kPi * 1.35f * u - f.phase + 0.9f * v;
    const float still = 0.07f * std::sin(2 * kPi * 0.8f * u + 0.6f);
    const float z = grow * (still + f.wave * std::sin(run) + f.flutter * std::sin(2.3f * run + 2 * v));
    return glm::vec3(f.width * (u - 0.06f * u * u), -f.height * v - f.droop * u * u * (1 + 0.15f * v), z);
  });
}

}  // namespace fovea::scene::yard
