// Materials and furniture of the room.
#include "framework/scene/builtin/room_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "framework/scene/builtin/textures.h"

namespace fovea::scene::room {

using namespace model;

namespace {

constexpr float kPi = glm::pi<float>();

float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

// A blue rug: a border with diamonds, stars in the field, a ring in the middle.
Texture rugPicture() {
  const glm::vec3 ground(0.05f, 0.17f, 0.62f), dark(0.02f, 0.05f, 0.24f), pale(0.62f, 0.66f, 0.70f),
      sand(0.70f, 0.50f, 0.20f);
  return bake("rug", 768, 560, [=](float u, float v) {
    const glm::vec2 q((u - 0.5f) * kRug.x, (v - 0.5f) * kRug.y);
    const float edge = std::min(0.5f * kRug.x - std::abs(q.x), 0.5f * kRug.y - std::abs(q.y));
    glm::vec3 c = ground;
    const auto band = [&](float low, float high, glm::vec3 color) {
      c = glm::mix(c, color,
                   smoothstep(low - 0.004f, low, edge) * (1 - smoothstep(high, high + 0.004f, edge)));
    };
    band(-1, 0.17f, dark);
    band(0.035f, 0.05f, pale);
    band(0.15f, 0.165f, pale);
    const float along = 0.5f * kRug.y - std::abs(q.y) < 0.5f * kRug.x - std::abs(q.x) ? q.x : q.y;
    const float cell = 0.1311f, x = std::abs(along / cell - std::floor(along / cell) - 0.5f);
    if (x / 0.30f + std::abs(edge - 0.10f) / 0.034f < 1) c = sand;
    if (edge > 0.2f) {
      const glm::vec2 g(q.x / 0.24f + (int(std::floor(q.y / 0.24f)) & 1 ? 0.5f : 0.0f), q.y / 0.24f);
      const glm::vec2 in = (g - glm::floor(g) - 0.5f) * 0.24f;
      const float a = std::atan2(in.y, in.x), r = glm::length(in);
      if (r < 0.026f + 0.012f * std::cos(5 * a)) c = pale;
    }
    const float weave = 0.94f + 0.06f * std::sin(u * 768 * 0.8f) * std::sin(v * 560 * 0.8f);
    return c * weave * (0.88f + 0.24f * fractal({u * 9, v * 7}, 411, 4));
  });
}

Texture globeMap() {
  return bake("globe", 384, 192, [](float u, float v) {
    // Land where the noise over the sphere is high; ice at the poles.
    const float lat = kPi * (0.5f - v), lon = 2 * kPi * u;
    const glm::vec3 d(std::cos(lat) * std::cos(lon), std::sin(lat), std::cos(lat) * std::sin(lon));
    const float land = fractal({2.1f * d.x + 1.3f * d.y + 7, 2.1f * d.z - 0.9f * d.y + 3}, 421, 5);
    glm::vec3 c = glm::mix(glm::vec3(0.05f, 0.20f, 0.45f), glm::vec3(0.10f, 0.34f, 0.52f),
                           smoothstep(0.42f, 0.52f, land));
    if (land > 0.52f)
      c = glm::mix(glm::vec3(0.20f, 0.36f, 0.10f), glm::vec3(0.60f, 0.48f, 0.22f),
                   smoothstep(0.54f, 0.66f, land));
    return glm::mix(c, glm::vec3(0.82f), smoothstep(0.40f, 0.46f, std::abs(v - 0.5f)));
  });
}

// What hangs on the walls: hills under a sky, a boat, a sun of crayon.
Texture pictureOf(int kind) {
  const char* names[4] = {"hills", "boat", "balloon", "drawing"};
  return bake(names[kind], 192, 192, [kind](float u, float v) {
    const float n = 0.9f + 0.2f * fractal({u * 12, v * 12}, 431u + uint32_t(kind), 4);
    glm::vec3 c(0.80f, 0.78f, 0.70f);
    if (kind == 0) {
      c = glm::mix(glm::vec3(0.26f, 0.50f, 0.74f), glm::vec3(0.80f, 0.70f, 0.55f), v * 1.4f);
      if (glm::length(glm::vec2(u - 0.72f, v - 0.25f)) < 0.09f) c = {0.85f, 0.60f, 0.14f};
      for (int i = 0; i < 4; ++i) {
        const float h = 0.42f + 0.14f * float(i) + 0.07f * std::sin(u * (5 + float(i)) + 2.3f * float(i));
        if (v > h) c = glm::mix(glm::vec3(0.32f, 0.46f, 0.36f), glm::vec3(0.10f, 0.28f, 0.07f), float(i) / 3);
      }
    } else if (kind == 1) {
      c = v < 0.62f ? glm::vec3(0.72f, 0.76f, 0.74f) : glm::vec3(0.05f, 0.26f, 0.40f);
      if (v > 0.30f && v < 0.58f && u > 0.5f && u - 0.5f < (v - 0.30f) * 0.9f) c = {0.75f, 0.14f, 0.08f};
      if (v > 0.24f && v < 0.58f && u < 0.485f && 0.485f - u < (v - 0.24f) * 0.7f) c = {0.80f, 0.78f, 0.68f};
      if (v > 0.60f && v < 0.70f && std::abs(u - 0.5f) < 0.27f - (v - 0.60f)) c = {0.30f, 0.15f, 0.07f};
    } else if (kind == 2) {
      c = glm::mix(glm::vec3(0.85f, 0.60f, 0.30f), glm::vec3(0.80f, 0.74f, 0.62f), v);
      const float r = glm::length(glm::vec2(u - 0.5f, (v - 0.40f) * 0.9f));
      if (r < 0.24f)
        c = int(std::floor((u - 0.26f) / 0.096f)) % 2 ? glm::vec3(0.70f, 0.10f, 0.12f)
                                                      : glm::vec3(0.08f, 0.22f, 0.50f);
      if (std::abs(u - 0.5f) < 0.05f && v > 0.76f && v < 0.84f) c = {0.32f, 0.18f, 0.08f};
    } else {
      const float r = glm::length(glm::vec2(u - 0.3f, v - 0.32f)), a = std::atan2(v - 0.32f, u - 0.3f);
      if (r < 0.12f || (r < 0.22f && std::cos(9 * a) > 0.75f)) c = {0.85f, 0.55f, 0.06f};
      if (v > 0.78f + 0.04f * std::sin(40 * u)) c = {0.12f, 0.42f, 0.10f};
      if (std::abs(u - 0.70f) < 0.12f && v > 0.52f && v < 0.80f) c = {0.62f, 0.12f, 0.10f};
      if (v > 0.38f && v < 0.52f && std::abs(u - 0.70f) < (v - 0.38f) * 1.15f) c = {0.10f, 0.16f, 0.50f};
    }
    return c * n;
  });
}

// Posts, rails and a raised panel in the x-y plane from (0, 0), standing out along +z by 0.022.
void addPanelled(MeshBuilder& m, uint32_t paint, float width, float height, int panels) {
  constexpr float kStile = 0.065f, kThick = 0.022f;
  const BoxOptions soft = {.bevel = 0.003f, .bevelSteps = 2};
  m.add(paint, box({0, 0, 0}, {kStile, height, kThick}, soft));
  m.add(paint, box({width - kStile, 0, 0}, {width, height, kThick}, soft));
  const float pitch = (height - kStile) / float(panels);
  for (int i = 0; i <= panels; ++i)
    m.add(paint, box({kStile - 0.002f, pitch * float(i), 0.0005f},
                     {width - kStile + 0.002f, pitch * float(i) + kStile, kThick - 0.0005f}, soft));
  for (int i = 0; i < panels; ++i) {
    const glm::vec3 low(kStile - 0.004f, pitch * float(i) + kStile - 0.004f, 0.007f),
        high(width - kStile + 0.004f, pitch * float(i + 1) + 0.004f, 0.015f);
    m.add(paint, box(low, high));
    m.add(paint, box(low + glm::vec3(0.03f, 0.03f, -0.006f), high + glm::vec3(-0.03f, -0.03f, 0.006f),
                     {.bevel = 0.006f, .bevelSteps = 2}));
  }
}

Shape knob(float r) {
  Outline o({0, 0});
  o.line(0.55f * r, 0).curve({0.4f * r, 0.3f * r}, {0.4f * r, 0.5f * r}, {0.6f * r, 0.8f * r}, 4);
  o.arc(0, 1.9f * r, 0.5f, 8);
  return lathe(o, {.segments = 24});
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

// A folded jersey about the middle of its foot.
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

// A book that stands on y = 0 with its spine towards +z, `wide` along x.
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

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const uint32_t wall = b.texture(plaster("plaster", glm::vec3(0.90f), 0.06f, 0, 512, 401));
  const uint32_t planks =
      b.texture(boards("planks", 5, {0.55f, 0.46f, 0.36f}, {0.95f, 0.90f, 0.82f}, 512, 402, 0.0005f));
  const uint32_t grain =
      b.texture(boards("grain", 2, {0.66f, 0.60f, 0.52f}, {0.92f, 0.88f, 0.82f}, 512, 403, 0.0005f));
  const uint32_t linen = b.texture(weave("linen", glm::vec3(0.92f), 64, 512, 404));
  const uint32_t striped = b.texture(stripes("ticking",
                                             {{{0.80f, 0.78f, 0.72f}, 3},
                                              {{0.12f, 0.24f, 0.45f}, 1},
                                              {{0.80f, 0.78f, 0.72f}, 1},
                                              {{0.12f, 0.24f, 0.45f}, 1}},
                                             256, 405));
  const uint32_t patch = b.texture(ground("plush", glm::vec3(0.72f), glm::vec3(0.95f), 0.10f, 256, 406));
  p.wall = b.material("wall", {0.90f, 0.87f, 0.81f}, {.texture = wall, .metres = 3});
  p.ceiling = b.material("ceiling", {0.86f, 0.86f, 0.84f}, {.texture = wall, .metres = 4});
  p.paint = b.material("white paint", {0.80f, 0.79f, 0.76f});
  p.outside = b.material("outside", {0.45f, 0.43f, 0.40f});
  p.floor =
      b.material("floor", {0.68f, 0.44f, 0.25f}, {.texture = planks, .metres = 0.70f, .metresHigh = 2.4f});
  p.gap = b.material("below the floor", {0.08f, 0.05f, 0.035f});
  p.red = b.material("red paint", {0.84f, 0.07f, 0.05f}, {.texture = patch, .metres = 2});
  p.redDeep = b.material("inside of the closet", {0.66f, 0.50f, 0.34f},
                         {.texture = grain, .metres = 0.5f, .metresHigh = 1.6f});
  const MaterialOptions along = {.texture = grain, .metres = 0.36f, .metresHigh = 1.4f};
  const MaterialOptions across = {.texture = grain, .metres = 1.4f, .metresHigh = 0.36f, .turnDegrees = 90};
  p.oak = b.material("oak", {0.58f, 0.37f, 0.20f}, along);
  p.oakAcross = b.material("oak, across", {0.58f, 0.37f, 0.20f}, across);
  p.birch = b.material("birch", {0.82f, 0.62f, 0.39f}, along);
  p.birchAcross = b.material("birch, across", {0.82f, 0.62f, 0.39f}, across);
  p.rug = b.material("rug", glm::vec3(1),
                     {.texture = b.texture(rugPicture()), .metres = kRug.x, .metresHigh = kRug.y});
  p.fringe = b.material("fringe", {0.68f, 0.64f, 0.54f});
  p.linen = b.material("sheet", {0.84f, 0.84f, 0.83f}, {.texture = linen, .metres = 0.5f});
  p.blanket =
      b.material("blanket", {0.10f, 0.40f, 0.38f}, {.texture = linen, .metres = 0.45f, .doubleSided = true});
  p.curtain =
      b.material("curtain", {0.90f, 0.50f, 0.09f}, {.texture = linen, .metres = 0.4f, .doubleSided = true});
  p.brass = b.material("brass", {0.62f, 0.42f, 0.14f});
  p.iron = b.material("black", {0.045f, 0.045f, 0.05f});
  p.paper = b.material("paper", {0.82f, 0.79f, 0.70f});
  p.shade = b.material("lamp shade", {0.84f, 0.76f, 0.60f}, {.doubleSided = true});
  p.leaf = b.material("leaves", {0.13f, 0.33f, 0.08f}, {.doubleSided = true});
  p.hedge = b.material("hedge", {0.07f, 0.15f, 0.04f});
  p.soil = b.material("soil", {0.08f, 0.055f, 0.04f});
  p.clay = b.material("terracotta", {0.62f, 0.28f, 0.15f}, {.texture = patch, .metres = 0.5f});
  p.bark = b.material("bark", {0.22f, 0.15f, 0.09f});
  p.plush = b.material("plush", {0.48f, 0.27f, 0.12f}, {.texture = patch, .metres = 0.12f});
  p.plushPale = b.material("pale plush", {0.78f, 0.60f, 0.38f}, {.texture = patch, .metres = 0.12f});
  p.wicker = b.material("wicker", {0.60f, 0.40f, 0.20f}, {.texture = patch, .metres = 0.3f});
  p.globe =
      b.material("globe", glm::vec3(1),
                 {.texture = b.texture(globeMap()), .metres = 2 * kPi * 0.135f, .metresHigh = kPi * 0.135f});
  for (int i = 0; i < 3; ++i)
    p.picture[i] = b.material("picture " + std::to_string(i + 1), glm::vec3(1),
                              {.texture = b.texture(pictureOf(i)), .metres = 1});
  p.drawing = b.material("drawing", glm::vec3(1),
                         {.texture = b.texture(pictureOf(3)), .metres = 0.21f, .metresHigh = 0.28f});
  const glm::vec3 cloths[6] = {{0.80f, 0.28f, 0.04f}, {0.05f, 0.36f, 0.40f}, {1, 1, 1},
                               {0.82f, 0.80f, 0.76f}, {0.70f, 0.22f, 0.30f}, {0.07f, 0.10f, 0.28f}};
  const char* clothNames[6] = {"orange cloth", "teal cloth", "striped cloth",
                               "white cloth",  "rose cloth", "navy cloth"};
  for (int i = 0; i < 6; ++i)
    p.cloth[i] = b.material(
        clothNames[i], cloths[i],
        {.texture = i == 2 ? striped : linen, .metres = i == 2 ? 0.16f : 0.4f, .doubleSided = true});
  const glm::vec3 books[7] = {{0.50f, 0.08f, 0.06f}, {0.08f, 0.18f, 0.40f}, {0.12f, 0.32f, 0.14f},
                              {0.74f, 0.52f, 0.10f}, {0.62f, 0.56f, 0.46f}, {0.36f, 0.12f, 0.26f},
                              {0.10f, 0.34f, 0.38f}};
  for (int i = 0; i < 7; ++i)
    p.book[i] = b.material("book " + std::to_string(i + 1), books[i], {.texture = patch, .metres = 0.3f});
  const glm::vec3 toys[6] = {{0.74f, 0.05f, 0.035f}, {0.04f, 0.16f, 0.58f}, {0.07f, 0.38f, 0.10f},
                             {0.86f, 0.60f, 0.05f},  {0.84f, 0.30f, 0.03f}, {0.82f, 0.81f, 0.78f}};
  const char* toyNames[6] = {"toy red", "toy blue", "toy green", "toy yellow", "toy orange", "toy white"};
  for (int i = 0; i < 6; ++i) p.toy[i] = b.material(toyNames[i], toys[i]);
  return p;
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
  m.add(p.red, sweep({{-w, h, 0}, {-w, h, d + 0.022f}, {w, h, d + 0.022f}, {w, h, 0}},
                     crown.moved({-0.001f, 0}), {.up = glm::vec3(0, 1, 0)}));
  m.add(p.red, box({-w, h + 0.004f, 0}, {w, h + 0.07f, d + 0.021f}));
  // Doors: the left one closed, the right one open.
  MeshBuilder door;
  addPanelled(door, p.red, w - 0.003f, h - foot - 0.006f, 3);
  m.add(door, at(-w, foot + 0.003f, d + 0.001f));
  m.add(p.brass, knob(0.016f), at(-0.035f, 1.02f, d + 0.022f) * turnX(90));
  const glm::mat4 hinge = at(w, foot + 0.003f, d + 0.001f) * turnY(108) * at(-(w - 0.003f), 0, 0);
  m.add(door, hinge);
  m.add(p.brass, knob(0.016f), hinge * at(0.033f, 0.93f, 0.022f) * turnX(90));
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

Shape cushion(float width, float height, float thickness, uint32_t seed, uint32_t level) {
  // A net of 7 x 7 points for the front and one for the back; they share their rim.
  constexpr int n = 6;
  SubdivisionCage c;
  c.level = level;
  int front[n + 1][n + 1], back[n + 1][n + 1];
  for (int side = 0; side < 2; ++side)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const bool rim = i == 0 || j == 0 || i == n || j == n;
        if (side == 1 && rim) {
          back[j][i] = front[j][i];
          continue;
        }
        const float x = 2 * float(i) / n - 1, y = 2 * float(j) / n - 1;
        // The edges are drawn in between the corners, the middle is full and uneven.
        const float pull = 1 - 0.09f * (1 - y * y) * x * x - 0.0f, pullY = 1 - 0.09f * (1 - x * x) * y * y;
        const float fill = std::pow((1 - x * x) * (1 - y * y), 0.45f);
        const float lump = 1 + 0.22f * (2 * random(seed, uint32_t(side * 64 + j * 8 + i)) - 1);
        const float z = rim ? 0.012f * (2 * random(seed + 1, uint32_t(j * 8 + i)) - 1)
                            : 0.62f * thickness * fill * lump * (side == 0 ? 1.0f : -1.0f);
        (side == 0 ? front : back)[j][i] = int(c.positions.size());
        c.positions.push_back({0.5f * width * x * pull, 0.5f * height * y * pullY, z});
        c.uvs.push_back({0.5f * width * x, -0.5f * height * y});
      }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      c.faceSizes.insert(c.faceSizes.end(), {4u, 4u});
      for (const int v : {front[j][i], front[j][i + 1], front[j + 1][i + 1], front[j + 1][i]})
        c.faceVertices.push_back(uint32_t(v));
      for (const int v : {back[j][i], back[j + 1][i], back[j + 1][i + 1], back[j][i + 1]})
        c.faceVertices.push_back(uint32_t(v));
    }
  c.faceUvs = c.faceVertices;
  c.corners = {{uint32_t(front[0][0]), 10},
               {uint32_t(front[0][n]), 10},
               {uint32_t(front[n][0]), 10},
               {uint32_t(front[n][n]), 10}};
  Shape s = refine(c).front();
  s.material = 0;
  smooth(s, 70);  // the seam is an edge at the corners
  return s;
}

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
  put(p.linen, 0.82f, 0.63f, 0.45f, 0.42f, -80, -24, 581, 1.5f);
  put(p.cloth[0], 0.55f, 0.665f, 0.23f, 0.43f, -22, -20, 582);
  put(p.cloth[2], 0.10f, 0.655f, 0.18f, 0.40f, 6, -20, 583);
  put(p.cloth[4], 0.64f, 0.635f, 0.50f, 0.34f, -62, -30, 584);
  put(p.cloth[1], -0.42f, 0.64f, 0.17f, 0.36f, 12, -18, 585);
  m.add(teddy(p), at(-0.16f, 0.492f, 0.36f) * turnY(14));
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
        lathe(shade, {.segments = 288,
                      .closed = true,
                      .swell = [](float a, float) { return 1 + 0.022f * std::cos(72 * a); }}),
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
          at(-0.19f + 0.035f * float(i), h + 0.0045f + (i > 1 ? 0.0f : 0.0f), -0.03f + 0.03f * float(i % 2)) *
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
  // Clockwise as seen from the front with the right of the way outside: counter-clockwise.
  m.add(p.oak, sweep({{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, profile,
                     {.closedPath = true, .up = glm::vec3(0, 0, 1)}));
  m.add(p.paint, box({-x, -y, 0.002f}, {x, y, 0.006f}));
  const float a = x - 0.045f, b = y - 0.045f;
  Sheet s = sheet(1, 1, {1, 1},
                  [&](float u, float v) { return glm::vec3((2 * u - 1) * a, (1 - 2 * v) * b, 0.0068f); });
  m.add(picture, surface(s, 0.001f));
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
  const float x = 0.5f * w, transom = 0.70f * h;
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
  m.add(p.brass, box({-0.010f, 0.36f * h, -0.068f}, {0.010f, 0.36f * h + 0.09f, -0.062f}, {.bevel = 0.002f}));
  m.add(p.brass, tube(smoothPath({{0, 0.36f * h + 0.05f, -0.064f},
                                  {0, 0.36f * h + 0.05f, -0.035f},
                                  {0.004f, 0.36f * h + 0.02f, -0.030f},
                                  {0.008f, 0.36f * h - 0.04f, -0.030f}},
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
    return glm::vec3(x + 0.3f * f.wave * free * std::cos(2 * kPi * v - f.phase) + 0.25f * f.billow * free, y,
                     z);
  });
}

}  // namespace fovea::scene::room
