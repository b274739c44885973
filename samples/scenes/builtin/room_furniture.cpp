// Furniture of the room.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/scenes/builtin/room_parts.h"

namespace fovea::scene::room {

using namespace model;

namespace {

constexpr float kPi = glm::pi<float>();

// Posts, rails and a raised panel in the x-y plane from (0, 0), standing out along +z by 0.022.
void addPanelled(MeshBuilder& m, uint32_t paint, float width, float height, int panels) {
  constexpr float kStile = 0.065f, kThick = 0.028f;
  const BoxOptions soft = {.bevel = 0.003f, .bevelSteps = 2};
  m.add(paint, box({0, 0, 0}, {kStile, height, kThick}, soft));
  m.add(paint, box({width - kStile, 0, 0}, {width, height, kThick}, soft));
  const float pitch = (height - kStile) / float(panels);
  for (int i = 0; i <= panels; ++i)
    m.add(paint, box({kStile - 0.002f, pitch * float(i), 0.0005f},
                     {width - kStile + 0.002f, pitch * float(i) + kStile, kThick - 0.0005f}, soft));
  for (int i = 0; i < panels; ++i) {
    const glm::vec3 low(kStile - 0.004f, pitch * float(i) + kStile - 0.004f, 0.009f),
        high(width - kStile + 0.004f, pitch * float(i + 1) + 0.004f, 0.017f);
    m.add(paint, box(low, high));
    m.add(paint, box(low + glm::vec3(0.03f, 0.03f, -0.006f), high + glm::vec3(-0.03f, -0.03f, 0.006f),
                     {.bevel = 0.006f, .bevelSteps = 2}));
  }
}

// A turned leg.
Shape leg(float height, float radius) {
  const float h = height, r = radius;
  Outline o({0, 0});
  o.line(0.55f * r, 0)
      .through({{0.75f * r, 0.10f * h}, {0.70f * r, 0.22f * h}, {1.0f * r, 0.48f * h}, {0.8f * r, 0.72f * h}},
               5);
  o.line(0.95f * r, 0.735f * h).arc(0.95f * r, 0.775f * h, 0.8f, 4).line(0.85f * r, 0.78f * h);
  o.line(1.05f * r, 0.82f * h).line(1.05f * r, h).line(0, h);
  return lathe(o, {.segments = 24});
}

// A garment on its hanger; the hook's bend is at the origin, the shoulders run along z.
MeshBuilder garment(const Palette& p, uint32_t cloth, float length, float flare, uint32_t seed) {
  MeshBuilder m;
  const float shoulder = 0.17f;
  const Sheet s = sheet(48, 22, {0.8f, length}, [&](float u, float v) {
    const float a = 2 * kPi * u, fold = smoothstep(0.25f, 1, v);
    const float half =
        shoulder * (0.32f + 0.68f * smoothstep(-0.02f, 0.10f, v)) * (1 - 0.12f * smoothstep(0.15f, 0.4f, v)) +
        flare * fold;
    const float deep = 0.022f + 0.030f * smoothstep(0.03f, 0.25f, v) + 0.022f * fold;
    const float pleat =
        fold * (0.016f * std::cos(9 * a + 2 * noise({4 * u, 2 * v}, seed)) + 0.006f * std::cos(17 * a));
    const float slope = 0.07f * smoothstep(0.35f, 1.0f, std::abs(std::sin(a))) * (1 - smoothstep(0, 0.3f, v));
    return glm::vec3((deep + pleat) * std::cos(a),
                     -0.075f - slope - length * v * (0.98f + 0.02f * std::cos(3 * a)),
                     (half + 0.6f * pleat) * std::sin(a));
  });
  m.add(cloth, surface(s));
  for (const float side : {-1.0f, 1.0f})
    m.add(cloth, tube(
                     smoothPath({{0, -0.135f, side * 0.125f},
                                 {0.004f, -0.17f, side * 0.185f},
                                 {0.010f, -0.31f, side * 0.215f},
                                 {0.008f, -0.43f, side * 0.205f}},
                                7),
                     [](float t) { return 0.050f - 0.014f * t + 0.004f * std::sin(14 * t); }, 18));
  m.add(p.birch, tube(smoothPath({{0, -0.125f, -0.17f},
                                  {0, -0.075f, -0.05f},
                                  {0, -0.065f, 0},
                                  {0, -0.075f, 0.05f},
                                  {0, -0.125f, 0.17f}},
                                 6),
                      0.007f, 8));
  m.add(p.iron, tube(smoothPath({{0, -0.065f, 0},
                                 {0, -0.03f, 0},
                                 {0, -0.012f, 0.016f},
                                 {0, 0.006f, 0.012f},
                                 {0, 0.010f, -0.002f},
                                 {0, 0.002f, -0.014f}},
                                5),
                     0.0025f, 6));
  return m;
}

// A folded jersey; the origin is the middle of its base.
Shape folded(float width, float depth, float height, uint32_t seed) {
  return bent(
      block(width, height, depth, {.bevel = 0.45f * height, .bevelSteps = 5, .cells = {8, 1, 8}}),
      [&](glm::vec3 q) {
        q.y *= 1 + 0.12f * (2 * noise({14 * q.x, 14 * q.z}, seed) - 1);
        q.x *= 1 + 0.03f * std::sin(60 * q.y);
        return q;
      },
      60);
}

// A book that stands on y = 0 with its spine towards +z and is `wide` along x.
void addBook(MeshBuilder& m, const Palette& p, uint32_t cover, glm::vec3 size, const glm::mat4& placement) {
  const float w = 0.5f * size.x, d = size.z, c = 0.0022f;
  // Cover in plan, x and -z: two boards and a spine that bows.
  Outline o({-w, 0});
  o.line(-w + c, 0).line(-w + c, d - 0.004f).arc(w - c, d - 0.004f, -0.2f, 6).line(w - c, 0).line(w, 0);
  o.line(w, d - 0.003f).arc(-w, d - 0.003f, 0.22f, 8);
  m.add(cover, extrude(o, size.y), placement * at(0, 0, 0) * turnX(-90) * scaled(1, -1, 1));
  m.add(p.paper, box({-w + c, 0.004f, 0.004f}, {w - c, size.y - 0.004f, d - 0.004f}), placement);
}

}  // namespace

Shape knob(float r) {
  Outline o({0, 0});
  o.line(0.55f * r, 0).curve({0.4f * r, 0.3f * r}, {0.4f * r, 0.5f * r}, {0.6f * r, 0.8f * r}, 4);
  o.arc(0, 1.9f * r, 0.5f, 8);
  return lathe(o, {.segments = 24});
}

MeshBuilder closet(const Palette& p) {
  constexpr float w = 0.60f, h = 2.02f, d = 0.56f, t = 0.022f, foot = 0.09f;
  MeshBuilder m;
  const BoxOptions soft = {.bevel = 0.002f};
  m.add(p.red, box({-w, 0, 0}, {-w + t, h, d}, soft)).add(p.red, box({w - t, 0, 0}, {w, h, d}, soft));
  m.add(p.redDeep, box({-w + t, foot, 0.001f}, {w - t, h - t, 0.012f}));
  m.add(p.redDeep, box({-w + t, foot, 0.012f}, {-w + t + 0.004f, h - t, d - 0.002f}));
  m.add(p.redDeep, box({w - t - 0.004f, foot, 0.012f}, {w - t, h - t, d - 0.002f}));
  m.add(p.redDeep, box({-w + t, foot, 0.012f}, {w - t, foot + t, d - 0.003f}));
  m.add(p.red, box({-w + t, h - t, 0}, {w - t, h, d}));
  m.add(p.red, box({-w + t, 0, d - 0.05f}, {w - t, foot - 0.002f, d - 0.02f}));
  m.add(p.redDeep, box({-w + t, 1.66f, 0.012f}, {w - t, 1.66f + t, d - 0.03f}, soft));
  Outline crown({0, 0});
  crown.line(0.012f, 0)
      .curve({0.014f, 0.03f}, {0.04f, 0.03f}, {0.045f, 0.055f}, 6)
      .line(0.05f, 0.075f)
      .line(0, 0.075f);
  m.add(p.red, sweep({{-w, h, 0}, {-w, h, d + 0.029f}, {w, h, d + 0.029f}, {w, h, 0}},
                     crown.moved({-0.001f, 0}), {.up = glm::vec3(0, 1, 0)}));
  m.add(p.red, box({-w, h + 0.004f, 0}, {w, h + 0.07f, d + 0.0285f}));
  // Doors: the left one closed, the right one open.
  MeshBuilder door;
  addPanelled(door, p.red, w - 0.003f, h - foot - 0.006f, 3);
  m.add(door, at(-w, foot + 0.003f, d + 0.001f));
  m.add(p.brass, knob(0.016f), at(-0.035f, 1.02f, d + 0.029f) * turnX(90));
  const glm::mat4 hinge = at(w, foot + 0.003f, d + 0.001f) * turnY(108) * at(-(w - 0.003f), 0, 0);
  m.add(door, hinge);
  m.add(p.brass, knob(0.016f), hinge * at(0.033f, 0.93f, 0.028f) * turnX(90));
  m.add(p.brass, knob(0.016f), hinge * at(0.033f, 0.93f, 0.0f) * turnX(-90));
  for (const float y : {0.30f, 1.0f, 1.75f})
    m.add(p.brass, cylinder(0.007f, 0.07f, 12), at(w + 0.004f, y, d + 0.006f));
  // Clothes, boxes and folded things.
  m.add(p.brass, tube({{-w + t, 1.585f, 0.28f}, {w - t, 1.585f, 0.28f}}, 0.013f, 16));
  const int cloths[11] = {3, 5, 0, 1, 4, 2, 3, 1, 4, 0, 5};
  for (int i = 0; i < 11; ++i)
    m.add(garment(p, p.cloth[cloths[i]], random(501, uint32_t(i), 0.62f, 0.98f),
                  random(502, uint32_t(i), 0.0f, 0.03f), 510 + uint32_t(i)),
          at(-0.50f + 0.096f * float(i), 1.592f, 0.28f) * turnY(random(503, uint32_t(i), -12, 12)));
  for (int i = 0; i < 5; ++i) {
    m.add(p.cloth[(i * 2 + 1) % 6], folded(0.28f, 0.34f, 0.048f, 520 + uint32_t(i)),
          at(0.32f + 0.006f * float(i % 2), 1.682f + 0.046f * float(i), 0.27f));
    if (i < 3)
      m.add(p.cloth[(i + 3) % 6], folded(0.26f, 0.32f, 0.052f, 530 + uint32_t(i)),
            at(-0.02f, 1.682f + 0.050f * float(i), 0.27f) * turnY(4));
  }
  m.add(p.book[6], block(0.34f, 0.17f, 0.36f, {.bevel = 0.004f}), at(-0.36f, 1.682f, 0.26f));
  m.add(p.book[6], block(0.355f, 0.05f, 0.375f, {.bevel = 0.004f}), at(-0.36f, 1.815f, 0.26f));
  m.add(p.book[3], block(0.36f, 0.20f, 0.34f, {.bevel = 0.004f}), at(0.34f, foot + t, 0.26f) * turnY(6));
  m.add(p.toy[5], block(0.37f, 0.05f, 0.35f, {.bevel = 0.004f}),
        at(0.34f, foot + t + 0.19f, 0.26f) * turnY(6));
  m.add(p.book[4], block(0.30f, 0.13f, 0.34f, {.bevel = 0.004f}), at(-0.10f, foot + t, 0.28f) * turnY(-5));
  return m;
}

MeshBuilder bookcase(const Palette& p) {
  constexpr float w = 0.46f, h = 1.36f, d = 0.29f, t = 0.022f;
  MeshBuilder m;
  const BoxOptions soft = {.bevel = 0.003f, .bevelSteps = 2};
  m.add(p.birch, box({-w, 0, 0}, {-w + t, h, d}, soft)).add(p.birch, box({w - t, 0, 0}, {w, h, d}, soft));
  m.add(p.birch, box({-w + t, 0.06f, 0.002f}, {w - t, h - 0.01f, 0.012f}));
  m.add(p.birchAcross, box({-w - 0.012f, h, -0.0f}, {w + 0.012f, h + 0.026f, d + 0.014f},
                           {.bevel = 0.006f, .bevelSteps = 3}));
  m.add(p.birchAcross, box({-w + t, 0, d - 0.05f}, {w - t, 0.062f, d - 0.03f}));
  const float levels[4] = {0.06f, 0.40f, 0.73f, 1.05f};
  for (const float y : levels)
    m.add(p.birchAcross, box({-w + t - 0.002f, y, 0.010f}, {w - t + 0.002f, y + t, d - 0.006f}, soft));
  uint32_t seed = 540;
  const auto row = [&](int level, float from, float to, float leanDegrees) {
    float x = from;
    const float room = level < 3 ? levels[level + 1] - levels[level] - t : h - levels[3] - t;
    while (true) {
      const uint32_t s = ++seed;
      const float wide = random(s, 0, 0.012f, 0.040f);
      if (x + wide > to) break;
      const glm::vec3 size(wide, std::min(random(s, 1, 0.19f, 0.285f), room - 0.015f),
                           random(s, 2, 0.14f, 0.20f));
      addBook(m, p, p.book[int(random(s, 3) * 6.999f)], size,
              at(x + 0.5f * wide, levels[level] + t, 0.265f - size.z - random(s, 4, 0, 0.02f)));
      x += wide + 0.0012f;
    }
    if (leanDegrees > 0) {  // the last one leans against the row
      const float a = glm::radians(leanDegrees), tall = 0.23f, wide = 0.026f;
      addBook(m, p, p.book[seed % 7], {wide, tall, 0.17f},
              at(x + tall * std::sin(a) + 0.5f * wide * std::cos(a) + 0.002f,
                 levels[level] + t + 0.5f * wide * std::sin(a), 0.08f) *
                  turnZ(leanDegrees));
    }
  };
  row(0, -w + t + 0.004f, -0.06f, 0);
  row(1, -w + t + 0.004f, 0.24f, 14);
  row(2, -0.10f, w - t - 0.004f, 0);
  row(3, -w + t + 0.004f, 0.10f, 11);
  // Lying books and what stands between.
  float y = levels[0] + t;
  for (int i = 0; i < 4; ++i) {
    const float thick = 0.026f + 0.006f * float(i % 3);
    addBook(m, p, p.book[(i * 3 + 1) % 7], {thick, 0.26f - 0.02f * float(i), 0.19f},
            at(0.34f - 0.01f * float(i), y + 0.5f * thick, 0.06f) * turnY(3.0f * float(i)) * turnZ(90));
    y += thick;
  }
  m.add(stackingRings(p), at(-0.30f, levels[2] + t, 0.15f));
  m.add(ball(p, 0.055f), at(-0.185f, levels[2] + t, 0.16f));
  m.add(toyTree(p, 0.17f), at(0.25f, levels[3] + t, 0.14f))
      .add(toyTree(p, 0.13f), at(0.34f, levels[3] + t, 0.19f));
  m.add(locomotive(p), at(0.37f, levels[1] + t, 0.16f) * turnY(-70) * scaled(0.62f));
  m.add(globe(p), at(-0.24f, h + 0.026f, 0.15f) * turnY(35));
  m.add(pottedPlant(p, 561), at(0.27f, h + 0.026f, 0.15f));
  return m;
}

MeshBuilder floorLamp(const Palette& p) {
  MeshBuilder m;
  Outline foot({0, 0});
  foot.line(0.155f, 0)
      .line(0.155f, 0.014f)
      .curve({0.10f, 0.026f}, {0.03f, 0.03f}, {0.022f, 0.07f}, 10)
      .line(0.012f, 0.09f)
      .line(0, 0.09f);
  m.add(p.brass, lathe(foot, {.segments = 48}));
  m.add(p.brass, tube({{0, 0.08f, 0}, {0, 1.36f, 0}}, 0.0105f, 18));
  for (const float y : {0.45f, 0.9f}) m.add(p.brass, torus(0.012f, 0.005f, 24, 8), at(0, y, 0));
  // A pleated shade, open above and below.
  Outline shade({0.235f, 0});
  shade.line(0.215f, 0.09f)
      .line(0.19f, 0.18f)
      .line(0.155f, 0.29f)
      .line(0.150f, 0.29f)
      .line(0.185f, 0.18f)
      .line(0.210f, 0.09f)
      .line(0.230f, 0);
  m.add(p.shade,
        lathe(shade, {.segments = 360,
                      .closed = true,
                      .swell = [](float a, float) { return 1 + 0.013f * std::cos(60 * a); }}),
        at(0, 1.24f, 0));
  m.add(p.brass, torus(0.238f, 0.004f, 64, 6), at(0, 1.241f, 0))
      .add(p.brass, torus(0.156f, 0.004f, 48, 6), at(0, 1.529f, 0));
  for (int i = 0; i < 3; ++i)
    m.add(p.brass, tube({{0, 1.40f, 0},
                         {0.155f * std::cos(2.1f * float(i)), 1.525f, 0.155f * std::sin(2.1f * float(i))}},
                        0.003f, 6));
  m.add(p.paper,
        lathe(Outline({{0, 0}})
                  .line(0.014f, 0)
                  .curve({0.016f, 0.03f}, {0.032f, 0.04f}, {0.032f, 0.065f}, 6)
                  .arc(0, 0.098f, 0.41f, 8),
              {.segments = 28}),
        at(0, 1.36f, 0));
  return m;
}

MeshBuilder pendant(const Palette& p) {
  // A globe of paper on wire hoops.
  MeshBuilder m;
  constexpr float r = 0.21f, drop = 0.62f;
  m.add(p.paint, lathe(Outline({{0, -0.035f}, {0.03f, -0.035f}, {0.05f, -0.01f}, {0.05f, 0.0f}, {0, 0.0f}}),
                       {.segments = 28}));
  m.add(p.iron, tube({{0, -0.03f, 0}, {0, -drop + r - 0.02f, 0}}, 0.004f, 8));
  Outline o;
  constexpr int kRibs = 22;
  for (int i = 0; i <= kRibs * 5; ++i) {
    const float t = float(i) / (kRibs * 5), a = kPi * (-0.46f + 0.92f * t);
    const float rr = r * (1 - 0.020f * std::pow(std::abs(std::cos(kPi * kRibs * t)), 0.6f));
    o.line(rr * std::cos(a), rr * std::sin(a) * 0.92f);
  }
  m.add(p.shade, lathe(o, {.segments = 56, .creaseDegrees = 70}), at(0, -drop, 0));
  return m;
}

MeshBuilder table(const Palette& p) {
  MeshBuilder m;
  constexpr float h = 0.50f, r = 0.37f;
  Outline top({0, h - 0.024f});
  top.line(r - 0.02f, h - 0.024f)
      .curve({r - 0.005f, h - 0.02f}, {r, h - 0.012f}, {r, h - 0.006f}, 5)
      .arc(r - 0.006f, h, 0.41f, 4)
      .line(0, h);
  m.add(p.birch, lathe(top, {.segments = 72}));
  m.add(p.toy[5], lathe(Outline({{r - 0.09f, h - 0.085f},
                                 {r - 0.07f, h - 0.085f},
                                 {r - 0.07f, h - 0.024f},
                                 {r - 0.09f, h - 0.024f}}),
                        {.segments = 60, .closed = true}));
  for (int i = 0; i < 4; ++i)
    m.add(p.toy[5], leg(h - 0.024f, 0.024f), turnY(90.0f * float(i) + 32) * at(0.245f, 0, 0) * turnZ(4));
  // Drawings, a mug of crayons, a plate with an apple.
  const auto sheetOfPaper = [&](float x, float z, float turn, float y, float curl) {
    Sheet s = sheet(12, 12, {0.21f, 0.28f}, [&](float u, float v) {
      const float lift = curl * std::pow(std::max(u + v - 1.2f, 0.0f), 2.0f);
      return glm::vec3((u - 0.5f) * 0.21f, 0.0008f + lift, (v - 0.5f) * 0.28f);
    });
    m.add(p.drawing, surface(s, 0.0008f), at(x, h + y, z) * turnY(turn));
  };
  sheetOfPaper(-0.10f, 0.12f, 24, 0, 0.08f);
  sheetOfPaper(0.06f, 0.17f, -14, 0.001f, 0.12f);
  Outline mug({0, 0});
  mug.line(0.036f, 0)
      .arc(0.040f, 0.004f, 0.4f, 3)
      .line(0.041f, 0.088f)
      .arc(0.037f, 0.088f, 1, 4)
      .line(0.036f, 0.008f)
      .line(0, 0.007f);
  m.add(p.toy[1], lathe(mug, {.segments = 40}), at(0.14f, h, -0.12f));
  m.add(p.toy[1],
        tube(smoothPath({{0.038f, 0.07f, 0},
                         {0.064f, 0.07f, 0},
                         {0.068f, 0.045f, 0},
                         {0.056f, 0.025f, 0},
                         {0.038f, 0.02f, 0}},
                        6),
             0.005f, 10),
        at(0.14f, h, -0.12f) * turnY(-60));
  for (int i = 0; i < 6; ++i) {
    Outline pencil({0, 0});
    pencil.line(0.0042f, 0).line(0.0042f, 0.13f).line(0.0010f, 0.146f).line(0, 0.1465f);
    m.add(p.toy[i], lathe(pencil, {.segments = 12}),
          at(0.14f, h + 0.008f, -0.12f) * turnY(60.0f * float(i)) * at(0.012f, 0, 0) *
              turnZ(-9 - float(i % 3)));
  }
  for (int i = 0; i < 4; ++i)
    m.add(p.toy[(i * 2 + 1) % 5], cylinder(0.0045f, 0.09f, 12, 0.001f),
          at(-0.19f + 0.035f * float(i), h + 0.0045f, -0.03f + 0.03f * float(i % 2)) *
              turnY(37.0f * float(i)) * turnZ(90));
  Outline plate({0, 0});
  plate.line(0.045f, 0)
      .line(0.05f, 0.004f)
      .curve({0.07f, 0.007f}, {0.08f, 0.012f}, {0.095f, 0.018f}, 6)
      .line(0.093f, 0.021f)
      .curve({0.07f, 0.014f}, {0.05f, 0.008f}, {0, 0.007f}, 6);
  m.add(p.toy[5], lathe(plate, {.segments = 48}), at(-0.14f, h, -0.16f));
  Outline apple({0, 0.006f});
  apple.through({{0.014f, 0.002f}, {0.034f, 0.022f}, {0.037f, 0.048f}, {0.020f, 0.066f}, {0.004f, 0.060f}}, 5)
      .line(0, 0.058f);
  m.add(p.toy[0], lathe(apple, {.segments = 36}), at(-0.155f, h + 0.007f, -0.165f));
  m.add(p.bark, tube(smoothPath({{0, 0.058f, 0}, {0.003f, 0.072f, 0}, {0.008f, 0.080f, 0}}, 4), 0.0015f, 6),
        at(-0.155f, h + 0.007f, -0.165f));
  m.add(p.toy[2], lathe(apple, {.segments = 36}),
        at(-0.10f, h + 0.008f, -0.145f) * turnZ(-8) * scaled(0.92f));
  return m;
}

MeshBuilder chair(const Palette& p) {
  MeshBuilder m;
  constexpr float h = 0.30f;
  const Outline seat = roundedRectangle(0.32f, 0.30f, 0.07f, 8);
  m.add(p.birch, extrude(seat, 0.024f, {.bevel = 0.005f}), at(0, h - 0.024f, 0) * turnX(-90));
  for (const float x : {-1.0f, 1.0f}) {
    m.add(p.toy[2], leg(h - 0.02f, 0.018f), at(x * 0.125f, 0, 0.105f) * turnX(-3) * turnZ(x * 3));
    m.add(p.toy[2], leg(h - 0.02f, 0.018f), at(x * 0.125f, 0, -0.105f) * turnX(5) * turnZ(x * 3));
    m.add(p.toy[2], tube(smoothPath({{x * 0.135f, h - 0.01f, -0.118f},
                                     {x * 0.138f, h + 0.13f, -0.130f},
                                     {x * 0.140f, h + 0.27f, -0.160f}},
                                    6),
                         0.013f, 14));
    m.add(p.toy[2], tube({{x * 0.137f, 0.12f, 0.108f}, {x * 0.137f, 0.12f, -0.112f}}, 0.008f, 12));
  }
  for (int i = -2; i <= 2; ++i)
    m.add(p.toy[2], tube(smoothPath({{0.048f * float(i), h - 0.005f, -0.120f},
                                     {0.049f * float(i), h + 0.12f, -0.134f},
                                     {0.050f * float(i), h + 0.245f, -0.158f}},
                                    5),
                         0.0065f, 12));
  // Top rail: bowed backwards.
  std::vector<glm::vec3> rail;
  for (int i = 0; i <= 20; ++i) {
    const float t = float(i) / 10 - 1;
    rail.push_back({0.165f * t, h + 0.255f + 0.012f * (1 - t * t), -0.150f - 0.018f * (1 - t * t)});
  }
  m.add(p.birchAcross, sweep(rail, roundedRectangle(0.018f, 0.062f, 0.008f, 3), {.up = glm::vec3(0, 1, 0)}));
  return m;
}

MeshBuilder drawers(const Palette& p) {
  MeshBuilder m;
  constexpr float w = 0.50f, h = 0.78f, d = 0.42f;
  const BoxOptions soft = {.bevel = 0.004f, .bevelSteps = 2};
  m.add(p.toy[5], box({-w, 0.06f, 0}, {w, h, d}, soft));
  m.add(p.birchAcross,
        box({-w - 0.015f, h, 0}, {w + 0.015f, h + 0.025f, d + 0.02f}, {.bevel = 0.007f, .bevelSteps = 3}));
  for (const float x : {-w + 0.05f, w - 0.05f})
    for (const float z : {0.05f, d - 0.05f})
      m.add(p.birch, lathe(Outline({{0, 0}, {0.018f, 0}, {0.026f, 0.06f}, {0, 0.06f}}), {.segments = 20}),
            at(x, 0, z));
  for (int i = 0; i < 3; ++i) {
    const float y = 0.085f + 0.232f * float(i);
    m.add(p.cloth[1], box({-w + 0.02f, y, d - 0.004f}, {w - 0.02f, y + 0.216f, d + 0.016f},
                          {.bevel = 0.005f, .bevelSteps = 2}));
    for (const float x : {-0.22f, 0.22f})
      m.add(p.brass, knob(0.015f), at(x, y + 0.108f, d + 0.016f) * turnX(90));
  }
  return m;
}

MeshBuilder pictureFrame(const Palette& p, uint32_t picture, float width, float height) {
  MeshBuilder m;
  const float x = 0.5f * width, y = 0.5f * height;
  Outline profile({-0.002f, 0});
  profile.line(0.030f, 0)
      .line(0.030f, 0.016f)
      .arc(0.020f, 0.024f, 0.4f, 4)
      .curve({0.012f, 0.020f}, {0.006f, 0.014f}, {-0.002f, 0.010f}, 5);
  // The right of the path must be outside, so it runs counter-clockwise seen from the front.
  m.add(p.oak, sweep({{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, profile,
                     {.closedPath = true, .up = glm::vec3(0, 0, 1)}));
  m.add(p.paint, box({-x, -y, 0.002f}, {x, y, 0.006f}));
  const float a = x - 0.045f, b = y - 0.045f;
  Sheet s = sheet(1, 1, {1, 1},
                  [&](float u, float v) { return glm::vec3((2 * u - 1) * a, (1 - 2 * v) * b, 0.0068f); });
  m.add(picture, surface(s, 0.001f));
  return m;
}

}  // namespace fovea::scene::room
