// A scene with everything that rays may hit or be aimed at: emissive lamps, a point light, an environment map, metal
// and glass.
#pragma once

#include <memory>
#include <vector>

#include "framework/scene/environment/environment_map.h"
#include "tests/passes/ray_reference.h"
#include "tests/support/shapes.h"

namespace fovea::test {

// A camera at the origin looks along -z, at a wall and a box before it; the rest stands behind the camera. glass:
// whether a pane there is transparent; if not, nothing is.
inline scene::Scene sceneOfEverything(bool glass = true) {
  scene::Scene s;
  s.cameras.emplace_back();
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), metal = addMaterial(s, glm::vec3(0.9f, 0.6f, 0.3f)),
                 lamp = addMaterial(s, glm::vec3(0.2f)), pane = addMaterial(s, glm::vec3(0.8f, 0.9f, 1));
  s.materials[metal].metallic = 1;
  s.materials[metal].roughness = 0.3f;
  s.materials[lamp].emission = {6, 5, 3};
  s.materials[pane].transmission = glass ? 0.9f : 0.0f;
  s.materials[pane].doubleSided = true;
  addBox(s, grey, {-9, -9, -6}, {9, 9, -5});
  addBox(s, grey, {-2, -2, -4.8f}, {-0.5f, 1, -4});
  addBox(s, grey, {-4, -4, 3}, {4, 4, 4});
  addBox(s, metal, {-1.6f, -1.1f, 1}, {0.9f, 1.3f, 2});
  for (int i = 0; i < 3; ++i)
    addBox(s, lamp, {-2.0f + 1.5f * float(i), 2, 0}, {-1.7f + 1.5f * float(i), 2.3f, 0.3f});
  addBox(s, pane, {1, -1, -1}, {2, 1, -0.9f});
  std::vector<glm::vec3> texels(32 * 16);
  for (size_t i = 0; i < texels.size(); ++i) texels[i] = glm::vec3(float(i % 7), 2, float(i / 64)) * 0.1f;
  s.environmentMap = std::make_shared<const scene::EnvironmentMap>(32, 16, texels, 0.4f);
  s.lights.push_back(pointLight({1.5f, 2, -3}, {30, 20, 10}));
  return s;
}

}  // namespace fovea::test
