// Implements complete() of the facade: what a scene that a program has put together lacks or has wrong.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/scene/load.h"
#include "framework/scene/scene.h"

namespace fovea::scene {
namespace {

// Sums of the normals of the triangles around each vertex, weighted by their areas, or up where there are none.
std::vector<glm::vec3> smoothNormals(const Primitive& p) {
  std::vector<glm::vec3> normals(p.positions.size(), glm::vec3(0));
  for (size_t i = 0; i + 2 < p.indices.size(); i += 3) {
    const glm::vec3 a = p.positions[p.indices[i]], b = p.positions[p.indices[i + 1]],
                    c = p.positions[p.indices[i + 2]];
    for (size_t k = 0; k < 3; ++k) normals[p.indices[i + k]] += glm::cross(b - a, c - a);
  }
  for (glm::vec3& n : normals) n = glm::dot(n, n) > 0 ? glm::normalize(n) : glm::vec3(0, 1, 0);
  return normals;
}

template <class T>
bool allFinite(const std::vector<T>& list) {
  return std::all_of(list.begin(), list.end(), [](const T& v) {
    for (int i = 0; i < T::length(); ++i)
      if (!std::isfinite(v[i])) return false;
    return true;
  });
}

class Completion {
 public:
  explicit Completion(Scene& scene) : scene_(scene) {}

  void run() {
    if (scene_.materials.empty()) mistake("materials", "a scene needs at least one material");
    if (scene_.cameras.empty()) mistake("cameras", "a scene needs at least one camera");
    size_t triangles = 0;
    for (size_t m = 0; m < scene_.meshes.size(); ++m)
      for (size_t p = 0; p < scene_.meshes[m].primitives.size(); ++p) {
        primitive(scene_.meshes[m].primitives[p], fmt::format("meshes[{}].primitives[{}]", m, p));
        triangles += scene_.meshes[m].primitives[p].indices.size() / 3;
      }
    if (triangles == 0) mistake("meshes", "a scene needs at least one triangle");
    for (size_t n = 0; n < scene_.nodes.size(); ++n) node(n);
    for (size_t i = 0; i < scene_.movers.size(); ++i) mover(scene_.movers[i], fmt::format("movers[{}]", i));
    for (size_t i = 0; i < scene_.lights.size(); ++i) light(scene_.lights[i], fmt::format("lights[{}]", i));
    messages_.throwIfErrors();
    addLightLevels(scene_);
    scene_.hash = contentHash(scene_);
  }

 private:
  void mistake(const std::string& path, std::string message) {
    messages_.error({scene_.name, 0, 0}, path, std::move(message));
  }

  void primitive(Primitive& p, const std::string& path) {
    const size_t count = p.positions.size();
    if (p.material >= scene_.materials.size())
      mistake(path + ".material",
              fmt::format("material {} of {} is not there", p.material, scene_.materials.size()));
    if (p.indices.size() % 3 != 0)
      mistake(path + ".indices", fmt::format("{} indices are no whole triangles", p.indices.size()));
    const auto wrong =
        std::find_if(p.indices.begin(), p.indices.end(), [&](uint32_t i) { return i >= count; });
    if (wrong != p.indices.end())
      return mistake(path + ".indices", fmt::format("vertex {} of {} is not there", *wrong, count));
    if (p.normals.empty()) p.normals = smoothNormals(p);
    if (p.uvs.empty()) p.uvs.resize(count, glm::vec2(0));
    if (p.normals.size() != count || p.uvs.size() != count)
      mistake(path, fmt::format("{} positions, but {} normals and {} texture coordinates", count,
                                p.normals.size(), p.uvs.size()));
    if (!allFinite(p.positions) || !allFinite(p.normals) || !allFinite(p.uvs))
      mistake(path, "a position, a normal or a texture coordinate is not finite");
  }

  void node(size_t n) {
    const Node& node = scene_.nodes[n];
    const std::string path = fmt::format("nodes[{}]", n);
    if (node.parent != kNoIndex && node.parent >= n)
      mistake(path + ".parent", "a parent comes before its children");
    if (node.mesh != kNoIndex && node.mesh >= scene_.meshes.size())
      mistake(path + ".mesh", fmt::format("mesh {} of {} is not there", node.mesh, scene_.meshes.size()));
  }

  void mover(const Mover& mover, const std::string& path) {
    if (mover.node >= scene_.nodes.size())
      return mistake(path + ".node",
                     fmt::format("node {} of {} is not there", mover.node, scene_.nodes.size()));
    if (!scene_.nodes[mover.node].dynamic) mistake(path + ".node", "the node of a mover is dynamic");
    const bool rising =
        std::is_sorted(mover.keys.begin(), mover.keys.end(),
                       [](const MotionKey& a, const MotionKey& b) { return a.time <= b.time; });
    if (mover.keys.empty() || !rising) mistake(path + ".keys", "a motion needs keys with increasing times");
  }

  void light(const Light& light, const std::string& path) {
    const float length = glm::length(light.direction);
    if (!(std::abs(length - 1) < 1e-3f))
      mistake(path + ".direction", fmt::format("the length of a direction is 1, not {}", length));
    if (!(light.intensity >= 0) || !std::isfinite(light.intensity))
      mistake(path + ".intensity", fmt::format("{} is no intensity of a light", light.intensity));
  }

  Scene& scene_;
  Diagnostics messages_;
};

}  // namespace

void complete(Scene& scene) { Completion(scene).run(); }

}  // namespace fovea::scene
