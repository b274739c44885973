// Furniture, pots and cloth of the balcony.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/scenes/builtin/balcony_parts.h"

namespace fovea::scene::balcony {

using namespace model;

namespace {

constexpr float kPi = glm::pi<float>();

}  // namespace

MeshBuilder bistroChair(const Palette& p) {
  MeshBuilder m;
  const uint32_t metal = p.cream;
  constexpr float kSeat = 0.45f, kBar = 0.011f;
  m.add(metal, torus(0.20f, kBar, 40, 8), at(0, kSeat, 0));
  for (int i = -3; i <= 3; ++i) {  // slats of the seat, bowed a little
    const float x = 0.053f * float(i), z = std::sqrt(0.198f * 0.198f - x * x);
    m.add(metal,
          sweep(smoothPath({{x, kSeat + 0.004f, -z}, {x, kSeat - 0.004f, 0}, {x, kSeat + 0.004f, z}}, 4),
                roundedRectangle(0.036f, 0.007f, 0.003f, 2), {.up = glm::vec3(0, 1, 0)}));
  }
  // Back legs and the hoop of the back are one bar.
  std::vector<glm::vec3> hoop = {{-0.19f, 0.006f, -0.27f}, {-0.185f, 0.24f, -0.215f},
                                 {-0.18f, kSeat, -0.165f}, {-0.178f, 0.66f, -0.20f},
                                 {-0.15f, 0.82f, -0.245f}, {0, 0.90f, -0.265f}};
  for (int i = 4; i >= 0; --i) hoop.push_back(hoop[size_t(i)] * glm::vec3(-1, 1, 1));
  m.add(metal, tube(smoothPath(hoop, 5), kBar, 8));
  for (const float s : {-1.0f, 1.0f}) {
    m.add(metal, tube(smoothPath({{s * 0.185f, 0.006f, 0.23f},
                                  {s * 0.17f, 0.24f, 0.175f},
                                  {s * 0.135f, kSeat - 0.004f, 0.145f}},
                                 5),
                      kBar, 8));
    for (const float z : {-0.27f, 0.23f})
      m.add(p.iron, sphere(0.015f, 10, 6), at(s * (z < 0 ? 0.19f : 0.185f), 0.0149f, z));
    // A heart of two curls within the hoop.
    std::vector<glm::vec3> curl;
    for (int i = 0; i <= 26; ++i) {
      const float t = float(i) / 26, a = -1.9f + 6.6f * t, r = 0.062f * (1 - 0.72f * t);
      const float x = 0.072f + r * std::cos(a), y = 0.735f + r * std::sin(a) * 1.15f;
      curl.push_back({s * x, y, -0.20f - 0.27f * (y - 0.66f)});
    }
    std::vector<glm::vec3> stem = {
        {s * 0.02f, kSeat + 0.004f, -0.197f}, {s * 0.008f, 0.56f, -0.18f}, {s * 0.02f, 0.64f, -0.193f}};
    stem.push_back(curl.front());
    m.add(metal, tube(smoothPath(stem, 4), 0.007f, 6));
    m.add(metal, tube(curl, 0.007f, 6));
  }
  m.add(metal, tube(smoothPath({{-0.183f, 0.25f, -0.213f}, {-0.12f, 0.21f, 0}, {-0.171f, 0.23f, 0.177f}}, 5),
                    0.007f, 6));
  m.add(metal, tube(smoothPath({{0.183f, 0.25f, -0.213f}, {0.12f, 0.21f, 0}, {0.171f, 0.23f, 0.177f}}, 5),
                    0.007f, 6));
  m.add(metal, tube({{-0.125f, 0.215f, -0.02f}, {0.125f, 0.215f, -0.02f}}, 0.007f, 6));
  return m;
}

MeshBuilder bistroTable(const Palette& p) {
  MeshBuilder m;
  Outline top({0, 0.715f});
  top.line(0.355f, 0.715f).arc(0.355f, 0.74f, 1, 6).line(0, 0.74f);
  m.add(p.stone, lathe(top, {.segments = 48}));
  m.add(p.cream, torus(0.345f, 0.009f, 48, 8), at(0, 0.709f, 0));
  Outline column({0, 0.16f});
  column.line(0.03f, 0.16f).arc(0.03f, 0.22f, 0.6f, 4).line(0.017f, 0.24f).line(0.015f, 0.42f);
  column.arc(0.015f, 0.47f, 0.9f, 5)
      .line(0.014f, 0.64f)
      .line(0.06f, 0.70f)
      .line(0.06f, 0.714f)
      .line(0, 0.714f);
  m.add(p.cream, lathe(column, {.segments = 20}));
  for (int i = 0; i < 3; ++i) {
    m.add(p.cream,
          tube(smoothPath({{0.005f, 0.30f, 0},
                           {0.07f, 0.27f, 0},
                           {0.13f, 0.14f, 0},
                           {0.20f, 0.045f, 0},
                           {0.29f, 0.014f, 0}},
                          5),
               0.013f, 8),
          turnY(120.0f * float(i) + 25));
    m.add(p.cream,
          tube(smoothPath({{0.01f, 0.52f, 0}, {0.08f, 0.53f, 0}, {0.15f, 0.62f, 0}, {0.26f, 0.705f, 0}}, 5),
               0.009f, 7),
          turnY(120.0f * float(i) + 25));
  }
  return m;
}

MeshBuilder tableware(const Palette& p) {
  MeshBuilder m;
  Outline bowl({0, 0});
  bowl.line(0.05f, 0).line(0.052f, 0.012f).curve({0.10f, 0.02f}, {0.125f, 0.05f}, {0.135f, 0.085f}, 7);
  bowl.line(0.128f, 0.087f).curve({0.115f, 0.05f}, {0.09f, 0.03f}, {0, 0.022f}, 7);
  const glm::mat4 dish = at(-0.07f, 0, -0.09f);
  m.add(p.glaze, lathe(bowl, {.segments = 36}), dish);
  Outline lemon({0, -0.047f});
  lemon.line(0.006f, -0.045f).curve({0.046f, -0.042f}, {0.046f, 0.034f}, {0.009f, 0.042f}, 8).line(0, 0.049f);
  const Shape fruit = lathe(lemon, {.segments = 16});
  const glm::vec3 heap[6] = {{0.045f, 0.065f, 0.02f},  {-0.04f, 0.066f, 0.045f}, {-0.03f, 0.064f, -0.05f},
                             {0.05f, 0.066f, -0.045f}, {0.0f, 0.110f, 0.0f},     {0.235f, 0.0335f, 0.125f}};
  for (int i = 0; i < 6; ++i)
    m.add(
        p.lemon, fruit,
        (i < 5 ? dish : glm::mat4(1)) * at(heap[i]) * turnY(71.0f * float(i)) * turnX(i < 5 ? 75.0f : 90.0f));
  Outline jug({0, 0});
  jug.line(0.055f, 0)
      .curve({0.10f, 0.05f}, {0.085f, 0.13f}, {0.045f, 0.165f}, 9)
      .curve({0.036f, 0.19f}, {0.045f, 0.21f}, {0.055f, 0.225f}, 5);
  jug.line(0.049f, 0.225f).curve({0.035f, 0.20f}, {0.03f, 0.17f}, {0.03f, 0.15f}, 4).line(0, 0.10f);
  m.add(p.white,
        lathe(jug, {.segments = 28,
                    .swell =
                        [](float a, float y) {
                          return 1 + (y > 0.18f ? 2.2f * (y - 0.18f) : 0.0f) *
                                         std::pow(std::max(0.0f, std::cos(a)), 6.0f) * 5;
                        }}),
        at(0.13f, 0, -0.14f) * turnY(140));
  m.add(
      p.white,
      tube(smoothPath({{-0.045f, 0.20f, 0}, {-0.10f, 0.19f, 0}, {-0.11f, 0.13f, 0}, {-0.078f, 0.08f, 0}}, 5),
           0.007f, 7),
      at(0.13f, 0, -0.14f) * turnY(140));
  Outline cup({0, 0});
  cup.line(0.022f, 0)
      .curve({0.038f, 0.01f}, {0.040f, 0.04f}, {0.041f, 0.062f}, 6)
      .line(0.037f, 0.062f)
      .curve({0.035f, 0.03f}, {0.03f, 0.012f}, {0, 0.01f}, 5);
  Outline saucer({0, 0});
  saucer.line(0.04f, 0).line(0.072f, 0.012f).line(0.070f, 0.015f).line(0.035f, 0.006f).line(0, 0.005f);
  for (const glm::vec2 c : {glm::vec2(-0.16f, 0.12f), glm::vec2(0.07f, 0.19f)}) {
    m.add(p.white, lathe(saucer, {.segments = 28}), at(c.x, 0, c.y));
    m.add(p.white, lathe(cup, {.segments = 24}), at(c.x, 0.005f, c.y));
    m.add(p.white, torus(0.016f, 0.0035f, 16, 6), at(c.x + 0.048f, 0.038f, c.y) * turnX(90));
  }
  // A book that was laid down open.
  for (const float s : {-1.0f, 1.0f}) {
    const Sheet page = sheet(6, 1, {0.12f, 0.17f}, [&](float u, float v) {
      return glm::vec3(s * 0.115f * u, 0.004f + 0.020f * std::sin(kPi * std::pow(u, 0.55f)),
                       (v - 0.5f) * 0.17f);
    });
    m.add(p.paper, surface(page, 0.007f),
          at(-0.005f, 0.005f, 0.14f - 0.02f) * turnY(24) * at(-0.16f, 0, -0.18f) * at(0, 0, 0.14f));
  }
  return m;
}

MeshBuilder lantern(const Palette& p) {
  MeshBuilder m;
  const uint32_t metal = p.iron;
  for (int i = 0; i < 5; ++i)  // a chain
    m.add(metal,
          bent(torus(0.012f, 0.0028f, 14, 6), [](glm::vec3 q) { return glm::vec3(q.x * 1.5f, q.y, q.z); }),
          at(0, -0.018f - 0.028f * float(i), 0) * turnY(90.0f * float(i)) * turnZ(90));
  m.add(metal, torus(0.028f, 0.004f, 20, 6), at(0, -0.175f, 0) * turnX(90));
  const LatheOptions six{.segments = 6, .creaseDegrees = 25};
  m.add(metal, lathe(Outline({{0, -0.285f},
                              {0.125f, -0.315f},
                              {0.13f, -0.305f},
                              {0.06f, -0.245f},
                              {0.045f, -0.215f},
                              {0.02f, -0.205f},
                              {0, -0.20f}}),
                     six));
  m.add(metal, lathe(Outline({{0, -0.62f},
                              {0.03f, -0.615f},
                              {0.095f, -0.60f},
                              {0.10f, -0.585f},
                              {0.085f, -0.578f},
                              {0, -0.578f}}),
                     six));
  m.add(metal, sphere(0.016f, 12, 8), at(0, -0.63f, 0));
  m.add(p.lampPane, lathe(Outline({{0, -0.58f}, {0.078f, -0.58f}, {0.108f, -0.312f}, {0, -0.312f}}), six));
  for (int i = 0; i < 6; ++i) {
    const float a = kPi * float(i) / 3, c = std::cos(a), s = std::sin(a);
    m.add(metal, tube({{0.082f * c, -0.582f, 0.082f * s}, {0.112f * c, -0.308f, 0.112f * s}}, 0.006f, 6));
    const float b = a + kPi / 3, cb = std::cos(b), sb = std::sin(b);
    m.add(metal, tube({{0.097f * c, -0.445f, 0.097f * s}, {0.097f * cb, -0.445f, 0.097f * sb}}, 0.004f, 5));
  }
  return m;
}

SubdivisionCage pillow(float width, float depth, float height, bool tufted) {
  constexpr uint32_t kCells = 4, kSide = kCells + 1;
  SubdivisionCage c;
  c.level = 2;
  // Upper and lower cover, joined by a narrow band.
  const auto point = [](uint32_t face, uint32_t i, uint32_t j) { return (face * kSide + j) * kSide + i; };
  for (uint32_t face = 0; face < 2; ++face)
    for (uint32_t j = 0; j < kSide; ++j)
      for (uint32_t i = 0; i < kSide; ++i) {
        const float x = 2 * float(i) / kCells - 1, z = 2 * float(j) / kCells - 1;
        float y = 0.5f * height * (0.25f + 0.95f * std::pow((1 - x * x) * (1 - z * z), 0.4f));
        if (tufted && i == kCells / 2 && j == kCells / 2) y *= 0.3f;
        // The sides are drawn in between the corners.
        const float px = x * (1 - 0.07f * x * x * (1 - z * z)), pz = z * (1 - 0.07f * z * z * (1 - x * x));
        c.positions.push_back({0.5f * width * px, face == 0 ? y : -y, 0.5f * depth * pz});
        c.uvs.push_back({0.5f * width * x, 0.5f * depth * z});
      }
  const auto quad = [&](uint32_t q0, uint32_t q1, uint32_t q2, uint32_t q3) {
    c.faceSizes.push_back(4);
    c.faceVertices.insert(c.faceVertices.end(), {q0, q1, q2, q3});
  };
  for (uint32_t j = 0; j < kCells; ++j)
    for (uint32_t i = 0; i < kCells; ++i) {
      quad(point(0, i, j), point(0, i, j + 1), point(0, i + 1, j + 1), point(0, i + 1, j));
      quad(point(1, i, j), point(1, i + 1, j), point(1, i + 1, j + 1), point(1, i, j + 1));
    }
  const auto band = [&](uint32_t i0, uint32_t j0, uint32_t i1,
                        uint32_t j1) {  // upper edge, seen from outside
    quad(point(0, i0, j0), point(1, i0, j0), point(1, i1, j1), point(0, i1, j1));
  };
  for (uint32_t i = 0; i < kCells; ++i) {
    band(i, kCells, i + 1, kCells);
    band(i + 1, 0, i, 0);
    band(kCells, i + 1, kCells, i);
    band(0, i, 0, i + 1);
  }
  c.faceUvs = c.faceVertices;
  return c;
}

MeshBuilder pot(uint32_t clay, uint32_t soil, PotShape shape, float r, float h) {
  MeshBuilder m;
  Outline o({0, 0});
  float ground = 0.9f * h, inner = 0.82f * r;
  if (shape == PotShape::Rim) {
    o.line(0.66f * r, 0).line(0.70f * r, 0.02f * h).line(0.90f * r, 0.78f * h).line(0.98f * r, 0.80f * h);
    o.arc(r, 0.97f * h, 0.15f, 4).line(0.96f * r, h).line(0.86f * r, h).line(0.82f * r, 0.86f * h);
  } else if (shape == PotShape::Belly) {
    o.line(0.58f * r, 0).curve({1.08f * r, 0.16f * h}, {1.18f * r, 0.60f * h}, {0.80f * r, 0.84f * h}, 12);
    o.curve({0.74f * r, 0.90f * h}, {0.80f * r, 0.93f * h}, {0.90f * r, 0.95f * h}, 4);
    o.arc(0.90f * r, h, 1, 5).line(0.76f * r, 0.98f * h).line(0.70f * r, 0.88f * h);
    inner = 0.72f * r;
  } else {
    const float wide = shape == PotShape::Trough ? 3.4f * r : 2 * r;
    const Outline outer = roundedRectangle(wide, 2 * r, 0.12f * r, 3);
    const Outline hole = roundedRectangle(wide - 0.3f * r, 1.7f * r, 0.08f * r, 3);
    m.add(clay, extrude(outer, {hole}, h - 0.03f, {.bevel = 0.006f}), at(0, 0.03f, 0) * turnX(-90));
    m.add(clay, extrude(outer.scaled({0.93f, 0.9f}), 0.05f), turnX(-90));
    m.add(soil, box({-0.5f * wide + 0.1f * r, 0.04f, -0.9f * r}, {0.5f * wide - 0.1f * r, ground, 0.9f * r}));
    return m;
  }
  m.add(clay, lathe(o, {.segments = 36}));
  if (shape == PotShape::Rim) m.add(clay, torus(0.825f * r, 0.016f * r, 36, 6), at(0, 0.5f * h, 0));
  m.add(soil, lathe(Outline({{inner * 1.03f, 0.87f * h}, {0.5f * inner, ground}, {0, 0.91f * h}}),
                    {.segments = 24}));
  return m;
}

Sheet awning(const AwningForm& f) {
  const float valance = f.valance, total = valance + f.depth + f.drop;
  return sheet(28, 21, {f.width, total}, [&](float u, float row) {
    // Rows of the net: 2 for the valance, 7 for the roof, 12 for the blind.
    const float j = row * 21;
    const float across = 4 * u * (1 - u);  // 0 where it is laced to wall and frame
    const float x = u * f.width, slope = f.slope * u;
    if (j < 2) {  // up to the front bar
      const float t = 1 - j / 2;
      const float scallop = 0.55f + 0.45f * std::abs(std::sin(7 * kPi * u));
      return glm::vec3(x, slope - valance * t * (j < 0.5f ? scallop : 1.0f),
                       t * (0.25f * f.wave * std::cos(9 * u - f.phase) + 0.02f));
    }
    if (j <= 9) {
      const float t = (j - 2) / 7;
      const float sag = std::sin(kPi * t) * (0.45f + 0.55f * across);
      return glm::vec3(
          x, slope - (0.075f - f.lift) * sag + 0.16f * f.wave * sag * std::sin(5 * t + 3 * u - f.phase),
          -f.depth * t);
    }
    const float t = (j - 9) / 12, free = smoothstep(0.0f, 0.8f, t);
    const float folds =
        0.022f * (0.4f + 0.6f * t) * std::cos(2 * kPi * (5.5f * u + 0.25f * noise({u * 4, t * 2}, 77)));
    const float run =
        f.wave * free * (0.45f + 0.55f * across) * std::sin(2 * kPi * (0.8f * t + 0.55f * u) - f.phase);
    return glm::vec3(
        x + 0.12f * f.wave * free * std::cos(2 * kPi * t - f.phase),
        slope * (1 - 0.5f * t) - f.drop * t + 0.10f * f.billow * free,
        -f.depth + folds + run +
            f.billow * std::sin(kPi * std::min(1.0f, 0.15f + 0.75f * t)) * (0.35f + 0.65f * across) * free);
  });
}

Shape hungCloth(float width, float height, uint32_t seed) {
  return surface(sheet(24, 18, {width, height}, [&](float u, float v) {
    // Pegs hold the upper edge; folds run down from them, and the hem moves in the wind.
    const float pegs = std::abs(std::sin(3 * kPi * u));
    return glm::vec3((u - 0.5f) * width * (1 - 0.04f * v), -height * v - 0.03f * (1 - v) * pegs - 0.01f,
                     0.035f * std::sin(6 * kPi * u + 2 * noise({u * 3, v * 2}, seed)) * (0.2f + v) +
                         0.12f * v * v * std::sin(3 * u + float(seed)));
  }));
}

Shape hungShirt(float size, uint32_t seed) {
  Outline o({-0.24f, -0.66f});
  o.line(0.24f, -0.66f)
      .line(0.235f, -0.22f)
      .line(0.36f, -0.36f)
      .line(0.45f, -0.27f)
      .line(0.26f, -0.02f)
      .line(0.11f, 0.0f);
  o.curve({0.06f, -0.07f}, {-0.06f, -0.07f}, {-0.11f, 0.0f}, 6)
      .line(-0.26f, -0.02f)
      .line(-0.45f, -0.27f)
      .line(-0.36f, -0.36f)
      .line(-0.235f, -0.22f);
  return bent(placed(extrude(o.scaled(glm::vec2(size)), 0.012f), glm::mat4(1)), [&](glm::vec3 q) {
    return q +
           glm::vec3(0, 0,
                     0.05f * std::sin(7 * q.x + float(seed)) - 0.12f * q.y * std::sin(float(seed) + q.y * 4));
  });
}

}  // namespace fovea::scene::balcony
