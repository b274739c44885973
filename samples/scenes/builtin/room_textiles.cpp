// The daybed, the rug, the window and its curtains.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/scenes/builtin/modelling/upholstery.h"
#include "samples/scenes/builtin/room_parts.h"

namespace fovea::scene::room {

using namespace model;

namespace {

constexpr float kPi = glm::pi<float>();

}  // namespace

MeshBuilder daybed(const Palette& p) {
  constexpr float w = 1.02f, d = 0.90f;
  MeshBuilder m;
  const BoxOptions soft = {.bevel = 0.006f, .bevelSteps = 3};
  for (const float x : {-w, w}) {
    const float h = x > 0 ? 0.86f : 0.62f;
    for (const float z : {0.035f, d - 0.035f}) {
      m.add(p.oak, block(0.06f, h, 0.06f, soft), at(x, 0, z));
      m.add(p.oak, knob(0.032f), at(x, h - 0.004f, z));
    }
    m.add(p.oakAcross, box({x - 0.018f, h - 0.13f, 0.06f}, {x + 0.018f, h - 0.02f, d - 0.06f}, soft));
    m.add(p.oakAcross, box({x - 0.016f, 0.20f, 0.06f}, {x + 0.016f, 0.34f, d - 0.06f}, soft));
    for (int i = 0; i < 6; ++i)
      m.add(p.oak, cylinder(0.011f, h - 0.13f - 0.34f + 0.02f, 16), at(x, 0.33f, 0.13f + 0.128f * float(i)));
  }
  for (const float z : {0.03f, d - 0.03f})
    m.add(p.oakAcross, box({-w + 0.02f, 0.19f, z - 0.014f}, {w - 0.02f, 0.34f, z + 0.014f}, soft));
  // Mattress, sheet, and a blanket that falls over the front.
  m.add(p.linen, bent(
                     box({-w + 0.035f, 0.27f, 0.05f}, {w - 0.035f, 0.46f, d - 0.05f},
                         {.bevel = 0.06f, .bevelSteps = 6, .cells = {16, 2, 8}}),
                     [](glm::vec3 q) {
                       return q + glm::vec3(0,
                                            0.012f * smoothstep(0.3f, 0.46f, q.y) *
                                                (2 * noise({6 * q.x, 6 * q.z}, 571) - 1),
                                            0);
                     },
                     60));
  const Sheet blanket = sheet(80, 60, {1.25f, 1.05f}, [&](float u, float v) {
    const float x = -0.90f + 1.24f * u, along = 0.10f + 1.02f * v, front = d - 0.012f;
    const float wrinkle =
        0.012f * (fractal({5.5f * x + 9 + 2.4f * along, 4 * along - 1.5f * x}, 572, 4) - 0.3f);
    const float top = 0.482f + std::abs(wrinkle) + 0.006f;
    // Over a rounded edge of radius r, then down in soft folds.
    const float r = 0.075f, turn = along - (front - r);
    const float px = x + 0.02f * std::sin(7 * along) * (u - 0.5f);
    if (turn < 0) return glm::vec3(px, top, along);
    const float a = std::min(turn / r, 0.5f * kPi), down = std::max(turn - 0.5f * kPi * r, 0.0f);
    const float fold = smoothstep(0.0f, 0.16f, down) *
                       (0.014f * std::sin(21 * x + 2 * std::sin(5 * x)) + 0.007f * std::sin(47 * x));
    return glm::vec3(px, top - r * (1 - std::cos(a)) - down * (0.97f + 0.05f * std::sin(3.1f * x)),
                     front - r + r * std::sin(a) + 0.022f * smoothstep(0, 0.05f, down) + fold);
  });
  m.add(p.blanket, surface(blanket, 0.010f));
  // Pillows lean against the head; two lie against the wall.
  const auto put = [&](uint32_t cloth, float x, float y, float z, float size, float turn, float lean,
                       uint32_t seed, float aspect = 1) {
    m.add(cloth, cushion(size * aspect, size, 0.30f * size, seed), at(x, y, z) * turnY(turn) * turnX(lean));
  };
  put(p.linen, 0.80f, 0.63f, 0.45f, 0.42f, -80, -24, 581, 1.5f);
  put(p.cloth[0], 0.42f, 0.665f, 0.23f, 0.43f, -22, -20, 582);
  put(p.cloth[2], -0.06f, 0.655f, 0.18f, 0.40f, 6, -20, 583);
  put(p.cloth[4], 0.52f, 0.635f, 0.50f, 0.34f, -62, -30, 584);
  put(p.cloth[1], -0.60f, 0.64f, 0.17f, 0.36f, 12, -18, 585);
  m.add(teddy(p), at(-0.36f, 0.492f, 0.36f) * turnY(14));
  return m;
}

MeshBuilder rug(const Palette& p) {
  MeshBuilder m;
  // Pile in low ribs, its edges and one corner slightly turned up.
  const Sheet s = sheet(112, 72, kRug, [](float u, float v) {
    const float x = (u - 0.5f) * kRug.x, z = (v - 0.5f) * kRug.y;
    const float edge = std::min(0.5f * kRug.x - std::abs(x), 0.5f * kRug.y - std::abs(z));
    const float lift = 0.030f * std::pow(smoothstep(1.55f, 2.0f, u + v), 2.0f);
    return glm::vec3(x,
                     kRugHeight - 0.004f - 0.003f * (1 - smoothstep(0, 0.02f, edge)) +
                         0.0016f * fractal({x * 24, z * 24}, 591, 2) + lift,
                     z);
  });
  m.add(p.rug, surface(s, 0.006f));
  // Fringes at both ends.
  for (const float side : {-1.0f, 1.0f})
    for (int i = 0; i < 128; ++i) {
      const uint32_t k = uint32_t(i) * 2 + (side > 0 ? 1u : 0u);
      const float z = kRug.y * ((float(i) + 0.5f) / 128 - 0.5f), x = side * (0.5f * kRug.x - 0.004f);
      const float l = random(592, k, 0.055f, 0.08f), bend = random(593, k, -0.012f, 0.012f);
      const float up = side > 0 ? 0.030f * std::pow(smoothstep(1.55f, 2.0f, 1.5f + z / kRug.y), 2.0f) : 0.0f;
      m.add(p.fringe, tube(
                          smoothPath({{x, 0.009f + up, z},
                                      {x + side * 0.3f * l, 0.0075f + up, z + 0.3f * bend},
                                      {x + side * 0.7f * l, 0.0045f + 0.5f * up, z + bend},
                                      {x + side * l, 0.0042f + 0.2f * up, z + 1.4f * bend}},
                                     2),
                          [](float t) { return 0.0042f - 0.0012f * t; }, 5));
    }
  return m;
}

MeshBuilder windowFrame(const Palette& p, float w, float h) {
  MeshBuilder m;
  const BoxOptions soft = {.bevel = 0.004f, .bevelSteps = 2};
  const float x = 0.5f * w, transom = 0.78f * h;
  // Frame in the hole; its inner face at z = -0.06.
  for (const float s : {-1.0f, 1.0f})
    m.add(p.paint, box({s > 0 ? x - 0.045f : -x - 0.002f, 0, -0.14f},
                       {s > 0 ? x + 0.002f : -x + 0.045f, h, -0.07f}, soft));
  m.add(p.paint, box({-x, -0.002f, -0.139f}, {x, 0.045f, -0.071f}, soft))
      .add(p.paint, box({-x, h - 0.045f, -0.139f}, {x, h + 0.002f, -0.071f}, soft));
  m.add(p.paint, box({-x, transom - 0.028f, -0.145f}, {x, transom + 0.028f, -0.065f}, soft));
  m.add(p.paint, box({-0.032f, 0.01f, -0.142f}, {0.032f, h - 0.01f, -0.068f}, soft));
  for (const float s : {-1.0f, 1.0f}) {
    const float a = s > 0 ? 0.032f : -x + 0.045f, b = s > 0 ? x - 0.045f : -0.032f;
    for (const auto& [low, high] :
         {std::pair{0.045f, transom - 0.028f}, std::pair{transom + 0.028f, h - 0.045f}}) {
      m.add(p.paint, box({a - 0.001f, low - 0.001f, -0.125f}, {a + 0.036f, high + 0.001f, -0.085f}, soft))
          .add(p.paint, box({b - 0.036f, low - 0.001f, -0.125f}, {b + 0.001f, high + 0.001f, -0.085f}, soft));
      m.add(p.paint, box({a, low - 0.001f, -0.1245f}, {b, low + 0.036f, -0.0855f}, soft))
          .add(p.paint, box({a, high - 0.036f, -0.1245f}, {b, high + 0.001f, -0.0855f}, soft));
    }
    // A glazing bar across each lower light.
    m.add(p.paint, box({a + 0.03f, 0.52f * transom - 0.009f, -0.117f},
                       {b - 0.03f, 0.52f * transom + 0.009f, -0.093f}, {.bevel = 0.003f}));
  }
  m.add(p.brass, box({-0.010f, 0.40f * h, -0.068f}, {0.010f, 0.40f * h + 0.09f, -0.062f}, {.bevel = 0.002f}));
  m.add(p.brass, tube(smoothPath({{0, 0.40f * h + 0.05f, -0.064f},
                                  {0, 0.40f * h + 0.05f, -0.035f},
                                  {0.004f, 0.40f * h + 0.02f, -0.030f},
                                  {0.008f, 0.40f * h - 0.04f, -0.030f}},
                                 5),
                      0.006f, 12));
  // Casing on the wall, and the sill.
  for (const float s : {-1.0f, 1.0f})
    m.add(p.paint,
          box({s > 0 ? x : -x - 0.085f, -0.02f, -0.01f}, {s > 0 ? x + 0.085f : -x, h + 0.0f, 0.022f}, soft));
  m.add(p.paint, box({-x - 0.10f, h, -0.01f}, {x + 0.10f, h + 0.10f, 0.028f}, soft));
  m.add(p.paint,
        box({-x - 0.12f, -0.030f, -0.10f}, {x + 0.12f, 0.006f, 0.10f}, {.bevel = 0.010f, .bevelSteps = 4}));
  return m;
}

MeshBuilder curtainRod(const Palette& p, float width) {
  MeshBuilder m;
  const float x = 0.5f * width;
  m.add(p.brass, tube({{-x, 0, 0}, {x, 0, 0}}, 0.0125f, 20));
  for (const float s : {-1.0f, 1.0f}) {
    Outline o({0, 0});
    o.line(0.0125f, 0)
        .line(0.019f, 0.004f)
        .line(0.019f, 0.010f)
        .line(0.012f, 0.014f)
        .curve({0.012f, 0.02f}, {0.032f, 0.024f}, {0.030f, 0.045f}, 6)
        .curve({0.028f, 0.062f}, {0.01f, 0.07f}, {0, 0.078f}, 6);
    m.add(p.brass, lathe(o, {.segments = 32}), at(s * x, 0, 0) * turnZ(-90 * s));
    m.add(p.brass, tube(smoothPath({{s * (x - 0.06f), -0.035f, -0.12f},
                                    {s * (x - 0.06f), -0.035f, -0.05f},
                                    {s * (x - 0.06f), -0.016f, 0}},
                                   5),
                        0.008f, 10));
    m.add(p.brass, cylinder(0.024f, 0.012f, 24, 0.002f), at(s * (x - 0.06f), -0.035f, -0.122f) * turnX(90));
  }
  return m;
}

Sheet curtain(const CurtainForm& f, uint32_t columns, uint32_t rows) {
  return sheet(columns, rows, {1.7f * f.width, f.height}, [&](float u, float v) {
    // Pleats that begin sharp at the rings and widen; tied back at 0.55 of the height.
    const float tie = f.gather * std::exp(-std::pow((v - 0.58f) / (v < 0.58f ? 0.30f : 0.42f), 2.0f));
    const float wide = 1 - 0.74f * tie;
    const float wander = 0.30f * (2 * noise({u * 4, v * 1.8f}, f.seed) - 1) * smoothstep(0, 0.5f, v);
    const float turn = 2 * kPi * (f.folds * u + wander);
    const float deep = (0.030f + 0.022f * smoothstep(0, 0.6f, v)) *
                       (0.75f + 0.5f * noise({u * f.folds, 5}, f.seed + 1)) * (0.7f + 0.3f * wide);
    const float free = smoothstep(0.02f, 1.0f, v);
    const float x = f.width * u * wide + 0.35f * deep * std::sin(2 * turn) * wide;
    const float z = deep * std::cos(turn) + f.billow * free * (0.35f + 0.65f * u) +
                    f.wave * free * std::sin(2 * kPi * (0.9f * v + 0.55f * u) - f.phase);
    const float y = -f.height * v + 0.5f * std::abs(f.billow) * f.billow * free +
                    0.02f * std::cos(turn) * smoothstep(0.9f, 1, v);
    return glm::vec3(x + 0.3f * f.wave * free * std::cos(2 * kPi * v - f.phase) + 0.42f * f.billow * free, y,
                     z);
  });
}

}  // namespace fovea::scene::room
