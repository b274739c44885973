// The paper's Cornell box: 5.5 m per side, about 5.8k triangles, a yellow cube close to the white back wall, and one
// spot light under the ceiling that reaches only the middle of the floor and the objects. Walls and ceiling are hence
// lit indirectly, and the cube's yellow shows on the wall. The moving version of the scene has a violet cloth as
// well, which hangs in front of the back wall and waves.
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "fovea/scene.h"
#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene {
namespace {

constexpr float kHalf = 2.75f;       // half of the inner width and depth, m
constexpr float kHeight = 5.5f;      // inner height; the floor is y = 0
constexpr float kThickness = 0.12f;  // of the walls

enum MaterialIndex : uint32_t { kWhite, kRed, kGreen, kYellow, kBlue, kGrey, kMaterialCount };

std::vector<Material> materials() {
  std::vector<Material> list(kMaterialCount);
  const auto set = [&](MaterialIndex i, const char* name, glm::vec3 color) {
    list[i].name = name;
    list[i].baseColor = glm::vec4(color, 1.0f);
  };
  set(kWhite, "white", {0.78f, 0.77f, 0.75f});
  set(kRed, "red", {0.63f, 0.08f, 0.06f});
  set(kGreen, "green", {0.14f, 0.50f, 0.12f});
  set(kYellow, "yellow", {0.80f, 0.62f, 0.03f});
  set(kBlue, "blue", {0.16f, 0.28f, 0.62f});
  set(kGrey, "light grey", {0.60f, 0.60f, 0.60f});
  return list;
}

// A quad with corners counter-clockwise seen from its front.
void addQuad(Primitive& p, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  const uint32_t base = uint32_t(p.positions.size());
  const glm::vec3 n = glm::normalize(glm::cross(b - a, c - a));
  for (const glm::vec3& v : {a, b, c, d}) {
    p.positions.push_back(v);
    p.normals.push_back(n);
  }
  for (const glm::vec2& uv : {glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0), glm::vec2(0, 0)})
    p.uvs.push_back(uv);
  for (uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(base + i);
}

// Inner faces, outer faces and the rim around the open front. Neighbours share exact corners, so that no light leaks
// at seams; the walls have the same thickness for a voxeliser as they appear to have.
Mesh shell() {
  std::vector<Primitive> byMaterial(kMaterialCount);
  for (uint32_t i = 0; i < kMaterialCount; ++i) byMaterial[i].material = i;
  const float o = kHalf + kThickness;
  const glm::vec3 in[8] = {{-kHalf, 0, kHalf},       {kHalf, 0, kHalf},        {kHalf, 0, -kHalf},
                           {-kHalf, 0, -kHalf},      {-kHalf, kHeight, kHalf}, {kHalf, kHeight, kHalf},
                           {kHalf, kHeight, -kHalf}, {-kHalf, kHeight, -kHalf}};
  const float low = -kThickness, high = kHeight + kThickness;
  const glm::vec3 out[8] = {{-o, low, kHalf},  {o, low, kHalf},  {o, low, -o},  {-o, low, -o},
                            {-o, high, kHalf}, {o, high, kHalf}, {o, high, -o}, {-o, high, -o}};
  struct Face {
    int v[4];
    MaterialIndex material;
  };
  const Face faces[] = {{{0, 1, 2, 3}, kWhite},   // floor
                        {{7, 6, 5, 4}, kWhite},   // ceiling
                        {{3, 2, 6, 7}, kWhite},   // back
                        {{0, 3, 7, 4}, kRed},     // left
                        {{2, 1, 5, 6}, kGreen}};  // right
  for (const Face& f : faces) {
    addQuad(byMaterial[f.material], in[f.v[0]], in[f.v[1]], in[f.v[2]], in[f.v[3]]);
    addQuad(byMaterial[kGrey], out[f.v[3]], out[f.v[2]], out[f.v[1]], out[f.v[0]]);
  }
  const int rim[4][2] = {{0, 1}, {1, 5}, {5, 4}, {4, 0}};
  for (const auto& e : rim) addQuad(byMaterial[kGrey], out[e[0]], out[e[1]], in[e[1]], in[e[0]]);
  Mesh mesh{"room", {}};
  for (Primitive& p : byMaterial)
    if (!p.indices.empty()) mesh.primitives.push_back(std::move(p));
  return mesh;
}

Mesh cube(MaterialIndex material) {
  Primitive p;
  p.material = material;
  const glm::vec3 v[8] = {{-0.5f, 0, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0, -0.5f}, {-0.5f, 0, -0.5f},
                          {-0.5f, 1, 0.5f}, {0.5f, 1, 0.5f}, {0.5f, 1, -0.5f}, {-0.5f, 1, -0.5f}};
  const int faces[6][4] = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4},
                           {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  for (const auto& f : faces) addQuad(p, v[f[0]], v[f[1]], v[f[2]], v[f[3]]);
  return {"cube", {std::move(p)}};
}

// A closed profile (x = radius, y = height) with its normals, turned about the y axis. Points on the
// axis become poles.
struct ProfilePoint {
  glm::vec2 position, normal;
};

Mesh lathe(const char* name, const std::vector<ProfilePoint>& profile, uint32_t segments,
           MaterialIndex material, bool closed) {
  Primitive p;
  p.material = material;
  const uint32_t rows = uint32_t(profile.size());
  for (uint32_t s = 0; s <= segments; ++s) {
    // The last column repeats the first exactly: its texture coordinate differs, its position must not.
    const float angle = glm::two_pi<float>() * float(s % segments) / float(segments);
    const float c = std::cos(angle), sn = std::sin(angle);
    for (uint32_t r = 0; r < rows; ++r) {
      const ProfilePoint& q = profile[r];
      p.positions.push_back({q.position.x * c, q.position.y, -q.position.x * sn});
      p.normals.push_back(glm::normalize(glm::vec3(q.normal.x * c, q.normal.y, -q.normal.x * sn)));
      p.uvs.push_back({float(s) / float(segments), 1.0f - float(r) / float(rows)});
    }
  }
  const uint32_t bands = closed ? rows : rows - 1;
  for (uint32_t s = 0; s < segments; ++s) {
    for (uint32_t r = 0; r < bands; ++r) {
      const uint32_t r1 = (r + 1) % rows;
      if (profile[r].position == profile[r1].position) continue;  // a crease: two normals at one place
      const uint32_t a = s * rows + r, b = (s + 1) * rows + r, c = (s + 1) * rows + r1, d = s * rows + r1;
      if (profile[r].position.x > 0.0f) p.indices.insert(p.indices.end(), {a, b, c});
      if (profile[r1].position.x > 0.0f) p.indices.insert(p.indices.end(), {a, c, d});
    }
  }
  return {name, {std::move(p)}};
}

Mesh sphere(uint32_t segments, uint32_t rings, MaterialIndex material) {
  std::vector<ProfilePoint> profile;
  for (uint32_t r = 0; r <= rings; ++r) {
    const float angle = glm::pi<float>() * (float(r) / float(rings) - 0.5f);
    const glm::vec2 n(r == 0 || r == rings ? 0.0f : std::cos(angle), std::sin(angle));
    profile.push_back({n, n});
  }
  return lathe("sphere", profile, segments, material, false);
}

Mesh torus(float major, float minor, uint32_t segments, uint32_t sides, MaterialIndex material) {
  std::vector<ProfilePoint> profile;
  for (uint32_t r = 0; r < sides; ++r) {
    const float angle = glm::two_pi<float>() * float(r) / float(sides);
    const glm::vec2 n(std::cos(angle), std::sin(angle));
    profile.push_back({glm::vec2(major, 0) + minor * n, n});
  }
  return lathe("ring", profile, segments, material, true);
}

// A hollow vase, whose wall is a closed solid, so that light enters it only through its mouth.
Mesh vase(uint32_t segments, uint32_t steps, MaterialIndex material) {
  constexpr float kHeightOfVase = 1.9f, kWall = 0.06f;
  const auto radius = [](float t) { return 0.42f + 0.20f * std::sin(5.2f * t + 0.3f) - 0.10f * t; };
  const auto slope = [](float t) {
    return (5.2f * 0.20f * std::cos(5.2f * t + 0.3f) - 0.10f) / kHeightOfVase;
  };
  std::vector<ProfilePoint> profile;
  profile.push_back({{0, 0}, {0, -1}});
  profile.push_back({{radius(0), 0}, {0, -1}});
  for (uint32_t i = 0; i <= steps; ++i) {
    const float t = float(i) / float(steps);
    profile.push_back({{radius(t), kHeightOfVase * t}, glm::normalize(glm::vec2(1, -slope(t)))});
  }
  profile.push_back({{radius(1) - 0.5f * kWall, kHeightOfVase + 0.5f * kWall}, {0, 1}});
  for (uint32_t i = 0; i <= steps; ++i) {
    const float t = 1.0f - float(i) / float(steps) * 0.96f;
    profile.push_back({{radius(t) - kWall, kHeightOfVase * t}, glm::normalize(glm::vec2(-1, slope(t)))});
  }
  profile.push_back({{0, kHeightOfVase * 0.04f}, {0, 1}});
  return lathe("vase", profile, segments, material, false);
}

void place(Scene& scene, const char* name, uint32_t mesh, glm::vec3 position, glm::quat rotation,
           glm::vec3 scale) {
  Node n;
  n.name = name;
  n.mesh = mesh;
  n.translation = position;
  n.rotation = rotation;
  n.scale = scale;
  scene.nodes.push_back(n);
}

constexpr float kClothWidth = 1.5f, kClothHeight = 2.75f;

// The cloth in the space of its rod. It sways as a whole, and two waves a quarter of a period apart run down
// it; both grow with the distance from the rod.
model::Sheet cloth(float sway, float wave, float phase) {
  return model::sheet(7, 8, {kClothWidth, kClothHeight}, [&](float u, float v) {
    const float folds = 0.06f * std::sin(3.0f * glm::two_pi<float>() * u + 1.5f * v);
    const float running = wave * v * std::sin(6.5f * v + 2.0f * u - phase);
    return glm::vec3(kClothWidth * (u - 0.5f) * (1.0f - 0.08f * v),
                     -kClothHeight * (v - 0.10f * sway * sway * v * v),
                     folds + sway * v * v * (0.8f + 0.4f * u) + running);
  });
}

void hangCloth(model::SceneBuilder& b) {
  const uint32_t violet =
      b.material("violet cloth", {0.52f, 0.24f, 0.66f}, model::MaterialOptions{.doubleSided = true});
  const glm::vec3 where(1.35f, 4.65f, -2.3f);
  const std::vector<model::Sheet> shapes = {cloth(0.38f, 0, 0), cloth(0.1f, 0.20f, 0),
                                            cloth(0.1f, 0.20f, glm::half_pi<float>())};
  const uint32_t node =
      b.place("cloth", b.mesh("cloth", model::cage(cloth(0.1f, 0, 0), 1, shapes), violet), where);
  b.swing(node,
          {{.amplitude = 0.9f, .period = 4},
           {.amplitude = 1, .period = 2},
           {.amplitude = 1, .period = 2, .phase = 0.25f}},
          8);
  model::MeshBuilder rod;
  const float end = 0.5f * kClothWidth + 0.1f;
  rod.add(kGrey, model::tube({{-end, 0, 0}, {end, 0, 0}}, 0.03f, 6));
  b.place("rod", b.mesh("rod", std::move(rod)), where);
}

}  // namespace

static Scene cornellBox() {
  Scene s;
  s.name = s.source = "cornellbox";
  s.materials = materials();
  s.meshes = {shell(), cube(kYellow), sphere(56, 28, kWhite), torus(0.62f, 0.24f, 40, 17, kBlue),
              vase(36, 8, kWhite)};
  const glm::quat upright(1, 0, 0, 0);
  const glm::vec3 up(0, 1, 0), one(1);
  place(s, "room", 0, glm::vec3(0), upright, one);
  place(s, "yellow cube", 1, {-0.75f, 0, -1.72f}, glm::angleAxis(glm::radians(14.0f), up), glm::vec3(1.6f));
  place(s, "sphere", 2, {1.45f, 0.75f, 0.55f}, upright, glm::vec3(0.75f));
  place(s, "ring", 3, {-0.95f, 0.24f, 0.95f}, upright, one);
  place(s, "vase", 4, {1.35f, 0, -1.45f}, upright, one);

  Light spot;
  spot.name = "ceiling spot";
  spot.type = LightType::Spot;
  spot.color = {1.0f, 0.95f, 0.86f};
  spot.intensity = 100.0f;
  spot.position = {0.0f, 5.45f, 0.25f};
  spot.direction = {0, -1, 0};
  spot.innerConeAngle = glm::radians(32.0f);
  spot.outerConeAngle = glm::radians(40.0f);
  s.lights.push_back(spot);

  // Far enough away that the opening frames a square picture from edge to edge.
  Camera camera;
  camera.name = "front";
  camera.position = {0, 0.5f * kHeight, 9.2f};
  camera.verticalFov = 2.0f * std::atan(0.985f * kHalf / (camera.position.z - kHalf));
  camera.zNear = 0.1f;
  s.cameras.push_back(camera);
  s.gaze.push_back({0.0f, {0.42f, 0.55f}, true});  // the cube and the wall it colours
  s.exposure = 1.25f;
  s.hash = contentHash(s);
  return s;
}

static Scene cornellBoxMoving() {
  model::SceneBuilder b("cornellbox_moving");
  b.scene = cornellBox();
  b.scene.name = b.scene.source = "cornellbox_moving";
  hangCloth(b);
  const glm::vec2 gaze = b.scene.gaze.front().position;
  b.scene.gaze.clear();
  return b.finish(b.scene.exposure, gaze);
}

FOVEA_SCENE("cornellbox", cornellBox);
FOVEA_SCENE("cornellbox_moving", cornellBoxMoving);

}  // namespace fovea::scene
