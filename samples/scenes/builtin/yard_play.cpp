// The yard's playground.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/scenes/builtin/yard_parts.h"

namespace fovea::scene::yard {

using namespace model;

namespace {

constexpr float kPi = glm::pi<float>(), kQuarter = 0.41421356f;

// A chain of oval links from a to b.
Shape chain(glm::vec3 a, glm::vec3 b, float link, float wire) {
  const Shape one = placed(torus(0.36f * link, wire, 9, 5), turnX(90) * scaled(0.72f, 1, 1.5f));
  const int count = int(glm::length(b - a) / (0.80f * link));
  Shape s;
  for (int i = 0; i < count; ++i)
    append(s, one,
           facing(glm::mix(a, b, (float(i) + 0.5f) / float(count)), {0, 0, 1}, b - a) *
               turnY(i % 2 == 0 ? 0.0f : 90.0f));
  return s;
}

}  // namespace

MeshBuilder slideTower(const Palette& p) {
  MeshBuilder m;
  constexpr float kHalf = 0.52f, kDeck = 1.25f, kTop = 2.15f;
  for (const float sx : {-1.0f, 1.0f})
    for (const float sz : {-1.0f, 1.0f})
      m.add(p.timber, cylinder(0.055f, kTop + 0.1f, 20, 0.008f), at(sx * kHalf, -0.05f, sz * kHalf));
  for (int i = 0; i < 9; ++i) {
    const float x = -kHalf + 2 * kHalf * (float(i) + 0.5f) / 9;
    m.add(p.timber, box({x - 0.054f, kDeck - 0.035f, -kHalf - 0.05f}, {x + 0.054f, kDeck, kHalf + 0.05f},
                        {.bevel = 0.006f}));
  }
  for (const float s : {-1.0f, 1.0f})
    m.add(p.timberAcross, box({-kHalf - 0.02f, kDeck - 0.15f, s * kHalf - 0.03f},
                              {kHalf + 0.02f, kDeck - 0.036f, s * kHalf + 0.03f}, {.bevel = 0.008f}));
  // Railings of slats at the sides, one of coloured boards.
  for (const float s : {-1.0f, 1.0f}) {
    for (const float y : {kDeck + 0.10f, kDeck + 0.62f})
      m.add(p.timber,
            box({s * kHalf - 0.022f, y, -kHalf}, {s * kHalf + 0.022f, y + 0.07f, kHalf}, {.bevel = 0.008f}));
    for (int i = 0; i < 6; ++i) {
      const float z = -0.36f + 0.144f * float(i);
      m.add(i % 2 == 0 ? p.blue : p.cream,
            box({s * (kHalf + 0.034f) - 0.011f, kDeck + 0.04f, z - 0.055f},
                {s * (kHalf + 0.034f) + 0.011f, kDeck + 0.76f, z + 0.055f}, {.bevel = 0.005f}));
    }
  }
  // A gabled roof of boards.
  for (const float s : {-1.0f, 1.0f})
    for (int i = 0; i < 6; ++i) {
      const float a = 0.135f * float(i);
      m.add(p.green,
            box({a, 0.005f * float(i & 1), -0.75f}, {a + 0.15f, 0.022f + 0.005f * float(i & 1), 0.75f},
                {.bevel = 0.005f}),
            at(0, kTop + 0.52f, 0) * scaled(s, 1, 1) * turnZ(-38));
    }
  for (const float s : {-1.0f, 1.0f})
    m.add(p.green, extrude(Outline({{-0.52f, 0}, {0.52f, 0}, {0, 0.41f}}), 0.025f, {.bevel = 0.004f}),
          at(0, kTop + 0.09f, s * kHalf - 0.012f));
  // The slide.
  const float wall = 0.17f, w = 0.25f, t = 0.022f;
  Outline section({-w, 0.03f});
  section.arc(-w + 0.05f, 0, kQuarter, 5)
      .line(w - 0.05f, 0)
      .arc(w, 0.03f, kQuarter, 5)
      .line(w + 0.02f, wall)
      .arc(w + 0.02f - t, wall, 1, 4);
  section.line(w - t, 0.045f)
      .arc(w - 0.06f, t, -kQuarter, 5)
      .line(-w + 0.06f, t)
      .arc(-w + t, 0.045f, -kQuarter, 5);
  section.line(-w - 0.02f + t, wall).arc(-w - 0.02f, wall, 1, 4);
  const std::vector<glm::vec3> run = smoothPath({{0, kDeck - 0.01f, kHalf - 0.02f},
                                                 {0, kDeck - 0.05f, kHalf + 0.30f},
                                                 {0, 0.86f, kHalf + 0.80f},
                                                 {0, 0.48f, kHalf + 1.36f},
                                                 {0, 0.25f, kHalf + 1.82f},
                                                 {0, 0.20f, kHalf + 2.12f},
                                                 {0, 0.20f, kHalf + 2.35f}},
                                                8);
  m.add(p.blue, sweep(run, section, {.up = glm::vec3(0, 1, 0)}));
  for (const float s : {-1.0f, 1.0f}) {
    m.add(p.steel, pole({s * 0.2f, -0.02f, kHalf + 1.75f}, {s * 0.2f, 0.28f, kHalf + 1.75f}, 0.02f, 12));
    m.add(p.steel, tube(roundedPath({{s * 0.29f, kDeck - 0.04f, kHalf + 0.06f},
                                     {s * 0.29f, kDeck + 0.62f, kHalf + 0.06f},
                                     {s * 0.29f, kDeck + 0.10f, kHalf + 0.62f}},
                                    0.15f),
                        0.016f, 10));
  }
  // A ladder up at the back and a net at the +x side.
  for (const float s : {-1.0f, 1.0f})
    m.add(p.timber,
          pole({s * 0.26f, -0.05f, -kHalf - 0.62f}, {s * 0.26f, kDeck + 0.55f, -kHalf - 0.02f}, 0.032f));
  for (int i = 0; i < 6; ++i) {
    const float k = (float(i) + 0.8f) / 6.6f;
    m.add(p.timberAcross, pole({-0.26f, 1.2f * k, -kHalf - 0.62f + 0.42f * k},
                               {0.26f, 1.2f * k, -kHalf - 0.62f + 0.42f * k}, 0.022f, 12));
  }
  const auto net = [&](float u, float v) {
    return glm::vec3(kHalf + 0.06f + 0.75f * (1 - v) - 0.05f * std::sin(kPi * v), v * (kDeck - 0.02f),
                     (u - 0.5f) * 0.9f * (1 - 0.15f * v));
  };
  for (int i = 0; i <= 5; ++i) {
    std::vector<glm::vec3> up, across;
    for (int k = 0; k <= 10; ++k) up.push_back(net(float(i) / 5, float(k) / 10));
    for (int k = 0; k <= 10; ++k) across.push_back(net(float(k) / 10, (float(i) + 0.5f) / 6));
    m.add(p.rope, tube(up, 0.011f, 8)).add(p.rope, tube(across, 0.011f, 8));
    for (int k = 0; k <= 5; ++k)
      m.add(p.red, sphere(0.02f, 10, 6), at(net(float(k) / 5, (float(i) + 0.5f) / 6)));
  }
  m.add(p.timber, pole({kHalf + 0.81f, 0.02f, -0.5f}, {kHalf + 0.81f, 0.02f, 0.5f}, 0.045f));
  return m;
}

MeshBuilder swingFrame(const Palette& p) {
  MeshBuilder m;
  constexpr float kHalf = 1.45f, kBar = kSwingBar + 0.05f;
  for (const float sx : {-1.0f, 1.0f}) {
    for (const float sz : {-1.0f, 1.0f}) {
      m.add(p.timber, pole({sx * (kHalf + 0.12f), -0.08f, sz * 0.85f}, {sx * kHalf, kBar + 0.05f, sz * 0.05f},
                           0.055f, 20));
      m.add(p.steel, cylinder(0.075f, 0.10f, 20, 0.01f), at(sx * (kHalf + 0.115f), -0.02f, sz * 0.83f));
    }
    m.add(p.timber,
          pole({sx * (kHalf + 0.07f), 0.85f, -0.55f}, {sx * (kHalf + 0.07f), 0.85f, 0.55f}, 0.035f));
    m.add(p.steel, torus(0.075f, 0.018f, 24, 8), at(sx * kHalf, kBar, 0) * turnZ(90));
  }
  m.add(p.timberAcross, pole({-kHalf - 0.18f, kBar, 0}, {kHalf + 0.18f, kBar, 0}, 0.058f, 24));
  for (const float x : {-0.95f, -0.45f, 0.45f, 0.95f})
    m.add(p.steel, torus(0.06f, 0.012f, 24, 8), at(x, kBar, 0) * turnZ(90));
  return m;
}

MeshBuilder swingSeat(const Palette& p) {
  MeshBuilder m;
  constexpr float kLong = 1.62f;
  for (const float s : {-1.0f, 1.0f}) {
    m.add(p.steel, chain({s * 0.25f, 0, 0}, {s * 0.225f, -kLong, 0}, 0.045f, 0.0045f));
    m.add(p.steel, tube(smoothPath({{s * 0.225f, -kLong - 0.06f, -0.06f},
                                    {s * 0.225f, -kLong, 0},
                                    {s * 0.225f, -kLong - 0.06f, 0.06f}},
                                   4),
                        0.006f, 8));
  }
  m.add(p.red, bent(box({-0.25f, -kLong - 0.10f, -0.09f}, {0.25f, -kLong - 0.06f, 0.09f},
                        {.bevel = 0.012f, .bevelSteps = 3, .cells = {16, 1, 4}}),
                    [](glm::vec3 q) { return glm::vec3(q.x, q.y + 0.55f * (q.x * q.x - 0.02f), q.z); }));
  return m;
}

MeshBuilder climbingDome(const Palette& p, float radius) {
  MeshBuilder m;
  constexpr int kRings = 4, kSides = 10;
  const auto point = [&](int ring, int i) {
    const float e = glm::radians(ring == 0 ? -3.0f : 4.0f + 78.0f * std::pow(float(ring) / kRings, 0.9f)),
                a = 2 * kPi * (float(i) + 0.5f * float(ring)) / kSides;
    return radius * glm::vec3(std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a));
  };
  const uint32_t paint[3] = {p.red, p.blue, p.yellow};
  for (int r = 0; r < kRings; ++r)
    for (int i = 0; i < kSides; ++i) {
      const glm::vec3 a = point(r, i);
      if (r > 0) m.add(paint[r % 3], pole(a, point(r, i + 1), 0.017f, 10));
      m.add(paint[(r + 1) % 3], pole(a, point(r + 1, i), 0.017f, 10))
          .add(paint[(r + 1) % 3], pole(a, point(r + 1, i - 1), 0.017f, 10));
      m.add(p.steel, sphere(0.030f, 12, 8), at(a));
    }
  for (int i = 0; i < kSides; ++i) {
    m.add(p.red, pole(point(kRings, i), point(kRings, i + 1), 0.017f, 10));
    m.add(p.steel, sphere(0.030f, 12, 8), at(point(kRings, i)));
  }
  return m;
}

MeshBuilder sandbox(const Palette& p, float edge) {
  MeshBuilder m;
  const float half = 0.5f * edge;
  for (const float s : {-1.0f, 1.0f}) {
    m.add(p.timberAcross, box({-half - 0.04f, -0.06f, s * half - 0.025f},
                              {half + 0.04f, 0.24f, s * half + 0.025f}, {.bevel = 0.01f, .bevelSteps = 2}));
    m.add(p.timberAcross,
          box({s * half - 0.025f, -0.06f, -half + 0.02f}, {s * half + 0.025f, 0.235f, half - 0.02f},
              {.bevel = 0.01f, .bevelSteps = 2}),
          glm::mat4(1));
    m.add(p.timberAcross, box({-half - 0.10f, 0.24f, s * half - 0.13f},
                              {half + 0.10f, 0.275f, s * half + 0.10f}, {.bevel = 0.012f, .bevelSteps = 2}));
    m.add(p.timber, box({s * half - 0.13f + (s > 0 ? 0.0f : 0.03f), 0.24f, -half + 0.132f},
                        {s * half + 0.13f - (s > 0 ? 0.03f : 0.0f), 0.275f, half - 0.132f},
                        {.bevel = 0.012f, .bevelSteps = 2}));
  }
  m.add(p.sand, surface(sheet(44, 44, {edge, edge}, [&](float u, float v) {
          const glm::vec2 q((u - 0.5f) * (edge - 0.03f), (v - 0.5f) * (edge - 0.03f));
          const float heap =
              0.16f * std::exp(-9 * glm::dot(q - glm::vec2(-0.28f, -0.22f), q - glm::vec2(-0.28f, -0.22f)));
          const float hollow =
              0.09f * std::exp(-16 * glm::dot(q - glm::vec2(0.30f, 0.12f), q - glm::vec2(0.30f, 0.12f)));
          return glm::vec3(q.x,
                           0.10f + heap - hollow + 0.05f * (fractal(q * 4.0f, 961, 3) - 0.5f) +
                               0.02f * noise(q * 19.0f, 962),
                           q.y);
        })));
  // Cakes of sand, moulds, a bucket and a spade.
  const Outline cake = {{0, 0}, {0.075f, 0}, {0.06f, 0.07f}, {0.055f, 0.075f}, {0, 0.075f}};
  for (const glm::vec2& c : {glm::vec2(0.10f, 0.42f), glm::vec2(-0.12f, 0.46f), glm::vec2(0.0f, 0.24f)})
    m.add(p.sand,
          lathe(cake, {.segments = 28, .swell = [](float a, float) { return 1 + 0.06f * std::cos(8 * a); }}),
          at(c.x, 0.085f, c.y));
  m.add(bucket(p, p.red, 0.17f), at(0.47f, 0.06f, 0.42f) * turnZ(8));
  m.add(bucket(p, p.green, 0.13f), at(-0.5f, 0.13f, 0.25f) * turnY(30) * turnZ(76));
  const Outline blade = roundedRectangle(0.09f, 0.12f, 0.03f, 5);
  const glm::mat4 spade = at(0.30f, 0.07f, -0.18f) * turnY(35) * turnZ(-22);
  m.add(p.yellow, extrude(blade, 0.008f, {.bevel = 0.002f}), spade)
      .add(p.yellow, pole({0, 0.05f, 0.004f}, {0, 0.26f, 0.004f}, 0.010f, 12), spade);
  m.add(p.yellow, pole({-0.035f, 0.26f, 0.004f}, {0.035f, 0.26f, 0.004f}, 0.010f, 12), spade);
  return m;
}

}  // namespace fovea::scene::yard
