// The stand-in for Sponza: an original two-storey courtyard of about 279k triangles, with arcades on columns
// below, twin arches on slender columns above, groin vaults, a beamed gallery, drapes, and orange trees around a
// well. The sun falls steeply through the open roof onto part of the paving and one side; everything else is lit
// by what these reflect.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "fovea/scene.h"
#include "samples/scenes/builtin/atrium_parts.h"
#include "samples/scenes/builtin/modelling/plants.h"

namespace fovea::scene {
namespace {

using namespace atrium;
using namespace model;

// Plan: columns stand on the edges of the court, and the galleries lie outside them.
constexpr float kBay = 3.0f, kDepth = 3.0f;  // a bay of a gallery is square
constexpr int kLongBays = 7, kShortBays = 3;
constexpr float kHalfLong = 0.5f * kBay * kLongBays, kHalfShort = 0.5f * kBay * kShortBays;
constexpr float kWall = 0.45f;  // thickness of the lower arcade
// Heights.
constexpr float kStep = 0.15f, kSpring = 3.2f, kCornice = 5.0f, kUpper = 5.35f, kParapet = 0.97f,
                kUpperSpring = 8.05f, kEaves = 9.25f, kRoof = 9.95f;
constexpr float kOpening = 2.44f, kUpperOpening = 1.22f;

// One side of the court. In its frame, x runs along the columns, +z points to the court, and the paving is at y = 0.
struct Side {
  glm::mat4 placement;
  int bays;
  float length() const { return kBay * float(bays); }
};

const Side kSides[4] = {{at(0, 0, -kHalfShort), kLongBays},
                        {at(0, 0, kHalfShort) * turnY(180), kLongBays},
                        {at(-kHalfLong, 0, 0) * turnY(90), kShortBays},
                        {at(kHalfLong, 0, 0) * turnY(-90), kShortBays}};

// The path around the court, clockwise seen from above, so that the court is on the right.
const std::vector<glm::vec3>& ringPath() {
  static const std::vector<glm::vec3> path = {{-kHalfLong, 0, -kHalfShort},
                                              {kHalfLong, 0, -kHalfShort},
                                              {kHalfLong, 0, kHalfShort},
                                              {-kHalfLong, 0, kHalfShort}};
  return path;
}

Shape ring(const Outline& section, float y) {
  return placed(sweep(ringPath(), section, {.closedPath = true, .up = glm::vec3(0, 1, 0)}), at(0, y, 0));
}

// A wall of arches that stand on imposts at y = 0, with its middle at z = 0.
Shape arcadeWall(float length, int arches, float opening, float height, float thickness) {
  const float pitch = length / float(arches);
  Shape s;
  for (int i = 0; i < arches; ++i) {
    const float x = -0.5f * length + pitch * (float(i) + 0.5f);
    append(s, extrude(archedPanel(pitch, height, opening, 0, 18).moved({x, 0}), thickness));
  }
  return placed(s, at(0, 0, -0.5f * thickness));
}

// The moulding around an arch, on the face z = 0, with the centre of the arch at the origin.
Shape archivolt(float radius, float width, float relief, int steps) {
  std::vector<glm::vec3> path;
  for (int i = 0; i <= steps; ++i) {
    const float a = glm::pi<float>() * float(i) / float(steps);
    path.push_back({radius * std::cos(a), radius * std::sin(a), 0});
  }
  const float w = width, r = relief;
  const Outline section = {{-0.012f, -0.03f},     {w, -0.03f},         {w, r},
                           {0.86f * w, 1.2f * r}, {0.74f * w, r},      {0.70f * w, 0.6f * r},
                           {0.12f * w, 0.6f * r}, {-0.012f, 0.45f * r}};
  return sweep(path, section, {.up = glm::vec3(0, 0, 1)});
}

void addPaving(MeshBuilder& m, const Palette& p) {
  constexpr int kAlong = 29, kAcross = 12;
  const glm::vec2 inner(2 * kHalfLong - 0.9f, 2 * kHalfShort - 0.9f),
      cell = inner / glm::vec2(kAlong, kAcross);
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kAcross; ++j) {
      const uint32_t index = uint32_t(i * kAcross + j);
      const bool border = i == 0 || j == 0 || i == kAlong - 1 || j == kAcross - 1;
      const bool band = i == 1 || j == 1 || i == kAlong - 2 || j == kAcross - 2;
      const bool lozenge = !border && !band && (i + j) % 4 == 0 && (i - j + 40) % 4 == 0;
      const uint32_t stone = border || lozenge                   ? p.floorDark
                             : band || random(21, index) < 0.35f ? p.floorWarm
                                                                 : p.floorPale;
      Shape slab =
          extrude(rectangle(cell.x - 0.012f, cell.y - 0.012f), 0.05f, {.bevel = 0.006f, .back = false});
      // Every slab is cut from another part of the stone.
      const glm::vec2 cut(random(22, index, 0, 9), random(23, index, 0, 9));
      for (glm::vec2& uv : slab.uvs) uv += cut;
      const glm::vec2 c = -0.5f * inner + cell * (glm::vec2(float(i), float(j)) + 0.5f);
      m.add(stone, slab, at(c.x, -0.05f + random(24, index, -0.0015f, 0.0015f), c.y) * turnX(-90));
    }
  const float x = kHalfLong + kDepth + 0.4f, z = kHalfShort + kDepth + 0.4f;
  m.add(p.mortar, box({-x, -0.5f, -z}, {x, -0.012f, z}));
  // One step up to the galleries.
  const Outline step = {{-0.5f, -0.1f}, {0.42f, -0.1f}, {0.42f, 0.10f},
                        {0.45f, 0.12f}, {0.45f, kStep}, {-0.5f, kStep}};
  m.add(p.limestone, ring(step, 0));
}

// Everything that runs around the court without a break.
void addCornices(MeshBuilder& m, const Palette& p) {
  Outline lower({-0.225f, 0});
  lower.line(0.225f, 0).line(0.26f, 0).line(0.26f, 0.05f).arc(0.33f, 0.12f, -0.4142f, 4).line(0.33f, 0.15f);
  lower.line(0.42f, 0.17f)
      .line(0.42f, 0.24f)
      .arc(0.47f, 0.29f, 0.4142f, 4)
      .line(0.47f, 0.35f)
      .line(-0.225f, 0.35f);
  m.add(p.limestone, ring(lower, kCornice));
  Outline upper({-0.15f, 0});
  upper.line(0.15f, 0)
      .line(0.19f, 0.02f)
      .line(0.19f, 0.10f)
      .arc(0.25f, 0.17f, -0.4142f, 4)
      .line(0.25f, 0.33f);
  upper.line(0.46f, 0.35f)
      .line(0.46f, 0.46f)
      .arc(0.55f, 0.57f, 0.4142f, 4)
      .line(0.55f, 0.70f)
      .line(-0.15f, 0.70f);
  m.add(p.limestone, ring(upper, kEaves));
  const Outline rail = {{-0.10f, 0},    {0.10f, 0},      {0.13f, 0.03f},  {0.15f, 0.05f},  {0.15f, 0.12f},
                        {0.13f, 0.14f}, {-0.13f, 0.14f}, {-0.15f, 0.12f}, {-0.15f, 0.05f}, {-0.13f, 0.03f}};
  m.add(p.limestone, ring(rail, kUpper + kParapet - 0.14f));
  m.add(p.limestone, ring(rectangle(0.24f, 0.10f), kUpper + 0.05f));
  // The roof over the galleries: boards below, tiles above.
  m.add(p.roofTiles,
        ring(Outline({{0.84f, 0}, {0.84f, 0.06f}, {-3.9f, 1.36f}, {-3.9f, 0.2f}, {-0.3f, 0}}), kRoof));
}

void addLowerSide(MeshBuilder& m, const Palette& p, const Side& side) {
  const float length = side.length(), half = 0.5f * length, radius = 0.5f * kOpening;
  m.add(p.plaster, arcadeWall(length, side.bays, kOpening, kCornice - kSpring, kWall), at(0, kSpring, 0));
  const Shape outer = archivolt(radius, 0.20f, 0.05f, 20);
  const Shape keystone = bent(box({-0.09f, 0, 0}, {0.09f, 0.34f, 0.09f}, {.bevel = 0.012f}), [](glm::vec3 q) {
    return glm::vec3(q.x * (1 + 0.8f * q.y), q.y, q.z * (0.7f + 0.9f * q.y));
  });
  const MeshBuilder pillar = column(p.limestone, kSpring - kStep - 0.12f);
  const MeshBuilder disc = tondo(p.white, p.glaze, p.white);
  const Shape impost = block(0.58f, 0.12f, 0.56f, {.bevel = 0.02f});
  const Shape rib = sweep(
      [] {
        std::vector<glm::vec3> path;
        for (int i = 0; i <= 14; ++i) {
          const float a = glm::pi<float>() * float(i) / 14;
          path.push_back({0, 1.36f * std::sin(a), -0.5f * kDepth + 1.36f * std::cos(a)});
        }
        return path;
      }(),
      rectangle(0.16f, 0.30f), {.up = glm::vec3(1, 0, 0)});
  for (int i = 0; i < side.bays; ++i) {
    const float x = -half + kBay * (float(i) + 0.5f);
    m.add(p.limestone, outer, at(x, kSpring, 0.5f * kWall));
    m.add(p.limestone, archivolt(radius, 0.20f, 0.05f, 12), at(x, kSpring, -0.5f * kWall) * turnY(180));
    m.add(p.limestone, keystone, at(x, kSpring + radius - 0.03f, 0.5f * kWall - 0.02f));
    m.add(p.plaster, groinVault(kDepth, 1.45f), at(x, kSpring + 0.08f, -0.5f * kDepth));
  }
  for (int i = 0; i <= side.bays; ++i) {
    const float x = -half + kBay * float(i);
    m.add(p.limestone, rib, at(x, kSpring + 0.02f, 0));
    m.add(p.limestone, box({x - 0.19f, kStep, -kDepth - 0.02f}, {x + 0.19f, kSpring - 0.14f, -kDepth + 0.13f},
                           {.bevel = 0.01f}));
    m.add(p.limestone, box({x - 0.24f, kSpring - 0.16f, -kDepth - 0.02f},
                           {x + 0.24f, kSpring + 0.02f, -kDepth + 0.19f}, {.bevel = 0.02f}));
    if (i == 0 || i == side.bays) continue;
    m.add(pillar, at(x, kStep, 0) * turnY(90.0f * float(i % 4)));
    m.add(p.limestone, impost, at(x, kSpring - 0.12f, 0));
    m.add(disc, at(x, kSpring + 1.27f, 0.5f * kWall));
  }
}

void addUpperSide(MeshBuilder& m, const Palette& p, const Side& side) {
  const float length = side.length(), half = 0.5f * length, pitch = 0.5f * kBay;
  const int arches = 2 * side.bays;
  m.add(p.plaster, arcadeWall(length, arches, kUpperOpening, kEaves - kUpperSpring, 0.30f),
        at(0, kUpperSpring, 0));
  const Shape moulding = archivolt(0.5f * kUpperOpening, 0.10f, 0.035f, 16);
  const float foot = kUpper + kParapet;
  const MeshBuilder slender = colonnette(p.limestone, kUpperSpring - foot);
  const Shape post = baluster(kParapet - 0.24f), pedestal = block(0.30f, kParapet + 0.002f, 0.32f);
  const Shape dentil = box({-0.07f, 0, 0}, {0.07f, 0.13f, 0.18f});
  for (int i = 0; i < arches; ++i) {
    const float x = -half + pitch * (float(i) + 0.5f);
    m.add(p.limestone, moulding, at(x, kUpperSpring, 0.15f));
    for (int k = 0; k < 4; ++k)
      m.add(p.limestone, post, at(x + 0.27f * (float(k) - 1.5f), kUpper + 0.10f, 0));
  }
  for (int i = 1; i < arches; ++i) {
    const float x = -half + pitch * float(i);
    m.add(p.limestone, pedestal, at(x, kUpper, 0));
    m.add(slender, at(x, foot, 0));
  }
  const int dentils = int(length / 0.30f);
  for (int i = 0; i < dentils; ++i)
    m.add(p.limestone, dentil,
          at(-half + length * (float(i) + 0.5f) / float(dentils), kEaves + 0.195f, 0.24f));
  // Ceiling beams of the gallery.
  const Shape beam = box({-0.08f, 0, -kDepth - 0.1f}, {0.08f, 0.22f, 0.0f});
  const int beams = int(length / 0.75f);
  for (int i = 0; i < beams; ++i)
    m.add(p.wood, beam, at(-half + length * (float(i) + 0.5f) / float(beams), kEaves + 0.10f, 0));
  // Tiles along the eaves, which are in the sun.
  Outline half_({-0.085f, 0});
  half_.arc(0.085f, 0, -1, 4).line(0.068f, 0).arc(-0.068f, 0, 1, 3);
  const Shape tile = sweep({{0, 0, 0.08f}, {0, 0.165f, -0.52f}}, half_, {.up = glm::vec3(0, 1, 0)});
  const int tiles = int((length + 1.2f) / 0.235f);
  for (int i = 0; i < tiles; ++i)
    m.add(p.roofTiles, tile,
          at(-half - 0.6f + (length + 1.2f) * (float(i) + 0.5f) / float(tiles), kRoof + 0.045f, 0.74f));
}

// The wall behind the galleries, with doors and niches below and shuttered windows above, sealed by a second layer.
void addBackWall(MeshBuilder& m, const Palette& p, const Side& side, uint32_t seed) {
  const bool isLong = side.bays == kLongBays;
  const float half = 0.5f * side.length() + kDepth + (isLong ? 0.4f : 0.0f), half0 = 0.5f * side.length();
  std::vector<Outline> lower, upper;
  for (int i = 0; i < side.bays; ++i) {
    const float x = -half0 + kBay * (float(i) + 0.5f);
    const bool door = (uint32_t(i) + seed) % 3 == 1;
    if (door)
      lower.push_back(archedOpening(1.25f, 0.004f, 2.1f, 14).moved({x, 0}));
    else if ((uint32_t(i) + seed) % 3 == 0)
      lower.push_back(archedOpening(0.8f, 1.0f, 1.9f, 12).moved({x, 0}));
    upper.push_back(Outline(rectangle(0.95f, 1.55f)).moved({x, 1.75f}));
    if (door) {
      m.add(archDoor(p.door, p.iron, 1.25f, 2.1f), at(x, kStep, -kDepth - 0.17f));
      m.add(p.limestone, archivolt(0.625f, 0.16f, 0.05f, 18), at(x, kStep + 2.1f, -kDepth));
      for (const float s : {-1.0f, 1.0f})
        m.add(p.limestone, box({x + s * 0.70f - 0.09f, kStep, -kDepth - 0.02f},
                               {x + s * 0.70f + 0.09f, kStep + 2.1f, -kDepth + 0.05f}, {.bevel = 0.01f}));
    }
    m.add(shutters(p.door, 0.95f, 1.55f), at(x, kUpper + 0.975f, -kDepth - 0.12f));
    m.add(p.limestone, box({x - 0.60f, kUpper + 0.86f, -kDepth - 0.02f},
                           {x + 0.60f, kUpper + 0.97f, -kDepth + 0.10f}, {.bevel = 0.015f}));
    m.add(p.limestone, box({x - 0.62f, kUpper + 2.53f, -kDepth - 0.02f},
                           {x + 0.62f, kUpper + 2.66f, -kDepth + 0.08f}, {.bevel = 0.015f}));
  }
  const auto panel = [&](float low, float high, const std::vector<Outline>& holes) {
    m.add(p.plaster,
          extrude(Outline({{-half, 0}, {half, 0}, {half, high - low}, {-half, high - low}}), holes, 0.22f),
          at(0, low, -kDepth - 0.22f));
  };
  panel(kStep, kUpper - 0.02f, lower);
  panel(kUpper - 0.02f, kRoof + 0.3f, upper);
  m.add(p.plaster, box({-half, -0.4f, -kDepth - 0.42f}, {half, kRoof + 0.7f, -kDepth - 0.2195f}));
}

void addGalleries(MeshBuilder& m, const Palette& p) {
  const float x0 = kHalfLong, x1 = kHalfLong + kDepth + 0.3f, z0 = kHalfShort,
              z1 = kHalfShort + kDepth + 0.3f;
  // The lower and upper floor and the upper ceiling: each is four overlapping boxes around the court.
  const auto around = [&](uint32_t material, float low, float high, float edge) {
    const float a = x0 + edge, b = z0 + edge;
    m.add(material, box({-x1, low, -z1}, {x1, high, -b}));
    m.add(material, box({-x1, low, b}, {x1, high, z1}));
    m.add(material, box({-x1, low, -b}, {-a, high, b}));
    m.add(material, box({a, low, -b}, {x1, high, b}));
  };
  around(p.tiles, -0.1f, kStep - 0.004f, 0.2f);
  around(p.tiles, kCornice - 0.1f, kUpper - 0.005f, 0.1f);
  around(p.wood, kEaves + 0.30f, kEaves + 0.45f, 0.0f);
  // Piers, vaults and beams of the corners.
  for (const float sx : {-1.0f, 1.0f})
    for (const float sz : {-1.0f, 1.0f}) {
      const glm::vec3 c(sx * x0, 0, sz * z0);
      m.add(p.ashlar, block(0.62f, kSpring - kStep - 0.12f, 0.62f, {.bevel = 0.02f}),
            at(c + glm::vec3(0, kStep, 0)));
      m.add(p.limestone, block(0.74f, 0.12f, 0.74f, {.bevel = 0.025f}),
            at(c + glm::vec3(0, kSpring - 0.12f, 0)));
      m.add(p.limestone, block(0.74f, 0.28f, 0.74f, {.bevel = 0.03f}), at(c + glm::vec3(0, kStep, 0)));
      m.add(p.ashlar, block(0.52f, kCornice - kSpring, 0.52f), at(c + glm::vec3(0, kSpring, 0)));
      m.add(p.limestone, block(0.42f, kUpperSpring - kUpper, 0.42f, {.bevel = 0.015f}),
            at(c + glm::vec3(0, kUpper, 0)));
      m.add(p.limestone, block(0.50f, 0.08f, 0.50f, {.bevel = 0.015f}),
            at(c + glm::vec3(0, kUpperSpring - 0.08f, 0)));
      m.add(p.limestone, block(0.36f, kEaves - kUpperSpring, 0.36f), at(c + glm::vec3(0, kUpperSpring, 0)));
      m.add(p.plaster, groinVault(kDepth, 1.45f),
            at(sx * (x0 + 0.5f * kDepth), kSpring + 0.08f, sz * (z0 + 0.5f * kDepth)));
      for (int i = 0; i < 4; ++i)
        m.add(p.wood, box({-0.08f, 0, 0}, {0.08f, 0.22f, kDepth}),
              at(sx * (x0 + 0.375f + 0.75f * float(i)), kEaves + 0.10f, sz > 0 ? z0 : -z0 - kDepth));
    }
}

// A rod across an arch with its curtain, in the frame of a side.
void addDrape(MeshBuilder& m, const Palette& p, const Side& side, int bay, float drawn, uint32_t cloth,
              uint32_t seed) {
  const float x = -0.5f * side.length() + kBay * (float(bay) + 0.5f), y = kSpring - 0.02f, z = -0.05f;
  DrapeForm f;
  f.width = kOpening - 0.12f;
  f.height = y - kStep - 0.08f;
  f.drawn = drawn;
  f.seed = seed;
  f.folds = 9;
  m.add(cloth, surface(drape(f, 54, 14)), side.placement * at(x, y, z));
  m.add(p.iron, tube({{-0.5f * kOpening, 0, 0}, {0.5f * kOpening, 0, 0}}, 0.016f, 8),
        side.placement * at(x, y + 0.015f, z));
}

// A carpet over the balustrade, which hangs down by `drop` on the side of the court.
void addCarpet(MeshBuilder& m, const Side& side, float x, uint32_t cloth, float width, float drop) {
  const Sheet s = sheet(12, 24, {width, drop + 0.75f}, [&](float u, float v) {
    const float along = v * (drop + 0.62f) - 0.45f;  // from inside over the rail and down
    const float hang = std::max(along - 0.17f, 0.0f), px = (u - 0.5f) * width;
    if (along < -0.17f) return glm::vec3(px, 0.015f + (along + 0.17f), -0.175f);
    if (hang == 0) return glm::vec3(px, 0.015f, along);
    return glm::vec3(px * (1 - 0.03f * hang), 0.015f - hang,
                     0.175f + 0.025f * hang * std::sin(9 * u + 3 * v));
  });
  m.add(cloth, surface(s), side.placement * at(x, kUpper + kParapet, 0));
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  addDrape(m, p, kSides[1], 1, 0.9f, p.cloth[1], 31);
  addDrape(m, p, kSides[1], 3, -0.9f, p.cloth[2], 32);
  addDrape(m, p, kSides[1], 5, -0.8f, p.cloth[3], 33);
  addDrape(m, p, kSides[0], 2, 0.9f, p.cloth[0], 35);
  addDrape(m, p, kSides[0], 4, -0.85f, p.cloth[1], 36);
  addDrape(m, p, kSides[0], 5, -0.9f, p.cloth[3], 39);
  addDrape(m, p, kSides[0], 6, 0.85f, p.cloth[2], 37);
  addDrape(m, p, kSides[3], 0, -0.9f, p.cloth[3], 38);
  addCarpet(m, kSides[0], -3.75f, p.carpet[0], 1.05f, 0.78f);
  addCarpet(m, kSides[0], 5.25f, p.carpet[1], 0.95f, 0.72f);
  addCarpet(m, kSides[1], 2.25f, p.carpet[0], 1.05f, 0.78f);
  addCarpet(m, kSides[3], -0.75f, p.carpet[1], 1.0f, 0.75f);
  for (const int k : {0, 1})
    for (const float x : {-6.0f, 0.0f, 6.0f})
      m.add(lantern(p), kSides[k].placement * at(x, kSpring + 1.46f, -0.5f * kDepth));
  m.add(bench(p.limestone, 1.7f), at(-3.0f, kStep, -kHalfShort - kDepth + 0.35f));
  m.add(bench(p.limestone, 1.7f), at(3.0f, kStep, kHalfShort + kDepth - 0.35f));
  m.add(jar(p.clay, 0.85f), at(7.4f, kStep, -kHalfShort + 0.02f) * scaled(1));
  m.add(jar(p.clay, 0.60f), at(-7.9f, kStep, -kHalfShort - 0.15f) * turnY(40));
  m.add(jar(p.clay, 0.95f), at(-8.2f, kStep, -kHalfShort - 0.75f) * turnY(80));
  m.add(wellHead(p), turnY(28));
  const Shape orange = sphere(0.038f, 9, 6);  // windfalls
  const glm::vec2 fallen[6] = {{-4.9f, -1.9f}, {-4.1f, 2.1f}, {3.7f, -2.2f},
                               {4.9f, -2.0f},  {3.9f, 2.3f},  {-2.7f, 0.9f}};
  for (const glm::vec2& f : fallen) m.add(p.orange, orange, at(f.x, 0.037f, f.y));
  b.place("furniture", b.mesh("furniture", std::move(m)));

  const uint32_t trees[2] = {b.mesh("orange tree", orangeTree(p, 41)),
                             b.mesh("second orange tree", orangeTree(p, 47))};
  b.place("orange tree 1", trees[0], {-5.7f, 0, -3.3f}, 20);
  b.place("orange tree 2", trees[1], {4.4f, 0, -3.0f}, 200, glm::vec3(1.1f));
  b.place("orange tree 3", trees[1], {-3.7f, 0, 3.0f}, 75, glm::vec3(0.95f));
  b.place("orange tree 4", trees[0], {4.8f, 0, 2.9f}, 140, glm::vec3(1.05f));

  MeshBuilder greens;
  const glm::mat4 pots[4] = {at(-9.6f, kStep, 3.7f), at(-9.5f, kStep, -3.8f), at(9.6f, kStep, -3.6f),
                             at(9.7f, kStep, 3.8f)};
  for (int i = 0; i < 4; ++i) {
    greens.add(pot(p.clay, p.soil, 0.24f, 0.36f), pots[i] * at(0, -kStep, 0));
    const Leaf blade = {.length = 0.62f, .width = 0.055f, .fold = 0.5f, .droop = 0.35f, .steps = 4};
    greens.add(p.leaf, rosette(30, blade, 75, 50 + uint32_t(i)), pots[i] * at(0, 0.32f - kStep, 0));
  }
  const Leaf ivy = {.length = 0.06f, .width = 0.05f, .fold = 0.2f, .droop = 0.2f, .steps = 1};
  const glm::vec2 falls[3] = {{-6.0f, 0}, {1.5f, 0}, {6.75f, 1}};
  for (int i = 0; i < 3; ++i) {
    const glm::mat4 place = kSides[int(falls[i].y)].placement * at(falls[i].x, kUpper + 0.02f, 0.36f);
    const Plant vine = trailing(16, 1.5f, 0.9f, ivy, 60 + uint32_t(i));
    greens.add(p.leaf, vine.leaves, place).add(p.bark, vine.wood, place);
    greens.add(p.clay, box({-0.5f, 0, -0.10f}, {0.5f, 0.16f, 0.08f}, {.bevel = 0.015f}), place);
  }
  b.place("greens", b.mesh("greens", std::move(greens)));
}

// The curtain in the wind: it billows, and two waves a quarter of a period apart make the motion travel.
void addMovingDrape(SceneBuilder& b, const Palette& p) {
  DrapeForm f;
  f.width = kOpening - 0.12f;
  f.height = kSpring - kStep - 0.15f;
  f.folds = 5;
  f.seed = 71;
  const auto shape = [&](float billow, float wave, float phase) {
    DrapeForm g = f;
    g.billow = billow;
    g.wave = wave;
    g.phase = phase;
    return drape(g, 24, 8);
  };
  f.billow = 0.12f;
  const Sheet rest = shape(0.12f, 0, 0);
  const uint32_t mesh =
      b.mesh("curtain in the wind",
             cage(rest, 2,
                  {shape(0.42f, 0, 0), shape(0.12f, 0.17f, 0), shape(0.12f, 0.17f, 0.5f * glm::pi<float>())}),
             p.cloth[0]);
  const glm::vec3 where = glm::vec3(
      kSides[1].placement * glm::vec4(-0.5f * kSides[1].length() + kBay * 2.5f, kSpring - 0.03f, 0.02f, 1));
  const uint32_t node = b.place("curtain in the wind", mesh, where, 180);
  MeshBuilder rod;
  rod.add(p.iron, tube({{-0.5f * kOpening, 0, 0}, {0.5f * kOpening, 0, 0}}, 0.016f, 8));
  b.place("curtain rod", b.mesh("curtain rod", std::move(rod)), where);
  b.swing(node,
          {{.amplitude = 0.8f, .period = 4},
           {.amplitude = 1, .period = 2},
           {.amplitude = 1, .period = 2, .phase = 0.25f}},
          8);
}

}  // namespace

static Scene atriumScene() {
  SceneBuilder b("atrium");
  const Palette p = makePalette(b);
  MeshBuilder building;
  addPaving(building, p);
  addCornices(building, p);
  addGalleries(building, p);
  uint32_t seed = 0;
  for (const Side& side : kSides) {
    MeshBuilder part;
    addLowerSide(part, p, side);
    addUpperSide(part, p, side);
    addBackWall(part, p, side, seed++);
    building.add(part, side.placement);
  }
  b.place("building", b.mesh("building", std::move(building)));
  furnish(b, p);
  addMovingDrape(b, p);
  MeshBuilder plane;
  plane.add(p.paper, paperPlane(), scaled(0.75f));
  b.place("paper plane", b.mesh("paper plane", std::move(plane)), {-2.6f, 3.6f, -0.9f}, 60);
  b.sun("sun", {1.0f, 0.93f, 0.82f}, 20, {0.40f, -0.92f, 0.43f});
  b.camera({-9.7f, 1.7f, -1.3f}, {0, 2.3f, 0.0f}, 50);
  b.scene.environment = {0.19f, 0.34f, 0.58f};
  return b.finish(1.25f, {0.62f, 0.55f});
}

FOVEA_SCENE("atrium", atriumScene);

}  // namespace fovea::scene
