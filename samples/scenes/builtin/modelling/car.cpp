// The body of the car is one surface: sections across the car, which are half superellipses, follow each other from the
// rear to the front, and end higher above the wheels. The cabin is a solid of dark glass between painted pillars.
#include "samples/scenes/builtin/modelling/car.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fovea::scene::model {
namespace {

constexpr float kRear = -1.75f, kNose = 1.75f, kLow = 0.20f;   // ends and lower edge of the body
constexpr float kRearDeep = 0.13f, kNoseDeep = 0.22f;          // of the rounded ends
constexpr float kAxle = 1.12f, kHub = 0.29f, kArch = 0.345f;   // wheels and the openings around them
constexpr float kWidth = 0.77f, kBelt = 0.70f, kRoof = 1.37f;  // half of the width; the cabin
constexpr float kSquare = 5;                                   // exponent of the superellipses
constexpr float kHalfPi = glm::half_pi<float>();

float topAt(float z) {
  return z < 0.5f ? 0.88f : 0.88f - 0.13f * smoothstep(0.4f, 2.0f, z) - 0.03f * (z - 0.5f);
}

float widthAt(float z) { return kWidth * (1 - 0.11f * std::pow(std::abs(z / kNose), 3.0f)); }

// Where the body ends below: at its edge, or at the opening around a wheel.
float bottomAt(float z) {
  const float d = std::min(std::abs(z - kAxle), std::abs(z + kAxle));
  return d > kArch ? kLow : kHub + std::sqrt(std::max(kArch * kArch - d * d, 0.0f));
}

struct Station {
  float z, top, width;
};

std::vector<Station> stations() {
  std::vector<float> middle;
  const float first = kRear + kRearDeep, last = kNose - kNoseDeep;
  for (int i = 0; i <= 28; ++i) {
    const float z = first + (last - first) * float(i) / 28;
    if (std::abs(std::abs(z) - kAxle) > kArch + 0.02f) middle.push_back(z);
  }
  for (const float axle : {-kAxle, kAxle}) {
    for (const float side : {-1.0f, 1.0f}) middle.push_back(axle + side * (kArch + 0.002f));
    for (int i = 0; i <= 12; ++i) middle.push_back(axle - kArch * std::cos(2 * kHalfPi * float(i) / 12));
  }
  std::sort(middle.begin(), middle.end());
  std::vector<Station> result;
  constexpr int kSteps = 9;  // of a rounded end
  const auto end = [&](float z, float deep, int i) {
    const float a = kHalfPi * float(i) / kSteps, inner = z - std::copysign(deep, z);
    const float low = kLow + 0.02f;
    result.push_back({inner + std::copysign(deep, z) * std::cos(a), low + (topAt(inner) - low) * std::sin(a),
                      widthAt(inner) * (0.93f + 0.07f * std::sin(a))});
  };
  for (int i = 0; i < kSteps; ++i) end(kRear, kRearDeep, i);
  for (const float z : middle) result.push_back({z, topAt(z), widthAt(z)});
  for (int i = kSteps - 1; i >= 0; --i) end(kNose, kNoseDeep, i);
  return result;
}

Shape body() {
  const std::vector<Station> along = stations();
  constexpr uint32_t kRows = 24;
  const Sheet net = sheet(uint32_t(along.size()) - 1, kRows, {3.5f, 3}, [&](float u, float v) {
    const Station& s = along[size_t(std::lround(u * float(along.size() - 1)))];
    const float cut = std::clamp((bottomAt(s.z) - kLow) / (s.top - kLow), 0.0f, 0.95f);
    const float from = std::asin(std::pow(cut, 0.5f * kSquare)), side = v < 0.5f ? 1.0f : -1.0f;
    const float a = from + (kHalfPi - from) * (1 - std::abs(2 * v - 1));
    const float x = v == 0.5f ? 0.0f : std::pow(std::max(std::cos(a), 0.0f), 2 / kSquare);
    return glm::vec3(side * s.width * x, kLow + (s.top - kLow) * std::pow(std::sin(a), 2 / kSquare), s.z);
  });
  return surface(net, 0.012f);
}

// The outside of the body at a height, on the side +x.
glm::vec3 sideAt(float z, float y) {
  const float q = (y - kLow) / (topAt(z) - kLow);
  return {widthAt(z) * std::pow(1 - std::pow(q, kSquare), 1 / kSquare) + 0.005f, y, z};
}

// A point of the cabin: x and z from -1 to 1, t from 0 at the belt to 1 at the roof.
glm::vec3 cabin(float x, float t, float z, float grow = 0) {
  const float front = 0.72f - 0.62f * t, rear = -1.62f + 0.26f * t;
  const float along = 0.5f * (front + rear) + (0.5f * (front - rear) + grow) * z;
  const float across = (0.70f - 0.13f * t - 0.05f * std::max(z, 0.0f) + grow) * x;
  return {across, kBelt + (kRoof - kBelt) * t, along - 0.09f * x * x * z};
}

void addCabin(MeshBuilder& m, const CarLook& look) {
  m.add(look.glass, bent(box({-1, 0, -1}, {1, 1, 1}, {.cells = {8, 5, 10}}),
                         [](glm::vec3 q) { return cabin(q.x, q.y, q.z); }));
  const Shape roof = bent(box({-1, 0, -1}, {1, 1, 1}, {.cells = {12, 1, 16}}), [](glm::vec3 q) {
    glm::vec3 p = cabin(q.x, 0.95f + 0.06f * q.y, q.z, 0.022f);
    p.y += 0.035f * (1 - q.x * q.x) * (1 - q.z * q.z);
    return p;
  });
  m.add(look.paint, roof);
  for (const float side : {-1.0f, 1.0f}) {
    for (const glm::vec2& pillar :
         {glm::vec2(0.99f, 0.03f), glm::vec2(-0.12f, 0.034f), glm::vec2(-0.95f, 0.06f)})
      m.add(look.paint, tube({cabin(side, 0.02f, pillar.x), cabin(side, 0.99f, pillar.x)}, pillar.y, 12));
    // The rubber along the foot of the windows, a mirror.
    std::vector<glm::vec3> foot;
    for (int i = 0; i <= 8; ++i) foot.push_back(cabin(side, 0.14f, -0.9f + 0.22f * float(i), 0.004f));
    m.add(look.dark, tube(foot, 0.012f, 8));
    const glm::vec3 mirror = cabin(side, 0.24f, 0.86f) + glm::vec3(side * 0.11f, 0, 0);
    m.add(look.dark, tube({cabin(side, 0.2f, 0.88f), mirror}, 0.012f, 8));
    m.add(look.paint, sphere(0.075f, 18, 10), at(mirror) * scaled(1, 0.72f, 0.5f));
  }
  for (const float x : {-0.35f, 0.15f})  // wipers
    m.add(look.dark, tube({cabin(x, 0.22f, 1.012f), cabin(x + 0.45f, 0.36f, 1.012f)}, 0.007f, 6));
}

void addWheels(MeshBuilder& m, const CarLook& look) {
  Outline rim({0, -0.05f});
  rim.line(0.19f, -0.05f).line(0.19f, 0.055f).line(0.172f, 0.06f).line(0.155f, 0.035f).line(0.06f, 0.045f);
  rim.line(0.045f, 0.062f).line(0, 0.064f);
  for (const float side : {-1.0f, 1.0f})
    for (const float z : {-kAxle, kAxle}) {
      const glm::mat4 where = at(side * 0.655f, kHub, z) * turnZ(-90 * side) * turnY(21 * z);
      m.add(look.rubber, tyre(), where).add(look.rim, lathe(rim, {.segments = 36}), where);
      for (int i = 0; i < 8; ++i)
        m.add(look.dark, cylinder(0.02f, 0.018f, 10), where * turnY(45 * float(i)) * at(0.108f, 0.03f, 0));
    }
  m.add(look.dark, box({-0.56f, 0.17f, -1.62f}, {0.56f, 0.5f, 1.5f}, {.bevel = 0.02f}));
}

}  // namespace

Shape tyre() {
  return lathe(roundedRectangle(0.105f, 0.16f, 0.036f, 2).moved({0.2425f, 0}),
               {.segments = 32, .creaseDegrees = 60, .closed = true});
}

MeshBuilder hatchback(const CarLook& look) {
  MeshBuilder m;
  m.add(look.paint, body());
  addCabin(m, look);
  addWheels(m, look);
  // Bumpers, the grille, lamps and plates.
  for (const float end : {-1.0f, 1.0f}) {
    m.add(look.chrome, tube(smoothPath({{-0.715f, 0.37f, end * 1.44f},
                                        {-0.69f, 0.37f, end * 1.66f},
                                        {-0.58f, 0.37f, end * 1.765f},
                                        {0, 0.37f, end * 1.785f},
                                        {0.58f, 0.37f, end * 1.765f},
                                        {0.69f, 0.37f, end * 1.66f},
                                        {0.715f, 0.37f, end * 1.44f}},
                                       6),
                            0.04f, 12));
    m.add(look.plate, box({-0.26f, 0.32f, 1.80f}, {0.26f, 0.43f, 1.838f}), turnY(end > 0 ? 0.0f : 180.0f));
  }
  m.add(look.dark, box({-0.31f, 0.46f, 1.55f}, {0.31f, 0.585f, 1.737f}, {.bevel = 0.015f}));
  for (const float y : {0.485f, 0.522f, 0.56f})
    m.add(look.chrome, tube({{-0.29f, y, 1.738f}, {0.29f, y, 1.738f}}, 0.007f, 8));
  for (const float side : {-1.0f, 1.0f}) {
    const glm::mat4 lamp = at(side * 0.49f, 0.60f, 1.672f) * turnX(-18) * turnY(14 * side);
    m.add(look.lens, sphere(0.098f, 24, 12), lamp * scaled(1, 1, 0.5f));
    m.add(look.chrome, torus(0.1f, 0.012f, 36, 8), lamp * turnX(90));
    m.add(look.tail, box({-0.06f, 0.56f, -0.05f}, {0.06f, 0.76f, 0.05f}, {.bevel = 0.015f}),
          at(side * 0.56f, 0, -1.67f));
    // The seams of a door, its handle, and the strip along the sill.
    std::vector<glm::vec3> seam, sill;
    for (int i = 0; i <= 8; ++i) seam.push_back(sideAt(-0.5f, 0.28f + 0.062f * float(i)));
    for (int i = 8; i >= 0; --i) seam.push_back(sideAt(0.62f, 0.28f + 0.062f * float(i)));
    for (int i = 0; i <= 8; ++i) sill.push_back(sideAt(-0.74f + 0.185f * float(i), 0.44f));
    seam.push_back(seam.front());
    const glm::mat4 mirror = scaled(side, 1, 1);
    m.add(look.dark, tube(seam, 0.004f, 6), mirror).add(look.dark, tube(sill, 0.011f, 8), mirror);
    m.add(look.chrome, box({-0.01f, -0.012f, -0.08f}, {0.022f, 0.012f, 0.08f}, {.bevel = 0.006f}),
          mirror * at(sideAt(-0.36f, 0.68f)));
  }
  return m;
}

}  // namespace fovea::scene::model
