#include "framework/scene/floor.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fovea::scene {

void addFloor(Scene& scene, const Floor& floor) {
  constexpr uint32_t kCorners = 96;
  Primitive disc;
  disc.material = uint32_t(scene.materials.size());
  disc.positions.push_back({0, 0, 0});
  for (uint32_t i = 0; i < kCorners; ++i) {
    const float angle = glm::two_pi<float>() * float(i) / float(kCorners);
    disc.positions.push_back({std::cos(angle), 0, -std::sin(angle)});
    disc.indices.insert(disc.indices.end(), {0, 1 + i, 1 + (i + 1) % kCorners});
  }
  disc.normals.assign(disc.positions.size(), {0, 1, 0});
  disc.uvs.assign(disc.positions.size(), glm::vec2(0));

  Material& material = scene.materials.emplace_back();
  material.name = "floor";
  material.baseColor = glm::vec4(floor.color, 1);
  material.specular = 0;  // matte, as the ground of a sky that continues it
  Node& node = scene.nodes.emplace_back();
  node.name = "floor";
  node.translation = floor.position;
  node.scale = glm::vec3(floor.radius, 1, floor.radius);
  node.mesh = uint32_t(scene.meshes.size());
  scene.meshes.push_back({"floor", {std::move(disc)}});
}

void removeFloor(Scene& scene) {
  scene.nodes.pop_back();
  scene.meshes.pop_back();
  scene.materials.pop_back();
}

}  // namespace fovea::scene
