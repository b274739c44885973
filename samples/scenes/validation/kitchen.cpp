// A kitchen at night: three spots in pendants above a counter, a strip under the wall cupboards and the light of an
// open refrigerator. Much is white and close together, and what lies between the counters is lit by them alone.
#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

struct Palette {
  uint32_t wall, ceiling, floor, front, counter, steel, dark, tile, strip, lining, glow, copper, green, lemon,
      board;
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 951);
  p.wall = b.material("wall", {0.72f, 0.70f, 0.64f}, {.texture = s.plaster, .metres = 3});
  p.ceiling = b.material("ceiling", {0.84f, 0.83f, 0.80f}, {.texture = s.plaster, .metres = 4});
  p.floor = b.material("oak floor", {0.50f, 0.36f, 0.22f},
                       {.texture = s.planks, .metres = 0.8f, .metresHigh = 2.6f});
  p.front = b.material("blue fronts", {0.15f, 0.24f, 0.33f});
  p.counter = b.material("white counter", {0.80f, 0.79f, 0.76f});
  p.steel = b.material("steel", {0.50f, 0.50f, 0.49f});
  p.dark = b.material("black iron", {0.05f, 0.05f, 0.05f});
  const uint32_t tiles = b.texture(masonry("tiles",
                                           {.columns = 6,
                                            .rows = 12,
                                            .joint = 0.06f,
                                            .low = glm::vec3(0.85f),
                                            .high = glm::vec3(0.97f),
                                            .jointColor = glm::vec3(0.55f),
                                            .weathering = 0.04f},
                                           512, 512, 952));
  p.tile = b.material("tiles", {0.76f, 0.78f, 0.74f}, {.texture = tiles, .metres = 1.2f});
  p.strip = b.material("strip", glm::vec3(0.4f), {.emission = {9.0f, 7.4f, 5.2f}});
  p.lining = b.material("white lining", {0.82f, 0.83f, 0.83f});
  p.glow = b.material("refrigerator lamp", glm::vec3(0.4f), {.emission = {10, 11, 12}});
  p.copper = b.material("copper", {0.66f, 0.33f, 0.20f});
  p.green = b.material("green glaze", {0.12f, 0.34f, 0.20f});
  p.lemon = b.material("lemons", {0.85f, 0.68f, 0.08f});
  p.board = b.material("chopping board", {0.56f, 0.38f, 0.20f}, {.texture = s.grain, .metres = 0.3f});
  return p;
}

constexpr Shell kRoom = {.x = 2.4f, .height = 2.6f, .back = -2.0f, .front = 2.6f};

// Cupboards from x = 0 to count * 0.6 with their backs at z = 0, `depth` deep, from `low` to `high`.
void addCupboards(MeshBuilder& m, const Palette& p, int count, float depth, float low, float high,
                  const glm::mat4& where) {
  m.add(p.front, box({0, low, 0}, {0.6f * float(count), high, depth - 0.02f}), where);
  for (int i = 0; i < count; ++i) {
    const float x = 0.6f * float(i);
    m.add(p.front,
          box({x + 0.004f, low + 0.004f, depth - 0.019f}, {x + 0.596f, high - 0.004f, depth},
              {.bevel = 0.003f}),
          where);
    m.add(p.copper,
          tube({{x + 0.08f, high - 0.06f, depth + 0.02f}, {x + 0.22f, high - 0.06f, depth + 0.02f}}, 0.006f,
               10),
          where);
    for (const float end : {0.085f, 0.215f})
      m.add(
          p.copper,
          tube({{x + end, high - 0.06f, depth - 0.002f}, {x + end, high - 0.06f, depth + 0.02f}}, 0.005f, 8),
          where);
  }
}

// A refrigerator with an open front, 0.7 m wide, whose lamp is under its top. Its back is at z = 0.
MeshBuilder refrigerator(const Palette& p) {
  MeshBuilder m;
  m.add(p.steel, box({-0.35f, 0, 0}, {-0.31f, 1.9f, 0.65f}));
  m.add(p.steel, box({0.31f, 0, 0}, {0.35f, 1.9f, 0.65f}));
  m.add(p.steel, box({-0.31f, 1.86f, 0}, {0.31f, 1.9f, 0.65f}));
  m.add(p.steel, box({-0.31f, 0, 0}, {0.31f, 0.1f, 0.65f}));
  m.add(p.lining, box({-0.31f, 0.1f, 0}, {0.31f, 1.86f, 0.05f}));
  for (const float x : {-0.309f, 0.299f})
    m.add(p.lining, box({x, 0.101f, 0.051f}, {x + 0.01f, 1.859f, 0.64f}));
  m.add(p.lining, box({-0.298f, 1.849f, 0.051f}, {0.298f, 1.859f, 0.64f}));
  m.add(p.glow, box({-0.2f, 1.825f, 0.12f}, {0.2f, 1.848f, 0.2f}));
  for (const float y : {0.45f, 0.8f, 1.15f, 1.5f})
    m.add(p.lining, box({-0.298f, y, 0.051f}, {0.298f, y + 0.012f, 0.56f}));
  // What is in it.
  for (int i = 0; i < 4; ++i)
    m.add(p.green, cylinder(0.045f, 0.22f, 28, 0.01f), at(-0.2f + 0.12f * float(i), 0.8121f, 0.3f));
  for (int i = 0; i < 5; ++i)
    m.add(p.lemon, sphere(0.035f, 20, 12), at(-0.2f + 0.09f * float(i), 1.198f, 0.32f));
  m.add(p.copper, cylinder(0.11f, 0.14f, 36, 0.01f), at(0.1f, 0.4621f, 0.28f));
  // The door stands open to the left.
  m.add(p.steel, box({-0.95f, 0.05f, 0.66f}, {-0.355f, 1.88f, 0.72f}, {.bevel = 0.01f}));
  return m;
}

MeshBuilder pendant(const Palette& p) {
  MeshBuilder m;
  Outline cone({0.13f, 0});
  cone.curve({0.12f, 0.08f}, {0.04f, 0.10f}, {0.03f, 0.18f}, 8).line(0.022f, 0.18f);
  cone.curve({0.032f, 0.095f}, {0.11f, 0.075f}, {0.122f, 0}, 8);
  m.add(p.copper, lathe(cone, {.segments = 48, .closed = true}));
  m.add(p.dark, cylinder(0.028f, 0.04f, 24), at(0, 0.181f, 0));
  m.add(p.dark, tube({{0, 0.21f, 0}, {0, 0.88f, 0}}, 0.004f, 8));
  return m;
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  const glm::mat4 back = at(-1.6f, 0, kRoom.back);
  addCupboards(m, p, 5, 0.6f, 0.1f, 0.86f, back);
  m.add(p.dark, box({0, 0, 0.001f}, {3.0f, 0.099f, 0.52f}), back);
  m.add(p.counter, box({-0.02f, 0.861f, 0.001f}, {3.02f, 0.90f, 0.63f}, {.bevel = 0.004f}), back);
  m.add(p.tile, box({-0.02f, 0.901f, 0.0005f}, {3.02f, 1.449f, 0.012f}), back);
  addCupboards(m, p, 5, 0.34f, 1.45f, 2.2f, back);
  m.add(p.strip, box({0.1f, 1.435f, 0.25f}, {2.9f, 1.4495f, 0.27f}), back);
  m.add(refrigerator(p), at(kRoom.x - 0.001f, 0, 0.2f) * turnY(-90));
  // The counter in the middle, with what lies on it.
  m.add(p.front, box({-1.3f, 0.08f, 0.1f}, {0.7f, 0.88f, 0.85f}, {.bevel = 0.004f}));
  m.add(p.dark, box({-1.25f, 0, 0.15f}, {0.65f, 0.079f, 0.8f}));
  m.add(p.counter, box({-1.36f, 0.881f, 0.02f}, {0.76f, 0.92f, 0.93f}, {.bevel = 0.004f}));
  m.add(p.board, box({-0.9f, 0.9205f, 0.3f}, {-0.45f, 0.945f, 0.6f}, {.bevel = 0.005f}));
  for (const glm::vec3& at_ :
       {glm::vec3(-0.75f, 0.981f, 0.42f), glm::vec3(-0.62f, 0.981f, 0.47f), glm::vec3(-0.68f, 0.981f, 0.36f)})
    m.add(p.lemon, sphere(0.035f, 24, 14), at(at_));
  m.add(p.green, vase(), at(0.3f, 0.9205f, 0.35f));
  m.add(p.copper,
        lathe(Outline({{0, 0}, {0.11f, 0}, {0.12f, 0.16f}, {0.115f, 0.16f}, {0.105f, 0.006f}, {0, 0.006f}}),
              {.segments = 48}),
        at(-1.1f, 0.9005f, kRoom.back + 0.32f));
  for (int i = 0; i < 3; ++i)
    m.add(p.green, cylinder(0.05f, 0.1f + 0.03f * float(i), 28, 0.006f),
          at(0.3f + 0.14f * float(i), 0.9005f, kRoom.back + 0.2f));
  b.place("furniture", b.mesh("furniture", std::move(m)));
  MeshBuilder lamps;
  for (const float x : {-1.0f, -0.3f, 0.4f}) lamps.add(pendant(p), at(x, 1.72f, 0.47f));
  b.place("pendants", b.mesh("pendants", std::move(lamps)));
  // A balloon that a child has let go.
  MeshBuilder balloon;
  Outline skin({0, -0.19f});
  skin.line(0.012f, -0.185f)
      .line(0.008f, -0.165f)
      .through({{0.09f, -0.09f}, {0.15f, 0.03f}, {0.10f, 0.14f}, {0.03f, 0.175f}}, 7)
      .line(0, 0.178f);
  balloon.add(p.lemon, lathe(skin, {.segments = 48}));
  balloon.add(
      p.dark,
      tube(smoothPath({{0, -0.18f, 0}, {0.02f, -0.4f, 0.01f}, {-0.02f, -0.6f, 0}, {0.01f, -0.8f, 0.01f}}),
           0.0025f, 6));
  b.place("balloon", b.mesh("balloon", std::move(balloon)), {-1.75f, 1.7f, 0.3f});
}

}  // namespace

static Scene kitchenScene() {
  SceneBuilder b("kitchen");
  const Palette p = makePalette(b);
  MeshBuilder room;
  Shell shell = kRoom;
  shell.wall = p.wall;
  shell.floor = p.floor;
  shell.ceiling = p.ceiling;
  addShell(room, shell);
  b.place("room", b.mesh("room", std::move(room)));
  furnish(b, p);
  for (const float x : {-1.0f, -0.3f, 0.4f})
    addSpot(b, "pendant", {1.0f, 0.80f, 0.58f}, 5, {x, 1.80f, 0.47f}, {0, -1, 0}, 20, 38);
  b.camera({-1.5f, 1.62f, 2.3f}, {0.35f, 1.0f, -0.9f}, 62);
  return b.finish(2.2f, {0.45f, 0.55f});
}

FOVEA_SCENE("kitchen", kitchenScene);

}  // namespace fovea::scene
