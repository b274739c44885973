// Gives scenes of many triangles a coarser mesh for voxels and the shadow maps of secondary lights.
#include <meshoptimizer.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <set>

#include "framework/base/threads.h"
#include "framework/scene/load.h"

namespace fovea::scene {
namespace {

// Drawing every triangle into the maps of a thousand lights takes a minute for each three million triangles on a CPU,
// and maps of 128 x 128 texels show little of the difference.
constexpr uint64_t kTooMany = uint64_t(1) << 20, kEnough = kTooMany / 2;
constexpr size_t kFewest = 64;  // that a primitive keeps

bool isTextured(const Scene& scene, const Primitive& p) {
  const Material& m = scene.materials[p.material];
  return m.baseColorTexture || m.emissionTexture;
}

// What is small, has holes, deforms or has a coarser level already stays as it is.
bool canBeCoarser(const Scene& scene, const Mesh& mesh, const Primitive& p) {
  return !mesh.cage && p.indices.size() / 3 > kFewest && p.lightIndices.empty() && p.targets.empty() &&
         p.joints.empty() && !scene.materials[p.material].masked;
}

// Triangles of the same vertices, about `share` of them. Vertices that differ in their normals alone count as one, as
// voxels and maps know only the normals of triangles.
std::vector<uint32_t> coarser(const Scene& scene, const Primitive& p, double share) {
  const meshopt_Stream streams[] = {{p.positions.data(), sizeof(glm::vec3), sizeof(glm::vec3)},
                                    {p.uvs.data(), sizeof(glm::vec2), sizeof(glm::vec2)}};
  std::vector<uint32_t> remap(p.positions.size());
  const size_t unique =
      meshopt_generateVertexRemapMulti(remap.data(), p.indices.data(), p.indices.size(), p.positions.size(),
                                       streams, isTextured(scene, p) ? 2 : 1);
  std::vector<uint32_t> indices(p.indices.size()), original(unique);
  std::vector<glm::vec3> positions(unique);
  meshopt_remapIndexBuffer(indices.data(), p.indices.data(), p.indices.size(), remap.data());
  for (size_t i = remap.size(); i-- > 0;)
    if (remap[i] < unique) original[remap[i]] = uint32_t(i), positions[remap[i]] = p.positions[i];
  const size_t target = std::max<size_t>(size_t(double(indices.size() / 3) * share), kFewest) * 3;
  indices.resize(meshopt_simplify(indices.data(), indices.data(), indices.size(), &positions[0].x, unique,
                                  sizeof(glm::vec3), target, std::numeric_limits<float>::max(), 0, nullptr));
  for (uint32_t& i : indices) i = original[i];
  return indices;
}

}  // namespace

bool addLightLevels(Scene& scene) {
  uint64_t whole = 0, reducible = 0;
  std::set<Primitive*> chosen;
  for (const Node& n : scene.nodes) {
    if (n.mesh == kNoIndex) continue;
    for (Primitive& p : scene.meshes[n.mesh].primitives) {
      const bool can = canBeCoarser(scene, scene.meshes[n.mesh], p);
      (can ? reducible : whole) += p.indices.size() / 3;
      if (can) chosen.insert(&p);
    }
  }
  if (whole + reducible <= kTooMany) return false;
  // What stays whole leaves at least a quarter to the rest.
  const double share = double(kEnough - std::min(whole, kEnough / 4 * 3)) / double(reducible);
  if (chosen.empty() || share >= 1) return false;
  const std::vector<Primitive*> list(chosen.begin(), chosen.end());
  std::atomic<size_t> next = 0;
  onThreads(std::min(threadCount(0), uint32_t(list.size())), [&] {
    for (size_t i = next++; i < list.size(); i = next++)
      list[i]->lightIndices = coarser(scene, *list[i], share);
  });
  return true;
}

}  // namespace fovea::scene
