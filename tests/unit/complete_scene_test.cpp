// Scenes that a program has put together: scene::complete() of the facade.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>

#include "fovea/scene.h"

namespace fovea::scene {
namespace {

using testing::HasSubstr;

Scene triangle() {
  Scene scene;
  scene.name = "triangle";
  scene.materials.resize(1);
  scene.cameras.resize(1);
  Primitive p;
  p.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
  p.indices = {0, 1, 2};
  scene.meshes = {{"triangle", {p}}};
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  return scene;
}

std::string mistakeOf(Scene scene) {
  try {
    complete(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(CompleteScene, FillsInWhatIsLacking) {
  Scene scene = triangle();
  complete(scene);
  const Primitive& p = scene.meshes[0].primitives[0];
  EXPECT_THAT(p.normals, testing::Each(glm::vec3(0, 0, 1)));
  EXPECT_EQ(p.uvs.size(), 3u);
  EXPECT_NE(scene.hash, 0u);
  Scene other = triangle();
  other.materials[0].baseColor.x = 0.5f;
  complete(other);
  EXPECT_NE(other.hash, scene.hash);
}

TEST(CompleteScene, NamesEveryMistake) {
  Scene scene = triangle();
  scene.meshes[0].primitives[0].material = 4;
  scene.nodes[0].mesh = 2;
  const std::string found = mistakeOf(scene);
  EXPECT_THAT(found, HasSubstr("material 4 of 1 is not there (at meshes[0].primitives[0].material)"));
  EXPECT_THAT(found, HasSubstr("mesh 2 of 1 is not there (at nodes[0].mesh)"));
  scene = triangle();
  scene.meshes[0].primitives[0].indices[1] = 3;
  EXPECT_THAT(mistakeOf(scene), HasSubstr("vertex 3 of 3 is not there"));
  scene = triangle();
  scene.meshes[0].primitives[0].positions[0].x = std::numeric_limits<float>::infinity();
  EXPECT_THAT(mistakeOf(scene), HasSubstr("not finite"));
  scene = triangle();
  scene.cameras.clear();
  EXPECT_THAT(mistakeOf(scene), HasSubstr("camera"));
}

TEST(LookAt, LooksAtItsTarget) {
  const Camera camera = lookAt({1, 2, 3}, {4, 2, 3});
  EXPECT_LT(glm::length(camera.orientation * glm::vec3(0, 0, -1) - glm::vec3(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::length(camera.orientation * glm::vec3(0, 1, 0) - glm::vec3(0, 1, 0)), 1e-6f);
}

}  // namespace
}  // namespace fovea::scene
