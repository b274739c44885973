#include "framework/scene/rays/ray_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <utility>
#include <vector>

#include "framework/base/hash.h"
#include "framework/scene/rays/ray_tracer.h"
#include "shaders/records/rays.h"

namespace fovea::scene {
namespace {

// What a look-up needs of one material with holes: a scene with this material and its base colour texture alone.
struct Mask {
  Scene scene;
};

Mask makeMask(const Scene& scene, const Material& material) {
  Mask mask;
  mask.scene.materials = {material};
  TextureUse& use = mask.scene.materials[0].baseColorTexture;
  if (use && use.texture < scene.textures.size()) {
    mask.scene.textures = {scene.textures[use.texture]};
    use.texture = 0;
  } else {
    use = {};
  }
  return mask;
}

bool hasHoles(const Material& m, Passing passing) {
  return m.masked && (passing == Passing::Never || !m.blended);
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
  // Triangles with holes only: the texture coordinates of their vertices, and the alpha of the vertex colours, found
  // through the triangle's index.
  std::vector<uint32_t>
      maskOfTriangle;  // index into masks, kNoIndex for opaque; empty when nothing has holes
  std::vector<std::array<glm::vec3, 3>> corners;
  std::vector<Mask> masks;
  bool meetsTransparency = false;
  double area = 0;

  Still(const Scene& scene, const Geometry& geometry, Passing passing) {
    meetsTransparency = passing == Passing::Met && std::ranges::any_of(scene.materials, letsLightThrough);
    addMasks(scene, geometry, passing);
    const uint32_t end = std::min(geometry.staticTriangles, uint32_t(geometry.triangles.size()));
    tracer = makeTracer(geometry, accepts(), {0, end});
    area = areaOf(geometry, 0, end);
  }

  RayTracer::Accepts accepts() const {
    if (masks.empty()) return {};
    return [this](uint32_t t, float u, float v) { return opaqueAt(t, u, v); };
  }

  bool opaqueAt(uint32_t triangle, float u, float v) const {
    const uint32_t m = maskOfTriangle[triangle];
    if (m == kNoIndex) return true;
    const Scene& s = masks[m].scene;
    const auto& t = corners[triangle];
    const glm::vec3 at = t[0] * (1.0f - u - v) + t[1] * u + t[2] * v;
    const Material& material = s.materials[0];
    return coverage(s, material, glm::vec2(at), at.z, false) > 0;
  }

  void addMasks(const Scene& from, const Geometry& geometry, Passing passing) {
    std::vector<uint32_t> maskOfMaterial(from.materials.size(), kNoIndex);
    for (size_t i = 0; i < from.materials.size(); ++i) {
      if (!hasHoles(from.materials[i], passing)) continue;
      maskOfMaterial[i] = uint32_t(masks.size());
      masks.push_back(makeMask(from, from.materials[i]));
    }
    if (masks.empty()) return;
    maskOfTriangle.assign(geometry.triangles.size(), kNoIndex);
    corners.resize(geometry.triangles.size());
    for (size_t t = 0; t < geometry.triangles.size(); ++t) {
      const Triangle& triangle = geometry.triangles[t];
      if (triangle.material() >= maskOfMaterial.size()) continue;
      maskOfTriangle[t] = maskOfMaterial[triangle.material()];
      for (int k = 0; k < 3; ++k)
        corners[t][size_t(k)] = {geometry.uvs.empty() ? glm::vec2(0) : geometry.uvs[triangle.v[k]],
                                 geometry.colors.empty() ? 1.0f : geometry.colors[triangle.v[k]].a};
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
  i.epsilon = kRayEpsilon * std::max(glm::length(geometry.boundsMax - geometry.boundsMin), kLeastDiagonal);
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

bool RayScene::isSolid(const RayHit& point) const {
  const Still& still = *impl_->still;
  return still.masks.empty() || still.opaqueAt(point.triangle, point.u, point.v);
}

bool RayScene::meetsTransparency() const { return impl_->still->meetsTransparency; }
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
  Hasher hash;
  hash.add(geometry.stillKey != 0 ? geometry.stillKey : stillKey(scene, geometry));
  // Where nothing lets light through, all ways of passing are the same.
  hash.add(std::ranges::any_of(scene.materials, letsLightThrough) ? uint32_t(passing) : 0);
  const uint64_t still = hash.value(), moving = movingKey(geometry);
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

uint64_t stillKey(const Scene& scene, const Geometry& geometry) {
  Hasher hash;
  hash.add(geometry.positions.data(), geometry.staticVertices());
  hash.add(geometry.triangles);
  hash.add(geometry.uvs);
  for (const glm::vec4& color : geometry.colors) hash.add(color.a);
  hash.add(&geometry.staticTriangles, 1);
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    if (!m.masked) continue;
    const TextureUse& use = m.baseColorTexture;
    hash.add(std::array<float, 9>{float(i), m.baseColor.a, m.alphaCutoff, use.transform[0].x,
                                  use.transform[0].y, use.transform[1].x, use.transform[1].y,
                                  use.transform[2].x, use.transform[2].y});
    hash.add(std::array<uint32_t, 5>{uint32_t(m.blended), use.texture, uint32_t(use.wrapU),
                                     uint32_t(use.wrapV), uint32_t(use.nearest)});
    if (use && use.texture < scene.textures.size()) hash.add(scene.textures[use.texture].rgba);
  }
  return std::max<uint64_t>(hash.value(), 1);
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
  if (shadingLength > 1e-6f) s.shadingNormal = m / shadingLength;
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
