// A balcony on a first floor by the sea, of about 192k triangles: pale tiles, a balustrade, pots, a bistro table, and
// an awning of orange canvas whose blind falls at the far end. The sun shines along the street onto the blind, which
// colours the floor; the side of the house and everything in the shade of the awning is lit by what these reflect.
// Houses across the street close the view.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "fovea/scene.h"
#include "samples/scenes/builtin/balcony_parts.h"
#include "samples/scenes/builtin/modelling/plants.h"

namespace fovea::scene {
namespace {

using namespace balcony;
using namespace model;

// Plan: the wall of the house is at x = kWall and faces +x; the balustrade stands at x = kRail and z = kEnd.
constexpr float kWall = -1.7f, kRail = 1.45f, kEnd = -4.9f, kBack = 3.3f;
constexpr float kStreet = -4.2f, kOpposite = 6.6f, kFar = -10.0f, kNear = 5.2f, kTop = 4.7f;
constexpr float kAwningFront = -2.95f, kAwningTop = 2.62f, kLanternZ = -2.3f;

// ---- Houses ----

struct Opening {
  float x, y, width, height;
  Shutters shutters;
  bool door = false, balcony = false, flowers = false;
};

// A wall of a house along x, with its face at z = 0 towards +z, sealed by a second layer.
void addHouse(MeshBuilder& m, const Palette& p, float x0, float x1, float top, uint32_t plaster,
              uint32_t wood, const std::vector<Opening>& openings, float fineFrom = 1e9f) {
  std::vector<Outline> holes;
  for (const Opening& o : openings) {
    holes.push_back(rectangle(o.width, o.height).moved({o.x, o.y + 0.5f * o.height}));
    m.add(window(p, wood, o.width, o.height, o.shutters, o.door, o.y < 1 && o.y > fineFrom), at(o.x, o.y, 0));
    if (o.balcony) m.add(ironBalcony(p, o.width + 0.9f, 0.75f), at(o.x, o.y - 0.005f, 0));
  }
  const float low = kStreet - 0.2f;
  m.add(plaster, extrude(Outline({{x0, low}, {x1, low}, {x1, top}, {x0, top}}), holes, 0.26f),
        at(0, 0, -0.26f));
  m.add(p.dark, box({x0, low, -0.50f}, {x1, top, -0.2595f}));
}

void addStoreys(MeshBuilder& m, const Palette& p, float x0, float x1, float top) {
  Outline course({-0.02f, 0});
  course.line(0.05f, 0)
      .line(0.05f, 0.06f)
      .arc(0.09f, 0.10f, -0.4142f, 3)
      .line(0.09f, 0.16f)
      .line(-0.02f, 0.16f);
  const auto along = [&](const Outline& section, float y) {
    // The front of the wall is to the right of the path.
    m.add(p.stone, sweep({{x0, y, 0}, {x1, y, 0}}, section.scaled({1, 1}), {.up = glm::vec3(0, 1, 0)}));
  };
  along(course, -0.42f);
  along(course, top - 0.45f);
  m.add(p.stone, box({x0, kStreet - 0.1f, -0.02f}, {x1, kStreet + 0.65f, 0.035f}, {.bevel = 0.012f}));
  m.add(p.roofTiles, eaves(x1 - x0), at(0.5f * (x0 + x1), top - 0.01f, 0.0f));
}

void addStreet(MeshBuilder& m, const Palette& p) {
  m.add(p.street, box({kWall - 2, kStreet - 0.5f, kFar - 2}, {kOpposite + 2, kStreet, kNear + 2}));
  {  // closes the street, in the sun
    MeshBuilder far;
    const float x0 = kWall - 0.1f, x1 = kOpposite + 0.1f;
    addHouse(far, p, x0, x1, kTop + 0.5f, p.rose, p.green,
             {{-0.3f, 0.5f, 0.95f, 1.6f, Shutters::Open},
              {2.05f, -0.12f, 1.05f, 2.2f, Shutters::Open, true, true},
              {4.55f, 0.5f, 0.95f, 1.6f, Shutters::Ajar, false, false, true},
              {-0.3f, 3.0f, 0.9f, 1.2f, Shutters::Closed},
              {2.05f, 3.0f, 0.9f, 1.2f, Shutters::Open},
              {4.55f, 3.0f, 0.9f, 1.2f, Shutters::Closed},
              {-0.2f, kStreet + 0.05f, 1.2f, 2.35f, Shutters::Closed, true},
              {2.05f, kStreet + 1.1f, 0.9f, 1.3f, Shutters::Closed},
              {4.45f, kStreet + 0.05f, 1.3f, 2.5f, Shutters::Closed, true}});
    addStoreys(far, p, x0, x1, kTop + 0.5f);
    m.add(far, at(0, 0, kFar));
  }
  {  // across the street, its face in the shade; its local x is the world's z
    MeshBuilder across;
    const float x0 = kFar - 0.1f, x1 = kNear + 0.1f, top = 4.0f;
    addHouse(across, p, x0, x1, top, p.ochre, p.brown,
             {{-8.2f, 0.4f, 0.95f, 1.65f, Shutters::Open},
              {-5.7f, -0.12f, 1.1f, 2.25f, Shutters::Open, true, true, true},
              {-3.1f, 0.4f, 0.95f, 1.65f, Shutters::Closed},
              {-0.6f, 0.4f, 0.95f, 1.65f, Shutters::Ajar, false, false, true},
              {2.0f, -0.12f, 1.1f, 2.25f, Shutters::Closed, true, true},
              {-8.2f, kStreet + 1.2f, 0.95f, 1.5f, Shutters::Closed},
              {-5.7f, kStreet + 0.05f, 1.4f, 2.5f, Shutters::Closed, true},
              {-3.1f, kStreet + 1.2f, 0.95f, 1.5f, Shutters::Open},
              {-0.6f, kStreet + 1.2f, 0.95f, 1.5f, Shutters::Closed},
              {2.0f, kStreet + 0.05f, 1.2f, 2.4f, Shutters::Closed, true}});
    addStoreys(across, p, x0, x1, top);
    m.add(p.iron,
          tube(smoothPath(
                   {{-6.95f, top - 0.05f, 0.10f}, {-6.95f, 1.0f, 0.08f}, {-6.95f, kStreet + 0.1f, 0.08f}}, 3),
               0.045f, 12),
          glm::mat4(1));
    m.add(across, at(kOpposite, 0, 0) * turnY(-90));
  }
  {  // behind the viewer
    MeshBuilder behind;
    addHouse(
        behind, p, -kOpposite - 0.1f, -kWall + 0.1f, 3.4f, p.limewash, p.blue,
        {{-4.2f, 0.3f, 1.0f, 1.5f, Shutters::Closed}, {-4.2f, kStreet + 1.2f, 1.0f, 1.5f, Shutters::Closed}});
    m.add(behind, at(0, 0, kNear) * turnY(180));
  }
  {  // the house of the balcony; its local x is the world's -z
    MeshBuilder own;
    addHouse(own, p, -kNear - 0.1f, -kFar + 0.1f, kTop + 0.6f, p.limewash, p.blue,
             {{0.45f, 0.012f, 1.25f, 2.3f, Shutters::Open, true},
              {3.75f, 0.012f, 1.15f, 2.25f, Shutters::Closed, true},
              {7.2f, 0.5f, 0.95f, 1.5f, Shutters::Closed},
              {0.45f, 3.35f, 0.9f, 1.1f, Shutters::Closed},
              {3.75f, 3.35f, 0.9f, 1.1f, Shutters::Open},
              {7.2f, 3.35f, 0.9f, 1.1f, Shutters::Closed},
              {7.2f, kStreet + 0.9f, 0.95f, 1.5f, Shutters::Closed},
              {3.75f, kStreet + 0.05f, 1.3f, 2.5f, Shutters::Closed, true}},
             -1);
    m.add(own, at(kWall, 0, 0) * turnY(90));
  }
}

// ---- The balcony itself ----

void addFloor(MeshBuilder& m, const Palette& p) {
  // Octagons with small squares between their corners, in a frame of plain slabs.
  constexpr float kCell = 0.29f, kCut = 0.075f, kGap = 0.004f, kBorder = 0.16f;
  const float x0 = kWall + kBorder, z0 = kEnd + 0.16f + kBorder;
  const int columns = 9, rows = int((kBack - z0) / kCell);
  const float half = 0.5f * (kCell - kGap), cut = kCut;
  const Outline octagon = {{-half + cut, -half}, {half - cut, -half}, {half, -half + cut},
                           {half, half - cut},   {half - cut, half},  {-half + cut, half},
                           {-half, half - cut},  {-half, -half + cut}};
  const float d = cut - 0.7f * kGap;
  const Outline dot = {{d, 0}, {0, d}, {-d, 0}, {0, -d}};
  const ExtrudeOptions chamfered{.bevel = 0.003f, .back = false};
  const auto lay = [&](uint32_t material, Shape tile, float x, float z, uint32_t index) {
    const glm::vec2 part(random(31, index, 0, 7), random(32, index, 0, 7));
    for (glm::vec2& uv : tile.uvs) uv += part;
    m.add(material, tile, at(x, -0.03f + random(33, index, -0.0008f, 0.0008f), z) * turnX(-90));
  };
  const Shape field = extrude(octagon, 0.03f, chamfered), square = extrude(dot, 0.03f, chamfered);
  uint32_t index = 0;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      lay(p.tile, field, x0 + kCell * (float(i) + 0.5f), z0 + kCell * (float(j) + 0.5f), index++);
      if (i > 0 && j > 0) lay(p.tileBlue, square, x0 + kCell * float(i), z0 + kCell * float(j), index++);
    }
  const float x1 = x0 + kCell * float(columns), z1 = z0 + kCell * float(rows);
  // Half octagons along the frame.
  const Shape halves[4] = {extrude({{0, -d}, {d, 0}, {0, d}}, 0.03f, chamfered),
                           extrude({{0, d}, {-d, 0}, {0, -d}}, 0.03f, chamfered),
                           extrude({{-d, 0}, {0, -d}, {d, 0}}, 0.03f, chamfered),
                           extrude({{d, 0}, {0, d}, {-d, 0}}, 0.03f, chamfered)};
  for (int j = 1; j < rows; ++j) {
    lay(p.tileBlue, halves[0], x0 + 0.5f * kGap, z0 + kCell * float(j), index++);
    lay(p.tileBlue, halves[1], x1 - 0.5f * kGap, z0 + kCell * float(j), index++);
  }
  for (int i = 1; i < columns; ++i) {
    lay(p.tileBlue, halves[2], x0 + kCell * float(i), z0 + 0.5f * kGap, index++);
    lay(p.tileBlue, halves[3], x0 + kCell * float(i), z1 - 0.5f * kGap, index++);
  }
  const auto slab = [&](float w, float h, float x, float z) {
    lay(p.tile, extrude(rectangle(w - kGap, h - kGap), 0.03f, chamfered), x, z, index++);
  };
  for (int j = 0; j < rows; ++j) {
    slab(kBorder, kCell, x0 - 0.5f * kBorder, z0 + kCell * (float(j) + 0.5f));
    slab(kBorder, kCell, x1 + 0.5f * kBorder, z0 + kCell * (float(j) + 0.5f));
  }
  for (int i = 0; i < columns; ++i) slab(kCell, kBorder, x0 + kCell * (float(i) + 0.5f), z0 - 0.5f * kBorder);
  slab(kBorder, kBorder, x0 - 0.5f * kBorder, z0 - 0.5f * kBorder);
  slab(kBorder, kBorder, x1 + 0.5f * kBorder, z0 - 0.5f * kBorder);
  m.add(p.mortar, box({kWall - 0.1f, -0.24f, kEnd - 0.1f}, {kRail + 0.1f, -0.006f, z1 + 0.3f}));
  // The slab's moulded edge over the street, and a skirting on the house.
  Outline edge({-0.25f, -0.32f});
  edge.line(0.10f, -0.32f)
      .arc(0.20f, -0.20f, -0.4142f, 5)
      .line(0.22f, -0.20f)
      .arc(0.22f, -0.08f, 1, 6)
      .line(0.20f, -0.07f)
      .line(0.20f, -0.012f)
      .line(-0.25f, -0.012f);
  m.add(p.stone, sweep({{kRail, 0, kBack + 0.2f}, {kRail, 0, kEnd}, {kWall, 0, kEnd}}, edge,
                       {.up = glm::vec3(0, 1, 0)}));
}

void addBalustrade(MeshBuilder& m, const Palette& p) {
  constexpr float kFoot = 0.10f, kHeight = 0.93f, kCap = 0.12f;
  const std::vector<glm::vec3> way = {{kRail, 0, kBack + 0.1f}, {kRail, 0, kEnd}, {kWall - 0.02f, 0, kEnd}};
  m.add(p.stone, sweep(way,
                       Outline({{-0.12f, -0.02f},
                                {0.12f, -0.02f},
                                {0.12f, kFoot - 0.02f},
                                {0.10f, kFoot},
                                {-0.10f, kFoot},
                                {-0.12f, kFoot - 0.02f}}),
                       {.up = glm::vec3(0, 1, 0)}));
  Outline cap({-0.09f, 0});
  cap.line(0.09f, 0)
      .line(0.10f, 0.025f)
      .arc(0.14f, 0.045f, -0.4142f, 3)
      .arc(0.14f, 0.105f, 0.9f, 6)
      .line(0.12f, kCap)
      .line(-0.12f, kCap);
  cap.line(-0.14f, 0.105f).arc(-0.14f, 0.045f, 0.9f, 6).arc(-0.10f, 0.025f, -0.4142f, 3);
  m.add(p.stone, placed(sweep(way, cap, {.up = glm::vec3(0, 1, 0)}), at(0, kHeight - kCap, 0)));
  const Shape near = baluster(kHeight - kCap - kFoot, 14), far = baluster(kHeight - kCap - kFoot, 10);
  const Shape pier = block(0.23f, kHeight - kCap - kFoot + 0.01f, 0.23f, {.bevel = 0.008f});
  const auto run = [&](glm::vec3 a, glm::vec3 b, int balusters) {
    m.add(p.stone, pier, at(a.x, kFoot - 0.004f, a.z));
    for (int i = 0; i < balusters; ++i) {
      const glm::vec3 q = glm::mix(a, b, (float(i) + 1.0f) / float(balusters + 1));
      m.add(p.stone, q.z < -2.7f || q.z > 1.8f ? far : near, at(q.x, kFoot, q.z));
    }
  };
  run({kRail, 0, kEnd}, {kRail, 0, -2.62f}, 10);
  run({kRail, 0, -2.62f}, {kRail, 0, -0.25f}, 10);
  run({kRail, 0, -0.25f}, {kRail, 0, 2.1f}, 10);
  run({kRail, 0, 2.1f}, {kRail, 0, kBack + 0.2f}, 5);
  run({kRail, 0, kEnd}, {kWall - 0.05f, 0, kEnd}, 14);
  m.add(p.limewash,
        box({kWall - 0.1f, -0.3f, kBack}, {kRail + 0.14f, 1.25f, kBack + 0.25f}, {.bevel = 0.015f}));
}

void addAwningFrame(MeshBuilder& m, const Palette& p) {
  const float x0 = kWall, x1 = 1.22f, z0 = kAwningFront, z1 = kAwningFront - 1.53f;
  const float low = kAwningTop - 0.175f;
  for (const float z : {z0, z1}) {
    m.add(p.iron, tube({{x1, 0.0f, z}, {x1, low + 0.02f, z}}, 0.019f, 14));
    m.add(p.iron, tube({{x0 - 0.02f, kAwningTop + 0.005f, z}, {x1 + 0.05f, low - 0.006f, z}}, 0.016f, 12));
    m.add(p.iron, cylinder(0.055f, 0.012f, 24, 0.003f), at(x1, 0, z));
    m.add(p.iron, sphere(0.030f, 20, 14), at(x1, low + 0.045f, z));
    m.add(p.iron, cylinder(0.045f, 0.02f, 20, 0.004f), at(x0 - 0.002f, kAwningTop + 0.005f, z) * turnZ(-90));
    m.add(p.iron,
          tube(smoothPath(
                   {{x1 - 0.01f, low - 0.36f, z}, {x1 - 0.08f, low - 0.12f, z}, {x1 - 0.34f, low + 0.03f, z}},
                   5),
               0.009f, 8));
  }
  m.add(p.iron, tube({{x1, low, z0 + 0.06f}, {x1, low, z1 - 0.06f}}, 0.014f, 12));
}

void addMovingAwning(SceneBuilder& b, const Palette& p) {
  const auto shape = [](float billow, float wave, float phase, float lift) {
    AwningForm f;
    f.billow = billow;
    f.wave = wave;
    f.phase = phase;
    f.lift = lift;
    return awning(f);
  };
  const float quarter = 0.5f * glm::pi<float>();
  const Sheet rest = shape(0.10f, 0, 0, 0);
  const uint32_t mesh = b.mesh("awning",
                               cage(rest, 2,
                                    {shape(0.24f, 0, 0, 0), shape(0.10f, 0.10f, 0, 0),
                                     shape(0.10f, 0.10f, quarter, 0), shape(0.10f, 0, 0, 0.06f)}),
                               p.awning);
  const uint32_t node = b.place("awning", mesh, {kWall + 0.04f, kAwningTop + 0.03f, kAwningFront});
  b.swing(node,
          {{.amplitude = 0.8f, .period = 4},
           {.amplitude = 1, .period = 2},
           {.amplitude = 1, .period = 2, .phase = 0.25f},
           {.amplitude = 0.8f, .period = 8.0f / 3}},
          8);
}

// ---- What stands on it ----

void addPlants(MeshBuilder& m, const Palette& p) {
  const auto put = [&](const Plant& plant, uint32_t wood, uint32_t leaves, uint32_t fruits,
                       const glm::mat4& where) {
    m.add(wood, plant.wood, where).add(leaves, plant.leaves, where);
    if (!plant.fruits.indices.empty()) m.add(fruits, plant.fruits, where);
  };
  {  // an olive between the doors
    const glm::mat4 where = at(-1.28f, 0, -1.8f);
    m.add(pot(p.clay, p.soil, PotShape::Belly, 0.27f, 0.46f), where);
    TreeForm f;
    f.trunkHeight = 0.55f;
    f.trunkRadius = 0.035f;
    f.crown = {0.35f, 0.40f, 0.36f};
    f.twigs = 150;
    f.leavesPerTwig = 12;
    f.twigLength = 0.2f;
    f.leaf = {.length = 0.07f, .width = 0.017f, .fold = 0.2f, .droop = 0.05f, .steps = 1};
    f.seed = 5;
    put(tree(f), p.bark, p.paleLeaf, p.lemon, where * at(0, 0.41f, 0));
  }
  {  // a lemon tree by the balustrade
    const glm::mat4 where = at(1.05f, 0, -0.35f);
    m.add(pot(p.clay, p.soil, PotShape::Rim, 0.25f, 0.42f), where);
    TreeForm f;
    f.trunkHeight = 0.48f;
    f.trunkRadius = 0.030f;
    f.crown = {0.37f, 0.36f, 0.37f};
    f.twigs = 115;
    f.leavesPerTwig = 9;
    f.twigLength = 0.18f;
    f.leaf = {.length = 0.095f, .width = 0.046f, .fold = 0.35f, .droop = 0.25f, .steps = 2};
    f.fruits = 16;
    f.fruitRadius = 0.034f;
    f.seed = 9;
    put(tree(f), p.bark, p.darkLeaf, p.lemon, where * at(0, 0.37f, 0));
  }
  {  // an agave and a few small pots
    m.add(pot(p.glaze, p.soil, PotShape::Belly, 0.22f, 0.34f), at(-1.28f, 0, -4.25f));
    m.add(p.paleLeaf,
          rosette(26, {.length = 0.46f, .width = 0.085f, .fold = 0.6f, .droop = 0.12f, .steps = 5}, 72, 51),
          at(-1.28f, 0.30f, -4.25f));
    m.add(pot(p.clay, p.soil, PotShape::Square, 0.15f, 0.30f), at(1.02f, 0, -4.1f) * turnY(8));
    m.add(p.leaf,
          rosette(34, {.length = 0.40f, .width = 0.03f, .fold = 0.4f, .droop = 0.55f, .steps = 5}, 78, 52),
          at(1.02f, 0.27f, -4.1f));
    m.add(pot(p.clay, p.soil, PotShape::Rim, 0.14f, 0.22f), at(-0.92f, 0, -2.35f));
    put(bush({0.17f, 0.22f, 0.17f}, 30, 10, {.length = 0.035f, .width = 0.018f, .steps = 1}, 53), p.bark,
        p.leaf, p.leaf, at(-0.92f, 0.19f, -2.35f));
    m.add(pot(p.glaze, p.soil, PotShape::Rim, 0.11f, 0.17f), at(0.80f, 0, -0.05f));
    put(flowers({0.14f, 0.22f, 0.14f}, 9, 0.035f, 16, 54), p.leaf, p.leaf, p.bloom, at(0.80f, 0.15f, -0.05f));
    put(bush({0.13f, 0.15f, 0.13f}, 22, 7, {.length = 0.05f, .width = 0.045f, .fold = 0.2f, .steps = 1}, 55),
        p.leaf, p.leaf, p.leaf, at(0.80f, 0.15f, -0.05f));
  }
  // Geraniums in troughs on the balustrade, with ivy over its edge.
  const float zs[3] = {-1.75f, 0.75f, -3.9f};
  for (uint32_t i = 0; i < 3; ++i) {
    const glm::mat4 where = at(kRail, 0.928f, zs[i]) * turnY(90);
    m.add(pot(p.clay, p.soil, PotShape::Trough, 0.095f, 0.17f), where);
    for (const float x : {-0.2f, 0.0f, 0.2f}) {
      const uint32_t seed = 60 + 3 * i + uint32_t(x * 5 + 1.5f);
      const glm::mat4 here = where * at(x, 0.15f, 0);
      put(bush({0.16f, 0.17f, 0.15f}, 14, 8, {.length = 0.052f, .width = 0.05f, .fold = 0.2f, .steps = 1},
               seed),
          p.leaf, p.leaf, p.leaf, here);
      put(flowers({0.17f, 0.23f, 0.15f}, 7, 0.036f, 15, seed + 20), p.leaf, p.leaf, p.bloom, here);
    }
    const Plant ivy =
        trailing(7, 0.62f, 0.5f, {.length = 0.045f, .width = 0.038f, .fold = 0.2f, .steps = 1}, 80 + i);
    put(ivy, p.bark, p.leaf, p.leaf, at(kRail - 0.06f, 1.09f, zs[i]) * turnY(-90));
  }
  {  // a bougainvillea from a pot up the wall and over the door
    const glm::mat4 where = at(-1.42f, 0, 0.62f);
    m.add(pot(p.clay, p.soil, PotShape::Rim, 0.2f, 0.36f), where);
    const Leaf leaf = {.length = 0.06f, .width = 0.038f, .fold = 0.3f, .droop = 0.2f, .steps = 1};
    const std::vector<glm::vec3> up = {
        {-1.42f, 0.3f, 0.62f},  {-1.56f, 0.9f, 0.68f},  {-1.62f, 1.7f, 0.52f},   {-1.60f, 2.45f, 0.42f},
        {-1.58f, 2.78f, -0.1f}, {-1.58f, 2.86f, -0.8f}, {-1.58f, 2.76f, -1.35f}, {-1.57f, 2.62f, -1.75f}};
    put(climber(up, {1, 0, 0}, 0.36f, 150, 8, leaf, 0.55f, 90), p.bark, p.leaf, p.bract, glm::mat4(1));
  }
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  const glm::vec3 table(0.25f, 0, -2.35f);
  m.add(bistroTable(p), at(table));
  m.add(tableware(p), at(table + glm::vec3(0, 0.74f, 0)) * turnY(20));
  const glm::mat4 chairs[2] = {at(-0.42f, 0, -2.85f) * turnY(50), at(0.78f, 0, -1.72f) * turnY(-128)};
  for (const glm::mat4& chair : chairs) m.add(bistroChair(p), chair);
  // A bracket for the lantern.
  m.add(p.iron, cylinder(0.05f, 0.016f, 20, 0.004f), at(kWall - 0.002f, 2.55f, kLanternZ) * turnZ(-90));
  m.add(p.iron, tube(smoothPath({{kWall, 2.55f, kLanternZ},
                                 {kWall + 0.2f, 2.61f, kLanternZ},
                                 {kWall + 0.42f, 2.59f, kLanternZ},
                                 {kWall + 0.47f, 2.52f, kLanternZ}},
                                6),
                     0.010f, 8));
  m.add(p.iron, tube(smoothPath({{kWall + 0.005f, 2.34f, kLanternZ},
                                 {kWall + 0.14f, 2.41f, kLanternZ},
                                 {kWall + 0.27f, 2.59f, kLanternZ}},
                                6),
                     0.007f, 7));
  // Washing across the street.
  const glm::vec3 from(kOpposite - 0.35f, 1.95f, -0.2f), to(kOpposite - 0.35f, 2.0f, -8.3f);
  m.add(p.white, tube(smoothPath({from, 0.5f * (from + to) - glm::vec3(0, 0.16f, 0), to}, 8), 0.004f, 5));
  for (const glm::vec3& end : {from, to})
    m.add(p.iron, tube({end, end + glm::vec3(0.4f, 0.05f, 0)}, 0.012f, 8));
  const auto line = [&](float t) { return glm::mix(from, to, t) - glm::vec3(0, 0.16f * 4 * t * (1 - t), 0); };
  m.add(p.linen, hungCloth(1.5f, 1.2f, 1), at(line(0.40f)) * turnY(-90));
  m.add(p.shirt, hungShirt(1.0f, 2), at(line(0.56f)) * turnY(-90));
  m.add(p.towel, hungCloth(0.6f, 0.95f, 3), at(line(0.66f)) * turnY(-90));
  m.add(p.linen, hungShirt(0.9f, 5), at(line(0.77f)) * turnY(-90));
  m.add(p.cushion, hungCloth(0.45f, 0.7f, 4), at(line(0.86f)) * turnY(-90));
  b.place("furniture", b.mesh("furniture", std::move(m)));

  const uint32_t seat = b.mesh("seat cushion", pillow(0.42f, 0.42f, 0.075f, true), p.cushion);
  b.place("cushion 1", seat, {-0.42f, 0.492f, -2.85f}, 50);
  b.place("cushion 2", seat, {0.78f, 0.492f, -1.72f}, -128);
  const uint32_t floorCushion = b.mesh("floor cushion", pillow(0.66f, 0.66f, 0.20f, true), p.stripedCushion);
  b.place("floor cushion", floorCushion, {-0.55f, 0.092f, -1.1f}, 24);

  MeshBuilder greens;
  addPlants(greens, p);
  b.place("plants", b.mesh("plants", std::move(greens)));

  MeshBuilder lamp;
  lamp.add(lantern(p), glm::mat4(1));
  b.place("lantern", b.mesh("lantern", std::move(lamp)), {kWall + 0.47f, 2.525f, kLanternZ});
}

}  // namespace

static Scene balconyScene() {
  SceneBuilder b("balcony");
  const Palette p = makePalette(b);
  MeshBuilder houses, terrace;
  addStreet(houses, p);
  b.place("houses", b.mesh("houses", std::move(houses)));
  addFloor(terrace, p);
  addBalustrade(terrace, p);
  addAwningFrame(terrace, p);
  b.place("terrace", b.mesh("terrace", std::move(terrace)));
  furnish(b, p);
  addMovingAwning(b, p);
  b.sun("sun", {1.0f, 0.93f, 0.82f}, 20, {-0.44f, -0.46f, -0.77f});
  b.camera({0.45f, 1.58f, 1.75f}, {-0.12f, 1.12f, -3.0f}, 55);
  b.scene.environment = {0.50f, 0.85f, 1.45f};
  return b.finish(0.38f, {0.55f, 0.68f});
}

FOVEA_SCENE("balcony", balconyScene);

}  // namespace fovea::scene
