// Makes the world-space triangles of a scene, which every rasteriser and ray tracer of the project reads.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "fovea/error.h"
#include "framework/base/budget.h"
#include "framework/scene/motion/deform.h"
#include "framework/scene/motion/motion.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/scene.h"
#include "framework/scene/subdivision/subdivision.h"
#include "framework/scene/tables/tangents.h"

namespace fovea::scene {
namespace {

// A few bytes of JSON can instance a mesh a million times. No device supports this many triangles.
constexpr uint64_t kMaxTriangles = uint64_t(1) << 26;

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// A node moves if it or an ancestor does; it is also dynamic if its shape changes.
std::vector<bool> dynamicNodes(const Scene& scene, const NodePoses& poses) {
  std::vector<bool> moves(scene.nodes.size()), dynamic(scene.nodes.size());
  for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& n = scene.nodes[i];
    moves[i] = n.dynamic || (n.parent != kNoIndex && moves[n.parent]) || poses.moves(i);
  }
  for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
    dynamic[i] = moves[i] || poses.reshapes(i);
    if (skinned(scene, scene.nodes[i]))
      for (uint32_t joint : scene.skins[scene.nodes[i].skin].joints) dynamic[i] = dynamic[i] || moves[joint];
  }
  return dynamic;
}

class Flattener {
 public:
  explicit Flattener(const Scene& scene) : scene_(scene), poses_(scene) {}

  Geometry run() {
    makeRoom();
    for (const Mesh& mesh : scene_.meshes)
      for (const Primitive& p : mesh.primitives) {
        coarse_ = coarse_ || !p.lightIndices.empty();
        secondUvs_ = secondUvs_ || !p.secondUvs.empty();
        colors_ = colors_ || !p.colors.empty();
        tangents_ = tangents_ || hasNormalMap(p);
      }
    const std::vector<bool> dynamic = dynamicNodes(scene_, poses_);
    const std::vector<glm::mat4> world = worldTransforms(scene_);
    begin("static", kNoIndex, false);
    for (uint32_t i = 0; i < scene_.nodes.size(); ++i)
      if (!dynamic[i]) append(i, {world[i], true});
    end();
    out_.staticTriangles = uint32_t(out_.triangles.size());
    out_.staticLightTriangles = uint32_t(out_.lightTriangles.size());
    for (uint32_t i = 0; i < scene_.nodes.size(); ++i) {
      if (!dynamic[i] || scene_.nodes[i].mesh == kNoIndex) continue;
      begin(scene_.nodes[i].name, i, true);
      append(i, poses_.at(i, 0));
      end();
      includePath(i, out_.objects.back());
    }
    for (uint32_t t = 0; t < out_.triangles.size(); ++t)
      if (emits(out_.triangles[t])) out_.emissive.push_back(t);
    out_.stillKey = stillKey(scene_, out_);
    out_.meanFreePath = meanFreePath();
    return std::move(out_);
  }

 private:
  // Lists that grow would be copied again and again, and take twice the memory.
  void makeRoom() {
    if (scene_.materials.size() > 0xffff)
      throw Error(ExitCode::BadInput,
                  "scene `" + scene_.name + "`: " + std::to_string(scene_.materials.size()) +
                      " materials; a triangle can name at most 65535",
                  "merge materials in the model");
    uint64_t triangles = 0, vertices = 0;
    for (const Node& n : scene_.nodes) {
      if (n.mesh == kNoIndex) continue;
      for (const Primitive& p : scene_.meshes.at(n.mesh).primitives) {
        triangles += p.indices.size() / 3;
        vertices += p.positions.size();
      }
    }
    if (triangles > kMaxTriangles || vertices > kMaxTriangles)
      throw Error(ExitCode::BadInput,
                  "scene `" + scene_.name + "`: its nodes draw " + std::to_string(triangles) +
                      " triangles with " + std::to_string(vertices) + " vertices; at most " +
                      std::to_string(kMaxTriangles) + " of either can be used",
                  "simplify the model or instance it less often");
    constexpr uint64_t kBytesOfTriangle = 128;  // its record, and its place in the structures of rays
    claimContent(triangles * kBytesOfTriangle + vertices * sizeof(float) * 8,
                 "scene `" + scene_.name + "`: " + std::to_string(triangles) + " triangles of all nodes");
    out_.triangles.reserve(triangles);
    out_.positions.reserve(vertices);
    out_.normals.reserve(vertices);
    out_.uvs.reserve(vertices);
  }

  void begin(const std::string& name, uint32_t node, bool dynamic) {
    if (out_.objects.size() >= 0xffff)
      throw Error(ExitCode::BadInput, "scene `" + scene_.name + "`: more than 65535 moving objects",
                  "mark fewer nodes as dynamic");
    object_ = {};
    object_.name = name;
    object_.node = node;
    object_.dynamic = dynamic;
    object_.firstTriangle = uint32_t(out_.triangles.size());
    object_.firstVertex = uint32_t(out_.positions.size());
  }

  void end() {
    object_.triangleCount = uint32_t(out_.triangles.size()) - object_.firstTriangle;
    object_.vertexCount = uint32_t(out_.positions.size()) - object_.firstVertex;
    out_.objects.push_back(object_);
  }

  void append(uint32_t nodeIndex, const NodePoses::Pose& at) {
    const Node& node = scene_.nodes[nodeIndex];
    if (node.mesh == kNoIndex) return;
    const Mesh& mesh = scene_.meshes.at(node.mesh);
    checkShape(node, mesh);
    ObjectPose pose{at.toWorld, at.visible};
    std::vector<glm::mat4> joints;
    std::vector<float> weights;
    std::shared_ptr<const Stencils> stencils;
    if (deforms(scene_, node)) {
      if (skinned(scene_, node)) poses_.jointsAt(nodeIndex, 0, joints);
      weights = poses_.weightsAt(nodeIndex, 0);
      pose.joints = joints;
      pose.weights = weights;
      if (mesh.cage) stencils = stencilsOf(node.mesh);
      describe(node.skin, joints.size(), weights.size(), stencils);
    }
    // The winding is that of the visible object: it must not change with time.
    const bool flip = mirrored(pose);
    uint32_t base = uint32_t(out_.positions.size());
    appendVertices(mesh, stencils.get(), pose, node);
    for (const Primitive& p : mesh.primitives) {
      appendTriangles(p, base, flip);
      base += uint32_t(p.positions.size());
    }
  }

  // The data that a frame has for this object.
  void describe(uint32_t skin, size_t joints, size_t weights, std::shared_ptr<const Stencils> stencils) {
    if (!object_.dynamic) return;
    object_.deforms = true;
    if (joints > 0) {  // meshes of one skin share its joints
      const auto [known, isNew] = firstJoint_.try_emplace(skin, jointCount_);
      object_.firstJoint = known->second;
      if (isNew) jointCount_ += uint32_t(joints);
    }
    object_.jointCount = uint32_t(joints);
    object_.firstWeight = weightCount_, object_.weightCount = uint32_t(weights);
    object_.stencils = std::move(stencils);
    weightCount_ += uint32_t(weights);
  }

  std::shared_ptr<const Stencils> stencilsOf(uint32_t mesh) {
    std::shared_ptr<const Stencils>& known = stencils_[mesh];
    if (!known) known = std::make_shared<const Stencils>(*scene_.meshes[mesh].cage);
    return known;
  }

  // Loaders and generators should make these valid; if they do not, nothing may be read past the end of an array.
  void checkShape(const Node& node, const Mesh& mesh) const {
    if (!deforms(scene_, node)) return;
    const size_t joints = node.skin < scene_.skins.size() ? scene_.skins[node.skin].joints.size() : 0;
    const auto check = [&](size_t vertices, const auto& shape) {
      bool fits = shape.joints.size() == shape.weights.size() &&
                  (shape.joints.empty() || (vertices > 0 && shape.joints.size() % vertices == 0));
      for (const MorphTarget& t : shape.targets)
        for (const auto* list : {&t.positions, &t.normals})
          fits = fits && (list->empty() || list->size() == vertices);
      for (size_t i = 0; node.skin != kNoIndex && i < shape.joints.size(); ++i)
        for (int k = 0; k < 4; ++k) fits = fits && shape.joints[i][k] < joints;
      if (!fits)
        throw Error(ExitCode::BadInput, "scene `" + scene_.name + "`: the morph targets or joints of mesh `" +
                                            mesh.name + "` do not fit its vertices, or those of node `" +
                                            node.name + "` its skin");
    };
    if (mesh.cage) return check(mesh.cage->positions.size(), *mesh.cage);
    for (const Primitive& p : mesh.primitives) check(p.positions.size(), p);
  }

  void appendVertices(const Mesh& mesh, const Stencils* stencils, const ObjectPose& pose, const Node& node) {
    const size_t first = out_.positions.size();
    size_t count = first;
    for (const Primitive& p : mesh.primitives) count += p.positions.size();
    out_.positions.resize(count);
    out_.normals.resize(count);
    placeVertices(mesh, stencils, pose, out_.positions.data() + first, out_.normals.data() + first);
    for (size_t i = first; i < count; ++i) {
      if (!isFinite(out_.positions[i]))
        throw Error(ExitCode::BadInput,
                    "scene `" + scene_.name + "`: node `" + node.name + "` moves vertex " +
                        std::to_string(i - first) + " of mesh `" + mesh.name +
                        "` to a place that is not finite",
                    "check the scales and matrices of the node and of those above it");
      out_.boundsMin = glm::min(out_.boundsMin, out_.positions[i]);
      out_.boundsMax = glm::max(out_.boundsMax, out_.positions[i]);
    }
    for (const Primitive& p : mesh.primitives) {
      out_.uvs.insert(out_.uvs.end(), p.uvs.begin(), p.uvs.end());
      const size_t end = out_.uvs.size();
      if (secondUvs_) {
        out_.secondUvs.insert(out_.secondUvs.end(), p.secondUvs.begin(), p.secondUvs.end());
        out_.secondUvs.resize(end, glm::vec2(0));
      }
      if (colors_) {
        out_.colors.insert(out_.colors.end(), p.colors.begin(), p.colors.end());
        out_.colors.resize(end, glm::vec4(1));
      }
    }
  }

  bool hasNormalMap(const Primitive& p) const {
    return p.material < scene_.materials.size() && scene_.materials[p.material].normalTexture;
  }

  // Sets the box of the object, in its space or in the world (see Object), and adds all places that it reaches
  // to the bounds.
  void includePath(uint32_t nodeIndex, Object& object) {
    if (object.vertexCount == 0) return;
    const Mover* mover = poses_.moverOf(nodeIndex);
    Bounds box;
    if (object.deforms) {
      box = animatedBounds(scene_, poses_, object);
    } else {
      for (const Primitive& p : scene_.meshes[scene_.nodes[nodeIndex].mesh].primitives)
        for (const glm::vec3& v : p.positions) box.include(v);
    }
    object.low = box.low, object.high = box.high;
    Bounds swept = box;
    if (!object.deforms && poses_.animated(nodeIndex))
      swept = animatedBounds(scene_, poses_, object);
    else if (!object.deforms && mover)
      swept = sweptBounds(poses_, nodeIndex, *mover, box);
    else if (!object.deforms)
      return;
    if (!isFinite(swept.low) || !isFinite(swept.high))
      throw Error(ExitCode::BadInput,
                  "scene `" + scene_.name + "`: node `" + scene_.nodes[nodeIndex].name +
                      "` moves to a place that is not finite",
                  "check its keys and the scales and matrices of the nodes above it");
    out_.boundsMin = glm::min(out_.boundsMin, swept.low);
    out_.boundsMax = glm::max(out_.boundsMax, swept.high);
  }

  float meanFreePath() const {
    double surface = 0;
    for (const Triangle& t : out_.triangles) {
      const glm::dvec3 a(out_.positions[t.v[0]]), b(out_.positions[t.v[1]]), c(out_.positions[t.v[2]]);
      surface += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    const glm::dvec3 size = glm::dvec3(out_.boundsMax) - glm::dvec3(out_.boundsMin);
    return surface > 0 ? float(4 * size.x * size.y * size.z / surface) : 0;
  }

  bool emits(const Triangle& t) const {
    return t.material() < scene_.materials.size() && scene_.materials[t.material()].emission != glm::vec3(0);
  }

  void appendTriangles(const Primitive& p, uint32_t base, bool flip) {
    const uint32_t tag = p.material | uint32_t(out_.objects.size()) << 16;
    const auto add = [&](const std::vector<uint32_t>& indices, std::vector<Triangle>& to) {
      for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        const uint32_t a = base + indices[i], b = base + indices[i + 1], c = base + indices[i + 2];
        to.push_back(flip ? Triangle{{a, c, b}, tag} : Triangle{{a, b, c}, tag});
      }
    };
    add(p.indices, out_.triangles);
    if (coarse_) add(p.lightIndices.empty() ? p.indices : p.lightIndices, out_.lightTriangles);
    if (tangents_) appendTangents(p, flip);
  }

  void appendTangents(const Primitive& p, bool flip) {
    std::vector<TriangleTangents> list;
    if (hasNormalMap(p)) list = triangleTangents(p, scene_.materials[p.material].normalTexture.set);
    list.resize(p.indices.size() / 3);
    if (flip)
      for (TriangleTangents& t : list) t = turned(t);
    out_.tangents.insert(out_.tangents.end(), list.begin(), list.end());
  }

  const Scene& scene_;
  NodePoses poses_;
  Geometry out_;
  Object object_;
  bool coarse_ = false;  // whether something is coarser for voxels and maps of secondary lights
  bool secondUvs_ = false, colors_ = false, tangents_ = false;    // whether any primitive has them
  uint32_t jointCount_ = 0, weightCount_ = 0;                     // totals of the objects so far
  std::map<uint32_t, uint32_t> firstJoint_;                       // of skins
  std::map<uint32_t, std::shared_ptr<const Stencils>> stencils_;  // of meshes with a cage that deforms
};

}  // namespace

Geometry flatten(const Scene& scene) { return Flattener(scene).run(); }

void moveObjects(const Frame& frame, Geometry& geometry) {
  for (size_t i = 0; i < std::min(geometry.objects.size(), frame.objects.size()); ++i) {
    const Object& object = geometry.objects[i];
    if (!object.dynamic || object.vertexCount == 0) continue;
    placeVertices(frame.scene->meshes[frame.scene->nodes[object.node].mesh], object.stencils.get(),
                  poseOf(object, i, frame), &geometry.positions[object.firstVertex],
                  &geometry.normals[object.firstVertex]);
  }
}

}  // namespace fovea::scene
