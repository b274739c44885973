// A ballroom lit by a hundred small lamps, all of which move: ten wheels under the ceiling with ten lamps each, of
// which eight shine down and two to all sides.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr Shell kHall = {.x = 7, .height = 5.5f, .back = -7, .front = 7, .thick = 0.3f};
constexpr int kWheels = 10, kLamps = 10;
constexpr float kRadius = 0.95f, kHigh = 3.5f;

struct Palette {
  uint32_t wall, floor, ceiling, column, wood, brass, velvet, cloth, shade[kWheels];
};

// Ten hues that differ from neighbour to neighbour.
glm::vec3 hue(int i) {
  const float turn = glm::two_pi<float>() * float(i * 3 % kWheels) / kWheels;
  return 0.55f + 0.4f * glm::cos(turn + glm::vec3(0, -2.094f, 2.094f));
}

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 2101);
  p.wall = b.material("cream plaster", {0.74f, 0.69f, 0.58f}, {.texture = s.plaster, .metres = 3});
  p.floor = b.material("parquet", {0.52f, 0.33f, 0.18f}, {.texture = s.planks, .metres = 1.2f});
  p.ceiling = b.material("white plaster", {0.78f, 0.77f, 0.74f}, {.texture = s.plaster, .metres = 4});
  p.column = b.material("pale stone", {0.68f, 0.66f, 0.62f}, {.texture = s.mottled, .metres = 1.4f});
  p.wood = b.material("mahogany", {0.33f, 0.13f, 0.07f}, {.texture = s.grain, .metres = 0.5f});
  p.brass = b.material("brass", {0.62f, 0.43f, 0.16f});
  p.velvet = b.material("green velvet", {0.07f, 0.27f, 0.16f}, {.texture = s.linen, .metres = 0.5f});
  p.cloth = b.material("table cloth", {0.80f, 0.78f, 0.74f}, {.texture = s.linen, .metres = 0.5f});
  for (int i = 0; i < kWheels; ++i)
    p.shade[i] = b.material("shade " + std::to_string(i + 1), 0.8f * hue(i), {.doubleSided = true});
  return p;
}

glm::vec3 lampOf(int i) {
  const float a = glm::two_pi<float>() * float(i) / kLamps;
  return {kRadius * std::cos(a), -0.16f, kRadius * std::sin(a)};
}

// A wheel about the origin, whose axle goes up to the ceiling.
MeshBuilder wheel(const Palette& p, uint32_t shade) {
  MeshBuilder m;
  m.add(p.brass, torus(kRadius, 0.025f, 30, 6));
  m.add(p.brass, tube({{0, -0.1f, 0}, {0, kHall.height - kHigh, 0}}, 0.03f, 8));
  const Shape bell = lathe(Outline({0.12f, -0.16f}).curve({0.11f, -0.08f}, {0.04f, -0.04f}, {0.02f, 0}, 3),
                           {.segments = 12});
  for (int i = 0; i < kLamps; ++i) {
    const glm::vec3 lamp = lampOf(i), rim(lamp.x, 0, lamp.z);
    if (i % 2 == 0) m.add(p.brass, tube({{0, 0, 0}, rim}, 0.012f, 6));
    if (i % 5 != 0) m.add(shade, bell, at(rim));
  }
  return m;
}

// Hangs a wheel up and lets it turn once in `seconds`.
void addWheel(SceneBuilder& b, const Palette& p, int index, glm::vec3 hub, float seconds) {
  const std::string name = "wheel " + std::to_string(index + 1);
  const uint32_t node = b.place(name, b.mesh(name, wheel(p, p.shade[index])), hub);
  for (int i = 0; i < kLamps; ++i) {
    const glm::vec3 where = hub + lampOf(i);
    const std::string lamp = name + ", lamp " + std::to_string(i + 1);
    if (i % 5 == 0)
      addPoint(b, lamp, hue(index), 1.3f, where);
    else
      addSpot(b, lamp, hue(index), 5, where, {0, -1, 0}, 20, 62);
    Node mount;
    mount.name = lamp;
    mount.parent = node;
    mount.translation = lampOf(i);
    mount.light = uint32_t(b.scene.lights.size()) - 1;
    b.scene.nodes.push_back(mount);
  }
  AnimationChannel turn;
  turn.node = node;
  turn.path = AnimationChannel::Path::Rotation;
  for (int i = 0; i <= 4; ++i) {
    const glm::quat q = glm::angleAxis(glm::half_pi<float>() * float(i), glm::vec3(0, 1, 0));
    turn.times.push_back(seconds * float(i) / 4);
    turn.values.insert(turn.values.end(), {q.x, q.y, q.z, q.w});
  }
  Animation animation;
  animation.name = name;
  animation.plays = true;
  animation.channels = {turn};
  b.scene.animations.push_back(animation);
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  Outline shaft({0, 0});
  shaft.line(0.42f, 0).line(0.42f, 0.2f).curve({0.3f, 0.25f}, {0.3f, 0.3f}, {0.28f, 0.4f}, 6);
  shaft.line(0.24f, 4.7f).curve({0.26f, 4.9f}, {0.36f, 4.9f}, {0.4f, 5.1f}, 6);
  shaft.line(0.4f, kHall.height + 0.01f).line(0, kHall.height + 0.01f);
  const Shape column = lathe(shaft, {.segments = 20});
  for (const float x : {-6.2f, 6.2f})
    for (int i = 0; i < 5; ++i) m.add(p.column, column, at(x, 0, -6.0f + 3 * float(i)));
  for (int i = 0; i < 4; ++i) m.add(p.column, column, at(-3.75f + 2.5f * float(i), 0, -6.2f));
  // Tables with long cloths, and seats around them.
  Outline cloth({0, 0});
  cloth.line(0.86f, 0)
      .curve({0.74f, 0.3f}, {0.7f, 0.6f}, {0.69f, 0.74f}, 6)
      .line(0.66f, 0.76f)
      .line(0, 0.76f);
  const Shape covered = lathe(cloth, {.segments = 60, .swell = [](float a, float y) {
                                        return 1 + 0.05f * (0.76f - y) * std::sin(12 * a);
                                      }});
  const glm::vec3 tables[5] = {
      {-3.4f, 0, 1.6f}, {3.3f, 0, 0.7f}, {-3.0f, 0, -3.4f}, {2.6f, 0, -3.9f}, {0.3f, 0, -1.4f}};
  const Shape stool = cylinder(0.26f, 0.45f, 24, 0.03f);
  uint32_t k = 0;
  for (const glm::vec3& t : tables) {
    m.add(p.cloth, covered, at(t));
    for (int i = 0; i < 4; ++i, ++k) {
      const float a = 90 * float(i) + random(2111, k, 0, 60);
      m.add(p.velvet, stool, at(t) * turnY(a) * at(0, 0, 1.25f));
    }
  }
  for (const float x : {-5.3f, 5.3f})
    m.add(p.velvet, block(0.6f, 0.45f, 2.4f, {.bevel = 0.03f, .bevelSteps = 2}), at(x, 0, -1.5f));
  addSkirting(m, kHall, p.wood, 0.25f);
  b.place("things", b.mesh("things", std::move(m)));
}

}  // namespace

static Scene ballroomScene() {
  SceneBuilder b("ballroom");
  const Palette p = makePalette(b);
  Shell shell = kHall;
  shell.wall = p.wall, shell.floor = p.floor, shell.ceiling = p.ceiling;
  MeshBuilder hall;
  addShell(hall, shell);
  b.place("hall", b.mesh("hall", std::move(hall)));
  furnish(b, p);
  for (int i = 0; i < kWheels; ++i)
    addWheel(b, p, i, {-4.2f + 2.8f * float(i % 4), kHigh, 1.8f - 3.1f * float(i / 4)}, 6 + 0.7f * float(i));
  b.camera({1.2f, 1.7f, 6.2f}, {-0.4f, 1.6f, -2}, 62);
  return b.finish(0.8f, {0.45f, 0.55f});
}

FOVEA_SCENE("ballroom", ballroomScene);

}  // namespace fovea::scene
