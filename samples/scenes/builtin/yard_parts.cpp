// Materials and buildings of the yard.
#include "samples/scenes/builtin/yard_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene::yard {

using namespace model;

namespace {

// The view into a window: dark, with the curtains drawn back.
Texture paneTexture() {
  return bake("pane", 128, 176, [](float u, float v) {
    const float side = std::min(u, 1 - u);
    const float edge = 0.16f + 0.12f * smoothstep(0.0f, 0.75f, v) - 0.10f * smoothstep(0.75f, 1.0f, v);
    const float fold = 0.72f + 0.28f * std::sin(side * 95.0f + 3 * v);
    const glm::vec3 dark = glm::mix(glm::vec3(0.07f, 0.09f, 0.12f), glm::vec3(0.025f, 0.028f, 0.03f), v);
    const glm::vec3 cloth = glm::vec3(0.40f, 0.38f, 0.33f) * fold;
    return glm::mix(cloth, dark, smoothstep(edge - 0.01f, edge + 0.01f, side));
  });
}

// Three stripes and a disc.
Texture flagTexture() {
  return bake("flag", 384, 240, [](float u, float v) {
    const glm::vec3 teal(0.03f, 0.28f, 0.33f), cream(0.74f, 0.70f, 0.58f), red(0.55f, 0.05f, 0.04f);
    glm::vec3 c = v < 0.34f ? teal : v < 0.67f ? cream : red;
    const glm::vec2 d((u - 0.33f) * 1.58f, v - 0.505f);
    const float r = glm::length(d), a = std::atan2(d.y, d.x);
    if (r < 0.115f + 0.02f * std::cos(12 * a)) c = {0.72f, 0.45f, 0.06f};
    return c * (0.94f + 0.06f * noise({u * 160, v * 100}, 903));
  });
}

void addSurfaces(SceneBuilder& b, Palette& p) {
  const auto plastered = [&](const char* name, glm::vec3 color, float contrast, float stains, uint32_t seed) {
    const uint32_t t = b.texture(plaster(name, color, contrast, stains, 384, seed));
    return b.material(name, glm::vec3(1), {.texture = t, .metres = 4.2f});
  };
  p.pale = plastered("pale plaster", {0.70f, 0.66f, 0.57f}, 0.13f, 0.22f, 911);
  p.ochre = plastered("ochre plaster", {0.66f, 0.45f, 0.24f}, 0.14f, 0.20f, 912);
  p.white = plastered("limewash", {0.78f, 0.76f, 0.71f}, 0.09f, 0.14f, 913);
  p.plinth = plastered("plinth", {0.34f, 0.33f, 0.31f}, 0.18f, 0.12f, 914);
  p.stone = plastered("cast stone", {0.60f, 0.58f, 0.53f}, 0.12f, 0.10f, 915);
  const MasonryLook bricks = {.columns = 8,
                              .rows = 24,
                              .joint = 0.13f,
                              .low = {0.46f, 0.27f, 0.19f},
                              .high = {0.62f, 0.40f, 0.29f},
                              .jointColor = {0.46f, 0.43f, 0.38f}};
  p.brick = b.material("brick", glm::vec3(1),
                       {.texture = b.texture(masonry("brick", bricks, 384, 384, 916)), .metres = 2.0f});
  p.paving[0] = plastered("paving", {0.60f, 0.58f, 0.54f}, 0.16f, 0, 917);
  p.paving[1] = plastered("paving, warm", {0.62f, 0.57f, 0.49f}, 0.18f, 0, 918);
  p.paving[2] = plastered("paving, grey", {0.52f, 0.52f, 0.51f}, 0.16f, 0, 919);
  p.mortar = b.material("joint sand", {0.30f, 0.26f, 0.20f});
  const auto grounded = [&](const char* name, glm::vec3 low, glm::vec3 high, float speckle, float metres,
                            uint32_t seed) {
    const uint32_t t = b.texture(ground(name, low, high, speckle, 384, seed));
    return b.material(name, glm::vec3(1), {.texture = t, .metres = metres});
  };
  p.lawn = grounded("lawn", {0.20f, 0.145f, 0.08f}, {0.12f, 0.19f, 0.05f}, 0.35f, 3.1f, 921);
  p.sand = grounded("sand", {0.55f, 0.43f, 0.27f}, {0.66f, 0.54f, 0.36f}, 0.12f, 1.3f, 922);
  p.soil = grounded("soil", {0.07f, 0.045f, 0.03f}, {0.13f, 0.09f, 0.06f}, 0.4f, 1.1f, 923);
  p.roof = grounded("tile", {0.36f, 0.13f, 0.075f}, {0.50f, 0.21f, 0.12f}, 0.12f, 1.7f, 924);
  p.felt = grounded("roofing felt", {0.06f, 0.065f, 0.07f}, {0.11f, 0.11f, 0.11f}, 0.3f, 1.5f, 925);
}

}  // namespace

std::vector<glm::vec3> roundedPath(const std::vector<glm::vec3>& corners, float reach, int steps) {
  std::vector<glm::vec3> path{corners.front()};
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    const glm::vec3 c = corners[i], in = corners[i - 1] - c, out = corners[i + 1] - c;
    const float r = std::min({reach, 0.49f * glm::length(in), 0.49f * glm::length(out)});
    const glm::vec3 a = c + r * glm::normalize(in), b = c + r * glm::normalize(out);
    for (int k = 0; k <= steps; ++k) {
      const float t = float(k) / float(steps);
      path.push_back(glm::mix(glm::mix(a, c, t), glm::mix(c, b, t), t));
    }
  }
  path.push_back(corners.back());
  return path;
}

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  addSurfaces(b, p);
  const auto boarded = [&](const char* name, int count, glm::vec3 low, glm::vec3 high, float metres,
                           uint32_t seed, float turn = 0, float gap = 0) {
    const uint32_t t = b.texture(boards(name, count, low, high, 256, seed, gap));
    return b.material(name, glm::vec3(1), {.texture = t, .metres = metres, .turnDegrees = turn});
  };
  p.timber = boarded("timber", 5, {0.32f, 0.20f, 0.10f}, {0.52f, 0.36f, 0.20f}, 0.9f, 931);
  p.timberAcross = boarded("timber, lying", 5, {0.32f, 0.20f, 0.10f}, {0.52f, 0.36f, 0.20f}, 0.9f, 931, 90);
  p.fence = boarded("fence", 6, {0.40f, 0.32f, 0.23f}, {0.62f, 0.53f, 0.41f}, 1.1f, 932);
  p.shed = boarded("shed", 6, {0.20f, 0.31f, 0.30f}, {0.27f, 0.40f, 0.38f}, 1.1f, 933);
  p.pane = b.material("window pane", glm::vec3(1),
                      {.texture = b.texture(paneTexture()),
                       .metres = kWindowSize.x,
                       .metresHigh = kWindowSize.y,
                       .offset = {0.5f * kWindowSize.x, kWindowSize.y}});
  p.flag = b.material(
      "flag", glm::vec3(1),
      {.texture = b.texture(flagTexture()), .metres = 1.5f, .metresHigh = 0.95f, .doubleSided = true});
  p.inside = b.material("dark inside", {0.05f, 0.05f, 0.05f});
  p.frame = b.material("window frame", {0.76f, 0.75f, 0.70f});
  p.door = b.material("door", {0.10f, 0.20f, 0.15f});
  p.shutter = b.material("shutter", {0.13f, 0.27f, 0.24f});
  p.zinc = b.material("zinc", {0.36f, 0.38f, 0.39f});
  p.orange = b.material("orange plastic", {0.86f, 0.125f, 0.008f});
  p.reflex = b.material("reflective strip", {0.82f, 0.82f, 0.80f});
  p.blue = b.material("blue paint", {0.05f, 0.20f, 0.52f});
  p.green = b.material("green paint", {0.10f, 0.33f, 0.12f});
  p.steel = b.material("galvanised steel", {0.48f, 0.49f, 0.50f});
  p.rubber = b.material("rubber", {0.035f, 0.035f, 0.038f});
  p.rope = b.material("rope", {0.52f, 0.44f, 0.30f});
  p.teal = b.material("bicycle paint", {0.04f, 0.30f, 0.34f});
  p.leather = b.material("leather", {0.26f, 0.12f, 0.05f});
  p.tray = b.material("barrow's tray", {0.08f, 0.26f, 0.12f});
  p.mast = b.material("mast", {0.80f, 0.80f, 0.78f});
  p.red = b.material("red", {0.60f, 0.05f, 0.04f});
  p.yellow = b.material("yellow", {0.78f, 0.55f, 0.06f});
  p.cream = b.material("cream", {0.74f, 0.70f, 0.60f});
  p.clay = b.material("clay", {0.50f, 0.22f, 0.12f});
  p.bark = b.material("bark", {0.16f, 0.12f, 0.085f});
  p.birch = b.material("birch bark", {0.58f, 0.55f, 0.50f});
  p.leaf[0] = b.material("leaves", {0.13f, 0.27f, 0.045f}, {.doubleSided = true});
  p.leaf[1] = b.material("dark leaves", {0.06f, 0.17f, 0.04f}, {.doubleSided = true});
  p.leaf[2] = b.material("young leaves", {0.25f, 0.36f, 0.07f}, {.doubleSided = true});
  p.blade[0] = b.material("grass", {0.14f, 0.29f, 0.05f}, {.doubleSided = true});
  p.blade[1] = b.material("dry grass", {0.27f, 0.32f, 0.09f}, {.doubleSided = true});
  p.fallen = b.material("fallen leaves", {0.40f, 0.24f, 0.06f}, {.doubleSided = true});
  p.clover = b.material("blossoms", {0.72f, 0.56f, 0.62f}, {.doubleSided = true});
  return p;
}

// ---- Buildings -------------------------------------------------------------------------------------------

namespace {

constexpr float kSkin = 0.20f;  // thickness of the wall that has the openings

// Fills an opening of kWindowSize from the origin upwards; the face of the wall is z = 0.
MeshBuilder windowUnit(const Palette& p, bool shutters) {
  MeshBuilder m;
  const float w = kWindowSize.x, h = kWindowSize.y, z = -0.11f;
  m.add(p.pane, box({-0.5f * w, 0, z - 0.06f}, {0.5f * w, h, z}));
  const BoxOptions soft = {.bevel = 0.006f};
  const auto bar = [&](float x0, float y0, float x1, float y1, float depth) {
    m.add(p.frame, box({x0, y0, z - 0.02f}, {x1, y1, z + depth}, soft));
  };
  bar(-0.5f * w, 0, -0.5f * w + 0.06f, h, 0.05f);
  bar(0.5f * w - 0.06f, 0, 0.5f * w, h, 0.05f);
  bar(-0.5f * w + 0.05f, 0, 0.5f * w - 0.05f, 0.07f, 0.048f);
  bar(-0.5f * w + 0.05f, h - 0.06f, 0.5f * w - 0.05f, h, 0.048f);
  bar(-0.035f, 0.06f, 0.035f, h - 0.05f, 0.042f);
  bar(-0.5f * w + 0.05f, 0.94f, 0.5f * w - 0.05f, 0.985f, 0.046f);
  for (const float s : {-1.0f, 1.0f})
    bar(s > 0 ? 0.03f : -0.45f, 0.46f, s > 0 ? 0.45f : -0.03f, 0.485f, 0.025f);
  m.add(p.stone, box({-0.5f * w - 0.09f, -0.08f, -0.12f}, {0.5f * w + 0.09f, 0.012f, 0.09f},
                     {.bevel = 0.012f, .bevelSteps = 2}));
  // The surround.
  for (const float s : {-1.0f, 1.0f})
    m.add(p.stone, box({s > 0 ? 0.5f * w : -0.5f * w - 0.12f, 0.01f, -0.02f},
                       {s > 0 ? 0.5f * w + 0.12f : -0.5f * w, h, 0.025f}, {.bevel = 0.008f}));
  m.add(p.stone,
        box({-0.5f * w - 0.16f, h, -0.02f}, {0.5f * w + 0.16f, h + 0.17f, 0.035f}, {.bevel = 0.012f}));
  if (!shutters) return m;
  for (const float s : {-1.0f, 1.0f}) {
    MeshBuilder leaf;  // from x = 0 to 0.5
    const float lw = 0.49f, lh = h + 0.04f;
    leaf.add(p.shutter, box({0, 0, 0}, {0.06f, lh, 0.035f}, {.bevel = 0.005f}));
    leaf.add(p.shutter, box({lw - 0.06f, 0, 0}, {lw, lh, 0.035f}, {.bevel = 0.005f}));
    for (const float y : {0.0f, 0.5f * lh - 0.03f, lh - 0.06f})
      leaf.add(p.shutter, box({0.05f, y, 0.002f}, {lw - 0.05f, y + 0.06f, 0.033f}, {.bevel = 0.004f}));
    const Shape slat = box({0.05f, -0.026f, -0.004f}, {lw - 0.05f, 0.026f, 0.004f});
    for (int i = 0; i < 30; ++i) {
      const float y = 0.09f + (lh - 0.18f) * (float(i) + 0.5f) / 30;
      if (std::abs(y - 0.5f * lh) > 0.05f) leaf.add(p.shutter, slat, at(0, y, 0.017f) * turnX(-35));
    }
    m.add(leaf, s > 0 ? at(0.5f * w + 0.03f, -0.01f, 0.045f) * turnY(-5)
                      : at(-0.5f * w - 0.03f, -0.01f, 0.045f) * turnY(5) * scaled(-1, 1, 1));
  }
  return m;
}

// Fills an opening 0.98 m wide and 2.15 m high.
MeshBuilder doorUnit(const Palette& p) {
  MeshBuilder m;
  const BoxOptions soft = {.bevel = 0.008f, .bevelSteps = 2};
  m.add(p.door, box({-0.49f, 0, -0.17f}, {0.49f, 2.15f, -0.10f}));
  for (const auto& [low, high] : {std::pair{0.16f, 0.86f}, std::pair{1.0f, 1.38f}, std::pair{1.48f, 2.0f}})
    for (const float x : {-0.40f, 0.05f})
      m.add(p.door, box({x, low, -0.12f}, {x + 0.35f, high, -0.078f}, {.bevel = 0.018f, .bevelSteps = 2}));
  m.add(p.steel, tube(smoothPath({{0.38f, 1.0f, -0.10f}, {0.38f, 1.0f, -0.04f}, {0.28f, 1.0f, -0.035f}}, 5),
                      0.011f, 10));
  for (const float s : {-1.0f, 1.0f})
    m.add(p.stone, box({s > 0 ? 0.49f : -0.63f, 0, -0.02f}, {s > 0 ? 0.63f : -0.49f, 2.15f, 0.03f}, soft));
  m.add(p.stone, box({-0.67f, 2.15f, -0.02f}, {0.67f, 2.34f, 0.04f}, soft));
  m.add(p.stone, box({-0.75f, -0.02f, -0.15f}, {0.75f, 0.13f, 0.42f}, {.bevel = 0.015f, .bevelSteps = 2}));
  return m;
}

// Rows of rounded tiles that rise along -z; columns run along x from 0, and each row is `step` further back.
Shape tiling(float width, int rows, float rise, float run) {
  Outline half({-0.098f, 0});
  half.arc(0.098f, 0, -0.8f, 5).line(0.084f, -0.004f).arc(-0.084f, -0.004f, 0.8f, 3);
  const float length = std::sqrt(rise * rise + run * run) * 1.12f;
  const glm::vec3 along = glm::normalize(glm::vec3(0, rise, -run));
  const Shape cover = sweep({glm::vec3(0), along * length}, half, {.up = glm::vec3(0, 1, 0)});
  Shape s;
  const int columns = int(width / 0.21f);
  for (int r = 0; r < rows; ++r)
    for (int i = 0; i < columns; ++i) {
      const uint32_t k = uint32_t(r * 997 + i);
      append(s, cover,
             at(width * (float(i) + 0.5f) / float(columns) + random(941, k, -0.006f, 0.006f),
                rise * float(r) + 0.014f * float(rows - r) / float(rows) + random(942, k, 0, 0.006f),
                -run * float(r) + random(943, k, -0.012f, 0.012f)));
    }
  return s;
}

}  // namespace

MeshBuilder eaves(const Palette& p, float width, int rows) {
  MeshBuilder m;
  const float half = 0.5f * width;
  constexpr float kRise = 0.17f, kRun = 0.32f;
  const float top = kRise * float(rows), back = 0.5f - kRun * float(rows);
  // The roof's body, closed down to the wall.
  const Outline body = {
      {0.46f, 0.0f}, {0.46f, 0.035f}, {back, top + 0.02f}, {back, -0.05f}, {-0.05f, -0.05f}};
  m.add(p.roof, placed(extrude(Outline(body), width), at(-half, 0, 0) * turnY(90) * scaled(-1, 1, 1)));
  m.add(p.roof, tiling(width, rows, kRise, kRun), at(-half, 0.05f, 0.50f));
  m.add(p.timberAcross, box({-half, -0.10f, 0.0f}, {half, 0.02f, 0.44f}));
  Outline gutter({-0.075f, 0});
  gutter.arc(0.075f, 0, 1, 8).line(0.068f, 0).arc(-0.068f, 0, -1, 8);
  m.add(p.zinc, sweep({{-half, -0.01f, 0.56f}, {half, -0.01f, 0.56f}}, gutter, {.up = glm::vec3(0, 1, 0)}));
  return m;
}

MeshBuilder downpipe(const Palette& p, float height) {
  MeshBuilder m;
  m.add(p.zinc, tube(roundedPath({{0, height, 0.50f},
                                  {0, height - 0.14f, 0.50f},
                                  {0, height - 0.60f, 0.10f},
                                  {0, 0.20f, 0.10f},
                                  {0, 0.05f, 0.28f}},
                                 0.10f),
                     0.045f, 16));
  for (float y = 0.8f; y < height - 0.8f; y += 1.5f) {
    m.add(p.zinc, cylinder(0.053f, 0.05f, 16, 0.008f), at(0, y, 0.10f));
    m.add(p.zinc, box({-0.012f, y + 0.01f, -0.01f}, {0.012f, y + 0.04f, 0.09f}));
  }
  return m;
}

MeshBuilder front(const Palette& p, const Front& f) {
  MeshBuilder m;
  const float half = 0.5f * f.width;
  std::vector<Outline> holes;
  for (const Window& w : f.windows) {
    holes.push_back(
        Outline(rectangle(kWindowSize.x, kWindowSize.y)).moved({w.x, w.sill + 0.5f * kWindowSize.y}));
    m.add(windowUnit(p, w.shutters), at(w.x, w.sill, 0));
  }
  for (const float x : f.doors) {
    holes.push_back(Outline({{x - 0.49f, 0.1f}, {x + 0.49f, 0.1f}, {x + 0.49f, 2.27f}, {x - 0.49f, 2.27f}}));
    m.add(doorUnit(p), at(x, 0.12f, 0));
  }
  m.add(f.plaster,
        extrude(Outline({{-half, -0.3f}, {half, -0.3f}, {half, f.height}, {-half, f.height}}), holes, kSkin),
        at(0, 0, -kSkin));
  m.add(p.inside, box({-half, -0.3f, -0.45f}, {half, f.height, -kSkin + 0.0005f}));
  // The plinth, between the doors.
  float from = -half;
  std::vector<float> doors = f.doors;
  doors.push_back(half + 0.63f);
  for (const float x : doors) {
    if (x - 0.63f > from + 0.05f)
      m.add(p.plinth, box({from, -0.2f, -0.05f}, {x - 0.63f, 0.42f, 0.035f}, {.bevel = 0.012f}));
    from = x + 0.63f;
  }
  Outline string({-0.03f, 0});
  string.line(0.05f, 0)
      .line(0.055f, 0.04f)
      .arc(0.085f, 0.08f, -0.4f, 4)
      .line(0.085f, 0.13f)
      .line(-0.03f, 0.15f);
  if (f.height > 5)
    m.add(p.stone, sweep({{-half, 3.05f, 0}, {half, 3.05f, 0}}, string, {.up = glm::vec3(0, 1, 0)}));
  return m;
}

MeshBuilder store(const Palette& p, float width, float depth, float height) {
  MeshBuilder m;
  const float half = 0.5f * width;
  constexpr float kWall = 0.26f, kRise = 0.105f, kRun = 0.30f;
  const Outline door = {
      {half - 1.55f, 0.02f}, {half - 0.65f, 0.02f}, {half - 0.65f, 2.0f}, {half - 1.55f, 2.0f}};
  m.add(p.white,
        extrude(Outline({{-half, -0.2f}, {half, -0.2f}, {half, height}, {-half, height}}), {door}, kWall),
        at(0, 0, -kWall));
  const float rise = kRise / kRun * depth;
  for (const float s : {-1.0f, 1.0f}) {
    const Outline cheek = {
        {0, -0.2f}, {depth - 0.02f, -0.2f}, {depth - 0.02f, height + rise - 0.02f}, {0, height}};
    m.add(p.white, extrude(cheek, kWall), at(s > 0 ? half - kWall : -half, 0, -0.02f) * turnY(90));
  }
  // The plank door with its ledges.
  for (int i = 0; i < 6; ++i)
    m.add(p.door, box({half - 1.55f + 0.15f * float(i) + 0.002f, 0.03f, -0.14f},
                      {half - 1.40f + 0.15f * float(i) - 0.002f, 1.99f, -0.10f}, {.bevel = 0.006f}));
  m.add(p.inside, box({half - 1.6f, -0.1f, -0.30f}, {half - 0.6f, 2.1f, -0.138f}));
  for (const float y : {0.35f, 1.55f})
    m.add(p.steel, box({half - 1.50f, y, -0.105f}, {half - 0.95f, y + 0.05f, -0.09f}, {.bevel = 0.003f}));
  m.add(p.steel, torus(0.035f, 0.007f, 20, 8), at(half - 0.74f, 1.0f, -0.085f) * turnX(90));
  m.add(p.stone, box({half - 1.68f, 2.0f, -0.05f}, {half - 0.52f, 2.14f, 0.02f}, {.bevel = 0.01f}));
  m.add(p.stone, box({half - 1.6f, -0.05f, -0.2f}, {half - 0.6f, 0.035f, 0.12f}, {.bevel = 0.01f}));
  m.add(p.plinth, box({-half - 0.012f, -0.2f, -0.1f}, {half - 1.60f, 0.20f, 0.018f}, {.bevel = 0.01f}));
  const int rows = int(depth / kRun) + 2;
  const Outline body = {{0.16f, 0.0f}, {0.16f, 0.035f}, {-depth, rise + 0.09f}, {-depth, rise}};
  m.add(p.roof, placed(extrude(Outline(body), width + 0.24f),
                       at(-half - 0.12f, height, 0) * turnY(90) * scaled(-1, 1, 1)));
  m.add(p.roof, tiling(width + 0.2f, rows - 1, kRise, kRun), at(-half - 0.1f, height + 0.05f, 0.22f));
  Outline gutter({-0.06f, 0});
  gutter.arc(0.06f, 0, 1, 8).line(0.054f, 0).arc(-0.054f, 0, -1, 8);
  m.add(p.zinc, sweep({{-half - 0.14f, height - 0.005f, 0.25f}, {half + 0.14f, height - 0.005f, 0.25f}},
                      gutter, {.up = glm::vec3(0, 1, 0)}));
  return m;
}

MeshBuilder shed(const Palette& p) {
  MeshBuilder m;
  constexpr float kW = 1.9f, kD = 1.5f, kLow = 1.85f, kHigh = 2.25f;
  const auto wall = [&](float length, const glm::mat4& where, float high, bool door) {
    const int count = int(length / 0.125f);
    for (int i = 0; i < count; ++i) {
      const float a = -0.5f * length + length * float(i) / float(count), b = a + length / float(count);
      const bool opening = door && a > -0.45f && b < 0.45f;
      m.add(p.shed,
            box({a + 0.002f, 0.06f, opening ? -0.035f : -0.02f},
                {b - 0.002f, opening ? 1.78f : high, opening ? -0.012f : 0.006f + 0.006f * float(i & 1)},
                {.bevel = 0.004f}),
            where);
    }
  };
  wall(kW, at(0, 0, 0.5f * kD), kLow, true);
  wall(kW, at(0, 0, -0.5f * kD) * turnY(180), kHigh, false);
  wall(kD, at(0.5f * kW, 0, 0) * turnY(90), kLow, false);
  wall(kD, at(-0.5f * kW, 0, 0) * turnY(-90), kLow, false);
  m.add(p.inside, box({-0.5f * kW + 0.03f, 0.02f, -0.5f * kD + 0.03f},
                      {0.5f * kW - 0.03f, kLow - 0.02f, 0.5f * kD - 0.03f}));
  for (const float sx : {-1.0f, 1.0f})
    for (const float sz : {-1.0f, 1.0f})
      m.add(p.frame, block(0.10f, kLow, 0.10f, {.bevel = 0.008f}), at(sx * 0.5f * kW, 0, sz * 0.5f * kD));
  // Cheeks under the pent roof, which falls to the front.
  const Outline cheek = {{-0.5f * kD, kLow - 0.02f}, {0.5f * kD, kLow - 0.02f}, {0.5f * kD, kHigh}};
  for (const float s : {-1.0f, 1.0f})
    m.add(p.shed, extrude(cheek, 0.03f),
          at(s > 0 ? 0.5f * kW - 0.02f : -0.5f * kW - 0.01f, 0, 0) * turnY(90));
  const Outline roof = {
      {-1.02f, kLow - 0.06f}, {0.92f, kHigh + 0.045f}, {0.92f, kHigh + 0.105f}, {-1.02f, kLow + 0.0f}};
  m.add(p.felt, extrude(roof, kW + 0.34f, {.bevel = 0.01f}), at(-0.5f * kW - 0.17f, 0, 0) * turnY(90));
  for (const float y : {0.30f, 1.50f})
    m.add(p.shed,
          box({-0.40f, y, 0.5f * kD - 0.014f}, {0.40f, y + 0.10f, 0.5f * kD + 0.012f}, {.bevel = 0.006f}));
  m.add(p.frame,
        box({-0.52f, 1.78f, 0.5f * kD - 0.01f}, {0.52f, 1.85f, 0.5f * kD + 0.025f}, {.bevel = 0.006f}));
  m.add(p.steel,
        tube(smoothPath(
                 {{0.33f, 0.9f, 0.73f}, {0.33f, 0.92f, 0.79f}, {0.33f, 1.03f, 0.79f}, {0.33f, 1.05f, 0.73f}},
                 5),
             0.009f, 8));
  m.add(p.stone, box({-0.5f * kW - 0.05f, -0.06f, -0.5f * kD - 0.05f},
                     {0.5f * kW + 0.05f, 0.06f, 0.5f * kD + 0.05f}, {.bevel = 0.01f}));
  return m;
}

MeshBuilder fence(const Palette& p, float length, float height) {
  MeshBuilder m;
  constexpr float kPitch = 0.118f, kWidth = 0.150f;  // boards on both sides of the rails, overlapping
  const float half = 0.5f * length;
  const int count = int(length / kPitch);
  for (int i = 0; i < count; ++i)
    for (const bool backSide : {false, true}) {
      const uint32_t k = uint32_t(2 * i + int(backSide));
      const float x = -half + length * (float(i) + (backSide ? 1.0f : 0.5f)) / float(count);
      const float top = height - random(951, k, 0, 0.018f), z = backSide ? -0.075f : 0.045f;
      Outline board({-0.5f * kWidth * 0.72f, 0.07f});
      board.line(0.5f * kWidth * 0.72f, 0.07f).line(0.5f * kWidth * 0.72f, top - 0.045f);
      board.arc(-0.5f * kWidth * 0.72f, top - 0.045f, 0.62f, 6);
      Shape s = extrude(board, 0.022f, {.bevel = 0.004f});
      for (glm::vec2& uv : s.uvs) uv += glm::vec2(0.183f * float(k % 6), random(952, k, 0, 1));
      m.add(p.fence, s, at(x, 0, z) * turnZ(random(953, k, -0.35f, 0.35f)));
    }
  for (const float y : {0.32f, 1.05f, height - 0.30f})
    m.add(p.timberAcross, box({-half, y, -0.053f}, {half, y + 0.09f, 0.045f}, {.bevel = 0.006f}));
  const int posts = int(length / 2.0f);
  for (int i = 0; i <= posts; ++i) {
    const float x = -half + length * float(i) / float(posts);
    m.add(p.timber, block(0.11f, height + 0.03f, 0.24f, {.bevel = 0.01f}), at(x, -0.02f, -0.005f));
    Outline cap({0, 0});
    m.add(p.zinc, block(0.15f, 0.025f, 0.28f, {.bevel = 0.008f}), at(x, height + 0.01f, -0.005f));
  }
  // Panels between the two rows of boards and a kerb, so that nothing shines through.
  m.add(p.fence, box({-half, 0.1f, -0.02f}, {half, height - 0.08f, 0.02f}));
  m.add(p.plinth, box({-half, -0.2f, -0.09f}, {half, 0.16f, 0.075f}, {.bevel = 0.012f}));
  return m;
}

}  // namespace fovea::scene::yard
