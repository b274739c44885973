// Builds the node tree of the scene that is shown, with its meshes, cameras and lights.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "framework/scene/gltf/internal.h"
#include "framework/scene/motion/deform.h"

namespace fovea::scene::gltf {
namespace {

// The rotation of a world transform, that is, the directions of its -Z and +Y, without scale and shear.
glm::quat orientationOf(const glm::mat4& m) {
  glm::vec3 back(m[2]), up(m[1]);
  if (glm::length(back) <= 0.0f) back = {0, 0, 1};
  back = glm::normalize(back);
  up -= glm::dot(up, back) * back;
  if (glm::length(up) <= 1e-12f) up = std::abs(back.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  up = glm::normalize(up - glm::dot(up, back) * back);
  return glm::normalize(glm::quat_cast(glm::mat3(glm::cross(up, back), up, back)));
}

class NodeBuilder {
 public:
  explicit NodeBuilder(Context& c) : c_(c), nodeOf_(c.sceneNode), cameras_(readCameras(c)) {
    nodeOf_.assign(c.model.nodes.size(), kNoIndex);
  }

  void run() {
    // Visits parents before children, with an explicit stack because trees may be as deep as the file is long.
    std::vector<std::pair<int, uint32_t>> stack;
    const std::vector<int> roots = rootNodes();
    for (auto r = roots.rbegin(); r != roots.rend(); ++r) stack.push_back({*r, kNoIndex});
    while (!stack.empty()) {
      const auto [from, parent] = stack.back();
      stack.pop_back();
      const uint32_t index = add(size_t(from), parent);
      const std::vector<int>& children = c_.model.nodes[size_t(from)].children;
      for (auto child = children.rbegin(); child != children.rend(); ++child)
        stack.push_back({*child, index});
    }
    world_ = worldTransforms(c_.scene);
    for (size_t i = 0; i < nodeOf_.size(); ++i)
      if (nodeOf_[i] != kNoIndex) attach(i);
    warnOfOrthographic(c_);
  }

 private:
  std::vector<int> parents() const {
    std::vector<int> parent(c_.model.nodes.size(), -1);
    for (size_t i = 0; i < c_.model.nodes.size(); ++i)
      for (int child : c_.model.nodes[i].children) parent[size_t(child)] = int(i);
    return parent;
  }

  // The default scene's nodes, else the first scene's, else every node without a parent.
  std::vector<int> rootNodes() const {
    const std::vector<int> parent = parents();
    std::vector<int> roots;
    if (c_.model.scenes.empty()) {
      for (size_t i = 0; i < parent.size(); ++i)
        if (parent[i] < 0) roots.push_back(int(i));
      return roots;
    }
    const tinygltf::Scene& scene = c_.model.scenes[size_t(std::max(c_.model.defaultScene, 0))];
    std::vector<bool> listed(parent.size());
    for (int n : scene.nodes) {
      if (listed[size_t(n)]) continue;
      listed[size_t(n)] = true;
      roots.push_back(n);
    }
    // Some exporters also list children, which are visited with their parents.
    const auto underListed = [&](int n) {
      for (int p = parent[size_t(n)]; p >= 0; p = parent[size_t(p)])
        if (listed[size_t(p)]) return true;
      return false;
    };
    const size_t before = roots.size();
    roots.erase(std::remove_if(roots.begin(), roots.end(), underListed), roots.end());
    if (roots.size() != before)
      c_.warn("scenes",
              "the scene lists nodes that are children of others; they are shown once, with their parents");
    return roots;
  }

  uint32_t add(size_t from, uint32_t parent) {
    const tinygltf::Node& n = c_.model.nodes[from];
    Node node;
    node.name = n.name.empty() ? "node " + std::to_string(from) : n.name;
    node.parent = parent;
    glm::dmat4 exact(1.0);
    if (n.matrix.size() == 16) {
      for (int i = 0; i < 16; ++i) exact[i / 4][i % 4] = n.matrix[size_t(i)];
      node.matrix = glm::mat4(exact);
    } else {
      if (n.translation.size() == 3)
        node.translation = {n.translation[0], n.translation[1], n.translation[2]};
      if (n.scale.size() == 3) node.scale = {n.scale[0], n.scale[1], n.scale[2]};
      if (n.rotation.size() == 4) node.rotation = rotationOf(n, from);
      exact = exactTransform(n, node);
    }
    const glm::mat4 local = localTransform(node);
    for (int i = 0; i < 16; ++i)
      if (!std::isfinite(local[i / 4][i % 4]))
        c_.fail(nameOf("nodes", from, n.name), "its transform is not finite in single precision");
    if (n.mesh >= 0) node.mesh = uint32_t(n.mesh);
    if (n.mesh >= 0 && !n.weights.empty()) readWeights(n, from, node);
    const uint32_t index = uint32_t(c_.scene.nodes.size());
    c_.scene.nodes.push_back(node);
    c_.local.push_back(exact);
    nodeOf_[from] = index;
    return index;
  }

  // Of translation, rotation and scale. `node` says whether the rotation is usable.
  static glm::dmat4 exactTransform(const tinygltf::Node& n, const Node& node) {
    glm::dmat4 m(1.0);
    if (n.rotation.size() == 4 && node.rotation != glm::quat(1, 0, 0, 0))
      m = glm::mat4_cast(
          glm::normalize(glm::dquat(n.rotation[3], n.rotation[0], n.rotation[1], n.rotation[2])));
    for (int axis = 0; axis < 3; ++axis) {
      if (n.scale.size() == 3) m[axis] *= n.scale[size_t(axis)];
      if (n.translation.size() == 3) m[3][axis] = n.translation[size_t(axis)];
    }
    return m;
  }

  void readWeights(const tinygltf::Node& n, size_t from, Node& node) const {
    const Mesh& mesh = c_.scene.meshes[node.mesh];
    const size_t targets = morphTargets(mesh);
    if (n.weights.size() != targets && (mesh.cage || !mesh.primitives.empty()))
      return c_.warn(nameOf("nodes", from, n.name) + ".weights",
                     std::to_string(n.weights.size()) + " weights for " + std::to_string(targets) +
                         " morph targets: they are ignored");
    for (double w : n.weights) node.weights.push_back(float(w));
  }

  glm::quat rotationOf(const tinygltf::Node& n, size_t from) const {
    const glm::quat q(float(n.rotation[3]), float(n.rotation[0]), float(n.rotation[1]), float(n.rotation[2]));
    const float length = glm::length(q);
    if (length > 1e-6f && std::isfinite(length)) {
      if (std::abs(length - 1.0f) > 0.01f)
        c_.warn(nameOf("nodes", from, n.name), "its rotation is not a unit quaternion and is normalised");
      return q / length;
    }
    c_.warn(nameOf("nodes", from, n.name), "its rotation is not a unit quaternion and is ignored");
    return glm::quat(1, 0, 0, 0);
  }

  void attach(size_t from) {
    Node& node = c_.scene.nodes[nodeOf_[from]];
    const glm::mat4& world = world_[nodeOf_[from]];
    const json::Value& written = itemsOf(&c_.root, "nodes")[from];
    if (const int index = indexIn(&written, "camera"); index >= 0) node.camera = camera(size_t(index), world);
    const int light = indexIn(extensionOf(&written, kLights), "light");
    if (light < 0) return;
    node.light = uint32_t(c_.scene.lights.size());
    c_.scene.lights.push_back(lightAt(size_t(light), world));
  }

  uint32_t camera(size_t index, const glm::mat4& world) {
    if (isOrthographic(c_.root.find("cameras")->items[index])) return kNoIndex;
    Camera& camera = c_.scene.cameras.emplace_back(cameras_[index]);
    camera.position = glm::vec3(world[3]);
    camera.orientation = orientationOf(world);
    return uint32_t(c_.scene.cameras.size() - 1);
  }

  Light lightAt(size_t index, const glm::mat4& world) {
    const json::Value& from = itemsOf(extensionOf(&c_.root, kLights), "lights")[index];
    const std::string name = textOr(&from, "name", ""), type = textOr(&from, "type", "point");
    Light light;
    light.name = name.empty() ? "light " + std::to_string(index) : name;
    light.type = type == "directional" ? LightType::Directional
                 : type == "spot"      ? LightType::Spot
                                       : LightType::Point;
    const std::array<double, 3> color = threeOr(&from, "color", 1);
    light.color = glm::max(glm::vec3(color[0], color[1], color[2]), 0.0f);
    light.intensity = float(numberOr(&from, "intensity", 1));
    light.range = float(numberOr(&from, "range", 0));
    if (light.type == LightType::Spot) {
      constexpr double kRightAngle = 1.5707963267948966, kDefaultOuter = 0.7853981633974483;
      const json::Value* spot = from.find("spot");
      light.outerConeAngle = float(std::min(numberOr(spot, "outerConeAngle", kDefaultOuter), kRightAngle));
      light.innerConeAngle = std::min(float(numberOr(spot, "innerConeAngle", 0)), light.outerConeAngle);
    }
    light.position = glm::vec3(world[3]);
    // The light points along the node's -Z; the node's scale does not affect it (KHR_lights_punctual).
    light.direction = orientationOf(world) * glm::vec3(0, 0, -1);
    return light;
  }

  static constexpr std::string_view kLights = "KHR_lights_punctual";
  Context& c_;
  std::vector<uint32_t>& nodeOf_;
  std::vector<Camera> cameras_;  // of the file
  std::vector<glm::mat4> world_;
};

}  // namespace

void buildNodes(Context& c) { NodeBuilder(c).run(); }

}  // namespace fovea::scene::gltf
