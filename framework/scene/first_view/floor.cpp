// Puts a floor under objects that would float in empty space.
#include <algorithm>
#include <cmath>

#include "framework/scene/first_view/first_view.h"
#include "framework/scene/floor.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::scene {
namespace {

constexpr uint32_t kSide = 32;  // of the picture, pixels
constexpr float kEmpty =
    0.5f;  // the share of it that surfaces have to fill without a floor, seen from inside
constexpr float kBelow =
    0.02f;  // the share of it that may show the ground without a floor, seen from outside
constexpr float kShadow = 1.2f;   // length of the shadow of the lowest assumed sun, relative to the height
constexpr float kFilled = 0.6f;   // and with one
constexpr float kMostRadius = 3;  // of the floor, relative to half of the scene's diagonal
constexpr float kGap =
    1e-4f;  // below the lowest point, relative to the diagonal, so that nothing lies in the floor

}  // namespace

std::string addFirstFloor(Scene& scene, const Geometry& geometry) {
  if (geometry.empty()) return {};
  const glm::vec3 size = geometry.boundsMax - geometry.boundsMin;
  Floor floor;
  floor.color = glm::vec3(kGroundReflectance);
  floor.position = 0.5f * (geometry.boundsMin + geometry.boundsMax);
  floor.position.y = geometry.boundsMin.y - kGap * glm::length(size);
  const auto rays = RayScene::cached(scene, geometry);
  const View view = makeView(scene.cameras.at(0), {kSide, kSide}, geometry);
  uint32_t surfaces = 0;
  std::vector<float>
      reaches;  // m; distances from the floor's centre at which rays through empty space hit its plane
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x) {
      const glm::vec3 direction = view.rayDirection(glm::vec2(x, y) + 0.5f);
      if (rays->intersect({view.eye, glm::normalize(direction), 0})) {
        ++surfaces;
        continue;
      }
      const float steps = (floor.position.y - view.eye.y) / direction.y;
      if (direction.y < 0 && steps > 0)
        reaches.push_back(glm::distance(view.eye + steps * direction, floor.position));
    }
  constexpr float kPixels = float(kSide * kSide);
  const bool outside = glm::any(glm::lessThan(view.eye, geometry.boundsMin)) ||
                       glm::any(glm::greaterThan(view.eye, geometry.boundsMax));
  const bool enough =
      outside ? float(reaches.size()) < kBelow * kPixels : float(surfaces) >= kEmpty * kPixels;
  if (enough || reaches.empty()) return {};
  std::ranges::sort(reaches);
  const size_t wanted = size_t(std::max(kFilled * kPixels - float(surfaces), 0.0f));
  const float most = kMostRadius * 0.5f * glm::length(size),
              least = std::min(0.5f * glm::length(glm::vec2(size.x, size.z)) + kShadow * size.y, most);
  floor.radius = std::clamp(reaches[std::min(wanted, reaches.size() - 1)], least, most);
  addFloor(scene, floor);
  return "a floor";
}

}  // namespace fovea::scene
