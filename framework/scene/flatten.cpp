// World-space triangles of a scene: what every renderer, rasteriser and ray tracer of the project reads.
#include <cmath>
#include <string>

#include "framework/base/diagnostic.h"
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

class Flattener {
 public:
  explicit Flattener(const Scene& scene) : scene_(scene), world_(worldTransforms(scene)) {}

  Geometry run() {
    checkLimits();
    const std::vector<bool> dynamic = dynamicNodes(scene_);
    begin("static", kNoIndex, false);
    for (uint32_t i = 0; i < scene_.nodes.size(); ++i)
      if (!dynamic[i]) append(i);
    end();
    out_.staticTriangles = uint32_t(out_.triangles.size());
    for (uint32_t i = 0; i < scene_.nodes.size(); ++i) {
      if (!dynamic[i] || scene_.nodes[i].mesh == kNoIndex) continue;
      begin(scene_.nodes[i].name, i, true);
      append(i);
      end();
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

  void append(uint32_t nodeIndex) {
    const Node& node = scene_.nodes[nodeIndex];
    if (node.mesh == kNoIndex) return;
    const glm::mat4& m = world_[nodeIndex];
    for (const Primitive& p : scene_.meshes.at(node.mesh).primitives) {
      const uint32_t base = uint32_t(out_.positions.size());
      appendVertices(p, m, node);
      appendTriangles(p, base, glm::determinant(glm::mat3(m)) < 0.0f);
    }
  }

  void appendVertices(const Primitive& p, const glm::mat4& m, const Node& node) {
    // The cofactor matrix equals det * inverse transpose: the same direction of normals up to the sign of
    // det, and it exists for flattened (singular) transforms too.
    const glm::mat3 a(m);
    const float sign = glm::determinant(a) < 0.0f ? -1.0f : 1.0f;
    const glm::mat3 cofactor =
        sign * glm::mat3(glm::cross(a[1], a[2]), glm::cross(a[2], a[0]), glm::cross(a[0], a[1]));
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
      const glm::vec3 n = cofactor * p.normals[i];
      const float length = glm::length(n);
      // A singular transform can swallow a normal; any unit vector will do for what is then a sliver.
      out_.normals.push_back(length > 0.0f && std::isfinite(length) ? n / length : glm::vec3(0, 1, 0));
      out_.uvs.push_back(p.uvs[i]);
    }
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
  Geometry out_;
  Object object_;
};

}  // namespace

Geometry flatten(const Scene& scene) { return Flattener(scene).run(); }

}  // namespace fovea::scene
