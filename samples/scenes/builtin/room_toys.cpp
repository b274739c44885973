// Toys of the room.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/scenes/builtin/modelling/plants.h"
#include "samples/scenes/builtin/modelling/upholstery.h"
#include "samples/scenes/builtin/room_parts.h"

namespace fovea::scene::room {

using namespace model;

namespace {

constexpr float kPi = glm::pi<float>();
constexpr float kToy = 1.35f;  // the train is modelled for a gauge of 66 mm, then scaled

// A wheel in the x-y plane about the origin, flange at +z.
MeshBuilder wheel(const Palette& p, uint32_t paint, float r) {
  MeshBuilder m;
  Outline tyre({0.62f * r, -0.006f});
  tyre.line(0.92f * r, -0.006f).arc(r, -0.003f, 0.4f, 2).line(r, 0.005f).arc(0.94f * r, 0.007f, 0.4f, 2);
  tyre.line(0.62f * r, 0.007f);
  m.add(paint, lathe(tyre, {.segments = 36, .closed = true}), turnX(90));
  m.add(p.toy[3],
        lathe(Outline({{0, -0.004f}, {0.64f * r, -0.004f}, {0.64f * r, 0.004f}, {0, 0.004f}}),
              {.segments = 24}),
        turnX(90));
  for (const float side : {-1.0f, 1.0f}) m.add(p.brass, sphere(0.22f * r, 16, 8), at(0, 0, side * 0.005f));
  return m;
}

// Two wheels and their axle across z, at height r.
void addAxle(MeshBuilder& m, const Palette& p, uint32_t paint, float x, float r) {
  const MeshBuilder w = wheel(p, paint, r);
  m.add(w, at(x, r, 0.034f)).add(w, at(x, r, -0.034f));
  m.add(p.iron, tube({{x, r, -0.03f}, {x, r, 0.03f}}, 0.0045f, 10));
}

// Buffers and a hook at the end `x`, which looks along +x for side 1.
void addCoupling(MeshBuilder& m, const Palette& p, float x, float side) {
  for (const float z : {-0.028f, 0.028f})
    m.add(p.iron,
          lathe(Outline({{0, 0}, {0.004f, 0}, {0.004f, 0.010f}, {0.009f, 0.012f}, {0, 0.015f}}),
                {.segments = 16}),
          at(x, 0.040f, z) * turnZ(-90 * side));
  m.add(p.brass,
        tube(smoothPath({{x, 0.036f, 0}, {x + side * 0.012f, 0.036f, 0}, {x + side * 0.017f, 0.043f, 0}}, 4),
             0.003f, 8));
}

void addChassis(MeshBuilder& m, const Palette& p, float half, float y) {
  m.add(p.birchAcross,
        box({-half, y, -0.040f}, {half, y + 0.014f, 0.040f}, {.bevel = 0.003f, .bevelSteps = 2}));
  addCoupling(m, p, half, 1);
  addCoupling(m, p, -half, -1);
}

// A vaulted roof along x from -half to half, `wide` to both sides.
Shape roof(float half, float wide, float rise) {
  Outline o({-wide, 0});
  o.line(wide, 0).line(wide, 0.006f).arc(-wide, 0.006f, 2 * rise / (2 * wide), 16);
  return placed(extrude(o, 2 * half, {.bevel = 0.002f}), at(-half, 0, 0) * turnY(90));
}

// A wall with windows in the x-y plane from (-half, 0), 5 mm thick about z = 0.
Shape windowedWall(float half, float height, int windows, float low, float high) {
  std::vector<Outline> holes;
  const float pitch = 2 * half / float(windows), w = 0.62f * pitch;
  for (int i = 0; i < windows; ++i)
    holes.push_back(roundedRectangle(w, high - low, 0.25f * w, 4)
                        .moved({-half + pitch * (float(i) + 0.5f), 0.5f * (low + high)}));
  return placed(extrude(Outline({{-half, 0}, {half, 0}, {half, height}, {-half, height}}), holes, 0.006f),
                at(0, 0, -0.003f));
}

// An egg about the origin with half axes `half`, its surface a little uneven.
Shape plushPart(glm::vec3 half, uint32_t seed, int segments = 32) {
  return bent(
      placed(sphere(1, segments, segments / 2), scaled(half.x, half.y, half.z)),
      [&](glm::vec3 q) {
        const float wobble =
            0.05f * (2 * noise(glm::vec2(q.x + 0.4f * q.z, q.y - 0.3f * q.z) * 26.0f, seed) - 1);
        return q * (1 + wobble);
      },
      80);
}

}  // namespace

float trackLength() { return 4 * kHalfStraight + 2 * kPi * kBend; }

TrackPoint trackAt(float distance) {
  const float total = trackLength(), bend = kPi * kBend;
  float s = std::fmod(distance + kHalfStraight, total);
  if (s < 0) s += total;
  if (s < 2 * kHalfStraight) return {{s - kHalfStraight, 0, kBend}, 0};
  s -= 2 * kHalfStraight;
  if (s < bend) {
    const float a = s / kBend;
    return {{kHalfStraight + kBend * std::sin(a), 0, kBend * std::cos(a)}, glm::degrees(a)};
  }
  s -= bend;
  if (s < 2 * kHalfStraight) return {{kHalfStraight - s, 0, -kBend}, 180};
  const float a = (s - 2 * kHalfStraight) / kBend;
  return {{-kHalfStraight - kBend * std::sin(a), 0, -kBend * std::cos(a)}, 180 + glm::degrees(a)};
}

MeshBuilder locomotive(const Palette& p) {
  MeshBuilder m;
  addChassis(m, p, 0.120f, 0.030f);
  addAxle(m, p, p.toy[0], 0.080f, 0.021f);
  addAxle(m, p, p.toy[0], 0.030f, 0.021f);
  addAxle(m, p, p.toy[0], -0.070f, 0.030f);
  for (const float z : {-0.045f, 0.045f}) {
    m.add(p.brass, box({0.025f, 0.019f, z - 0.002f}, {0.085f, 0.025f, z + 0.002f}, {.bevel = 0.001f}));
    m.add(p.toy[0], box({-0.028f, 0.040f, z - 0.010f}, {0.112f, 0.047f, z + 0.006f}, {.bevel = 0.002f}));
  }
  // Boiler with its bands, smoke box, chimney, dome and lamp.
  Outline boiler({0, 0});
  boiler.line(0.034f, 0).line(0.034f, 0.118f).line(0.037f, 0.119f).line(0.037f, 0.146f);
  boiler.arc(0.030f, 0.151f, 0.4f, 4).line(0.026f, 0.151f).arc(0, 0.156f, 0.12f, 5);
  const glm::mat4 along = at(-0.032f, 0.085f, 0) * turnZ(-90);
  m.add(p.toy[1], lathe(boiler, {.segments = 48}), along);
  for (const float y : {0.030f, 0.065f, 0.100f})
    m.add(p.brass, torus(0.034f, 0.0022f, 48, 8), along * at(0, y, 0));
  m.add(p.iron, box({0.04f, 0.040f, -0.022f}, {0.100f, 0.062f, 0.022f}, {.bevel = 0.003f}));
  Outline chimney({0, 0});
  chimney.line(0.018f, 0).curve({0.012f, 0.008f}, {0.011f, 0.02f}, {0.012f, 0.034f}, 6);
  chimney.line(0.020f, 0.048f)
      .arc(0.020f, 0.054f, 1, 4)
      .line(0.014f, 0.054f)
      .line(0.010f, 0.036f)
      .line(0, 0.034f);
  m.add(p.iron, lathe(chimney, {.segments = 32}), at(0.098f, 0.117f, 0));
  Outline dome({0, -0.01f});
  dome.line(0.017f, -0.01f).line(0.015f, 0.006f).curve({0.015f, 0.02f}, {0.008f, 0.026f}, {0, 0.026f}, 8);
  m.add(p.brass, lathe(dome, {.segments = 32}), at(0.045f, 0.117f, 0));
  m.add(p.brass,
        lathe(Outline({{0, 0}, {0.009f, 0}, {0.012f, 0.012f}, {0.010f, 0.013f}, {0, 0.010f}}),
              {.segments = 24}),
        at(0.118f, 0.122f, 0) * turnZ(-90));
  m.add(p.brass, cylinder(0.005f, 0.022f, 16, 0.001f), at(0.005f, 0.116f, 0));
  // Cab.
  for (const float z : {-0.040f, 0.040f})
    m.add(p.toy[0], windowedWall(0.042f, 0.095f, 1, 0.050f, 0.085f), at(-0.074f, 0.043f, z));
  m.add(p.toy[0], windowedWall(0.040f, 0.095f, 2, 0.074f, 0.090f), at(-0.033f, 0.043f, 0) * turnY(90));
  m.add(p.toy[0], box({-0.115f, 0.043f, -0.040f}, {-0.110f, 0.080f, 0.040f}, {.bevel = 0.001f}));
  m.add(p.toy[3], roof(0.052f, 0.052f, 0.020f), at(-0.075f, 0.137f, 0));
  // Cow catcher.
  for (int i = -4; i <= 4; ++i) {
    const float z = 0.009f * float(i);
    m.add(p.iron, tube({{0.121f, 0.030f, 0.8f * z}, {0.145f - 0.10f * std::abs(z), 0.012f, z}}, 0.0028f, 6));
  }
  MeshBuilder out;
  out.add(m, scaled(kToy));
  return out;
}

MeshBuilder tender(const Palette& p) {
  MeshBuilder m;
  addChassis(m, p, 0.095f, 0.030f);
  for (const float x : {-0.055f, 0.055f}) addAxle(m, p, p.toy[0], x, 0.021f);
  for (const float z : {-0.040f, 0.040f})
    m.add(p.toy[2], box({-0.090f, 0.043f, z - 0.003f}, {0.090f, 0.085f, z + 0.003f}, {.bevel = 0.002f}));
  for (const float x : {-0.088f, 0.088f})
    m.add(p.toy[2], box({x - 0.003f, 0.043f, -0.038f}, {x + 0.003f, 0.085f, 0.038f}, {.bevel = 0.002f}));
  // A load of blocks.
  const uint32_t colors[7] = {p.toy[3], p.toy[0], p.birch, p.toy[1], p.toy[4], p.birch, p.toy[3]};
  for (int i = 0; i < 7; ++i) {
    const float x = -0.066f + 0.022f * float(i), z = i % 2 == 0 ? 0.013f : -0.014f;
    m.add(colors[i], block(0.032f, 0.032f, 0.032f, {.bevel = 0.003f, .bevelSteps = 2}),
          at(x, i % 3 == 1 ? 0.067f : 0.047f, z) * turnY(float(i) * 37) * turnX(i % 3 == 1 ? 14.0f : 0.0f));
  }
  MeshBuilder out;
  out.add(m, scaled(kToy));
  return out;
}

MeshBuilder coach(const Palette& p) {
  MeshBuilder m;
  addChassis(m, p, 0.110f, 0.030f);
  for (const float x : {-0.068f, 0.068f}) addAxle(m, p, p.toy[0], x, 0.021f);
  for (const float z : {-0.040f, 0.040f}) {
    m.add(p.toy[3], windowedWall(0.102f, 0.085f, 4, 0.036f, 0.070f), at(0, 0.043f, z));
    m.add(p.toy[0], box({-0.103f, 0.060f, z - 0.0045f}, {0.103f, 0.066f, z + 0.0045f}, {.bevel = 0.001f}));
  }
  for (const float x : {-0.100f, 0.100f})
    m.add(p.toy[3], windowedWall(0.038f, 0.085f, 1, 0.036f, 0.070f), at(x, 0.043f, 0) * turnY(90));
  m.add(p.birch, box({-0.095f, 0.046f, -0.030f}, {0.095f, 0.062f, 0.030f}, {.bevel = 0.003f}));
  m.add(p.toy[1], roof(0.112f, 0.050f, 0.018f), at(0, 0.127f, 0));
  MeshBuilder out;
  out.add(m, scaled(kToy));
  return out;
}

MeshBuilder track(const Palette& p) {
  MeshBuilder m;
  constexpr int kPieces = 14, kSteps = 10;
  const Outline section = {{-0.070f, 0},       {0.070f, 0},        {0.074f, 0.004f},   {0.074f, 0.022f},
                           {0.072f, 0.0245f},  {0.056f, 0.0245f},  {0.055f, 0.0165f},  {0.036f, 0.0165f},
                           {0.035f, 0.0245f},  {-0.035f, 0.0245f}, {-0.036f, 0.0165f}, {-0.055f, 0.0165f},
                           {-0.056f, 0.0245f}, {-0.072f, 0.0245f}, {-0.074f, 0.022f},  {-0.074f, 0.004f}};
  const float length = trackLength() / kPieces;
  for (int i = 0; i < kPieces; ++i) {
    std::vector<glm::vec3> path;
    for (int k = 0; k <= kSteps; ++k)
      path.push_back(trackAt(length * float(i) + 0.0015f + (length - 0.003f) * float(k) / kSteps).position);
    m.add(p.birch, sweep(path, section, {.up = glm::vec3(0, 1, 0), .creaseDegrees = 60}));
  }
  return m;
}

MeshBuilder tunnel(const Palette& p) {
  // Two arches of stacked blocks and a roof: spans the track, which runs along x.
  MeshBuilder m;
  for (const float x : {-0.13f, 0.13f}) {
    m.add(p.birch, extrude(archedPanel(0.36f, 0.30f, 0.21f, 0.165f, 20), 0.045f, {.bevel = 0.003f}),
          at(x - 0.0225f, 0, 0) * turnY(90));
    m.add(p.toy[0], box({x - 0.03f, 0.30f, -0.19f}, {x + 0.03f, 0.325f, 0.19f}, {.bevel = 0.003f}));
  }
  for (const float z : {-0.15f, 0.15f})
    m.add(p.toy[1], box({-0.105f, 0, z - 0.022f}, {0.105f, 0.30f, z + 0.022f}, {.bevel = 0.003f}));
  Outline gable({-0.20f, 0});
  gable.line(0.20f, 0).line(0, 0.13f);
  m.add(p.toy[2], extrude(gable, 0.32f, {.bevel = 0.003f}), at(-0.16f, 0.325f, 0) * turnY(90));
  return m;
}

MeshBuilder toyTree(const Palette& p, float h) {
  MeshBuilder m;
  Outline foot({0, 0});
  foot.line(0.17f * h, 0)
      .line(0.17f * h, 0.03f * h)
      .arc(0.15f * h, 0.05f * h, 0.4f, 3)
      .line(0.05f * h, 0.06f * h);
  foot.line(0.045f * h, 0.30f * h).line(0, 0.30f * h);
  m.add(p.birch, lathe(foot, {.segments = 28}));
  for (int i = 0; i < 3; ++i) {
    const float y = h * (0.24f + 0.22f * float(i)), r = h * (0.27f - 0.055f * float(i));
    Outline cone({0, y});
    cone.line(0.9f * r, y).arc(0.92f * r, y + 0.03f * h, 0.8f, 4).line(0.16f * r, y + 0.31f * h);
    cone.arc(0, y + 0.33f * h, 0.3f, 3);
    m.add(p.toy[2], lathe(cone, {.segments = 32}));
  }
  return m;
}

MeshBuilder teddy(const Palette& p) {
  MeshBuilder m;
  m.add(p.plush, plushPart({0.105f, 0.125f, 0.090f}, 301, 40), at(0, 0.12f, 0));
  m.add(p.plushPale, plushPart({0.070f, 0.085f, 0.030f}, 302), at(0, 0.115f, 0.068f) * turnX(-6));
  m.add(p.plush, plushPart({0.090f, 0.082f, 0.080f}, 303, 40), at(0, 0.295f, 0.012f));
  m.add(p.plushPale, plushPart({0.042f, 0.034f, 0.036f}, 304), at(0, 0.278f, 0.086f));
  m.add(p.iron, plushPart({0.014f, 0.010f, 0.009f}, 305, 16), at(0, 0.293f, 0.118f));
  m.add(p.iron,
        tube(smoothPath({{-0.014f, 0.264f, 0.116f}, {0, 0.268f, 0.1225f}, {0.014f, 0.264f, 0.116f}}, 6),
             0.0018f, 6));
  for (const float s : {-1.0f, 1.0f}) {
    m.add(p.plush, plushPart({0.034f, 0.034f, 0.018f}, 306, 24), at(s * 0.072f, 0.362f, 0) * turnZ(-s * 30));
    m.add(p.plushPale, plushPart({0.021f, 0.021f, 0.012f}, 307, 20),
          at(s * 0.073f, 0.361f, 0.011f) * turnZ(-s * 30));
    m.add(p.iron, sphere(0.0085f, 16, 10), at(s * 0.032f, 0.312f, 0.083f));
    m.add(p.plush, plushPart({0.038f, 0.085f, 0.040f}, 308),
          at(s * 0.115f, 0.165f, 0.038f) * turnX(-48) * turnZ(s * 24));
    m.add(p.plush, plushPart({0.046f, 0.046f, 0.098f}, 309), at(s * 0.078f, 0.046f, 0.115f) * turnY(s * 16));
    m.add(p.plush, plushPart({0.043f, 0.055f, 0.032f}, 310), at(s * 0.106f, 0.058f, 0.192f) * turnY(s * 16));
    m.add(p.plushPale, plushPart({0.030f, 0.040f, 0.010f}, 311, 24),
          at(s * 0.113f, 0.058f, 0.220f) * turnY(s * 16));
  }
  // A ribbon with a bow.
  m.add(p.toy[0], torus(0.066f, 0.010f, 40, 8), at(0, 0.226f, 0.004f) * turnX(6) * scaled(1, 0.9f, 0.95f));
  for (const float s : {-1.0f, 1.0f})
    m.add(p.toy[0], plushPart({0.030f, 0.018f, 0.010f}, 312, 20),
          at(s * 0.028f, 0.222f, 0.078f) * turnZ(s * 18));
  return m;
}

MeshBuilder globe(const Palette& p) {
  MeshBuilder m;
  constexpr float r = 0.135f, y = 0.235f;
  Shape ball = sphere(r, 48, 28);
  m.add(p.globe, ball, at(0, y, 0) * turnZ(-23));
  Outline foot({0, 0});
  foot.line(0.095f, 0).line(0.095f, 0.010f).curve({0.07f, 0.02f}, {0.02f, 0.02f}, {0.014f, 0.05f}, 8);
  foot.line(0.012f, 0.075f).line(0, 0.08f);
  m.add(p.oak, lathe(foot, {.segments = 36}));
  std::vector<glm::vec3> arc;
  for (int i = 0; i <= 24; ++i) {
    const float a = glm::radians(-113.0f + 180.0f * float(i) / 24);
    arc.push_back({(r + 0.014f) * std::cos(a), y + (r + 0.014f) * std::sin(a), 0});
  }
  m.add(p.brass, sweep(arc, rectangle(0.005f, 0.012f), {.up = glm::vec3(0, 0, 1)}));
  for (const float s : {-1.0f, 1.0f})
    m.add(p.brass, cylinder(0.006f, 0.022f, 16),
          at(0, y, 0) * turnZ(-23) * at(0, s > 0 ? r - 0.004f : -r - 0.018f, 0));
  return m;
}

MeshBuilder ball(const Palette& p, float r) {
  // Six gores and two caps, as on a beach ball.
  MeshBuilder m;
  const uint32_t colors[6] = {p.toy[0], p.toy[5], p.toy[1], p.toy[5], p.toy[3], p.toy[5]};
  Outline side;
  for (int i = 0; i <= 26; ++i) {
    const float a = kPi * (-0.5f + (0.07f + 0.86f * float(i) / 26));
    side.line(r * std::cos(a), r * std::sin(a));
  }
  for (int i = 0; i < 6; ++i)
    m.add(colors[i],
          lathe(side, {.segments = 10, .fromDegrees = 60.0f * float(i), .toDegrees = 60.0f * float(i + 1)}),
          at(0, r, 0) * turnZ(28) * turnX(17));
  for (const float s : {0.0f, 180.0f}) {
    Outline cap;
    for (int i = 0; i <= 5; ++i) {
      const float a = kPi * (0.43f + 0.07f * float(i) / 5);
      cap.line(i == 5 ? 0 : r * std::cos(a), r * std::sin(a));
    }
    m.add(p.toy[5], lathe(cap, {.segments = 36}), at(0, r, 0) * turnZ(28) * turnX(17) * turnX(s));
  }
  return m;
}

MeshBuilder basket(const Palette& p) {
  MeshBuilder m;
  constexpr int kStakes = 22, kRows = 15;
  const auto radius = [](float y) { return 0.175f + 0.16f * y - 0.12f * y * y; };
  for (int j = 0; j < kRows; ++j) {
    std::vector<glm::vec3> path;
    const float y = 0.014f + 0.020f * float(j);
    for (int i = 0; i < kStakes * 4; ++i) {
      const float a = 2 * kPi * float(i) / (kStakes * 4);
      const float r = radius(y) + 0.0075f * std::cos(a * kStakes / 2 + kPi * float(j));
      path.push_back({r * std::cos(a), y, r * std::sin(a)});
    }
    m.add(p.wicker, tube(path, 0.0095f, 7, true));
  }
  for (int i = 0; i < kStakes; ++i) {
    const float a = 2 * kPi * float(i) / kStakes;
    std::vector<glm::vec3> path;
    for (int k = 0; k <= 8; ++k) {
      const float y = 0.32f * float(k) / 8;
      path.push_back({radius(y) * std::cos(a), y, radius(y) * std::sin(a)});
    }
    m.add(p.wicker, tube(path, 0.007f, 6));
  }
  // A plaited rim and two handles.
  for (int strand = 0; strand < 3; ++strand) {
    std::vector<glm::vec3> path;
    for (int i = 0; i < 132; ++i) {
      const float a = 2 * kPi * float(i) / 132, b = 24 * a + 2 * kPi * float(strand) / 3;
      const float r = radius(0.32f) + 0.009f * std::cos(b);
      path.push_back({r * std::cos(a), 0.322f + 0.009f * std::sin(b), r * std::sin(a)});
    }
    m.add(p.wicker, tube(path, 0.008f, 6, true));
  }
  for (const float s : {-1.0f, 1.0f})
    m.add(p.wicker, tube(smoothPath({{s * 0.205f, 0.30f, -0.05f},
                                     {s * 0.225f, 0.37f, -0.035f},
                                     {s * 0.225f, 0.37f, 0.035f},
                                     {s * 0.205f, 0.30f, 0.05f}},
                                    6),
                         0.010f, 8));
  m.add(p.wicker, cylinder(0.175f, 0.012f, 40), at(0, 0.001f, 0));
  // Its contents: a folded blanket, a ball, and rolls of paper.
  m.add(p.cloth[0], cushion(0.32f, 0.30f, 0.16f, 331), at(0, 0.25f, 0.01f) * turnX(-80) * turnZ(20));
  m.add(ball(p, 0.085f), at(0.055f, 0.29f, -0.055f));
  for (int i = 0; i < 2; ++i) {
    Outline roll({0.017f, 0});
    roll.line(0.019f, 0).line(0.019f, 0.42f).line(0.017f, 0.42f);
    m.add(p.paper, lathe(roll, {.segments = 24, .closed = true}),
          at(-0.07f - 0.03f * float(i), 0.16f, -0.03f + 0.07f * float(i)) * turnZ(17 + 6 * float(i)) *
              turnX(-9));
  }
  return m;
}

MeshBuilder castle(const Palette& p) {
  MeshBuilder m;
  const BoxOptions round = {.bevel = 0.004f, .bevelSteps = 2};
  const auto cube = [&](int color, float x, float y, float z, glm::vec3 size, float turn) {
    m.add(color < 0 ? p.birch : p.toy[color], block(size.x, size.y, size.z, round),
          at(x, y, z) * turnY(turn));
  };
  cube(1, -0.14f, 0, 0, {0.08f, 0.08f, 0.08f}, 4);
  cube(0, 0.13f, 0, 0.01f, {0.08f, 0.08f, 0.08f}, -7);
  cube(-1, -0.14f, 0.08f, 0.002f, {0.08f, 0.08f, 0.08f}, -3);
  cube(3, 0.13f, 0.08f, 0.006f, {0.08f, 0.08f, 0.08f}, 5);
  m.add(p.birch, extrude(archedPanel(0.19f, 0.12f, 0.10f, 0.04f, 20), 0.07f, {.bevel = 0.003f}),
        at(-0.005f, 0, -0.035f));
  cube(2, 0.0f, 0.12f, 0, {0.20f, 0.04f, 0.075f}, 1);
  cube(4, -0.005f, 0.16f, 0, {0.34f, 0.035f, 0.08f}, 2);
  for (const float x : {-0.135f, 0.125f})
    m.add(p.toy[5], cylinder(0.030f, 0.09f, 36, 0.003f), at(x, 0.195f, 0.0f));
  m.add(p.birch, extrude(Outline({{-0.06f, 0}, {0.06f, 0}, {0, 0.06f}}), 0.07f, {.bevel = 0.003f}),
        at(0, 0.195f, -0.035f));
  for (const float x : {-0.135f, 0.125f})
    m.add(p.toy[0],
          lathe(Outline({{0, 0}, {0.040f, 0}, {0.040f, 0.006f}, {0.004f, 0.085f}, {0, 0.087f}}),
                {.segments = 36}),
          at(x, 0.285f, 0.0f));
  // Strewn about.
  cube(3, 0.30f, 0, 0.12f, {0.08f, 0.04f, 0.08f}, 33);
  cube(2, -0.30f, 0, 0.16f, {0.06f, 0.06f, 0.06f}, 61);
  cube(4, 0.05f, 0, 0.22f, {0.12f, 0.04f, 0.04f}, -24);
  m.add(p.toy[1], cylinder(0.028f, 0.11f, 36, 0.003f), at(-0.10f, 0.028f, 0.19f) * turnY(50) * turnZ(90));
  m.add(p.birch, extrude(archedPanel(0.16f, 0.08f, 0.08f, 0.0f, 20), 0.05f, {.bevel = 0.003f}),
        at(0.24f, 0.0f, 0.26f) * turnY(-35));
  return m;
}

MeshBuilder stackingRings(const Palette& p) {
  MeshBuilder m;
  m.add(p.birch, lathe(Outline({{0, 0}, {0.060f, 0}, {0.064f, 0.006f}, {0.060f, 0.016f}, {0, 0.016f}}),
                       {.segments = 36}));
  const int order[5] = {1, 2, 3, 4, 0};
  float y = 0.016f;
  for (int i = 0; i < 5; ++i) {
    const float tubeRadius = 0.0155f - 0.0012f * float(i), r = 0.056f - 0.008f * float(i) - tubeRadius;
    m.add(p.toy[order[i]], torus(std::max(r, 0.012f), tubeRadius, 40, 14), at(0, y + tubeRadius, 0));
    y += 1.9f * tubeRadius;
  }
  m.add(p.birch, cylinder(0.008f, y, 16), at(0, 0.01f, 0));
  m.add(p.toy[0], sphere(0.020f, 28, 16), at(0, y + 0.016f, 0));
  return m;
}

MeshBuilder pottedPlant(const Palette& p, uint32_t seed) {
  MeshBuilder m;
  Outline pot({0, 0});
  pot.line(0.075f, 0)
      .line(0.100f, 0.13f)
      .line(0.110f, 0.132f)
      .line(0.113f, 0.165f)
      .arc(0.106f, 0.17f, 0.5f, 3);
  pot.line(0.098f, 0.168f).line(0.092f, 0.14f).line(0, 0.142f);
  m.add(p.clay, lathe(pot, {.segments = 40}));
  m.add(p.soil, lathe(Outline({{0.094f, 0.146f}, {0.04f, 0.152f}, {0, 0.153f}}), {.segments = 24}));
  m.add(p.leaf,
        rosette(26, {.length = 0.34f, .width = 0.045f, .fold = 0.35f, .droop = 0.5f, .steps = 7}, 68, seed),
        at(0, 0.145f, 0));
  m.add(p.leaf,
        rosette(16, {.length = 0.24f, .width = 0.05f, .fold = 0.3f, .droop = 0.3f, .steps = 6}, 40, seed + 1),
        at(0, 0.15f, 0) * turnY(30));
  return m;
}

MeshBuilder openBook(const Palette& p) {
  MeshBuilder m;
  for (const float side : {-1.0f, 1.0f}) {
    m.add(p.book[0], box({0, 0, -0.152f}, {0.218f, 0.003f, 0.152f}, {.bevel = 0.001f}), scaled(side, 1, 1));
    // Half of the pages: a bowed block, and a leaf that stands up.
    const auto page = [&](float low, float thick) {
      return bent(box({0.001f, low, -0.145f}, {0.210f, low + thick, 0.145f}, {.cells = {14, 1, 1}}),
                  [=](glm::vec3 q) {
                    const float t = q.x / 0.21f;
                    return q + glm::vec3(
                                   0, (q.y - 0.003f) * (1.1f * std::sin(kPi * std::sqrt(t)) - 0.55f * t), 0);
                  });
    };
    m.add(p.paper, page(0.003f, 0.016f), scaled(side, 1, 1));
    const Sheet leaf = sheet(16, 2, {1, 1}, [&](float u, float v) {
      const float t = side > 0 ? u : 1 - u, lift = side > 0 ? 0.034f * t * t : 0.0015f;
      return glm::vec3(side * (0.002f + 0.206f * t),
                       0.0195f + lift + 0.016f * (1.1f * std::sin(kPi * std::sqrt(t)) - 0.55f * t),
                       0.29f * (v - 0.5f));
    });
    m.add(p.picture[side > 0 ? 2 : 1], surface(leaf, 0.0007f));
  }
  return m;
}

MeshBuilder bunting(const Palette& p, float width, float sag) {
  MeshBuilder m;
  const auto hang = [&](float t) { return glm::vec3(width * t, -sag * 4 * t * (1 - t), 0); };
  std::vector<glm::vec3> cord;
  for (int i = 0; i <= 48; ++i) cord.push_back(hang(float(i) / 48));
  m.add(p.fringe, tube(cord, 0.004f, 6));
  const int flags = int(width / 0.17f);
  for (int i = 0; i < flags; ++i) {
    const float t0 = (float(i) + 0.12f) / float(flags), t1 = (float(i) + 0.88f) / float(flags);
    const glm::vec3 a = hang(t0), b = hang(t1);
    const Sheet s = sheet(10, 10, {0.12f, 0.16f}, [&](float u, float v) {
      const float c = 0.5f + (u - 0.5f) * (1 - 0.96f * v);
      const glm::vec3 top = glm::mix(a, b, c);
      return top + glm::vec3(0, -0.165f * v, 0.012f * v * std::sin(7 * u + 5 * v + float(i)));
    });
    m.add(p.toy[i % 5], surface(s, 0.002f));
  }
  return m;
}

}  // namespace fovea::scene::room
