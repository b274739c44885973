// A wall and a nearer box as an eye sees them, for tests of passes that work on the surfaces of the picture.
#pragma once

#include <cmath>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "tests/passes/deferred_reference.h"
#include "tests/passes/ray_reference.h"
#include "tests/support/shapes.h"

namespace fovea::test {

constexpr glm::ivec2 kSize{48, 40};

// A mask of tiles of 16 x 16 pixels, of which the last row is cut.
constexpr glm::uvec2 kTiles{3, 3};
const std::vector<uint8_t> kSomeTiles{255, 0, 255, 0, 0, 255, 0, 255, 0};

// Sets the pixels outside of them to 0; each has `channels` numbers.
template <class T>
void clearOutside(std::vector<T>& image, size_t channels) {
  for (size_t i = 0; i < image.size(); ++i) {
    const size_t pixel = i / channels, x = pixel % kSize.x, y = pixel / kSize.x;
    if (kSomeTiles[y / 16 * kTiles.x + x / 16] == 0) image[i] = T(0);
  }
}

// What a camera at `position` sees: a wall and a nearer box.
struct Eye {
  scene::Scene scene;
  scene::Geometry geometry;
  scene::View view;
  GBuffer seen;

  explicit Eye(glm::vec3 position)
      : scene(model()), geometry(scene::flatten(scene)), view(viewAt(geometry, position)), seen(look()) {}

  static scene::Scene model() {
    scene::Scene s;
    const uint32_t m = addMaterial(s, glm::vec3(0.5f));
    addBox(s, m, {-9, -9, -6}, {9, 9, -5});
    addBox(s, m, {-0.6f, -0.7f, -4}, {0.5f, 0.6f, -3});
    scene::Mover mover;  // object 1
    mover.node = uint32_t(s.nodes.size() - 1);
    mover.keys.resize(1);
    s.nodes[mover.node].dynamic = true;
    s.movers.push_back(mover);
    return s;
  }
  static scene::View viewAt(const scene::Geometry& geometry, glm::vec3 position) {
    scene::Camera camera;
    camera.position = position;
    camera.verticalFov = 0.8f;
    return scene::makeView(camera, glm::uvec2(kSize), geometry);
  }
  GBuffer look() const {
    return {kSize.x, kSize.y, scene::pixelRays(view), [&](int x, int y) {
              SurfacePixel p;
              const glm::dvec3 ray = glm::normalize(glm::dvec3(view.rayDirection(glm::vec2(x, y) + 0.5f)));
              const RayHit hit = castRay(scene, geometry, glm::dvec3(view.eye), ray, {});
              if (!hit) return p;
              p.position = glm::vec3(glm::dvec3(view.eye) + hit.t * ray);
              p.distance = float(hit.t);
              p.normal = glm::vec3(faceNormal(geometry, hit.triangle));
              if (glm::dot(glm::dvec3(p.normal), ray) > 0) p.normal = -p.normal;
              return p;
            }};
  }
};

inline bool sameSurface(const SurfacePixel& a, const SurfacePixel& b) {
  return b.distance > 0 && std::abs(glm::dot(b.position - a.position, a.normal)) <= 0.005f * a.distance &&
         glm::dot(a.normal, b.normal) > 0.9f;
}

}  // namespace fovea::test
