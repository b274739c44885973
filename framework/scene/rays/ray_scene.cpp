#include "framework/scene/rays/ray_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <utility>
#include <vector>

#include "framework/base/hash.h"
#include "framework/base/random.h"
#include "framework/scene/materials/passage.h"
#include "framework/scene/rays/ray_tracer.h"

namespace fovea::scene {
namespace {

// The textures that say where a material lets light through.
constexpr TextureUse Material::*kPassingTextures[] = {
    &Material::baseColorTexture, &Material::metallicRoughnessTexture, &Material::transmissionTexture};

// What a look-up needs of one material with holes: a scene with this material and its textures alone.
struct Mask {
  Scene scene;
};

Mask makeMask(const Scene& scene, const Material& material) {
  Mask mask;
  mask.scene.materials = {material};
  for (const auto texture : kPassingTextures) {
    TextureUse& use = mask.scene.materials[0].*texture;
    const bool needed = texture == &Material::baseColorTexture || material.transmission > 0;
    if (!needed || !use || use.texture >= scene.textures.size()) {
      use = {};
      continue;
    }
    mask.scene.textures.push_back(scene.textures[use.texture]);
    use.texture = uint32_t(mask.scene.textures.size() - 1);
  }
  return mask;
}

bool hasHoles(const Material& m, Passing passing) {
  switch (passing) {
    case Passing::Never:
      return m.masked;
    case Passing::Random:
      return m.masked || letsLightThrough(m);
    case Passing::Met:
      return m.masked && !m.blended;
  }
  return false;
}

void addHoles(const Scene& scene, const Material& m, Hasher& hash) {
  hash.add(std::array<float, 10>{m.alphaCutoff, m.transmission, m.metallic, m.roughness, m.ior, m.specular,
                                 m.specularColor.r, m.specularColor.g, m.specularColor.b, float(m.blended)});
  hash.add(std::array<float, 4>{m.baseColor.r, m.baseColor.g, m.baseColor.b, m.baseColor.a});
  for (const auto texture : kPassingTextures) {
    const TextureUse& use = m.*texture;
    hash.add(std::array<float, 6>{use.transform[0].x, use.transform[0].y, use.transform[1].x,
                                  use.transform[1].y, use.transform[2].x, use.transform[2].y});
    hash.add(std::array<uint32_t, 3>{use.texture, uint32_t(use.wrapU), uint32_t(use.wrapV)});
    if (use && use.texture < scene.textures.size()) hash.add(scene.textures[use.texture].rgba);
  }
}

// Hash of everything but the positions of vertices that move.
uint64_t stillKey(const Scene& scene, const Geometry& geometry, Passing passing) {
  Hasher hash;
  hash.add(geometry.positions.data(), geometry.staticVertices());
  hash.add(geometry.triangles);
  hash.add(geometry.uvs);
  hash.add(&geometry.staticTriangles, 1);
  // Where nothing lets light through, all ways of passing are the same.
  const bool passes = std::ranges::any_of(scene.materials, letsLightThrough);
  const uint32_t way = passes ? uint32_t(passing) : 0;
  hash.add(&way, 1);
  for (uint32_t i = 0; i < scene.materials.size(); ++i)
    if (hasHoles(scene.materials[i], passing)) {
      hash.add(&i, 1);
      addHoles(scene, scene.materials[i], hash);
    }
  return hash.value();
}

uint64_t movingKey(const Geometry& geometry) {
  Hasher hash;
  const size_t first = geometry.staticVertices();
  hash.add(geometry.positions.data() + first, geometry.positions.size() - first);
  return hash.value();
}

std::unique_ptr<RayTracer> makeTracer(const Geometry& geometry, RayTracer::Accepts accepts,
                                      TriangleRange range) {
#ifdef FOVEA_EMBREE
  return makeEmbreeTracer(geometry, std::move(accepts), range);
#else
  return makeBvhTracer(geometry, std::move(accepts), range);
#endif
}

double areaOf(const Geometry& geometry, uint32_t first, uint32_t end) {
  double area = 0;
  for (uint32_t i = first; i < end; ++i) {
    const Triangle& t = geometry.triangles[i];
    const glm::vec3 &a = geometry.positions[t.v[0]], &b = geometry.positions[t.v[1]],
                    &c = geometry.positions[t.v[2]];
    area += 0.5 * double(glm::length(glm::cross(b - a, c - a)));
  }
  return area;
}

}  // namespace

// The parts that stay the same while dynamic objects move: the tracer of all static triangles, and all masks.
struct RayScene::Still {
  std::unique_ptr<RayTracer> tracer;
  Passing passing;
  // Triangles with holes only: three uvs each, found through the triangle's index.
  std::vector<uint32_t>
      maskOfTriangle;  // index into masks, kNoIndex for opaque; empty when nothing has holes
  std::vector<std::array<glm::vec2, 3>> uvs;
  std::vector<Mask> masks;
  bool choosesAtRandom = false;
  double area = 0;

  Still(const Scene& scene, const Geometry& geometry, Passing passing_) : passing(passing_) {
    choosesAtRandom = passing == Passing::Random && std::ranges::any_of(scene.materials, letsLightThrough);
    addMasks(scene, geometry);
    const uint32_t end = std::min(geometry.staticTriangles, uint32_t(geometry.triangles.size()));
    tracer = makeTracer(geometry, accepts(), {0, end});
    area = areaOf(geometry, 0, end);
  }

  RayTracer::Accepts accepts() const {
    if (masks.empty()) return {};
    return [this](const RayTracer::Meeting& at) { return stops(at); };
  }

  bool stops(const RayTracer::Meeting& at) const {
    const uint32_t m = maskOfTriangle[at.triangle];
    if (m == kNoIndex) return true;
    const Scene& s = masks[m].scene;
    const auto& t = uvs[at.triangle];
    const glm::vec2 uv = t[0] * (1.0f - at.u - at.v) + t[1] * at.u + t[2] * at.v;
    const Material& material = s.materials[0];
    if (passing != Passing::Random || !letsLightThrough(material))
      return reflectance(s, material, uv).a >= material.alphaCutoff;
    if (at.key == kMeetsAll) return material.blended || coverage(s, material, uv) > 0;
    const float stopped = coverage(s, material, uv) * (1 - passage(s, material, uv, at.cosine));
    return stopped > uniformFloat(hashCombine(at.key, at.triangle));
  }

  void addMasks(const Scene& from, const Geometry& geometry) {
    std::vector<uint32_t> maskOfMaterial(from.materials.size(), kNoIndex);
    for (size_t i = 0; i < from.materials.size(); ++i) {
      if (!hasHoles(from.materials[i], passing)) continue;
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

struct RayScene::Impl {
  std::shared_ptr<const Still> still;
  std::unique_ptr<RayTracer> moving;  // null if nothing moves
  float epsilon = 1e-5f;
  double area = 0;
};

RayScene::RayScene(const Scene& scene, const Geometry& geometry, Passing passing)
    : RayScene(std::make_shared<const Still>(scene, geometry, passing), geometry) {}

RayScene::RayScene(std::shared_ptr<const Still> still, const Geometry& geometry)
    : impl_(std::make_unique<Impl>()) {
  Impl& i = *impl_;
  i.still = std::move(still);
  i.area = i.still->area;
  if (geometry.empty()) return;
  i.epsilon = 1e-5f * std::max(glm::length(geometry.boundsMax - geometry.boundsMin), 1e-3f);
  const uint32_t end = uint32_t(geometry.triangles.size());
  if (geometry.staticTriangles >= end) return;
  i.moving = makeTracer(geometry, i.still->accepts(), {geometry.staticTriangles, end});
  i.area += areaOf(geometry, geometry.staticTriangles, end);
}

RayScene::~RayScene() = default;

RayHit RayScene::intersect(const Ray& ray) const {
  const RayHit hit = impl_->still->tracer->intersect(ray);
  if (!impl_->moving) return hit;
  Ray shorter = ray;
  if (hit) shorter.far = hit.distance;
  const RayHit nearer = impl_->moving->intersect(shorter);
  return nearer ? nearer : hit;
}

bool RayScene::occluded(const Ray& ray) const {
  return impl_->still->tracer->occluded(ray) || (impl_->moving && impl_->moving->occluded(ray));
}

bool RayScene::choosesAtRandom() const { return impl_->still->choosesAtRandom; }
float RayScene::epsilon() const { return impl_->epsilon; }
double RayScene::surfaceArea() const { return impl_->area; }

std::shared_ptr<const RayScene> RayScene::cached(const Scene& scene, const Geometry& geometry,
                                                 Passing passing) {
  struct Entry {
    uint64_t still = 0, moving = 0;
    std::shared_ptr<const RayScene> rays;
  };
  static std::mutex mutex;
  static std::array<Entry, 2> entries;  // the latest first
  const uint64_t still = stillKey(scene, geometry, passing), moving = movingKey(geometry);
  const auto is = [&](const Entry& e) { return e.rays && e.still == still && e.moving == moving; };
  const std::scoped_lock lock(mutex);
  if (!is(entries[0])) std::swap(entries[0], entries[1]);
  if (is(entries[0])) return entries[0].rays;
  for (const Entry& e : entries)
    if (e.rays && e.still == still) {
      entries[0] = {still, moving,
                    std::shared_ptr<const RayScene>(new RayScene(e.rays->impl_->still, geometry))};
      return entries[0].rays;
    }
  entries[0] = {still, moving, std::make_shared<RayScene>(scene, geometry, passing)};
  return entries[0].rays;
}

TriangleVertices triangleVertices(const Geometry& geometry, uint32_t triangle) {
  const Triangle& t = geometry.triangles[triangle];
  TriangleVertices result;
  for (int k = 0; k < 3; ++k) {
    result.positions[k] = geometry.positions[t.v[k]];
    result.normals[k] = geometry.normals.empty() ? glm::vec3(0) : geometry.normals[t.v[k]];
    result.uvs[k] = geometry.uvs.empty() ? glm::vec2(0) : geometry.uvs[t.v[k]];
  }
  result.materialAndObject = t.materialAndObject;
  return result;
}

SurfaceHit surfaceAt(const TriangleVertices& t, float u, float v) {
  const float w = 1.0f - u - v;
  const glm::vec3 &a = t.positions[0], &b = t.positions[1], &c = t.positions[2];
  SurfaceHit s;
  s.position = a * w + b * u + c * v;
  const glm::vec3 n = glm::cross(b - a, c - a);
  const float length = glm::length(n);
  s.geometricNormal = length > 0 ? n / length : glm::vec3(0, 1, 0);
  s.shadingNormal = s.geometricNormal;
  const glm::vec3 m = t.normals[0] * w + t.normals[1] * u + t.normals[2] * v;
  const float shadingLength = glm::length(m);
  if (shadingLength > 1e-12f) s.shadingNormal = m / shadingLength;
  // In some models normals contradict the winding; the winding decides.
  if (glm::dot(s.shadingNormal, s.geometricNormal) < 0) s.shadingNormal = -s.shadingNormal;
  s.uv = t.uvs[0] * w + t.uvs[1] * u + t.uvs[2] * v;
  const Triangle ids{{0, 0, 0}, t.materialAndObject};
  s.material = ids.material();
  s.object = ids.object();
  return s;
}

SurfaceHit surfaceAt(const Geometry& geometry, const RayHit& hit) {
  return surfaceAt(triangleVertices(geometry, hit.triangle), hit.u, hit.v);
}

}  // namespace fovea::scene
