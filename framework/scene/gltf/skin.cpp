// Builds skins: joints, inverse bind matrices, and the nodes whose meshes they bend.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "framework/scene/gltf/internal.h"
#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene::gltf {
namespace {

const std::string kUnskinned = "the mesh is shown unskinned";

// Returns a skin without joints if the scene does not show one of them.
Skin skinOf(const Context& c, size_t index) {
  const json::Value& from = itemsOf(&c.root, "skins")[index];
  const std::string name = textOr(&from, "name", ""), place = nameOf("skins", index, name);
  const std::vector<json::Value>& joints = itemsOf(&from, "joints");
  Skin skin;
  skin.name = name.empty() ? "skin " + std::to_string(index) : name;
  std::vector<float> inverseBind;
  if (const int accessor = indexIn(&from, "inverseBindMatrices"); accessor >= 0) {
    inverseBind = readFloats(c, accessor, 16, place + ".inverseBindMatrices");
    if (inverseBind.size() < 16 * joints.size())
      c.fail(place, std::to_string(joints.size()) + " joints, but only " +
                        std::to_string(inverseBind.size() / 16) + " inverse bind matrices");
    for (float v : inverseBind)
      if (!std::isfinite(v)) c.fail(place, "an inverse bind matrix is not finite");
  }
  for (size_t i = 0; i < joints.size(); ++i) {
    const uint32_t node = c.sceneNode[size_t(joints[i].integer)];
    if (node == kNoIndex) return {skin.name, {}, {}};
    skin.joints.push_back(node);
    skin.inverseBind.push_back(inverseBind.empty() ? glm::mat4(1.0f) : glm::make_mat4(&inverseBind[16 * i]));
  }
  return skin;
}

void checkJoints(const Context& c, const Mesh& mesh, size_t joints, const std::string& place) {
  const auto check = [&](const std::vector<glm::u16vec4>& list, size_t vertices) {
    for (size_t i = 0; i < list.size(); ++i)
      for (int k = 0; k < 4; ++k)
        if (list[i][k] >= joints)
          c.fail(place, "vertex " + std::to_string(i % vertices) + " follows joint " +
                            std::to_string(list[i][k]) + " of a skin with " + std::to_string(joints) +
                            " joints");
  };
  for (const Primitive& p : mesh.primitives) check(p.joints, p.positions.size());
  if (mesh.cage) check(mesh.cage->joints, mesh.cage->positions.size());
}

bool followsJoints(const Mesh& mesh) {
  return (mesh.cage && !mesh.cage->joints.empty()) ||
         std::ranges::any_of(mesh.primitives, [](const Primitive& p) { return !p.joints.empty(); });
}

}  // namespace

void buildSkins(Context& c) {
  const std::vector<json::Value>& skins = itemsOf(&c.root, "skins");
  std::vector<uint32_t> known(skins.size(), kNoIndex);  // index in the scene
  for (size_t i = 0; i < c.model.nodes.size(); ++i) {
    const json::Value& written = itemsOf(&c.root, "nodes")[i];
    const int from = indexIn(&written, "skin"), meshOf = indexIn(&written, "mesh");
    if (from < 0 || meshOf < 0 || c.sceneNode[i] == kNoIndex) continue;
    const std::string place = nameOf("nodes", i, c.model.nodes[i].name);
    uint32_t& index = known[size_t(from)];
    if (index == kNoIndex) {
      index = uint32_t(c.scene.skins.size());
      c.scene.skins.emplace_back();
      if (!c.attempt([&] { c.scene.skins.back() = skinOf(c, size_t(from)); }, kUnskinned)) continue;
    }
    const Mesh& mesh = c.scene.meshes[size_t(meshOf)];
    if (!followsJoints(mesh)) {
      c.warn(place, "it has a skin, but its mesh has no JOINTS_0 and WEIGHTS_0: " + kUnskinned);
      continue;
    }
    const size_t joints = c.scene.skins[index].joints.size();
    if (joints == 0) {
      c.warn(place, "its skin has no joints in the scene; " + kUnskinned);
      continue;
    }
    if (c.attempt([&] { checkJoints(c, mesh, joints, place); }, kUnskinned))
      c.scene.nodes[c.sceneNode[i]].skin = index;
  }
}

}  // namespace fovea::scene::gltf
