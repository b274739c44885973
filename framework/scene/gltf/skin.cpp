// Builds skins: joints, inverse bind matrices, and the nodes whose meshes they bend.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "framework/scene/gltf/internal.h"
#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene::gltf {
namespace {

// Returns a skin without joints if the scene does not show one of them.
Skin skinOf(const Context& c, size_t index) {
  const tinygltf::Skin& from = c.model.skins[index];
  const std::string place = nameOf("skins", index, from.name);
  Skin skin;
  skin.name = from.name.empty() ? "skin " + std::to_string(index) : from.name;
  std::vector<float> inverseBind;
  if (from.inverseBindMatrices >= 0) {
    inverseBind = readFloats(c, from.inverseBindMatrices, 16, place + ".inverseBindMatrices");
    if (inverseBind.size() < 16 * from.joints.size())
      c.fail(place, std::to_string(from.joints.size()) + " joints, but only " +
                        std::to_string(inverseBind.size() / 16) + " inverse bind matrices");
    for (float v : inverseBind)
      if (!std::isfinite(v)) c.fail(place, "an inverse bind matrix is not finite");
  }
  for (size_t i = 0; i < from.joints.size(); ++i) {
    const uint32_t node = c.sceneNode[size_t(from.joints[i])];
    if (node == kNoIndex) return {skin.name, {}, {}};
    skin.joints.push_back(node);
    skin.inverseBind.push_back(inverseBind.empty() ? glm::mat4(1.0f) : glm::make_mat4(&inverseBind[16 * i]));
  }
  return skin;
}

void checkJoints(const Context& c, const Mesh& mesh, size_t joints, const std::string& place) {
  const auto check = [&](const std::vector<glm::u16vec4>& list) {
    for (size_t i = 0; i < list.size(); ++i)
      for (int k = 0; k < 4; ++k)
        if (list[i][k] >= joints)
          c.fail(place, "vertex " + std::to_string(i) + " follows joint " + std::to_string(list[i][k]) +
                            " of a skin with " + std::to_string(joints) + " joints");
  };
  for (const Primitive& p : mesh.primitives) check(p.joints);
  if (mesh.cage) check(mesh.cage->joints);
}

}  // namespace

void buildSkins(Context& c) {
  std::vector<uint32_t> known(c.model.skins.size(), kNoIndex);  // index in the scene
  for (size_t i = 0; i < c.model.nodes.size(); ++i) {
    const tinygltf::Node& from = c.model.nodes[i];
    if (from.skin < 0 || from.mesh < 0 || c.sceneNode[i] == kNoIndex) continue;
    const std::string place = nameOf("nodes", i, from.name);
    uint32_t& index = known[size_t(from.skin)];
    if (index == kNoIndex) {
      index = uint32_t(c.scene.skins.size());
      c.scene.skins.push_back(skinOf(c, size_t(from.skin)));
    }
    const size_t joints = c.scene.skins[index].joints.size();
    if (joints == 0) {
      c.warn(place, "its skin has no joints in the scene; the mesh is shown unskinned");
      continue;
    }
    checkJoints(c, c.scene.meshes[size_t(from.mesh)], joints, place);
    c.scene.nodes[c.sceneNode[i]].skin = index;
  }
}

}  // namespace fovea::scene::gltf
