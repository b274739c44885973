#include "framework/scene/motion/deform.h"

#include <algorithm>
#include <cmath>

#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene {
namespace {

// The cofactor matrix equals det * inverse transpose. It gives normals the same direction up to the sign of det, and
// it also exists for flattened (singular) transforms.
glm::mat3 normalMatrix(const glm::mat4& m) {
  const glm::mat3 a(m);
  const float sign = glm::determinant(a) < 0.0f ? -1.0f : 1.0f;
  return sign * glm::mat3(glm::cross(a[1], a[2]), glm::cross(a[2], a[0]), glm::cross(a[0], a[1]));
}

// A singular transform can make a normal vanish; any unit vector serves for what is then a sliver.
glm::vec3 unitNormal(const glm::vec3& n) {
  const float length = glm::length(n);
  return length > 0.0f && std::isfinite(length) ? n / length : glm::vec3(0, 1, 0);
}

// Rest shape, targets and joints of a primitive or of a cage (which has no normals).
struct Shape {
  const std::vector<glm::vec3>& positions;
  const std::vector<glm::vec3>* normals;
  const std::vector<MorphTarget>& targets;
  const std::vector<glm::u16vec4>& joints;
  const std::vector<glm::vec4>& weights;
};

void addTargets(const Shape& shape, const ObjectPose& pose, glm::vec3* positions, glm::vec3* normals) {
  for (size_t t = 0; t < std::min(shape.targets.size(), pose.weights.size()); ++t) {
    const float weight = pose.weights[t];
    if (weight == 0.0f) continue;
    const MorphTarget& target = shape.targets[t];
    for (size_t i = 0; i < target.positions.size(); ++i) positions[i] += weight * target.positions[i];
    if (normals)
      for (size_t i = 0; i < target.normals.size(); ++i) normals[i] += weight * target.normals[i];
  }
}

void place(const Shape& shape, const ObjectPose& pose, glm::vec3* positions, glm::vec3* normals) {
  const size_t count = shape.positions.size();
  std::copy(shape.positions.begin(), shape.positions.end(), positions);
  if (normals) std::copy(shape.normals->begin(), shape.normals->end(), normals);
  addTargets(shape, pose, positions, normals);
  const bool bent = !shape.joints.empty() && !pose.joints.empty();
  const glm::mat3 turn = normalMatrix(pose.toWorld);
  for (size_t i = 0; i < count; ++i) {
    glm::mat4 m(0.0f);
    for (size_t entry = i; bent && entry < shape.joints.size(); entry += count)  // of each set
      for (int k = 0; k < 4; ++k) m += shape.weights[entry][k] * pose.joints[shape.joints[entry][k]];
    const glm::mat4& toWorld = bent ? m : pose.toWorld;
    positions[i] = glm::vec3(toWorld * glm::vec4(positions[i], 1.0f));
    if (normals) normals[i] = unitNormal((bent ? normalMatrix(m) : turn) * normals[i]);
  }
}

size_t vertexCount(const Mesh& mesh) {
  size_t count = 0;
  for (const Primitive& p : mesh.primitives) count += p.positions.size();
  return count;
}

void placeCage(const SubdivisionCage& cage, const Stencils& stencils, const ObjectPose& pose,
               glm::vec3* positions, glm::vec3* normals) {
  thread_local std::vector<glm::vec3> points;
  points.resize(std::max(points.size(), cage.positions.size()));
  place({cage.positions, nullptr, cage.targets, cage.joints, cage.weights}, pose, points.data(), nullptr);
  const size_t count = stencils.vertexCount();
  stencils.evaluate({points.data(), cage.positions.size()}, {positions, count}, {normals, count});
  if (!mirrored(pose)) return;
  for (size_t i = 0; i < count; ++i) normals[i] = -normals[i];
}

}  // namespace

bool skinned(const Scene& scene, const Node& node) {
  if (node.mesh == kNoIndex || node.skin == kNoIndex) return false;
  const Mesh& mesh = scene.meshes[node.mesh];
  if (mesh.cage && !mesh.cage->joints.empty()) return true;
  return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                     [](const Primitive& p) { return !p.joints.empty(); });
}

size_t morphTargets(const Mesh& mesh) {
  size_t count = mesh.cage ? mesh.cage->targets.size() : 0;
  for (const Primitive& p : mesh.primitives) count = std::max(count, p.targets.size());
  return count;
}

bool deforms(const Scene& scene, const Node& node) {
  return node.mesh != kNoIndex && (skinned(scene, node) || morphTargets(scene.meshes[node.mesh]) > 0);
}

std::vector<float> restWeights(const Scene& scene, const Node& node) {
  const Mesh& mesh = scene.meshes[node.mesh];
  std::vector<float> weights = node.weights.empty() ? mesh.weights : node.weights;
  weights.resize(morphTargets(mesh), 0.0f);
  return weights;
}

ObjectPose poseOf(const Object& object, size_t index, const Frame& frame) {
  ObjectPose pose;
  if (index < frame.objects.size()) {
    pose.toWorld = frame.objects[index].toWorld;
    pose.visible = frame.objects[index].visible;
  }
  if (frame.joints.size() >= size_t(object.firstJoint) + object.jointCount)
    pose.joints = {frame.joints.data() + object.firstJoint, object.jointCount};
  if (frame.weights.size() >= size_t(object.firstWeight) + object.weightCount)
    pose.weights = {frame.weights.data() + object.firstWeight, object.weightCount};
  return pose;
}

void placeVertices(const Mesh& mesh, const Stencils* stencils, const ObjectPose& pose, glm::vec3* positions,
                   glm::vec3* normals) {
  if (!pose.visible) {
    const size_t count = stencils ? stencils->vertexCount() : vertexCount(mesh);
    std::fill_n(positions, count, glm::vec3(pose.toWorld[3]));
    std::fill_n(normals, count, glm::vec3(0, 1, 0));
    return;
  }
  if (stencils) return placeCage(*mesh.cage, *stencils, pose, positions, normals);
  for (const Primitive& p : mesh.primitives) {
    place({p.positions, &p.normals, p.targets, p.joints, p.weights}, pose, positions, normals);
    positions += p.positions.size();
    normals += p.positions.size();
  }
}

bool mirrored(const ObjectPose& pose) {
  return glm::determinant(glm::mat3(pose.joints.empty() ? pose.toWorld : pose.joints[0])) < 0.0f;
}

}  // namespace fovea::scene
