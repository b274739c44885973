#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "fovea/scene.h"
#include "fovea/test.h"
#include "framework/scene/frame.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "tests/passes/ray_reference.h"
#include "tests/references/octahedral.h"
#include "tests/support/pixel_rays.h"
#include "tests/support/raster_grid.h"
#include "tests/support/sky.h"

namespace fovea::test {
namespace {

constexpr uint32_t kBackground = ~0u;

double snap() { return std::max(0.01, double(rasterGrid())); }  // pixels
float hair() { return std::max(1.0f / 64, rasterGrid()); }      // a hair off an edge, pixels
double mostAtEdges(double share) { return share * 64 * hair(); }

struct Pixel {
  glm::vec4 position;
  glm::vec3 normal, face, albedo, emission;
  uint32_t id;
};

class Output {
 public:
  explicit Output(const PassTest& test)
      : surfaces_(surfacesOf(test, "gbuffer", int(test.desc("gbuffer.distance").width))),
        normal_(test.floats("gbuffer.normal")),
        face_(test.floats("gbuffer.face")),
        albedo_(test.floats("gbuffer.albedo")),
        emission_(test.floats("gbuffer.emission")),
        id_(test.values<uint32_t>("gbuffer.id")) {}
  Pixel at(size_t i) const {
    auto vec = [i](const std::vector<float>& v) {
      return glm::vec4(v[4 * i], v[4 * i + 1], v[4 * i + 2], v[4 * i + 3]);
    };
    return {surfaces_[i],
            glm::vec3(vec(normal_)),
            scene::octDecode({face_[2 * i], face_[2 * i + 1]}),
            glm::vec3(vec(albedo_)),
            glm::vec3(vec(emission_)),
            id_[i]};
  }

 private:
  std::vector<glm::vec4> surfaces_;
  std::vector<float> normal_, face_, albedo_, emission_;
  std::vector<uint32_t> id_;
};

// Compares every pixel with the ray through its centre. A pixel may see something else only if a ray a hair
// beside it sees it too. Returns the share of such pixels.
class Comparison {
 public:
  Comparison(const PassTest& test, const scene::Scene& scene, bool cull)
      : scene_(scene), geometry_(test.geometry()), view_(test.lastFrame().views[0]), output_(test) {
    options_.cullSingleSided = cull;
    options_.tMin = 1e-9;
  }

  double run() {
    size_t excused = 0;
    const glm::uvec2 size = view_.size;
    for (uint32_t y = 0; y < size.y; ++y)
      for (uint32_t x = 0; x < size.x; ++x) {
        const Pixel pixel = output_.at(size_t(y) * size.x + x);
        const glm::vec2 centre(x + 0.5f, y + 0.5f);
        if (explain(pixel, centre, snap()).empty()) continue;
        bool near = false;
        for (float r = 1.0f / 64; r <= hair(); r *= 2)
          for (const glm::vec2 d :
               {glm::vec2(1, 1), {-1, 1}, {1, -1}, {-1, -1}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}})
            near |= explain(pixel, centre + d * r, 1.5 * r + snap()).empty();
        excused += near;
        if (near) continue;
        ADD_FAILURE() << "pixel " << x << ", " << y << ": " << explain(pixel, centre, snap());
        if (++failures_ > 5) return 1;
      }
    return double(excused) / (size.x * size.y);
  }

  size_t hits() const { return hits_; }

 private:
  // Describes what differs from the ray through p, which may be off by `slack` pixels; "" if nothing does.
  std::string explain(const Pixel& pixel, glm::vec2 p, double slack) {
    const glm::dvec3 eye(view_.eye), ray(view_.rayDirection(p));
    const RayHit hit = castRay(scene_, geometry_, eye, ray, options_);
    if (!hit) {
      if (pixel.id != kBackground)
        return "id " + std::to_string(pixel.id) + " where there is only background";
      if (pixel.position.w != 0) return "background with a distance";
      return explainBackground(pixel.emission, glm::normalize(glm::vec3(ray)));
    }
    ++hits_;
    const scene::Triangle& triangle = geometry_.triangles[hit.triangle];
    if (pixel.id != triangle.materialAndObject) return "id " + std::to_string(pixel.id);
    return explainPosition(pixel, hit, eye, ray, slack) + explainSurface(pixel, hit, ray);
  }

  // The device's arc functions turn directions by some 1e-4 radians, which counts where the map changes quickly.
  std::string explainBackground(glm::vec3 got, glm::vec3 direction) const {
    const scene::EnvironmentMap* map = scene_.environmentMap.get();
    const glm::vec3 want = map ? map->radiance(direction) : scene_.environment;
    float slack = 1e-3f * (1 + glm::length(want));
    for (const glm::vec3 turn : {glm::vec3(3e-4f, 0, 0), {0, 3e-4f, 0}, {0, 0, 3e-4f}})
      for (const float side : {-1.0f, 1.0f})
        if (map)
          slack =
              std::max(slack, glm::distance(want, map->radiance(glm::normalize(direction + side * turn))));
    return glm::distance(got, want) <= slack ? "" : "wrong environment";
  }

  std::string explainPosition(const Pixel& pixel, const RayHit& hit, glm::dvec3 eye, glm::dvec3 ray,
                              double slack) const {
    const glm::dvec3 want = eye + hit.t * ray, got(pixel.position);
    const double distance = glm::length(want - eye);
    const glm::dvec3 face = faceNormal(geometry_, hit.triangle);
    if (std::abs(glm::dot(got - want, face)) > 2e-6 * (distance + glm::length(eye)))
      return "off the surface by " + std::to_string(std::abs(glm::dot(got - want, face))) + " m ";
    const double cosine = std::abs(glm::dot(face, ray)) / glm::length(ray);
    const double pixelSize = distance * 2 * std::tan(0.5 * view_.verticalFov) / view_.size.y;
    if (glm::length(got - want) > slack * pixelSize / std::max(cosine, 1e-3) + 1e-5 * distance)
      return "position off by " + std::to_string(glm::length(got - want)) + " m ";
    if (std::abs(pixel.position.w - glm::length(got - eye)) > 1e-5 * distance) return "wrong distance ";
    return "";
  }

  std::string explainSurface(const Pixel& pixel, const RayHit& hit, glm::dvec3 ray) const {
    glm::dvec3 face = faceNormal(geometry_, hit.triangle);
    if (glm::dot(face, ray) > 0) face = -face;
    glm::dvec3 normal(glm::normalize(interpolate(geometry_, geometry_.normals, hit)));
    if (glm::dot(normal, face) < 0) normal = -normal;
    const scene::Material& material = scene_.materials[geometry_.triangles[hit.triangle].material()];
    const glm::vec2 uv = interpolate(geometry_, geometry_.uvs, hit);
    const glm::vec3 albedo(scene::reflectance(scene_, material, uv));
    const glm::vec3 emission = scene::emission(scene_, material, uv);
    if (glm::length(glm::dvec3(pixel.face) - face) > 1e-4) return "wrong face ";
    if (glm::length(glm::dvec3(pixel.normal) - normal) > 6e-3) return "wrong normal ";
    if (glm::length(pixel.albedo - albedo) > 4e-3f) return "wrong albedo ";
    if (glm::length(pixel.emission - emission) > 1e-3f * (1 + glm::length(emission)))
      return "wrong emission ";
    return "";
  }

  const scene::Scene& scene_;
  const scene::Geometry& geometry_;
  const scene::View& view_;
  Output output_;
  RayOptions options_;
  size_t hits_ = 0;
  int failures_ = 0;
};

TEST(GBuffer, EqualsRaysThroughPixelCentres) {
  const scene::Scene scene = scene::builtin("cornellbox");
  PassTest test("gbuffer");
  test.viewSize(48, 48).scene(scene);
  test.run();
  Comparison comparison(test, scene, true);
  EXPECT_LT(comparison.run(), mostAtEdges(0.01));
  EXPECT_GT(comparison.hits(), 48u * 48u / 2);
}

// A masked quad in front of a wall, one quad seen from behind for each kind of material, a glowing quad, and a tilted
// one far away.
scene::Scene materials() {
  scene::Scene s;
  s.name = "materials";
  s.environment = {0.25f, 0.5f, 2};
  s.textures.push_back(checkerTexture());
  scene::TextureUse checker;
  checker.texture = 0;
  scene::Material masked, single, both, glowing, tiled;
  masked.baseColorTexture = checker;
  masked.masked = masked.doubleSided = true;
  masked.metallic = 0.25f;
  single.baseColor = {0.5f, 0.25f, 0.125f, 1};
  both.baseColor = {0.2f, 0.3f, 0.4f, 1};
  both.doubleSided = true;
  glowing.emission = {3, 2, 1};
  tiled.baseColorTexture = checker;  // opaque, so its alpha is ignored
  tiled.baseColorTexture.transform = {3, 0.5f, -0.5f, 2, 0.1f, 0.2f};
  tiled.baseColorTexture.wrapV = scene::Wrap::Mirror;
  s.materials = {masked, single, both, glowing, tiled};
  addQuad(s, 0, {-2, -1, 1}, {-0.1f, -1, 1}, {-0.1f, 1, 1}, {-2, 1, 1});
  addQuad(s, 4, {-2.5f, -1.5f, 0}, {2.5f, -1.5f, -1}, {2.5f, 1.5f, -1}, {-2.5f, 1.5f, 0});
  addQuad(s, 1, {0.2f, 0, 1}, {0.2f, 1, 1}, {1, 1, 1}, {1, 0, 1});            // its back is not seen
  addQuad(s, 2, {0.2f, -1, 1}, {0.2f, -0.2f, 1}, {1, -0.2f, 1}, {1, -1, 1});  // its back is seen
  addQuad(s, 3, {1.2f, -1, 1}, {2, -1, 1.2f}, {2, 1, 1}, {1.2f, 1, 0.9f});
  scene::Camera camera;
  camera.position = {0.1f, 0.05f, 4};
  camera.verticalFov = 1;
  s.cameras.push_back(camera);
  return s;
}

TEST(GBuffer, MaterialsAsGltfSays) {
  const scene::Scene scene = materials();
  for (const bool cull : {true, false}) {
    PassTest test("gbuffer");
    test.param("cull", cull ? "auto" : "none").viewSize(96, 64).scene(scene);
    test.run();
    Comparison comparison(test, scene, cull);
    EXPECT_LT(comparison.run(), mostAtEdges(0.02)) << "cull " << cull;
  }
}

TEST(GBuffer, AnEnvironmentMapFillsTheBackground) {
  scene::Scene scene = materials();
  scene.environmentMap = skyWithSun();
  PassTest test("gbuffer");
  test.viewSize(96, 64).scene(scene);
  test.run();
  EXPECT_LT(Comparison(test, scene, true).run(), 0.02);
}

// An off-axis projection, as for the eyes of a head-mounted display.
TEST(GBuffer, ThroughALens) {
  const scene::Scene scene = materials();
  for (const bool left : {true, false}) {
    PassTest test("gbuffer");
    test.viewSize(96, 80).scene(scene);
    test.beforeFrame([&](PassTest&, scene::Frame& frame) {
      const scene::Lens lens{0.8f, 0.5f, 0.5f, 0.6f};
      frame.views[0] = scene::makeView(scene.cameras[0], frame.views[0].size, *frame.geometry,
                                       glm::vec2(0.5f), scene::frustumOf(lens, left));
    });
    test.run();
    Comparison comparison(test, scene, true);
    EXPECT_LT(comparison.run(), mostAtEdges(0.02)) << "left " << left;
    EXPECT_GT(comparison.hits(), 1000u);
  }
}

// A long floor that passes under the camera: a triangle clipped at the near plane, seen at a grazing angle
// to the horizon.
TEST(GBuffer, ExactOnLargeTrianglesThroughTheNearPlane) {
  scene::Scene s;
  s.materials.emplace_back();
  addQuad(s, 0, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50});
  scene::Camera camera;
  camera.position = {3, 0.2f, 7};
  camera.zNear = 0.01f;
  s.cameras.push_back(camera);
  PassTest test("gbuffer");
  test.viewSize(64, 64).scene(s);
  test.run();
  Comparison comparison(test, s, true);
  EXPECT_LT(comparison.run(), mostAtEdges(0.02));
}

// Textures of odd sizes, repeated and mirrored dozens of times on either side of 0, for the remainders
// of texel numbers.
TEST(GBuffer, TexturesWrapFarFromTheirOrigin) {
  scene::Scene s;
  scene::Texture noise;
  noise.width = 5;
  noise.height = 3;
  for (uint32_t i = 0; i < 4 * noise.width * noise.height; ++i) noise.rgba.push_back(uint8_t(i * 151 + 37));
  s.textures.push_back(noise);
  const scene::Wrap wraps[] = {scene::Wrap::Repeat, scene::Wrap::Mirror, scene::Wrap::Clamp};
  for (uint32_t k = 0; k < 3; ++k) {
    scene::Material m;
    m.baseColorTexture.texture = 0;
    m.baseColorTexture.wrapU = wraps[k];
    m.baseColorTexture.wrapV = wraps[(k + 1) % 3];
    m.baseColorTexture.transform = {24, 0, 0, 31, -11.3f, -14.7f};
    s.materials.push_back(m);
    const float x = float(k) - 1.5f;
    addQuad(s, k, {x, -1, 0}, {x + 1, -1, 0}, {x + 1, 1, 0}, {x, 1, 0});
  }
  scene::Camera camera;
  camera.position = {0.02f, 0.03f, 3};
  s.cameras.push_back(camera);
  PassTest test("gbuffer");
  test.viewSize(96, 72).scene(s);
  test.run();
  Comparison comparison(test, s, true);
  EXPECT_LT(comparison.run(), mostAtEdges(0.02));
}

// The values must match to the precision of the half floats that hold them, also in the dark.
TEST(GBuffer, CodesOfColoursBecomeLinearLight) {
  scene::Scene s;
  scene::Texture codes;
  codes.width = 256;
  codes.height = 1;
  for (uint32_t i = 0; i < 256; ++i)
    codes.rgba.insert(codes.rgba.end(), {uint8_t(i), uint8_t(255 - i), uint8_t(i / 2), 255});
  s.textures.push_back(codes);
  scene::Material m;
  m.baseColorTexture.texture = 0;
  s.materials.push_back(m);
  addQuad(s, 0, {-1, -0.1f, 0}, {1, -0.1f, 0}, {1, 0.1f, 0}, {-1, 0.1f, 0});
  scene::Camera camera;
  camera.position = {0, 0, 2};
  camera.verticalFov = 0.0078f;  // 8 pixels of 1024: the quad fills the width
  s.cameras.push_back(camera);
  PassTest test("gbuffer");
  test.viewSize(1024, 8).scene(s);
  test.run();
  const std::vector<glm::vec4> surfaces = surfacesOf(test, "gbuffer", 1024);
  const std::vector<float> albedo = test.floats("gbuffer.albedo");
  size_t seen = 0;
  for (size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].w == 0) continue;
    ++seen;
    const glm::vec4 want = scene::reflectance(s, m, {0.5f + 0.5f * surfaces[i].x, 0.5f});
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(albedo[4 * i + c], want[c], 1e-3f * want[c] + 2e-6f) << "pixel " << i;
  }
  EXPECT_GT(seen, 8u * 1000);
}

}  // namespace
}  // namespace fovea::test
