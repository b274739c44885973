// World-space triangles of a scene: what every renderer, rasteriser and ray tracer of the project reads.
#include <algorithm>
#include <cmath>
#include <string>

#include "framework/base/diagnostic.h"
#include "framework/scene/motion.h"
#include "framework/scene/scene.h"

namespace fovea::scene {
namespace {

// A few bytes of JSON can instance a mesh a million times; this many triangles are past what any device here
// takes.
constexpr uint64_t kMaxTriangles = uint64_t(1) << 26;

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// A node moves when it or anything above it does.
std::vector<bool> dynamicNodes(const Scene& scene) {
  std::vector<bool> dynamic(scene.nodes.size());
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& n = scene.nodes[i];
    dynamic[i] = n.dynamic || (n.parent != kNoIndex && dynamic[n.parent]);
  }
  return dynamic;
}

// The cofactor matrix equals det * inverse transpose: the same direction of normals up to the sign of det,
// and it exists for flattened (singular) transforms too.
glm::mat3 normalMatrix(const glm::mat4& m) {
  const glm::mat3 a(m);
  const float sign = glm::determinant(a) < 0.0f ? -1.0f : 1.0f;
  return sign * glm::mat3(glm::cross(a[1], a[2]), glm::cross(a[2], a[0]), glm::cross(a[0], a[1]));
}

// A singular transform can swallow a normal; any unit vector will do for what is then a sliver.
glm::vec3 unitNormal(const glm::vec3& n) {
  const float length = glm::length(n);
  return length > 0.0f && std::isfinite(length) ? n / length : glm::vec3(0, 1, 0);
}

// Invisible: all of it in one point, triangles that nothing draws or hits.
glm::mat4 placement(const glm::mat4& toWorld, bool visible) {
  if (visible) return toWorld;
  glm::mat4 point(0.0f);
  point[3] = toWorld[3];
  return point;
}

class Flattener {
 public:
  explicit Flattener(const Scene& scene) : scene_(scene), world_(worldTransforms(scene)), poses_(scene) {}

  Geometry run() {
    checkLimits();
    const std::vector<bool> dynamic = dynamicNodes(scene_);
    begin("static", kNoIndex, false);
    for (uint32_t i = 0; i < scene_.nodes.size(); ++i)
      if (!dynamic[i]) append(i, world_[i]);
    end();
    out_.staticTriangles = uint32_t(out_.triangles.size());
    for (uint32_t i = 0; i < scene_.nodes.size(); ++i) {
      if (!dynamic[i] || scene_.nodes[i].mesh == kNoIndex) continue;
      begin(scene_.nodes[i].name, i, true);
      const NodePoses::Pose pose = poses_.at(i, 0);
      append(i, placement(pose.toWorld, pose.visible));
      end();
      includePath(i);
    }
    return std::move(out_);
  }

 private:
  void checkLimits() const {
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

  // The winding is that of the visible object: it must not change with time.
  void append(uint32_t nodeIndex, const glm::mat4& m) {
    const Node& node = scene_.nodes[nodeIndex];
    if (node.mesh == kNoIndex) return;
    const bool mirrored = glm::determinant(glm::mat3(world_[nodeIndex])) < 0.0f;
    for (const Primitive& p : scene_.meshes.at(node.mesh).primitives) {
      const uint32_t base = uint32_t(out_.positions.size());
      appendVertices(p, m, node);
      appendTriangles(p, base, mirrored);
    }
  }

  void appendVertices(const Primitive& p, const glm::mat4& m, const Node& node) {
    const glm::mat3 normals = normalMatrix(m);
    for (size_t i = 0; i < p.positions.size(); ++i) {
      const glm::vec3 position(m * glm::vec4(p.positions[i], 1.0f));
      if (!isFinite(position))
        throw Error(ExitCode::BadInput,
                    "scene `" + scene_.name + "`: node `" + node.name + "` moves vertex " +
                        std::to_string(i) + " of mesh `" + scene_.meshes[node.mesh].name +
                        "` to a place that is not finite",
                    "check the scales and matrices of the node and of those above it");
      out_.positions.push_back(position);
      out_.boundsMin = glm::min(out_.boundsMin, position);
      out_.boundsMax = glm::max(out_.boundsMax, position);
      out_.normals.push_back(unitNormal(normals * p.normals[i]));
      out_.uvs.push_back(p.uvs[i]);
    }
  }

  void includePath(uint32_t nodeIndex) {
    const Mover* mover = poses_.moverOf(nodeIndex);
    if (!mover) return;
    Bounds mesh;
    for (const Primitive& p : scene_.meshes[scene_.nodes[nodeIndex].mesh].primitives)
      for (const glm::vec3& v : p.positions) mesh.include(v);
    if (mesh.low.x > mesh.high.x) return;
    const Bounds swept = sweptBounds(poses_, nodeIndex, *mover, mesh);
    if (!isFinite(swept.low) || !isFinite(swept.high))
      throw Error(ExitCode::BadInput,
                  "scene `" + scene_.name + "`: node `" + scene_.nodes[nodeIndex].name +
                      "` moves to a place that is not finite",
                  "check its keys and the scales and matrices of the nodes above it");
    out_.boundsMin = glm::min(out_.boundsMin, swept.low);
    out_.boundsMax = glm::max(out_.boundsMax, swept.high);
  }

  void appendTriangles(const Primitive& p, uint32_t base, bool flip) {
    const uint32_t tag = p.material | uint32_t(out_.objects.size()) << 16;
    for (size_t i = 0; i + 2 < p.indices.size(); i += 3) {
      const uint32_t a = base + p.indices[i], b = base + p.indices[i + 1], c = base + p.indices[i + 2];
      out_.triangles.push_back(flip ? Triangle{{a, c, b}, tag} : Triangle{{a, b, c}, tag});
    }
  }

  const Scene& scene_;
  std::vector<glm::mat4> world_;
  NodePoses poses_;
  Geometry out_;
  Object object_;
};

}  // namespace

Geometry flatten(const Scene& scene) { return Flattener(scene).run(); }

void moveObjects(const Frame& frame, Geometry& geometry) {
  for (size_t i = 0; i < std::min(geometry.objects.size(), frame.objects.size()); ++i) {
    const Object& object = geometry.objects[i];
    if (!object.dynamic) continue;
    const glm::mat4 m = placement(frame.objects[i].toWorld, frame.objects[i].visible);
    const glm::mat3 normals = normalMatrix(m);
    uint32_t v = object.firstVertex;
    for (const Primitive& p : frame.scene->meshes[frame.scene->nodes[object.node].mesh].primitives)
      for (size_t k = 0; k < p.positions.size(); ++k, ++v) {
        geometry.positions[v] = glm::vec3(m * glm::vec4(p.positions[k], 1.0f));
        geometry.normals[v] = unitNormal(normals * p.normals[k]);
      }
  }
}

}  // namespace fovea::scene
