// A small chapel of stone. The sun falls through five windows of the right wall onto benches, floor and altar, so that
// nearly all that is seen is lit by a few bright patches; the vault above has no direct light.
#include <glm/gtc/constants.hpp>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/furniture.h"
#include "samples/scenes/builtin/modelling/textures.h"

namespace fovea::scene {
namespace {

using namespace model;

constexpr float kHalfWidth = 3.2f, kSpring = 4.2f, kBack = -7.5f, kFront = 5.5f, kWall = 0.6f;
constexpr float kBay = 2.4f;  // from window to window
constexpr int kWindows = 5;

struct Palette {
  uint32_t stone, vault, floor, oak, cloth, brass, wax, runner, grass;
};

Palette makePalette(SceneBuilder& b) {
  Palette p{};
  const Stock s = makeStock(b, 901);
  const uint32_t blocks = b.texture(masonry("ashlar",
                                            {.columns = 4,
                                             .rows = 8,
                                             .joint = 0.05f,
                                             .low = glm::vec3(0.72f),
                                             .high = glm::vec3(0.95f),
                                             .jointColor = glm::vec3(0.6f)},
                                            512, 512, 902));
  p.stone = b.material("sandstone", {0.62f, 0.53f, 0.41f}, {.texture = blocks, .metres = 3.2f});
  p.vault = b.material("limewash", {0.80f, 0.77f, 0.70f}, {.texture = s.plaster, .metres = 4});
  const uint32_t slabs = b.texture(masonry("slabs",
                                           {.columns = 4,
                                            .rows = 4,
                                            .joint = 0.03f,
                                            .low = glm::vec3(0.70f),
                                            .high = glm::vec3(0.98f),
                                            .jointColor = glm::vec3(0.45f),
                                            .staggered = false},
                                           512, 512, 903));
  p.floor = b.material("slabs", {0.58f, 0.54f, 0.48f}, {.texture = slabs, .metres = 3});
  p.oak =
      b.material("dark oak", {0.24f, 0.14f, 0.08f}, {.texture = s.grain, .metres = 0.4f, .metresHigh = 1.4f});
  p.cloth = b.material("altar cloth", {0.78f, 0.76f, 0.72f}, {.texture = s.linen, .metres = 0.4f});
  p.brass = b.material("brass", {0.62f, 0.43f, 0.16f});
  p.wax = b.material("wax", {0.82f, 0.76f, 0.60f});
  p.runner = b.material("red runner", {0.30f, 0.13f, 0.12f}, {.texture = s.mottled, .metres = 0.8f});
  const uint32_t lawn =
      b.texture(ground("lawn", {0.10f, 0.17f, 0.05f}, {0.17f, 0.26f, 0.09f}, 0.4f, 256, 904));
  p.grass = b.material("lawn", glm::vec3(1), {.texture = lawn, .metres = 4});
  return p;
}

// A side wall along z: panels with round arches, and what lies below their sills. Its inner face is at x = 0 and looks
// along +x; with `open`, light comes through.
MeshBuilder sideWall(const Palette& p, bool open) {
  MeshBuilder m;
  const float start = kBack + 0.5f * (kFront - kBack - kBay * kWindows), sill = 1.6f;
  const glm::mat4 upright = turnY(90);  // z becomes the direction of x
  if (!open) {
    m.add(p.stone, box({-kWall, 0, kBack - kWall}, {0, kSpring, kFront + kWall}));
    return m;
  }
  m.add(p.stone, box({-kWall, 0, kBack - kWall}, {0, sill, kFront + kWall}));
  m.add(p.stone, box({-kWall, sill, kBack - kWall}, {0, kSpring, start}));
  m.add(p.stone, box({-kWall, sill, start + kBay * kWindows}, {0, kSpring, kFront + kWall}));
  for (int i = 0; i < kWindows; ++i)
    m.add(p.stone, extrude(archedPanel(kBay, kSpring - sill, 1.35f, 1.4f, 20), kWall),
          at(-kWall, sill, start + kBay * (float(i) + 0.5f)) * upright);
  return m;
}

MeshBuilder shell(const Palette& p) {
  MeshBuilder m;
  m.add(p.floor, box({-kHalfWidth - kWall, -0.4f, kBack - kWall}, {kHalfWidth + kWall, 0, kFront + kWall}));
  // What is seen through the windows: a strip of lawn and the wall of the churchyard.
  m.add(p.grass, box({kHalfWidth + kWall + 0.01f, -0.5f, -16}, {9, -0.1f, 14}));
  m.add(p.stone, box({9.01f, -0.5f, -16}, {9.4f, 2.4f, 14}));
  m.add(sideWall(p, false), at(-kHalfWidth, 0, 0));
  m.add(sideWall(p, true), at(kHalfWidth, 0, 0) * scaled(-1, 1, 1));
  // End walls reach above the vault, which is a thick half pipe.
  const float top = kSpring + kHalfWidth + 0.5f;
  m.add(p.stone, box({-kHalfWidth, 0, kBack - kWall}, {kHalfWidth, top, kBack}));
  m.add(p.stone, box({-kHalfWidth, 0, kFront}, {kHalfWidth, top, kFront + kWall}));
  Outline section({kHalfWidth + kWall, 0});
  section.arc(-kHalfWidth - kWall, 0, 1, 40).line(-kHalfWidth, 0).arc(kHalfWidth, 0, -1, 40);
  m.add(p.vault, extrude(section, kFront - kBack + 2 * kWall), at(0, kSpring, kBack - kWall));
  // Ribs of the vault with corbels under them.
  Outline rib({kHalfWidth + 0.05f, 0});
  rib.arc(-kHalfWidth - 0.05f, 0, 1, 40).line(-kHalfWidth + 0.14f, 0).arc(kHalfWidth - 0.14f, 0, -1, 40);
  for (const float z : {-5.2f, -2.8f, -0.4f, 2.0f}) {
    m.add(p.stone, extrude(rib, 0.3f), at(0, kSpring, z - 0.15f));
    for (const float x : {-1.0f, 1.0f})
      m.add(p.stone, block(0.3f, 0.35f, 0.36f, {.bevel = 0.03f}),
            at(x * (kHalfWidth - 0.1f), kSpring - 0.36f, z));
  }
  return m;
}

MeshBuilder bench(const Palette& p) {
  MeshBuilder m;
  constexpr float kLength = 2.05f;
  m.add(p.oak, box({-kLength / 2, 0.43f, -0.2f}, {kLength / 2, 0.465f, 0.18f}, {.bevel = 0.006f}));
  m.add(p.oak, box({-kLength / 2, 0.50f, 0.19f}, {kLength / 2, 0.86f, 0.215f}, {.bevel = 0.006f}));
  for (const float x : {-1.0f, 1.0f}) {
    Outline end({{-0.22f, 0}, {0.24f, 0}});
    end.line(0.24f, 0.86f)
        .curve({0.24f, 0.98f}, {0.12f, 0.98f}, {0.12f, 0.86f}, 8)
        .line(0.10f, 0.56f)
        .line(-0.22f, 0.50f);
    m.add(p.oak, extrude(end, 0.05f, {.bevel = 0.006f}),
          at(x * (kLength / 2 + 0.03f) + 0.025f, 0, 0) * turnY(-90));
  }
  return m;
}

MeshBuilder altar(const Palette& p) {
  MeshBuilder m;
  m.add(p.floor, box({-2.4f, 0.001f, kBack}, {2.4f, 0.16f, kBack + 2.6f}, {.bevel = 0.01f}));
  m.add(p.floor, box({-1.9f, 0.161f, kBack}, {1.9f, 0.32f, kBack + 2.1f}, {.bevel = 0.01f}));
  const glm::mat4 table = at(0, 0.321f, kBack + 1.0f);
  m.add(p.stone, block(1.7f, 0.9f, 0.7f, {.bevel = 0.02f}), table);
  m.add(p.cloth, block(1.9f, 0.03f, 0.86f, {.bevel = 0.008f}), table * at(0, 0.901f, 0));
  m.add(p.cloth, box({-0.95f, 0.45f, 0.40f}, {0.95f, 0.90f, 0.425f}), table);
  for (const float x : {-0.65f, 0.65f}) {
    Outline stick({0, 0});
    stick.line(0.09f, 0)
        .line(0.09f, 0.02f)
        .through({{0.02f, 0.07f}, {0.035f, 0.16f}, {0.02f, 0.25f}, {0.05f, 0.29f}}, 5);
    stick.line(0, 0.29f);
    m.add(p.brass, lathe(stick, {.segments = 32}), table * at(x, 0.932f, 0));
    m.add(p.wax, cylinder(0.022f, 0.3f, 20, 0.004f), table * at(x, 1.222f, 0));
  }
  return m;
}

void furnish(SceneBuilder& b, const Palette& p) {
  MeshBuilder m;
  const MeshBuilder seat = bench(p);
  for (int row = 0; row < 6; ++row)
    for (const float x : {-1.75f, 1.75f}) m.add(seat, at(x, 0, -3.6f + 1.15f * float(row)));
  m.add(p.runner, box({-0.35f, 0.001f, kBack + 2.7f}, {0.35f, 0.014f, kFront - 0.6f}));
  m.add(altar(p));
  // A font beside the door.
  Outline font({0, 0});
  font.line(0.3f, 0)
      .line(0.3f, 0.08f)
      .through({{0.13f, 0.2f}, {0.11f, 0.55f}, {0.2f, 0.72f}, {0.38f, 0.85f}}, 6);
  font.line(0.38f, 0.95f).line(0.32f, 0.95f).through({{0.25f, 0.84f}, {0.1f, 0.78f}}, 5).line(0, 0.77f);
  m.add(p.stone, lathe(font, {.segments = 56}), at(-2.2f, 0, 4.2f));
  b.place("furniture", b.mesh("furniture", std::move(m)));
  // A lamp without a flame hangs before the altar on a chain.
  MeshBuilder lamp;
  Outline bowl({0, -0.16f});
  bowl.through({{0.08f, -0.14f}, {0.15f, -0.04f}, {0.14f, 0.04f}}, 6).line(0.125f, 0.04f);
  bowl.through({{0.13f, -0.03f}, {0.07f, -0.12f}}, 5).line(0, -0.135f);
  lamp.add(p.brass, lathe(bowl, {.segments = 40}));
  for (int i = 0; i < 3; ++i) {
    const float a = glm::two_pi<float>() * float(i) / 3;
    lamp.add(p.brass, tube({{0.132f * std::cos(a), 0.035f, 0.132f * std::sin(a)}, {0, 0.55f, 0}}, 0.006f, 8));
  }
  lamp.add(p.brass, tube({{0, 0.54f, 0}, {0, 4.1f, 0}}, 0.008f, 8));
  b.place("lamp", b.mesh("lamp", std::move(lamp)), {0, 3.2f, -4.6f});
}

}  // namespace

static Scene chapelScene() {
  SceneBuilder b("chapel");
  const Palette p = makePalette(b);
  b.place("walls", b.mesh("walls", shell(p)));
  furnish(b, p);
  b.sun("sun", {1.0f, 0.90f, 0.74f}, 40, {-0.84f, -0.50f, -0.22f});
  b.camera({0.9f, 1.65f, 4.6f}, {-0.5f, 1.5f, -3.0f}, 60);
  return b.finish(1.3f, {0.45f, 0.6f});
}

FOVEA_SCENE("chapel", chapelScene);

}  // namespace fovea::scene
