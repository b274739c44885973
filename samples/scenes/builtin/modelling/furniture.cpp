#include "samples/scenes/builtin/modelling/furniture.h"

#include <cmath>

#include "samples/scenes/builtin/modelling/textures.h"
#include "samples/scenes/builtin/modelling/upholstery.h"

namespace fovea::scene::model {

Stock makeStock(SceneBuilder& b, uint32_t seed) {
  Stock s{};
  s.plaster = b.texture(plaster("plaster", glm::vec3(0.92f), 0.08f, 0.02f, 512, seed));
  s.planks =
      b.texture(boards("planks", 5, {0.60f, 0.52f, 0.44f}, {0.95f, 0.90f, 0.84f}, 512, seed + 1, 0.006f));
  s.grain =
      b.texture(boards("grain", 2, {0.68f, 0.62f, 0.55f}, {0.94f, 0.90f, 0.85f}, 512, seed + 2, 0.0005f));
  s.linen = b.texture(weave("linen", glm::vec3(0.94f), 64, 512, seed + 3));
  s.mottled = b.texture(ground("mottled", glm::vec3(0.74f), glm::vec3(0.96f), 0.08f, 256, seed + 4));
  return s;
}

MeshBuilder sofa(const SeatLook& look, float width, int seats) {
  MeshBuilder m;
  const float x = 0.5f * width, arm = 0.20f, inner = width - 2 * arm, depth = 0.86f;
  const BoxOptions soft = {.bevel = 0.02f, .bevelSteps = 3};
  m.add(look.cover, box({-x + 0.02f, 0.11f, 0.03f}, {x - 0.02f, 0.27f, depth - 0.03f}, soft));
  for (int i = 0; i < seats; ++i) {
    const float w = inner / float(seats), middle = -0.5f * inner + w * (float(i) + 0.5f);
    m.add(look.cover, channelPad({w - 0.006f, 0.17f, 0.64f}, 4), at(middle, 0.265f, depth - 0.34f));
  }
  m.add(look.cover, box({-x + arm - 0.02f, 0.2f, 0.0f}, {x - arm + 0.02f, 0.72f, 0.12f}, soft));
  m.add(look.cover, buttonedPad({inner + 0.02f, 0.18f, 0.52f}, 3 * seats, 4),
        at(0, 0.56f, 0.10f) * turnX(80));
  m.add(look.cover, cylinder(0.085f, inner + 0.02f, 24, 0.02f),
        at(0.5f * inner + 0.01f, 0.76f, 0.07f) * turnZ(90));
  for (const float side : {-1.0f, 1.0f}) {
    const float middle = side * (x - 0.5f * arm);
    m.add(look.cover, box({middle - 0.075f, 0.12f, 0.01f}, {middle + 0.075f, 0.58f, depth - 0.02f}, soft));
    m.add(look.cover, cylinder(0.105f, depth + 0.01f, 28, 0.03f), at(middle, 0.58f, 0.0f) * turnX(90));
    m.add(look.legs, sphere(0.016f, 12, 8), at(middle, 0.58f, depth + 0.008f));
    for (const float z : {0.08f, depth - 0.10f}) {
      Outline leg({0, 0});
      leg.line(0.022f, 0).through({{0.020f, 0.03f}, {0.038f, 0.08f}, {0.034f, 0.115f}}, 4).line(0, 0.115f);
      m.add(look.legs, lathe(leg, {.segments = 16}), at(side * (x - 0.10f), 0, z));
    }
  }
  const float y = 0.43f;
  m.add(look.cushion[0], roundCushion(0.21f, 0.17f),
        at(-0.5f * inner + 0.22f, y + 0.20f, 0.40f) * turnY(22) * turnX(66));
  if (seats > 1) {
    m.add(look.cushion[1], cushion(0.42f, 0.42f, 0.14f, 711),
          at(0.5f * inner - 0.24f, y + 0.20f, 0.36f) * turnY(-18) * turnX(-22));
    m.add(look.cushion[2], cushion(0.34f, 0.34f, 0.12f, 712),
          at(0.5f * inner - 0.46f, y + 0.16f, 0.47f) * turnY(-8) * turnX(-30));
  }
  return m;
}

MeshBuilder pouffe(uint32_t cover, uint32_t legs, float radius, float height) {
  MeshBuilder m;
  const float r = radius, h = height;
  Outline o({0, 0.04f * h});
  o.line(0.90f * r, 0.04f * h)
      .curve({1.03f * r, 0.2f * h}, {1.05f * r, 0.75f * h}, {0.92f * r, 0.92f * h}, 12);
  o.curve({0.75f * r, 1.03f * h}, {0.3f * r, 1.02f * h}, {0.06f * r, 0.97f * h}, 10).line(0, 0.955f * h);
  m.add(cover, lathe(o, {.segments = 160, .creaseDegrees = 60, .swell = [](float a, float) {
                           return 0.94f + 0.06f * std::sqrt(std::abs(std::sin(10 * a)));
                         }}));
  for (int i = 0; i < 4; ++i)
    m.add(legs, cylinder(0.06f * r, 0.06f * h, 12), turnY(45 + 90 * float(i)) * at(0.7f * r, 0, 0));
  return m;
}

MeshBuilder paddedBench(uint32_t cover, uint32_t legs, float width, float depth) {
  MeshBuilder m;
  const float x = 0.5f * width, z = 0.5f * depth;
  m.add(cover,
        buttonedPad({width, 0.12f, depth}, int(std::round(width / 0.2f)), int(std::round(depth / 0.14f))),
        at(0, 0.34f, 0));
  m.add(legs, box({-x + 0.02f, 0.30f, -z + 0.02f}, {x - 0.02f, 0.345f, z - 0.02f}, {.bevel = 0.004f}));
  for (const float sx : {-1.0f, 1.0f})
    for (const float sz : {-1.0f, 1.0f})
      m.add(legs, box({-0.018f, 0, -0.018f}, {0.018f, 0.31f, 0.018f}, {.bevel = 0.003f}),
            at(sx * (x - 0.10f), 0, sz * (z - 0.05f)));
  return m;
}

MeshBuilder roundTable(uint32_t wood, float radius, float height) {
  MeshBuilder m;
  const float r = radius, h = height;
  m.add(wood, cylinder(r, 0.03f, 64, 0.008f), at(0, h - 0.03f, 0));
  Outline leg({0, 0.05f});
  leg.line(0.06f, 0.05f)
      .through({{0.028f, 0.2f * h}, {0.05f, 0.4f * h}, {0.025f, 0.7f * h}, {0.06f, h - 0.028f}}, 6);
  leg.line(0, h - 0.028f);
  m.add(wood, lathe(leg, {.segments = 32}));
  for (int i = 0; i < 3; ++i) {
    const std::vector<glm::vec3> foot = smoothPath(
        {{0.02f, 0.11f, 0}, {0.4f * r, 0.09f, 0}, {0.7f * r, 0.022f, 0}, {0.78f * r, 0.02f, 0}}, 6);
    m.add(wood,
          tube(
              foot, [](float t) { return 0.024f - 0.006f * t; }, 12),
          turnY(120 * float(i) + 20));
  }
  return m;
}

MeshBuilder rectTable(uint32_t wood, float width, float depth, float height) {
  MeshBuilder m;
  const float x = 0.5f * width, z = 0.5f * depth;
  m.add(wood, box({-x, height - 0.035f, -z}, {x, height, z}, {.bevel = 0.006f, .bevelSteps = 2}));
  m.add(wood, box({-x + 0.06f, height - 0.12f, -z + 0.06f}, {x - 0.06f, height - 0.034f, z - 0.06f}));
  for (const float sx : {-1.0f, 1.0f})
    for (const float sz : {-1.0f, 1.0f})
      m.add(wood, box({-0.03f, 0, -0.03f}, {0.03f, height - 0.034f, 0.03f}, {.bevel = 0.004f}),
            at(sx * (x - 0.075f), 0, sz * (z - 0.075f)));
  return m;
}

void addShell(MeshBuilder& m, const Shell& s) {
  const float x = s.x + s.thick, low = -s.thick, high = s.height + s.thick, e = 0.5f * s.thick;
  m.add(s.wall, box({-x, low, s.back - s.thick}, {x, high, s.back}));
  m.add(s.wall, box({-x, low, s.back - e}, {-s.x, high, s.front + (s.closed ? e : 0.0f)}));
  m.add(s.wall, box({s.x, low, s.back - e}, {x, high, s.front + (s.closed ? e : 0.0f)}));
  const float end = s.closed ? s.front + e : s.front - 0.02f * s.thick;
  m.add(s.floor, box({-s.x - e, low + 0.1f * s.thick, s.back - e}, {s.x + e, 0, end}));
  m.add(s.ceiling, box({-s.x - e, s.height, s.back - e}, {s.x + e, high - 0.1f * s.thick, end}));
  if (s.closed) m.add(s.wall, box({-x, low, s.front}, {x, high, s.front + s.thick}));
}

void addSkirting(MeshBuilder& m, const Shell& s, uint32_t paint, float height) {
  const float t = 0.14f * height;
  m.add(paint, box({-s.x - t, -t, s.back - t}, {s.x + t, height, s.back + t}, {.bevel = 0.2f * t}));
  for (const float side : {-1.0f, 1.0f})
    m.add(paint,
          box({side * s.x - t, -t, s.back - t}, {side * s.x + t, height, s.front}, {.bevel = 0.2f * t}));
  if (s.closed)
    m.add(paint, box({-s.x - t, -t, s.front - t}, {s.x + t, height, s.front + t}, {.bevel = 0.2f * t}));
}

MeshBuilder framed(uint32_t frame, uint32_t picture, float width, float height) {
  MeshBuilder m;
  const float x = 0.5f * width, y = 0.5f * height;
  for (const float side : {-1.0f, 1.0f}) {
    const float a = side > 0 ? x : -x - 0.04f, b = side > 0 ? y : -y - 0.04f;
    m.add(frame, box({a, -y - 0.04f, -0.01f}, {a + 0.04f, y + 0.04f, 0.035f}, {.bevel = 0.006f}));
    m.add(frame, box({-x - 0.001f, b, -0.01f}, {x + 0.001f, b + 0.04f, 0.034f}, {.bevel = 0.006f}));
  }
  m.add(picture, box({-x - 0.005f, -y - 0.005f, -0.008f}, {x + 0.005f, y + 0.005f, 0.015f}));
  return m;
}

uint32_t painting(SceneBuilder& b, const std::string& name, float width, float height, uint32_t seed) {
  const auto color = [seed](uint32_t i) {
    const float hue = random(seed, i) * 6.2832f, value = random(seed + 1, i, 0.25f, 0.85f);
    return value * (glm::vec3(0.62f) + 0.30f * glm::cos(glm::vec3(hue, hue + 2.1f, hue + 4.2f)));
  };
  const uint32_t texture = b.texture(bake(name, 256, 256, [&](float u, float v) {
    glm::vec3 c = glm::mix(color(0), color(1), fractal({3 * u, 3 * v}, seed, 4));
    for (uint32_t i = 2; i < 7; ++i) {
      const glm::vec2 middle(random(seed + 2, i, 0.15f, 0.85f), random(seed + 3, i, 0.15f, 0.85f));
      const glm::vec2 half(random(seed + 4, i, 0.06f, 0.28f), random(seed + 5, i, 0.06f, 0.24f));
      const glm::vec2 q = glm::abs(glm::vec2(u, v) - middle) / half;
      const float d = i % 2 == 0 ? std::max(q.x, q.y) : glm::length(q);
      const float ragged = d + 0.12f * (noise({24 * u, 24 * v}, seed + i) - 0.5f);
      c = glm::mix(color(i), c, smoothstep(0.97f, 1.0f, ragged));
    }
    return glm::min(c * (0.9f + 0.15f * fractal({40 * u, 12 * v}, seed + 9, 3)), glm::vec3(0.88f));
  }));
  return b.material(
      name, glm::vec3(1),
      {.texture = texture, .metres = width, .metresHigh = height, .offset = {0.5f * width, 0.5f * height}});
}

Shape railing(float width, float height, int count, float radius) {
  Shape s;
  for (const float y : {0.08f * height, height})
    append(s, tube({{0, y, 0}, {width, y, 0}}, 1.8f * radius, 8));
  for (int i = 0; i < count; ++i) {
    const float x = width * (float(i) + 0.5f) / float(count);
    append(s, tube({{x, 0.08f * height, 0}, {x, height, 0}}, radius, 6));
  }
  for (const float x : {0.0f, width}) append(s, tube({{x, 0, 0}, {x, 1.02f * height, 0}}, 2.2f * radius, 8));
  return s;
}

Shape shade(float lower, float upper, float height) {
  const float t = 0.02f * lower;
  return lathe(Outline({{lower, 0}, {upper, height}, {upper - t, height}, {lower - t, 0}}),
               {.segments = 48, .closed = true});
}

Shape vase() {
  Outline o({0, 0});
  o.line(0.05f, 0)
      .through({{0.085f, 0.08f}, {0.05f, 0.18f}, {0.03f, 0.24f}, {0.045f, 0.28f}}, 5)
      .line(0, 0.27f);
  return lathe(o, {.segments = 40});
}

void addPot(MeshBuilder& m, uint32_t clay, uint32_t soil, float radius, float height,
            const glm::mat4& where) {
  const float r = radius, h = height;
  Outline o({0, 0});
  o.line(0.68f * r, 0).line(0.92f * r, 0.78f * h).line(r, 0.78f * h).line(r, h).line(0.88f * r, h);
  o.line(0.84f * r, 0.88f * h).line(0, 0.88f * h);
  m.add(clay, lathe(o, {.segments = 32}), where);
  Outline earth({0, 0.80f * h});
  earth.line(0.86f * r, 0.80f * h).line(0.84f * r, 0.89f * h).line(0, 0.915f * h);
  m.add(soil, lathe(earth, {.segments = 24}), where);
}

void addBooks(MeshBuilder& m, const uint32_t (&covers)[3], uint32_t paper, int count, float height,
              uint32_t seed, const glm::mat4& where) {
  float x = 0;
  for (uint32_t i = 0; i < uint32_t(count); ++i) {
    const float w = height * random(seed, i, 0.09f, 0.2f), h = height * random(seed + 1, i, 0.78f, 1.0f);
    const float d = height * random(seed + 2, i, 0.6f, 0.72f), c = 0.02f * height;
    m.add(covers[i % 3], box({x, 0, -d}, {x + 0.1f * w, h, 0}), where);
    m.add(covers[i % 3], box({x + 0.9f * w, 0, -d}, {x + w, h, 0}), where);
    m.add(covers[i % 3], box({x + 0.001f * w, 0.001f * h, -c}, {x + 0.999f * w, 0.999f * h, 0.1f * c}),
          where);
    m.add(paper, box({x + 0.05f * w, 0.02f * h, -d + c}, {x + 0.95f * w, 0.97f * h, -0.5f * c}), where);
    x += 1.03f * w;
  }
}

void addPoint(SceneBuilder& b, const std::string& name, glm::vec3 color, float intensity, glm::vec3 where) {
  Light l;
  l.name = name;
  l.type = LightType::Point;
  l.color = color;
  l.intensity = intensity;
  l.position = where;
  b.scene.lights.push_back(l);
}

void addSpot(SceneBuilder& b, const std::string& name, glm::vec3 color, float intensity, glm::vec3 where,
             glm::vec3 direction, float inner, float outer) {
  Light l;
  l.name = name;
  l.type = LightType::Spot;
  l.color = color;
  l.intensity = intensity;
  l.position = where;
  l.direction = glm::normalize(direction);
  l.innerConeAngle = glm::radians(inner);
  l.outerConeAngle = glm::radians(outer);
  b.scene.lights.push_back(l);
}

}  // namespace fovea::scene::model
