// Skinned meshes as their joints hold them at rest. Their own node's transform does not count
// (glTF 2.0, 3.7.3.3).
#include <tiny_gltf.h>

#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "framework/scene/gltf_internal.h"

namespace fovea::scene::gltf {
namespace {

// World transform of each joint times its inverse bind matrix; empty when the scene does not show a joint.
std::vector<glm::mat4> jointMatrices(const Context& c, size_t index, const std::vector<glm::mat4>& world) {
  const tinygltf::Skin& skin = c.model.skins[index];
  const std::string place = nameOf("skins", index, skin.name);
  std::vector<float> inverseBind;
  if (skin.inverseBindMatrices >= 0) {
    inverseBind = readFloats(c, skin.inverseBindMatrices, 16, place + ".inverseBindMatrices");
    if (inverseBind.size() < 16 * skin.joints.size())
      c.fail(place, std::to_string(skin.joints.size()) + " joints, but only " +
                        std::to_string(inverseBind.size() / 16) + " inverse bind matrices");
  }
  std::vector<glm::mat4> matrices;
  for (size_t i = 0; i < skin.joints.size(); ++i) {
    const uint32_t node = c.sceneNode[size_t(skin.joints[i])];
    if (node == kNoIndex) return {};
    matrices.push_back(inverseBind.empty() ? world[node]
                                           : world[node] * glm::make_mat4(&inverseBind[16 * i]));
  }
  return matrices;
}

void bend(const Context& c, Primitive& p, const std::vector<VertexSkin>& skin,
          const std::vector<glm::mat4>& joints, const std::string& place) {
  for (size_t i = 0; i < p.positions.size(); ++i) {
    glm::mat4 m(0.0f);
    for (int k = 0; k < 4; ++k) {
      if (skin[i].weights[k] == 0.0f) continue;
      if (skin[i].joints[k] >= joints.size())
        c.fail(place, "vertex " + std::to_string(i) + " follows joint " + std::to_string(skin[i].joints[k]) +
                          " of a skin with " + std::to_string(joints.size()) + " joints");
      m += skin[i].weights[k] * joints[skin[i].joints[k]];
    }
    p.positions[i] = glm::vec3(m * glm::vec4(p.positions[i], 1.0f));
    const glm::mat3 a(m);
    const glm::mat3 cofactor(glm::cross(a[1], a[2]), glm::cross(a[2], a[0]), glm::cross(a[0], a[1]));
    const glm::vec3 n = cofactor * p.normals[i];
    const float length = glm::length(n);
    if (length > 0.0f && std::isfinite(length)) p.normals[i] = n / length;
    if (!std::isfinite(p.positions[i].x + p.positions[i].y + p.positions[i].z))
      c.fail(place, "vertex " + std::to_string(i) + " is moved by its joints to a place that is not finite");
  }
}

}  // namespace

void applySkins(Context& c) {
  const std::vector<glm::mat4> world = worldTransforms(c.scene);
  for (size_t i = 0; i < c.model.nodes.size(); ++i) {
    const tinygltf::Node& from = c.model.nodes[i];
    if (from.skin < 0 || from.mesh < 0 || c.sceneNode[i] == kNoIndex) continue;
    const std::string place = nameOf("nodes", i, from.name);
    const std::vector<glm::mat4> joints = jointMatrices(c, size_t(from.skin), world);
    const auto& skins = c.skins[size_t(from.mesh)];
    if (joints.empty()) {
      c.warn(place, "its skin has no joints in the scene; the mesh is shown unskinned");
      continue;
    }
    Mesh mesh = c.scene.meshes[size_t(from.mesh)];
    for (size_t p = 0; p < mesh.primitives.size(); ++p) {
      c.vertices += mesh.primitives[p].positions.size();
      if (c.vertices > kMaxVertices)
        c.fail(place, "skinned copies bring the meshes past " + std::to_string(kMaxVertices) + " vertices");
      if (!skins[p].empty()) bend(c, mesh.primitives[p], skins[p], joints, place);
    }
    c.scene.nodes[c.sceneNode[i]].mesh = kNoIndex;
    Node shown;
    shown.name = c.scene.nodes[c.sceneNode[i]].name;
    shown.mesh = uint32_t(c.scene.meshes.size());
    c.scene.meshes.push_back(std::move(mesh));
    c.scene.nodes.push_back(shown);
  }
}

}  // namespace fovea::scene::gltf
