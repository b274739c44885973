// Materials of the room and their pictures.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/scenes/builtin/modelling/textures.h"
#include "samples/scenes/builtin/room_parts.h"

namespace fovea::scene::room {

using namespace model;

namespace {

constexpr float kPi = glm::pi<float>();

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

// The pictures on the walls: hills under a sky, a boat, and a sun in crayon.
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
      b.material("floor", {0.74f, 0.50f, 0.30f}, {.texture = planks, .metres = 0.70f, .metresHigh = 2.4f});
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
      b.material("curtain", {0.88f, 0.46f, 0.09f}, {.texture = linen, .metres = 0.4f, .doubleSided = true});
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

}  // namespace fovea::scene::room
