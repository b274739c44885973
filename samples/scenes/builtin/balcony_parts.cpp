#include "samples/scenes/builtin/balcony_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene::balcony {

using namespace model;

namespace {

constexpr float kPi = glm::pi<float>();

// Cloth in pleats under a rail, from (-width / 2, height) down to 0.
Shape pleats(float width, float height, uint32_t seed, uint32_t columns) {
  return surface(sheet(columns, 3, {1.6f * width, height}, [&](float u, float v) {
    const float turn = 2 * kPi * (0.2f * float(columns) * u + 0.4f * noise({u * 5, v}, seed));
    return glm::vec3((u - 0.5f) * width, height * (1 - v), (0.012f + 0.01f * v) * std::cos(turn));
  }));
}

}  // namespace

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const uint32_t wall = b.texture(plaster("limewash", glm::vec3(0.88f, 0.87f, 0.85f), 0.12f, 0.10f, 512, 11));
  const uint32_t old =
      b.texture(plaster("old plaster", glm::vec3(0.84f, 0.82f, 0.79f), 0.26f, 0.26f, 512, 12));
  const uint32_t stone = b.texture(plaster("stone", glm::vec3(0.86f, 0.84f, 0.80f), 0.20f, 0.12f, 512, 13));
  const uint32_t grain = b.texture(boards("paint", 6, glm::vec3(0.72f), glm::vec3(0.88f), 256, 14));
  const uint32_t cloth = b.texture(weave("weave", glm::vec3(0.95f), 96, 512, 15));
  const uint32_t canvas = b.texture(stripes("awning",
                                            {{{0.92f, 0.215f, 0.02f}, 5},
                                             {{0.90f, 0.50f, 0.17f}, 0.4f},
                                             {{0.92f, 0.215f, 0.02f}, 0.5f},
                                             {{0.90f, 0.50f, 0.17f}, 0.4f}},
                                            512, 16));
  const uint32_t blueStripes = b.texture(stripes("ticking",
                                                 {{{0.78f, 0.76f, 0.70f}, 2},
                                                  {{0.10f, 0.22f, 0.38f}, 1.2f},
                                                  {{0.78f, 0.76f, 0.70f}, 0.5f},
                                                  {{0.10f, 0.22f, 0.38f}, 0.3f}},
                                                 256, 17));
  MasonryLook setts;
  setts.columns = 8;
  setts.rows = 12;
  setts.low = {0.22f, 0.21f, 0.20f};
  setts.high = {0.38f, 0.36f, 0.33f};
  const uint32_t cobbles = b.texture(masonry("setts", setts, 512, 512, 18));

  p.limewash = b.material("limewash", {0.86f, 0.80f, 0.70f}, {.texture = wall, .metres = 3.4f});
  p.ochre = b.material("ochre plaster", {0.84f, 0.60f, 0.30f}, {.texture = old, .metres = 4.1f});
  p.rose = b.material("rose plaster", {0.83f, 0.52f, 0.40f}, {.texture = old, .metres = 3.7f});
  p.stone = b.material("stone", {0.82f, 0.77f, 0.67f}, {.texture = stone, .metres = 2.3f});
  p.tile = b.material("pale tiles", {0.85f, 0.81f, 0.73f}, {.texture = stone, .metres = 2.9f});
  p.tileBlue = b.material("blue tiles", {0.22f, 0.35f, 0.47f}, {.texture = stone, .metres = 1.7f});
  p.mortar = b.material("mortar", {0.46f, 0.43f, 0.38f});
  p.street = b.material("setts", glm::vec3(1), {.texture = cobbles, .metres = 1.3f});
  p.roofTiles = b.material("roof tiles", {0.66f, 0.32f, 0.19f}, {.texture = old, .metres = 1.1f});
  p.blue = b.material("blue paint", {0.14f, 0.33f, 0.46f}, {.texture = grain, .metres = 0.5f});
  p.green = b.material("green paint", {0.15f, 0.30f, 0.20f}, {.texture = grain, .metres = 0.5f});
  p.brown = b.material("stained wood", {0.32f, 0.19f, 0.10f}, {.texture = grain, .metres = 0.5f});
  p.white = b.material("white paint", {0.80f, 0.78f, 0.74f});
  p.cream = b.material("cream enamel", {0.78f, 0.74f, 0.64f});
  p.dark = b.material("dim room", {0.06f, 0.055f, 0.05f});
  p.iron = b.material("iron", {0.055f, 0.055f, 0.06f});
  p.brass = b.material("brass", {0.50f, 0.34f, 0.12f});
  p.clay = b.material("terracotta", {0.72f, 0.36f, 0.21f}, {.texture = stone, .metres = 0.9f});
  p.glaze = b.material("blue glaze", {0.07f, 0.20f, 0.42f});
  p.soil = b.material("soil", {0.10f, 0.07f, 0.05f});
  p.bark = b.material("bark", {0.27f, 0.21f, 0.15f}, {.texture = old, .metres = 0.3f});
  p.leaf = b.material("leaves", {0.12f, 0.29f, 0.05f}, {.doubleSided = true});
  p.darkLeaf = b.material("lemon leaves", {0.06f, 0.18f, 0.04f}, {.doubleSided = true});
  p.paleLeaf = b.material("olive leaves", {0.20f, 0.27f, 0.15f}, {.doubleSided = true});
  p.bract = b.material("bracts", {0.70f, 0.05f, 0.28f}, {.doubleSided = true});
  p.bloom = b.material("geranium petals", {0.78f, 0.05f, 0.04f}, {.doubleSided = true});
  p.lemon = b.material("lemons", {0.88f, 0.70f, 0.06f});
  p.awning = b.material("awning", glm::vec3(1), {.texture = canvas, .metres = 0.70f, .doubleSided = true});
  p.cushion = b.material("teal cloth", {0.10f, 0.36f, 0.38f}, {.texture = cloth, .metres = 0.6f});
  p.stripedCushion = b.material("ticking", glm::vec3(1), {.texture = blueStripes, .metres = 0.16f});
  p.linen =
      b.material("linen", {0.84f, 0.83f, 0.80f}, {.texture = cloth, .metres = 0.8f, .doubleSided = true});
  p.shirt = b.material("blue shirt", {0.16f, 0.33f, 0.60f},
                       {.texture = cloth, .metres = 0.8f, .doubleSided = true});
  p.towel = b.material("towel", glm::vec3(1), {.texture = blueStripes, .metres = 0.5f, .doubleSided = true});
  p.paper = b.material("paper", {0.82f, 0.80f, 0.74f});
  p.lampPane = b.material("milk glass", {0.86f, 0.82f, 0.70f});
  p.curtain = b.material("voile", {0.86f, 0.85f, 0.82f}, {.doubleSided = true});
  return p;
}

MeshBuilder shutterLeaf(uint32_t wood, float w, float h, bool fine) {
  constexpr float kStile = 0.065f, kThick = 0.04f;
  const BoxOptions rounded{.bevel = fine ? 0.004f : 0.0f};
  MeshBuilder m;
  m.add(wood, box({0, 0, 0}, {kStile, h, kThick}, rounded));
  m.add(wood, box({w - kStile, 0, 0}, {w, h, kThick}, rounded));
  const float rails[4] = {0, 0.46f * h, h - 0.08f, h};
  for (int i = 0; i < 3; ++i)
    m.add(wood, box({kStile - 0.002f, rails[i], 0.003f},
                    {w - kStile + 0.002f, rails[i] + 0.08f, kThick - 0.003f}, rounded));
  for (int k = 0; k < 2; ++k) {
    const float low = rails[k] + 0.08f, high = rails[k + 1], wide = fine ? 0.026f : 0.04f;
    const int slats = std::max(3, int((high - low) / (fine ? 0.052f : 0.08f)));
    for (int i = 0; i < slats; ++i)
      m.add(wood, box({kStile - 0.004f, -wide, -0.004f}, {w - kStile + 0.004f, wide, 0.004f}),
            at(0, low + (high - low) * (float(i) + 0.5f) / float(slats), 0.5f * kThick) * turnX(38));
  }
  return m;
}

MeshBuilder window(const Palette& p, uint32_t wood, float w, float h, Shutters shutters, bool door,
                   bool fine) {
  MeshBuilder m;
  const float leafWidth = 0.5f * w;
  // Surround, and the sill that carries off the rain.
  for (const float s : {-1.0f, 1.0f})
    m.add(p.stone, box({s * (0.5f * w + 0.055f) - 0.055f, door ? 0.0f : -0.02f, -0.02f},
                       {s * (0.5f * w + 0.055f) + 0.055f, h, 0.02f}, {.bevel = fine ? 0.005f : 0.0f}));
  m.add(p.stone, box({-0.5f * w - 0.13f, h, -0.02f}, {0.5f * w + 0.13f, h + 0.12f, 0.03f},
                     {.bevel = fine ? 0.006f : 0.0f}));
  if (!door)
    m.add(p.stone,
          box({-0.5f * w - 0.14f, -0.09f, -0.1f}, {0.5f * w + 0.14f, -0.001f, 0.09f}, {.bevel = 0.01f}));
  const MeshBuilder leaf = shutterLeaf(wood, leafWidth - 0.004f, h - 0.02f, fine);
  if (shutters == Shutters::Closed) {
    m.add(leaf, at(-leafWidth + 0.002f, 0.01f, -0.055f));
    m.add(leaf, at(0.002f, 0.01f, -0.055f));
    return m;
  }
  // Folded back against the wall on their hinges, or standing off it.
  const float angle = shutters == Shutters::Open ? 6.0f : 38.0f;
  m.add(leaf, at(0.5f * w + 0.115f, 0.01f, 0.022f) * turnY(-angle));
  m.add(leaf, at(-0.5f * w - 0.115f, 0.01f, 0.022f) * scaled(-1, 1, 1) * turnY(-0.6f * angle));
  for (const float s : {-1.0f, 1.0f}) {
    const float x0 = s < 0 ? -leafWidth : 0.0f, x1 = x0 + leafWidth, post = 0.055f;
    const float foot = door ? 0.62f : 0.07f;
    const BoxOptions rounded{.bevel = fine ? 0.005f : 0.0f};
    const auto bar = [&](glm::vec2 low, glm::vec2 high, float depth) {
      m.add(p.white, box({low, -0.15f - 0.5f * depth}, {high, -0.15f + 0.5f * depth}, rounded));
    };
    bar({x0 + 0.002f, 0.004f}, {x0 + post, h - 0.002f}, 0.05f);
    bar({x1 - post, 0.004f}, {x1 - 0.002f, h - 0.002f}, 0.05f);
    bar({x0 + post - 0.002f, h - 0.08f}, {x1 - post + 0.002f, h - 0.003f}, 0.046f);
    bar({x0 + post - 0.002f, 0.005f}, {x1 - post + 0.002f, foot}, door ? 0.03f : 0.046f);
    if (door) {
      bar({x0 + post - 0.002f, foot - 0.02f}, {x1 - post + 0.002f, foot + 0.05f}, 0.046f);
      bar({x0 + post - 0.002f, 0.004f}, {x1 - post + 0.002f, 0.12f}, 0.046f);
      m.add(p.white, box({x0 + post + 0.04f, 0.18f, -0.14f}, {x1 - post - 0.04f, foot - 0.06f, -0.122f},
                         {.bevel = 0.008f}));
    }
    const int panes = door ? 3 : 2;
    for (int i = 1; i < panes; ++i) {
      const float y = foot + (h - 0.08f - foot) * float(i) / float(panes);
      bar({x0 + post - 0.002f, y - 0.013f}, {x1 - post + 0.002f, y + 0.013f}, 0.03f);
    }
    m.add(p.curtain, pleats(leafWidth - 0.1f, h - 0.06f, uint32_t(7 + s), fine ? 30 : 18),
          at(0.5f * (x0 + x1) + 0.0f, 0.02f, -0.205f));
  }
  m.add(p.brass, sphere(0.022f, 12, 8), at(0.045f, 0.45f * h, -0.105f));
  return m;
}

MeshBuilder ironBalcony(const Palette& p, float w, float depth) {
  MeshBuilder m;
  m.add(p.stone,
        box({-0.5f * w - 0.06f, -0.14f, -0.05f}, {0.5f * w + 0.06f, 0, depth + 0.06f}, {.bevel = 0.02f}));
  for (const float s : {-0.36f, 0.36f}) {
    Outline console({0, -0.48f});
    console.curve({0.05f, -0.34f}, {0.25f, -0.36f}, {0.8f * depth, -0.139f}, 7).line(0, -0.139f);
    m.add(p.stone, extrude(console, 0.12f, {.bevel = 0.008f}),
          at(s * w - 0.06f, 0, 0) * turnY(-90) * scaled(1, 1, -1));
  }
  const std::vector<glm::vec3> rail = {
      {-0.5f * w, 0, -0.02f}, {-0.5f * w, 0, depth}, {0.5f * w, 0, depth}, {0.5f * w, 0, -0.02f}};
  for (const float y : {0.09f, 0.96f})
    m.add(p.iron, sweep(rail, rectangle(0.032f, 0.014f), {.up = glm::vec3(0, 1, 0)}), at(0, y, 0));
  const auto bars = [&](glm::vec3 a, glm::vec3 b) {
    const int count = int(glm::length(b - a) / 0.115f);
    for (int i = 0; i <= count; ++i) {
      const glm::vec3 q = glm::mix(a, b, float(i) / float(count));
      // Bellied bars.
      const glm::vec3 out = a.z == b.z ? glm::vec3(0, 0, 1) : glm::vec3(a.x > 0 ? 1 : -1, 0, 0);
      m.add(p.iron, tube(smoothPath({q + glm::vec3(0, 0.09f, 0), q + 0.05f * out + glm::vec3(0, 0.28f, 0),
                                     q + 0.02f * out + glm::vec3(0, 0.55f, 0), q + glm::vec3(0, 0.96f, 0)},
                                    1),
                         0.0075f, 4));
    }
  };
  bars({-0.5f * w, 0, depth}, {0.5f * w, 0, depth});
  bars({-0.5f * w, 0, 0.06f}, {-0.5f * w, 0, depth - 0.1f});
  bars({0.5f * w, 0, 0.06f}, {0.5f * w, 0, depth - 0.1f});
  return m;
}

Shape baluster(float h, int segments) {
  Outline o({0, 0});
  o.line(0.070f, 0).line(0.070f, 0.075f * h).line(0.052f, 0.085f * h).arc(0.052f, 0.135f * h, 0.8f, 2);
  o.line(0.036f, 0.145f * h);
  o.through({{0.040f, 0.19f * h},
             {0.079f, 0.36f * h},
             {0.052f, 0.56f * h},
             {0.032f, 0.74f * h},
             {0.034f, 0.82f * h}},
            2);
  o.line(0.050f, 0.835f * h).arc(0.050f, 0.885f * h, 0.8f, 2).line(0.046f, 0.90f * h);
  o.line(0.066f, 0.925f * h).line(0.066f, h).line(0, h);
  return lathe(o, {.segments = segments});
}

Shape eaves(float length) {
  Outline half({-0.09f, 0});
  half.arc(0.09f, 0, -1, 5).line(0.072f, 0).arc(-0.072f, 0, 1, 3);
  const Shape tile = sweep({{0, 0.01f, 0.5f}, {0, 0.24f, -0.5f}}, half, {.up = glm::vec3(0, 1, 0)});
  Shape s;
  const int tiles = int(length / 0.225f);
  for (int i = 0; i < tiles; ++i)
    append(s, tile,
           at(-0.5f * length + length * (float(i) + 0.5f) / float(tiles),
              0.13f + random(91, uint32_t(i), -0.008f, 0.008f), random(92, uint32_t(i), -0.015f, 0.015f)));
  append(
      s,
      extrude(
          Outline(
              {{-0.5f, 0.30f}, {-0.5f, 0.2f}, {-0.1f, 0.0f}, {0.0f, 0.0f}, {0.46f, 0.09f}, {0.46f, 0.13f}}),
          length),
      at(0.5f * length, 0, 0) * turnY(-90));
  return s;
}

}  // namespace fovea::scene::balcony
