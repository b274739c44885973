#include "framework/scene/origin.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <memory>

#include "framework/scene/motion/deform.h"
#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene {
namespace {

constexpr double kFarRadii = 16;     // from there on, single precision loses what can be seen
constexpr double kForgotten = 1000;  // parts that reach farther than so many times the median do not count

double radiusOf(const DoubleBounds& b) { return 0.5 * glm::length(b.high - b.low); }

bool isFar(glm::dvec3 position, double radius) {
  const glm::dvec3 p = glm::abs(position);
  return std::max({p.x, p.y, p.z}) > kFarRadii * radius;
}

glm::dvec3 times(const glm::dmat4& m, glm::dvec3 p) { return glm::dvec3(m * glm::dvec4(p, 1)); }

std::vector<glm::dmat4> composed(const Scene& scene, const std::vector<glm::dmat4>& local) {
  std::vector<glm::dmat4> world(local);
  for (size_t i = 0; i < world.size(); ++i)
    if (scene.nodes[i].parent != kNoIndex) world[i] = world[scene.nodes[i].parent] * world[i];
  return world;
}

std::vector<DoubleBounds> meshBounds(const Scene& scene) {
  std::vector<DoubleBounds> list;
  for (const Mesh& mesh : scene.meshes) {
    DoubleBounds& box = list.emplace_back();
    for (const Primitive& p : mesh.primitives)
      for (const glm::vec3& v : p.positions) box.include(v);
  }
  return list;
}

std::vector<DoubleBounds> partsAt(const Scene& scene, const std::vector<glm::dmat4>& world,
                                  const std::vector<DoubleBounds>& meshes) {
  std::vector<DoubleBounds> parts;
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    if (node.mesh == kNoIndex || meshes[node.mesh].empty()) continue;
    DoubleBounds& part = parts.emplace_back();
    if (!skinned(scene, node)) {
      part.include(meshes[node.mesh], world[i]);
      continue;
    }
    const Skin& skin = scene.skins[node.skin];
    for (size_t j = 0; j < skin.joints.size(); ++j)
      part.include(meshes[node.mesh], world[skin.joints[j]] * glm::dmat4(skin.inverseBind[j]));
  }
  return parts;
}

// The value in the middle of a list that is not empty.
double median(std::vector<double> list) {
  const auto middle = list.begin() + ptrdiff_t(list.size() / 2);
  std::ranges::nth_element(list, middle);
  return *middle;
}

class Recentring {
 public:
  Recentring(Scene& scene, const std::vector<glm::dmat4>& authored)
      : scene_(scene), authored_(authored), nodes_(scene.nodes.size()), meshes_(scene.meshes.size()) {}

  void run() {
    findTurning();
    const std::vector<DoubleBounds> boxes = meshBounds(scene_);
    const std::vector<glm::dmat4> world = composed(scene_, atFirstKeys());
    const DoubleBounds most = boundsOfMost(partsAt(scene_, world, boxes));
    const double radius = radiusOf(most);
    if (most.empty() || !(radius > 0) || !std::isfinite(radius)) return;
    scene_.origin = originOf(most);
    chooseMeshes(world, boxes, radius);
    chooseNodes(world, radius);
    const auto moved = [](const glm::dvec3& origin) { return origin != glm::dvec3(0); };
    if (!moved(scene_.origin) && std::ranges::none_of(nodes_, moved)) return;
    moveMeshes();
    moveChannels();
    moveNodes();
    moveSkins();
    moveLightsAndCameras();
  }

 private:
  // A node that turns or grows about its own origin has to keep it, and so has one that carries a camera.
  void findTurning() {
    keeps_.resize(scene_.nodes.size());
    for (size_t i = 0; i < scene_.nodes.size(); ++i) keeps_[i] = scene_.nodes[i].camera != kNoIndex;
    for (const Animation& a : scene_.animations)
      for (const AnimationChannel& c : a.channels)
        if (c.path == AnimationChannel::Path::Rotation || c.path == AnimationChannel::Path::Scale)
          keeps_[c.node] = true;
  }

  // Nodes may lie anywhere before an animation places them.
  std::vector<glm::dmat4> atFirstKeys() const {
    std::vector<glm::dmat4> local = authored_;
    if (scene_.animations.empty()) return local;
    for (const AnimationChannel& c : scene_.animations[0].channels) {
      const size_t first = c.interpolation == AnimationChannel::Interpolation::CubicSpline ? 3 : 0;
      if (c.path == AnimationChannel::Path::Translation && c.values.size() >= first + 3)
        local[c.node][3] = glm::dvec4(c.values[first], c.values[first + 1], c.values[first + 2], 1);
    }
    return local;
  }

  void chooseMeshes(const std::vector<glm::dmat4>& world, const std::vector<DoubleBounds>& boxes,
                    double radius) {
    std::vector<bool> far(meshes_.size()), stays(meshes_.size());
    for (size_t i = 0; i < scene_.nodes.size(); ++i) {
      const uint32_t mesh = scene_.nodes[i].mesh;
      if (mesh == kNoIndex || boxes[mesh].empty()) continue;
      const glm::dvec3 middle = 0.5 * (boxes[mesh].low + boxes[mesh].high);
      stays[mesh] = stays[mesh] || keeps_[i] || skinned(scene_, scene_.nodes[i]);
      far[mesh] = far[mesh] || isFar(glm::dmat3(world[i]) * middle, radius);
    }
    for (size_t m = 0; m < meshes_.size(); ++m)
      if (far[m] && !stays[m]) meshes_[m] = originOf(boxes[m]);
  }

  void chooseNodes(const std::vector<glm::dmat4>& world, double radius) {
    for (size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Node& node = scene_.nodes[i];
      if (node.mesh != kNoIndex) {
        if (!skinned(scene_, node)) nodes_[i] = meshes_[node.mesh];
        continue;
      }
      const bool carries = node.light == kNoIndex && !keeps_[i];
      if (!carries || !isFar(glm::dvec3(world[i][3]) - scene_.origin, radius)) continue;
      const glm::dvec3 origin = times(glm::inverse(world[i]), scene_.origin);
      if (std::isfinite(glm::dot(origin, origin))) nodes_[i] = origin;
    }
  }

  glm::dvec3 parentOrigin(size_t node) const {
    const uint32_t parent = scene_.nodes[node].parent;
    return parent == kNoIndex ? scene_.origin : nodes_[parent];
  }

  void moveMeshes() {
    for (size_t m = 0; m < meshes_.size(); ++m) {
      if (meshes_[m] == glm::dvec3(0)) continue;
      const auto move = [&](std::vector<glm::vec3>& positions) {
        for (glm::vec3& p : positions) p = glm::vec3(glm::dvec3(p) - meshes_[m]);
      };
      Mesh& mesh = scene_.meshes[m];
      for (Primitive& p : mesh.primitives) move(p.positions);
      if (!mesh.cage) continue;
      auto cage = std::make_shared<SubdivisionCage>(*mesh.cage);
      move(cage->positions);
      mesh.cage = std::move(cage);
    }
  }

  void moveChannels() {
    for (Animation& a : scene_.animations)
      for (AnimationChannel& c : a.channels) {
        if (c.path != AnimationChannel::Path::Translation) continue;
        const glm::dvec3 by = glm::dmat3(authored_[c.node]) * nodes_[c.node] - parentOrigin(c.node);
        const bool cubic = c.interpolation == AnimationChannel::Interpolation::CubicSpline;
        for (size_t k = cubic ? 3 : 0; k + 2 < c.values.size(); k += cubic ? 9 : 3)
          for (int axis = 0; axis < 3; ++axis)
            c.values[k + size_t(axis)] = float(double(c.values[k + size_t(axis)]) + by[axis]);
      }
  }

  void moveNodes() {
    for (size_t i = 0; i < scene_.nodes.size(); ++i) {
      Node& node = scene_.nodes[i];
      const glm::dvec3 above = parentOrigin(i);
      if (nodes_[i] == glm::dvec3(0) && above == glm::dvec3(0)) continue;
      node.origin = nodes_[i];
      const glm::vec3 translation(times(authored_[i], nodes_[i]) - above);
      if (node.matrix)
        (*node.matrix)[3] = glm::vec4(translation, 1);
      else
        node.translation = translation;
    }
  }

  void moveSkins() {
    for (Skin& skin : scene_.skins)
      for (size_t j = 0; j < skin.joints.size(); ++j) {
        const glm::dvec3 origin = nodes_[skin.joints[j]];
        glm::mat4& bind = skin.inverseBind[j];
        if (origin != glm::dvec3(0)) bind[3] = glm::vec4(glm::dvec4(bind[3]) - glm::dvec4(origin, 0));
      }
  }

  void moveLightsAndCameras() {
    const std::vector<glm::dmat4> world = composed(scene_, authored_);
    for (size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Node& node = scene_.nodes[i];
      const glm::vec3 position = fromAuthor(scene_, glm::dvec3(world[i][3]));
      if (node.light != kNoIndex) scene_.lights[node.light].position = position;
      if (node.camera != kNoIndex) scene_.cameras[node.camera].position = position;
    }
  }

  Scene& scene_;
  const std::vector<glm::dmat4>& authored_;
  std::vector<glm::dvec3> nodes_, meshes_;  // the new origins
  std::vector<bool> keeps_;                 // nodes
};

glm::dvec3 originAbove(const Scene& scene, uint32_t node) {
  const uint32_t parent = scene.nodes[node].parent;
  return parent == kNoIndex ? scene.origin : scene.nodes[parent].origin;
}

glm::dvec3 turned(const Node& node, const glm::quat& rotation) {
  return glm::dquat(rotation) * (glm::dvec3(node.scale) * node.origin);
}

}  // namespace

void DoubleBounds::include(const DoubleBounds& box, const glm::dmat4& m) {
  for (int c = 0; c < 8 && !box.empty(); ++c)
    include(times(
        m, {c & 1 ? box.high.x : box.low.x, c & 2 ? box.high.y : box.low.y, c & 4 ? box.high.z : box.low.z}));
}

DoubleBounds boundsOfMost(const std::vector<DoubleBounds>& parts) {
  DoubleBounds all;
  std::vector<double> axes[3], reaches;
  for (const DoubleBounds& part : parts) {
    all.include(part, glm::dmat4(1));
    for (int axis = 0; axis < 3; ++axis) axes[axis].push_back(0.5 * (part.low[axis] + part.high[axis]));
  }
  if (parts.empty()) return all;
  const glm::dvec3 middle(median(axes[0]), median(axes[1]), median(axes[2]));
  for (const DoubleBounds& part : parts)
    reaches.push_back(glm::distance(0.5 * (part.low + part.high), middle) + radiusOf(part));
  const double limit = kForgotten * median(reaches);
  if (!(limit > 0)) return all;
  DoubleBounds most;
  for (size_t i = 0; i < parts.size(); ++i)
    if (reaches[i] <= limit) most.include(parts[i], glm::dmat4(1));
  return most;
}

glm::dvec3 originOf(const DoubleBounds& authored) {
  glm::dvec3 origin(0);
  if (authored.empty()) return origin;
  const glm::dvec3 middle = 0.5 * (authored.low + authored.high);
  const double radius = radiusOf(authored);
  // A number with few digits, so that scenes that differ by a round number of metres mostly become equal.
  const double step = radius > 0 ? std::exp2(std::floor(std::log2(radius)) - 12) : 0;
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(middle[axis]) > kFarRadii * radius)
      origin[axis] = step > 0 ? std::round(middle[axis] / step) * step : middle[axis];
  return origin;
}

std::vector<DoubleBounds> authoredParts(const Scene& scene) {
  std::vector<glm::dmat4> local;
  for (const Node& n : scene.nodes) local.emplace_back(localTransform(n));
  std::vector<DoubleBounds> parts = partsAt(scene, composed(scene, local), meshBounds(scene));
  for (DoubleBounds& part : parts) part.low += scene.origin, part.high += scene.origin;
  return parts;
}

void recentre(Scene& scene, const std::vector<glm::dmat4>& authored) { Recentring(scene, authored).run(); }

glm::dvec3 authoredTranslation(const Scene& scene, uint32_t node) {
  const Node& n = scene.nodes[node];
  return glm::dvec3(n.translation) - turned(n, n.rotation) + originAbove(scene, node);
}

glm::vec3 translationFrom(const Scene& scene, uint32_t node, glm::dvec3 authored, const glm::quat& rotation) {
  return glm::vec3(authored + turned(scene.nodes[node], rotation) - originAbove(scene, node));
}

}  // namespace fovea::scene
