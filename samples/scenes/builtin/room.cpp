// A children's room of about 476k triangles. The afternoon sun falls through the only window onto a blue rug with a
// toy train and onto the foot of a red closet; everything else is lit by what those, the floor and the walls reflect.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/room_parts.h"

namespace fovea::scene {
namespace {

using namespace room;
using namespace model;

// Inner faces of the walls; x runs from -kX to kX.
constexpr float kX = 2.5f, kBack = -2.3f, kFront = 2.6f, kHeight = 2.7f, kThick = 0.22f;
constexpr glm::vec2 kWindow{0.4f, 0.80f};  // middle of its sill
constexpr float kWindowWidth = 1.8f, kWindowHeight = 1.5f;
constexpr glm::vec3 kTrack{-0.60f, 0.0135f, -0.05f};  // middle of the oval and of the rug

Shape ring(const Outline& section, float y) {
  const std::vector<glm::vec3> path = {{-kX, 0, kBack}, {kX, 0, kBack}, {kX, 0, kFront}, {-kX, 0, kFront}};
  return placed(sweep(path, section, {.closedPath = true, .up = glm::vec3(0, 1, 0)}), at(0, y, 0));
}

void addWalls(MeshBuilder& m, const Palette& p) {
  const float x = kX + kThick, top = kHeight + kThick;
  const Outline hole =
      rectangle(kWindowWidth, kWindowHeight).moved({kWindow.x, kWindow.y + 0.5f * kWindowHeight});
  m.add(p.wall, extrude(Outline({{-x, -0.2f}, {x, -0.2f}, {x, top}, {-x, top}}), {hole}, kThick),
        at(0, 0, kBack - kThick));
  m.add(p.wall, box({-x, -0.2f, kFront}, {x, top, kFront + kThick}));
  m.add(p.wall, box({-x, -0.2f, kBack - 0.1f}, {-kX, top, kFront + 0.1f}));
  m.add(p.wall, box({kX, -0.2f, kBack - 0.1f}, {x, top, kFront + 0.1f}));
  m.add(p.ceiling, box({-kX - 0.1f, kHeight, kBack - 0.1f}, {kX + 0.1f, kHeight + 0.19f, kFront + 0.1f}));
  Outline cornice({-0.01f, -0.16f});
  cornice.line(0.016f, -0.16f).arc(0.016f, -0.140f, 1, 5).line(0.012f, -0.136f).line(0.012f, -0.120f);
  cornice.curve({0.022f, -0.06f}, {0.06f, -0.028f}, {0.115f, -0.022f}, 12)
      .line(0.118f, -0.016f)
      .arc(0.140f, -0.004f, 0.5f, 5);
  cornice.line(0.150f, -0.004f).line(0.150f, 0.01f).line(-0.01f, 0.01f);
  m.add(p.paint, ring(cornice, kHeight));
  Outline skirting({-0.01f, -0.01f});
  skirting.line(0.018f, -0.01f)
      .line(0.018f, 0.075f)
      .curve({0.018f, 0.09f}, {0.010f, 0.088f}, {0.008f, 0.105f}, 5)
      .line(-0.01f, 0.105f);
  m.add(p.paint, ring(skirting, 0));
  // A rosette around the lamp's cord.
  Outline rosette({0, 0});
  rosette.line(0.24f, 0)
      .arc(0.22f, 0.022f, 0.5f, 5)
      .line(0.19f, 0.018f)
      .arc(0.15f, 0.030f, -0.3f, 5)
      .line(0.08f, 0.034f)
      .line(0, 0.036f);
  m.add(
      p.ceiling,
      lathe(rosette,
            {.segments = 96,
             .swell = [](float a, float y) { return 1 + (y > 0.001f ? 0.025f : 0.0f) * std::cos(16 * a); }}),
      at(-0.35f, kHeight + 0.001f, 0.1f) * turnX(180));
}

void addFloor(MeshBuilder& m, const Palette& p) {
  constexpr int kRows = 36;
  const float wide = 2 * kX / kRows;
  uint32_t k = 0;
  for (int i = 0; i < kRows; ++i) {
    float z = kBack - random(601, uint32_t(i), 0.0f, 1.6f);
    while (z < kFront) {
      const float length = random(602, ++k, 1.1f, 2.1f);
      const float low = std::max(z, kBack), high = std::min(z + length, kFront);
      z += length;
      if (high - low < 0.05f) continue;
      const float a = -kX + wide * float(i);
      Shape plank = box({a + 0.0006f, -0.02f, low + 0.0006f},
                        {a + wide - 0.0006f, random(603, k, -0.0006f, 0.0f), high - 0.0006f},
                        {.bevel = 0.0022f, .bottom = false});
      // Each plank shows another board of the picture.
      const glm::vec2 cut(0.14f * float(int(random(604, k) * 4.99f)) - a, random(605, k, 0, 2.4f));
      for (glm::vec2& uv : plank.uvs) uv += cut;
      m.add(p.floor, plank);
    }
  }
  m.add(p.gap, box({-kX - 0.1f, -0.2f, kBack - 0.1f}, {kX + 0.1f, -0.008f, kFront + 0.1f}));
}

// What is seen through the window: a hedge and a strip of ground.
void addOutside(MeshBuilder& m, const Palette& p) {
  constexpr float back = -3.12f, front = -2.80f, top = 1.36f;
  m.add(p.soil, box({-1.9f, -0.2f, back - 0.05f}, {2.7f, -0.12f, kBack - 0.1f}));
  m.add(p.hedge, bent(
                     box({-1.8f, -0.15f, back}, {2.6f, top, front},
                         {.bevel = 0.08f, .bevelSteps = 3, .cells = {44, 14, 4}}),
                     [](glm::vec3 q) {
                       return q + 0.05f * glm::vec3(0, noise(glm::vec2(q.x, q.z) * 5.0f, 611),
                                                    1.4f * noise(glm::vec2(q.x, q.y) * 6.0f, 612) - 0.7f);
                     },
                     80));
  const Shape blade = leafBlade({.length = 0.075f, .width = 0.042f, .fold = 0.25f, .droop = 0.2f});
  for (uint32_t i = 0; i < 3400; ++i) {
    const bool above = i % 4 == 0;
    const float x = random(613, i, -1.2f, 2.2f);
    const glm::vec3 q(x, above ? top + random(614, i, 0.0f, 0.05f) : random(614, i, 0.55f, top + 0.03f),
                      above ? random(615, i, back, front) : front + random(615, i, -0.02f, 0.035f));
    const glm::vec3 d(random(616, i, -1, 1), random(617, i, -0.4f, 0.9f),
                      above ? random(618, i, -1, 1) : random(618, i, 0.15f, 1.2f));
    m.add(p.leaf, blade, facing(q, d));
  }
}

// A door with its casing on the wall; looks along +z, stands on y = 0.
MeshBuilder roomDoor(const Palette& p) {
  MeshBuilder m;
  const BoxOptions soft = {.bevel = 0.004f, .bevelSteps = 2};
  m.add(p.paint, box({-0.42f, 0.004f, -0.02f}, {0.42f, 2.04f, 0.012f}, soft));
  for (const float s : {-1.0f, 1.0f}) {
    m.add(p.paint,
          box({s > 0 ? 0.425f : -0.515f, 0, -0.02f}, {s > 0 ? 0.515f : -0.425f, 2.05f, 0.028f}, soft));
    for (const auto& [low, high] : {std::pair{0.14f, 0.90f}, std::pair{1.02f, 1.90f}})
      m.add(p.paint, box({s > 0 ? 0.05f : -0.33f, low, 0.0f}, {s > 0 ? 0.33f : -0.05f, high, 0.020f},
                         {.bevel = 0.014f, .bevelSteps = 3}));
  }
  m.add(p.paint, box({-0.53f, 2.05f, -0.02f}, {0.53f, 2.15f, 0.034f}, soft));
  m.add(p.brass, tube(smoothPath({{0.35f, 0.98f, 0.01f},
                                  {0.35f, 0.98f, 0.055f},
                                  {0.32f, 0.98f, 0.062f},
                                  {0.25f, 0.975f, 0.060f}},
                                 6),
                      0.008f, 12));
  return m;
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  m.add(closet(p), at(-kX, 0, -0.15f) * turnY(90));
  m.add(bookcase(p), at(-1.55f, 0, kBack));
  m.add(daybed(p), at(0.75f, 0, kBack + 0.26f));
  m.add(floorLamp(p), at(-0.84f, 0, -1.72f) * turnY(20));
  m.add(pendant(p), at(-0.35f, kHeight - 0.03f, 0.1f));
  m.add(table(p), at(0.98f, 0, -0.42f) * turnY(12));
  m.add(chair(p), at(1.06f, 0, 0.16f) * turnY(172));
  m.add(drawers(p), at(kX, 0, 0.55f) * turnY(-90));
  m.add(roomDoor(p), at(-0.9f, 0, kFront) * turnY(180));
  m.add(windowFrame(p, kWindowWidth, kWindowHeight), at(kWindow.x, kWindow.y, kBack));
  m.add(curtainRod(p, 3.0f), at(kWindow.x, 2.43f, kBack + 0.12f));
  m.add(pictureFrame(p, p.picture[1], 0.34f, 0.34f), at(-1.92f, 1.97f, kBack));
  m.add(pictureFrame(p, p.picture[0], 0.46f, 0.36f), at(-1.36f, 1.99f, kBack));
  m.add(pictureFrame(p, p.picture[2], 0.40f, 0.52f), at(-kX, 1.45f, -1.55f) * turnY(90));
  m.add(pictureFrame(p, p.picture[0], 0.70f, 0.50f), at(kX, 1.6f, 0.55f) * turnY(-90));
  m.add(bunting(p, 1.66f, 0.11f), at(-2.46f, 2.46f, kBack + 0.02f));
  b.place("furniture", b.mesh("furniture", std::move(m)));

  MeshBuilder toys;
  toys.add(rug(p), at(kTrack.x, 0, kTrack.z));
  toys.add(track(p), at(kTrack));
  toys.add(tunnel(p), at(kTrack) * at(0.12f, 0, -kBend));
  toys.add(castle(p), at(kTrack) * at(-0.02f, 0, -0.06f) * turnY(18));
  toys.add(toyTree(p, 0.27f), at(kTrack) * at(-0.92f, 0, -0.66f))
      .add(toyTree(p, 0.21f), at(kTrack) * at(-0.72f, 0, -0.75f));
  toys.add(toyTree(p, 0.24f), at(kTrack) * at(0.50f, 0, -0.22f));
  toys.add(ball(p, 0.115f), at(0.44f, kTrack.y, 0.57f) * turnY(40));
  toys.add(basket(p), at(-1.40f, 0, -1.52f));
  toys.add(stackingRings(p), at(kTrack) * at(-0.44f, 0, 0.12f));
  toys.add(openBook(p), at(0.02f, 0.0f, 1.17f) * turnY(28));
  const BoxOptions round = {.bevel = 0.004f, .bevelSteps = 2};
  toys.add(p.toy[3], block(0.07f, 0.07f, 0.07f, round), at(-0.45f, 0, 1.16f) * turnY(25));
  toys.add(p.toy[0], block(0.14f, 0.035f, 0.07f, round), at(-0.62f, 0, 1.05f) * turnY(-38));
  toys.add(p.toy[2], cylinder(0.032f, 0.11f, 40, 0.003f), at(-0.36f, 0.032f, 1.34f) * turnY(65) * turnZ(90));
  b.place("toys", b.mesh("toys", std::move(toys)));
}

// The curtains: the left one billows and ripples in the draught; the right one is tied back.
void addCurtains(SceneBuilder& b, const Palette& p) {
  CurtainForm f;
  f.width = 0.52f;
  f.height = 2.36f;
  f.folds = 6;
  f.seed = 621;
  f.billow = 0.17f;
  const auto shape = [&](float billow, float wave, float phase) {
    CurtainForm g = f;
    g.billow = billow;
    g.wave = wave;
    g.phase = phase;
    return curtain(g, 44, 20);
  };
  const uint32_t mesh = b.mesh(
      "curtain in the draught",
      cage(shape(0.17f, 0, 0), 2,
           {shape(0.32f, 0, 0), shape(0.17f, 0.085f, 0), shape(0.17f, 0.085f, 0.5f * glm::pi<float>())}),
      p.curtain);
  const glm::vec3 rod(kWindow.x, 2.405f, kBack + 0.12f);
  const uint32_t node = b.place("curtain in the draught", mesh, rod + glm::vec3(-1.42f, 0, 0));
  b.swing(node,
          {{.amplitude = 0.9f, .period = 4, .phase = 0.1f},
           {.amplitude = 0.8f, .period = 2},
           {.amplitude = 0.8f, .period = 2, .phase = 0.25f}},
          8);

  MeshBuilder m;
  CurtainForm tied = f;
  tied.gather = 0.8f;
  tied.billow = 0;
  tied.seed = 631;
  m.add(p.curtain, surface(curtain(tied, 120, 60)), at(rod + glm::vec3(1.42f, 0, 0)) * scaled(-1, 1, 1));
  m.add(p.cloth[0], torus(0.105f, 0.014f, 40, 8),
        at(rod + glm::vec3(1.35f, -1.37f, 0)) * scaled(0.95f, 1.6f, 0.75f) * turnZ(-12));
  for (const float side : {-1.0f, 1.0f})
    for (int i = 0; i < 7; ++i)
      m.add(p.brass, torus(0.020f, 0.0035f, 24, 8),
            at(rod + glm::vec3(side * (1.42f - 0.52f * (float(i) + 0.02f) / 6.1f), 0.020f, 0)) * turnZ(90));
  b.place("curtain, tied back", b.mesh("curtain, tied back", std::move(m)));
}

void addTrain(SceneBuilder& b, const Palette& p) {
  // Behind the locomotive, as the scene file has it.
  const struct {
    const char* name;
    MeshBuilder mesh;
    float behind;
  } cars[3] = {{"locomotive", locomotive(p), 0}, {"tender", tender(p), 0.345f}, {"coach", coach(p), 0.675f}};
  for (const auto& car : cars) {
    const TrackPoint t = trackAt(-0.30f - car.behind);
    b.place(car.name, b.mesh(car.name, car.mesh), kTrack + t.position + glm::vec3(0, kRailTop, 0),
            t.turnYDegrees);
  }
}

}  // namespace

static Scene roomScene() {
  SceneBuilder b("room");
  const Palette p = makePalette(b);
  MeshBuilder building;
  addWalls(building, p);
  addFloor(building, p);
  addOutside(building, p);
  b.place("building", b.mesh("building", std::move(building)));
  furnish(b, p);
  addCurtains(b, p);
  addTrain(b, p);

  Light sun;
  sun.name = "sun";
  sun.type = LightType::Spot;
  sun.color = {1.0f, 0.92f, 0.80f};
  sun.direction = glm::normalize(glm::vec3(-0.42f, -0.41f, 0.68f));
  sun.position = glm::vec3(kWindow.x, kWindow.y + 0.5f * kWindowHeight, kBack) - 10.0f * sun.direction;
  sun.intensity = 2000;  // 20 lux at the window
  sun.innerConeAngle = glm::radians(5.6f);
  sun.outerConeAngle = glm::radians(6.1f);
  b.scene.lights.push_back(sun);
  b.camera({1.6f, 1.30f, 2.2f}, {-0.6f, 0.72f, -0.9f}, 60);
  b.scene.environment = {0.06f, 0.095f, 0.15f};
  return b.finish(7.5f, {0.5f, 0.6f});
}

FOVEA_SCENE("room", roomScene);

}  // namespace fovea::scene
