#include "framework/scene/ray_scene.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <utility>
#include <vector>

#include "framework/scene/ray_tracer.h"

namespace fovea::scene {
namespace {

// What a look-up needs of one masked material: the alpha channel on its own, as the scene filters it.
struct Mask {
  Scene scene;  // one material with one texture of which only alpha is kept
};

Mask makeMask(const Scene& scene, const Material& material) {
  Mask mask;
  mask.scene.materials = {material};
  TextureUse& use = mask.scene.materials[0].baseColorTexture;
  if (use && use.texture < scene.textures.size()) {
    mask.scene.textures = {scene.textures[use.texture]};
    use.texture = 0;
  }
  return mask;
}

// Content, not addresses: a scene that replaces another one may well live where the first one was.
XXH64_hash_t contentKey(const Scene& scene, const Geometry& geometry) {
  XXH3_state_t* state = XXH3_createState();
  XXH3_64bits_reset(state);
  const auto add = [&](const auto& list) {
    const uint64_t count = list.size();
    XXH3_64bits_update(state, &count, sizeof count);
    if (count != 0) XXH3_64bits_update(state, list.data(), count * sizeof(list[0]));
  };
  add(geometry.positions);
  add(geometry.triangles);
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    if (!m.masked) continue;
    const TextureUse& use = m.baseColorTexture;
    const std::array<float, 9> values{float(i),           m.baseColor.a,       m.alphaCutoff,
                                      use.transform[0].x, use.transform[0].y, use.transform[1].x,
                                      use.transform[1].y, use.transform[2].x, use.transform[2].y};
    const std::array<uint32_t, 3> modes{use.texture, uint32_t(use.wrapU), uint32_t(use.wrapV)};
    XXH3_64bits_update(state, values.data(), sizeof values);
    XXH3_64bits_update(state, modes.data(), sizeof modes);
    if (use && use.texture < scene.textures.size()) add(scene.textures[use.texture].rgba);
  }
  add(geometry.uvs);
  const XXH64_hash_t key = XXH3_64bits_digest(state);
  XXH3_freeState(state);
  return key;
}

}  // namespace

struct RayScene::Impl {
  std::unique_ptr<RayTracer> tracer;
  // Masked triangles only: three uvs each, found through the triangle's index.
  std::vector<uint32_t> maskOfTriangle;  // index into masks, kNoIndex for opaque; empty when nothing is masked
  std::vector<std::array<glm::vec2, 3>> uvs;
  std::vector<Mask> masks;
  float epsilon = 1e-5f;
  double area = 0;

  bool opaqueAt(uint32_t triangle, float u, float v) const {
    const uint32_t m = maskOfTriangle[triangle];
    if (m == kNoIndex) return true;
    const Scene& s = masks[m].scene;
    const auto& t = uvs[triangle];
    const glm::vec2 uv = t[0] * (1.0f - u - v) + t[1] * u + t[2] * v;
    const Material& material = s.materials[0];
    return reflectance(s, material, uv).a >= material.alphaCutoff;
  }

  void addMasks(const Scene& from, const Geometry& geometry) {
    std::vector<uint32_t> maskOfMaterial(from.materials.size(), kNoIndex);
    for (size_t i = 0; i < from.materials.size(); ++i) {
      if (!from.materials[i].masked) continue;
      maskOfMaterial[i] = uint32_t(masks.size());
      masks.push_back(makeMask(from, from.materials[i]));
    }
    if (masks.empty()) return;
    maskOfTriangle.assign(geometry.triangles.size(), kNoIndex);
    uvs.resize(geometry.triangles.size());
    for (size_t t = 0; t < geometry.triangles.size(); ++t) {
      const Triangle& triangle = geometry.triangles[t];
      if (triangle.material() >= maskOfMaterial.size()) continue;
      maskOfTriangle[t] = maskOfMaterial[triangle.material()];
      for (int k = 0; k < 3; ++k)
        uvs[t][size_t(k)] = geometry.uvs.empty() ? glm::vec2(0) : geometry.uvs[triangle.v[k]];
    }
  }
};

RayScene::RayScene(const Scene& scene, const Geometry& geometry) : impl_(std::make_unique<Impl>()) {
  Impl& i = *impl_;
  i.addMasks(scene, geometry);
  RayTracer::Accepts accepts;
  if (!i.masks.empty()) accepts = [&i](uint32_t t, float u, float v) { return i.opaqueAt(t, u, v); };
#ifdef FOVEA_EMBREE
  i.tracer = makeEmbreeTracer(geometry, std::move(accepts));
#else
  i.tracer = makeBvhTracer(geometry, std::move(accepts));
#endif
  if (geometry.empty()) return;
  i.epsilon = 1e-5f * std::max(glm::length(geometry.boundsMax - geometry.boundsMin), 1e-3f);
  for (const Triangle& t : geometry.triangles) {
    const glm::vec3 &a = geometry.positions[t.v[0]], &b = geometry.positions[t.v[1]],
                    &c = geometry.positions[t.v[2]];
    i.area += 0.5 * double(glm::length(glm::cross(b - a, c - a)));
  }
}

RayScene::~RayScene() = default;

RayHit RayScene::intersect(const Ray& ray) const { return impl_->tracer->intersect(ray); }
bool RayScene::occluded(const Ray& ray) const { return impl_->tracer->occluded(ray); }
float RayScene::epsilon() const { return impl_->epsilon; }
double RayScene::surfaceArea() const { return impl_->area; }

std::shared_ptr<const RayScene> RayScene::cached(const Scene& scene, const Geometry& geometry) {
  static std::mutex mutex;
  static std::array<std::pair<XXH64_hash_t, std::shared_ptr<const RayScene>>, 2> entries;
  const XXH64_hash_t key = contentKey(scene, geometry);
  const std::scoped_lock lock(mutex);
  if (!entries[0].second || entries[0].first != key) std::swap(entries[0], entries[1]);
  if (!entries[0].second || entries[0].first != key) entries[0] = {key, std::make_shared<RayScene>(scene, geometry)};
  return entries[0].second;
}

SurfaceHit surfaceAt(const Geometry& geometry, const RayHit& hit) {
  const Triangle& t = geometry.triangles[hit.triangle];
  const float w = 1.0f - hit.u - hit.v;
  const glm::vec3 &a = geometry.positions[t.v[0]], &b = geometry.positions[t.v[1]], &c = geometry.positions[t.v[2]];
  SurfaceHit s;
  s.position = a * w + b * hit.u + c * hit.v;
  const glm::vec3 n = glm::cross(b - a, c - a);
  const float length = glm::length(n);
  s.geometricNormal = length > 0 ? n / length : glm::vec3(0, 1, 0);
  s.shadingNormal = s.geometricNormal;
  if (!geometry.normals.empty()) {
    const glm::vec3 m =
        geometry.normals[t.v[0]] * w + geometry.normals[t.v[1]] * hit.u + geometry.normals[t.v[2]] * hit.v;
    const float shadingLength = glm::length(m);
    if (shadingLength > 1e-12f) s.shadingNormal = m / shadingLength;
    // Models exist whose normals point against their winding; the winding decides.
    if (glm::dot(s.shadingNormal, s.geometricNormal) < 0) s.shadingNormal = -s.shadingNormal;
  }
  if (!geometry.uvs.empty())
    s.uv = geometry.uvs[t.v[0]] * w + geometry.uvs[t.v[1]] * hit.u + geometry.uvs[t.v[2]] * hit.v;
  s.material = t.material();
  s.object = t.object();
  return s;
}

}  // namespace fovea::scene
