// A gallery of modern art without punctual lights: all light comes from emissive panels in the ceiling. White walls,
// one red and one blue partition, smooth sculptures on plinths, a padded bench, and a mobile that turns in the air.
#include <cmath>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

struct Palette {
  uint32_t wall, floor, red, blue, panel, frame, plinth, bronze, marble, yellow, black, leather, steel, rope,
      picture[5];
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 901);
  p.wall = b.material("white wall", {0.86f, 0.86f, 0.85f}, {.texture = s.plaster, .metres = 4});
  p.floor = b.material("oak floor", {0.66f, 0.48f, 0.31f},
                       {.texture = s.planks, .metres = 1.0f, .metresHigh = 3.2f});
  p.red = b.material("red partition", {0.62f, 0.09f, 0.06f}, {.texture = s.plaster, .metres = 3});
  p.blue = b.material("blue partition", {0.10f, 0.20f, 0.46f}, {.texture = s.plaster, .metres = 3});
  p.panel = b.material("glowing panel", {0.80f, 0.80f, 0.80f}, {.emission = {4.6f, 4.5f, 4.2f}});
  p.frame = b.material("panel frame", {0.60f, 0.60f, 0.60f});
  p.plinth = b.material("plinth", {0.80f, 0.79f, 0.77f});
  p.bronze = b.material("bronze", {0.36f, 0.22f, 0.10f}, {.texture = s.mottled, .metres = 0.6f});
  p.marble = b.material("marble", {0.82f, 0.80f, 0.78f}, {.texture = s.mottled, .metres = 1.2f});
  p.yellow = b.material("yellow enamel", {0.82f, 0.58f, 0.04f});
  p.black = b.material("black enamel", {0.04f, 0.04f, 0.045f});
  p.leather = b.material("black leather", {0.07f, 0.065f, 0.06f});
  p.steel = b.material("steel", {0.50f, 0.50f, 0.52f});
  p.rope = b.material("rope", {0.46f, 0.08f, 0.10f});
  const glm::vec2 sizes[5] = {{1.8f, 1.3f}, {1.1f, 1.5f}, {2.2f, 1.4f}, {1.3f, 1.3f}, {1.0f, 1.4f}};
  for (uint32_t i = 0; i < 5; ++i)
    p.picture[i] = painting(b, "painting " + std::to_string(i + 1), sizes[i].x, sizes[i].y, 921 + 20 * i);
  return p;
}

constexpr Shell kHall = {.x = 6, .height = 4.2f, .back = -5, .front = 5, .thick = 0.3f};

// A trefoil knot, about the origin.
Shape knot(float size, float radius) {
  std::vector<glm::vec3> path;
  for (int i = 0; i <= 160; ++i) {
    const float t = 6.2831853f * float(i) / 160;
    path.push_back(
        size *
        glm::vec3(std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)) /
        3.0f);
  }
  return tube(path, radius, 20);
}

// A tall figure of stone: a lathe that swells and turns.
Shape figure(float height) {
  Outline o({0, 0});
  const float h = height;
  o.line(0.20f, 0).through({{0.24f, 0.15f * h},
                            {0.12f, 0.34f * h},
                            {0.22f, 0.55f * h},
                            {0.10f, 0.74f * h},
                            {0.13f, 0.88f * h},
                            {0.05f, h}},
                           10);
  o.line(0, h);
  return lathe(o, {.segments = 72, .creaseDegrees = 60, .swell = [h](float a, float y) {
                     return 1 + 0.22f * std::cos(2 * a + 4.2f * y / h) + 0.05f * std::cos(5 * a - 7 * y / h);
                   }});
}

void addPanels(MeshBuilder& m, const Palette& p) {
  for (const float z : {-3.1f, 0.0f, 3.1f})
    for (const float x : {-3.6f, 0.0f, 3.6f}) {
      const float y = kHall.height;
      m.add(p.panel, box({x - 0.9f, y - 0.05f, z - 0.45f}, {x + 0.9f, y + 0.05f, z + 0.45f}));
      for (const float side : {-1.0f, 1.0f}) {
        m.add(p.frame, box({x - 0.95f, y - 0.07f, z + side * 0.475f - 0.025f},
                           {x + 0.95f, y + 0.05f, z + side * 0.475f + 0.025f}));
        m.add(p.frame, box({x + side * 0.925f - 0.025f, y - 0.069f, z - 0.46f},
                           {x + side * 0.925f + 0.025f, y + 0.05f, z + 0.46f}));
      }
    }
}

void addPlinth(MeshBuilder& m, const Palette& p, float width, float height, const glm::mat4& where) {
  m.add(p.plinth, block(width, height, width, {.bevel = 0.008f, .bevelSteps = 2}), where);
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  // Two partitions in the hall, with pictures on both.
  m.add(p.red, box({-4.3f, -0.1f, -2.3f}, {-1.5f, 3.1f, -2.0f}, {.bevel = 0.006f}));
  m.add(p.blue, box({2.6f, -0.1f, -2.9f}, {2.9f, 3.1f, 0.3f}, {.bevel = 0.006f}));
  m.add(framed(p.black, p.picture[0], 1.8f, 1.3f), at(-2.9f, 1.6f, -2.0f));
  m.add(framed(p.black, p.picture[1], 1.1f, 1.5f), at(2.6f, 1.6f, -1.3f) * turnY(-90));
  m.add(framed(p.plinth, p.picture[2], 2.2f, 1.4f), at(0.8f, 1.65f, kHall.back));
  m.add(framed(p.black, p.picture[3], 1.3f, 1.3f), at(-kHall.x, 1.6f, 0.6f) * turnY(90));
  m.add(framed(p.black, p.picture[4], 1.0f, 1.4f), at(kHall.x, 1.6f, 1.5f) * turnY(-90));
  m.add(paddedBench(p.leather, p.steel, 1.8f, 0.55f), at(0.35f, 0, 0.9f) * turnY(8));
  // Sculptures.
  addPlinth(m, p, 0.55f, 0.95f, at(-1.05f, 0, -0.5f) * turnY(15));
  m.add(p.bronze, knot(0.34f, 0.07f), at(-1.05f, 1.36f, -0.5f) * turnY(25));
  addPlinth(m, p, 0.62f, 0.35f, at(1.35f, 0, -1.6f));
  m.add(p.marble, figure(1.75f), at(1.35f, 0.349f, -1.6f));
  addPlinth(m, p, 0.5f, 0.8f, at(-3.7f, 0, 0.7f) * turnY(-10));
  for (const auto& [y, r] : {std::pair{0.20f, 0.21f}, std::pair{0.53f, 0.15f}, std::pair{0.76f, 0.10f}})
    m.add(p.yellow, sphere(r, 40, 24), at(-3.7f, 0.8f + y, 0.7f));
  m.add(p.black, torus(0.42f, 0.13f, 64, 24), at(4.3f, 0.55f, 1.8f) * turnZ(90) * turnX(30));
  addPlinth(m, p, 0.8f, 0.12f, at(4.3f, 0, 1.8f));
  // A rope on posts before the red partition.
  std::vector<glm::vec3> posts = {{-4.1f, 0, -1.1f}, {-2.9f, 0, -1.0f}, {-1.9f, 0, -1.25f}};
  for (const glm::vec3& q : posts) {
    m.add(p.steel, cylinder(0.14f, 0.015f, 32, 0.004f), at(q));
    m.add(p.steel, tube({{0, 0.01f, 0}, {0, 0.92f, 0}}, 0.016f, 12), at(q));
    m.add(p.steel, sphere(0.03f, 16, 10), at(q) * at(0, 0.93f, 0));
  }
  for (size_t i = 0; i + 1 < posts.size(); ++i) {
    std::vector<glm::vec3> path;
    for (int k = 0; k <= 16; ++k) {
      const float t = float(k) / 16;
      path.push_back(glm::mix(posts[i], posts[i + 1], t) + glm::vec3(0, 0.88f - 0.9f * t * (1 - t), 0));
    }
    m.add(p.rope, tube(path, 0.014f, 8));
  }
  b.place("exhibits", b.mesh("exhibits", std::move(m)));
  // A mobile that hangs from the ceiling: its own origin is where it turns.
  MeshBuilder mobile;
  mobile.add(p.black, tube(smoothPath({{-0.9f, -0.05f, 0}, {0, 0, 0}, {0.9f, -0.12f, 0}}, 8), 0.006f, 8));
  mobile.add(p.black, tube({{0, 0, 0}, {0, 0.28f, 0}}, 0.004f, 6));
  const struct {
    float x, y, size;
    uint32_t color;
  } discs[6] = {{-0.9f, -0.32f, 0.20f, p.red}, {-0.55f, -0.42f, 0.14f, p.yellow},
                {0.9f, -0.45f, 0.22f, p.blue}, {0.62f, -0.30f, 0.12f, p.black},
                {0.30f, -0.50f, 0.16f, p.red}, {-0.2f, -0.36f, 0.11f, p.yellow}};
  for (int i = 0; i < 6; ++i) {
    const float top = -0.09f * std::abs(discs[i].x);
    mobile.add(p.black, tube({{discs[i].x, top, 0}, {discs[i].x, discs[i].y, 0}}, 0.003f, 6));
    mobile.add(discs[i].color, cylinder(discs[i].size, 0.012f, 40, 0.004f),
               at(discs[i].x, discs[i].y - discs[i].size, 0) * turnY(35 * float(i)) * turnX(90) *
                   scaled(1, 1, 0.75f));
  }
  b.place("mobile", b.mesh("mobile", std::move(mobile)), {0.45f, 3.55f, -0.35f}, 20);
  MeshBuilder wire;
  wire.add(p.black, tube({{0, 0.28f, 0}, {0, 0.66f, 0}}, 0.004f, 6));
  b.place("wire of the mobile", b.mesh("wire of the mobile", std::move(wire)), {0.45f, 3.55f, -0.35f});
}

}  // namespace

static Scene galleryScene() {
  SceneBuilder b("gallery");
  const Palette p = makePalette(b);
  MeshBuilder hall;
  Shell shell = kHall;
  shell.wall = shell.ceiling = p.wall;
  shell.floor = p.floor;
  addShell(hall, shell);
  addSkirting(hall, shell, p.plinth, 0.09f);
  addPanels(hall, p);
  b.place("hall", b.mesh("hall", std::move(hall)));
  furnish(b, p);
  b.camera({-0.9f, 1.6f, 4.4f}, {-0.15f, 1.45f, -1.5f}, 60);
  return b.finish(1.6f, {0.4f, 0.5f});
}

FOVEA_SCENE("gallery", galleryScene);

}  // namespace fovea::scene
