#include "passes/path-trace/path_integrator.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>

#include "framework/base/low_discrepancy.h"
#include "framework/base/random.h"
#include "framework/scene/lights.h"
#include "framework/scene/paraboloid.h"
#include "framework/scene/texture_taps.h"

namespace fovea::passes {
namespace {

using namespace scene;

constexpr float kInversePi = glm::one_over_pi<float>();

// Shadow rays end just before what they ask for.
constexpr float kShadowEnd = 0.9999f;

glm::vec3 cosineDirection(glm::vec3 normal, float u, float v) {
  const float r = std::sqrt(u), phi = glm::two_pi<float>() * v;
  return toWorld(orthonormalFrame(normal), {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - u)});
}

glm::vec3 reflectanceOf(const Material& material, glm::vec4 texture) {
  return glm::vec3(material.baseColor) * glm::vec3(texture) * (1.0f - material.metallic);
}

// Distance along a ray, in lengths of its direction, to where clip-space depth is 0 (near plane) or w (far
// plane).
Ray clipped(const View& view, glm::vec3 direction) {
  Ray ray;
  ray.origin = view.eye;
  ray.direction = direction;
  const glm::vec4 a = view.worldToClip * glm::vec4(view.eye, 1),
                  b = view.worldToClip * glm::vec4(direction, 0);
  if (b.z != 0) ray.near = std::max(0.0f, -a.z / b.z);
  if (const float far = (a.w - a.z) / (b.z - b.w); far > ray.near) ray.far = far;
  return ray;
}

}  // namespace

float PathSampler::number(uint32_t k) const {
  return independent ? uniformFloat(hashCombine(stream, k)) : sobol(index, k, stream);
}

std::array<float, 2> PathSampler::pair(uint32_t k) const {
  if (independent) return {number(k), number(k + 1)};
  return sobolPair(index, k, stream);
}

// One path under way.
struct PathIntegrator::Path {
  PathVertex vertex;
  glm::vec3 light{0}, throughput{0};
  Ray ray;  // from the vertex
  RayHit hit;
  SurfaceHit surface;
  TextureTaps texture;
  glm::vec3 irradiance{0};  // of the last surface
};

PathIntegrator::PathIntegrator(const Frame& frame, const View& view, const RayScene& rays, uint32_t depth)
    : frame_(frame), view_(view), rays_(rays), emitters_(frame), depth_(depth) {
  triangles_.reserve(frame.geometry->triangles.size());
  for (uint32_t t = 0; t < frame.geometry->triangles.size(); ++t)
    triangles_.push_back(triangleVertices(*frame.geometry, t));
  copyTexels();
}

// Squares of 32 texels fill one page, squares of 4 one cache line: a look-up rarely needs more than one of
// either.
size_t PathIntegrator::TexelBlocks::at(uint32_t x, uint32_t y) const {
  const size_t block = size_t(y / 32) * blocksPerRow + x / 32;
  const uint32_t tile = y / 4 % 8 * 8 + x / 4 % 8, texel = y % 4 * 4 + x % 4;
  return first + 4 * (block * 1024 + tile * 16 + texel);
}

void PathIntegrator::copyTexels() {
  const Scene& scene = *frame_.scene;
  blocks_.resize(scene.textures.size());
  size_t size = 0;
  for (const Material& m : scene.materials) {
    const uint32_t i = m.baseColorTexture.texture;
    if (i >= scene.textures.size() || blocks_[i].width != 0) continue;
    const Texture& t = scene.textures[i];
    if (t.width == 0 || t.height == 0) continue;
    blocks_[i] = {t.width, t.height, (t.width + 31) / 32, t.srgb, size};
    size += size_t(4096) * blocks_[i].blocksPerRow * ((t.height + 31) / 32);
  }
  texels_.resize(size);
  for (size_t i = 0; i < blocks_.size(); ++i) {
    const TexelBlocks& blocks = blocks_[i];
    const uint8_t* from = scene.textures[i].rgba.data();
    for (uint32_t y = 0; y < blocks.height; ++y)
      for (uint32_t x = 0; x < blocks.width; ++x, from += 4) std::memcpy(&texels_[blocks.at(x, y)], from, 4);
  }
}

RayHit PathIntegrator::intersect(const Ray& ray, uint64_t& rays) const {
  ++rays;
  if (record_ != nullptr) record_->push_back({ray, false});
  return rays_.intersect(ray);
}

bool PathIntegrator::occluded(const Ray& ray, uint64_t& rays) const {
  ++rays;
  if (record_ != nullptr) record_->push_back({ray, true});
  return rays_.occluded(ray);
}

PathVertex PathIntegrator::vertexAt(const SurfaceHit& s, glm::vec3 direction) const {
  const float side = glm::dot(s.geometricNormal, direction) < 0 ? 1.0f : -1.0f;
  PathVertex v;
  v.normal = side * s.shadingNormal;
  v.face = side * s.geometricNormal;
  v.position = s.position;
  // Off the surface and back along the ray, where there is nothing: also where two walls meet, whose seam a
  // step away from one of them would not leave.
  v.origin = s.position + (v.face - direction) * rays_.epsilon();
  return v;
}

EyePoint PathIntegrator::look(glm::vec2 pixel, uint64_t& rays) const {
  EyePoint point;
  Ray ray = clipped(view_, view_.rayDirection(pixel));
  while (const RayHit hit = intersect(ray, rays)) {
    const SurfaceHit s = surfaceAt(*frame_.geometry, hit);
    const Material& material = frame_.scene->materials[s.material];
    const bool front = glm::dot(s.geometricNormal, ray.direction) < 0;
    if (!front && !material.doubleSided) {
      ray.near = std::nextafter(hit.distance, ray.far) * (1.0f + 1e-6f);
      continue;
    }
    point.surface = true;
    point.vertex = vertexAt(s, glm::normalize(ray.direction));
    point.vertex.reflectance =
        reflectanceOf(material, sampleTexture(*frame_.scene, material.baseColorTexture, s.uv));
    point.direct = emission(*frame_.scene, material, s.uv);
    if (depth_ >= 2) point.direct += point.vertex.reflectance * kInversePi * allLights(point.vertex, rays);
    return point;
  }
  point.direct = frame_.scene->environment;
  return point;
}

glm::vec3 PathIntegrator::unshadowed(const Light& light, const PathVertex& v, Ray& shadowRay) const {
  const LightSample l = sampleLight(light, v.position);
  const float cosine = glm::dot(v.normal, l.direction);
  if (cosine <= 0 || glm::dot(v.face, l.direction) <= 0) return glm::vec3(0);
  shadowRay.origin = v.origin;
  shadowRay.direction = l.direction;
  if (l.distance < kFarAway) shadowRay.far = l.distance * kShadowEnd;
  return l.irradiance * cosine;
}

glm::vec3 PathIntegrator::allLights(const PathVertex& v, uint64_t& rays) const {
  glm::vec3 sum(0);
  for (const Light& light : frame_.lights) {
    Ray shadowRay;
    const glm::vec3 e = unshadowed(light, v, shadowRay);
    if (e != glm::vec3(0) && !occluded(shadowRay, rays)) sum += e;
  }
  return sum;
}

// One of the lights, in proportion to what it would do if nothing were in between; the random number is
// stretched over the outcome of each decision, so that one is enough.
glm::vec3 PathIntegrator::oneLight(const PathVertex& v, const PathSampler& random, uint32_t k,
                                   uint64_t& rays) const {
  glm::vec3 chosen(0);
  Ray shadowRay;
  float u = frame_.lights.size() > 1 ? random.number(k) : 0.0f, sum = 0, chosenWeight = 0;
  for (const Light& light : frame_.lights) {
    Ray ray;
    const glm::vec3 e = unshadowed(light, v, ray);
    const float weight = e.r + e.g + e.b;
    if (!(weight > 0)) continue;
    sum += weight;
    const float p = weight / sum;
    if (u < p) {
      u /= p;
      chosen = e;
      chosenWeight = weight;
      shadowRay = ray;
    } else {
      u = (u - p) / (1.0f - p);
    }
  }
  if (sum == 0 || occluded(shadowRay, rays)) return glm::vec3(0);
  return chosen * (sum / chosenWeight);
}

// Both ways to an emissive triangle, a point chosen on it and a bounce that happens to hit it, are weighted
// by the balance heuristic (Veach and Guibas 1995): neither has spikes, where emitters touch other surfaces
// or where they are small.
glm::vec3 PathIntegrator::emitterLight(const PathVertex& v, float choice, float u1, float u2,
                                       uint64_t& rays) const {
  const EmitterPoint p = emitters_.sample(v.origin, choice, u1, u2);
  Ray ray;
  ray.origin = v.origin;
  ray.direction = p.position + p.normal * rays_.epsilon() - v.origin;
  const float d2 = glm::dot(ray.direction, ray.direction);
  if (!(d2 > 0) || p.radiance == glm::vec3(0)) return glm::vec3(0);
  const glm::vec3 w = ray.direction / std::sqrt(d2);
  const float cosine = glm::dot(v.normal, w), cosineEmitter = -glm::dot(p.normal, w);
  if (cosine <= 0 || cosineEmitter <= 0 || glm::dot(v.face, w) <= 0) return glm::vec3(0);
  ray.far = kShadowEnd;
  if (occluded(ray, rays)) return glm::vec3(0);
  const float density = p.density * d2 / cosineEmitter;  // per sr
  return p.radiance * (cosine * kInversePi / (density + cosine * kInversePi));
}

// Light that arrives at the vertex, as far as it is asked for directly; then the ray to the next one. `edges`
// join the vertex to the eye; the light that it reflects has come along one more at least. Random numbers of
// a vertex: two for the direction, one for the light, one unused; two for the point on an emitter, one for
// which.
bool PathIntegrator::leave(Path& path, uint32_t edges, const PathSampler& random, uint64_t& rays) const {
  const PathVertex& v = path.vertex;
  const uint32_t k = 8 * edges;
  if (edges > 1) path.light += path.throughput * kInversePi * oneLight(v, random, k + 2, rays);
  if (!emitters_.empty()) {
    const std::array<float, 2> u = random.pair(k + 4);
    path.light += path.throughput * emitterLight(v, random.number(k + 6), u[0], u[1], rays);
  }
  const std::array<float, 2> u = random.pair(k);
  path.ray.origin = v.origin;
  path.ray.direction = cosineDirection(v.normal, u[0], u[1]);
  if (glm::dot(path.ray.direction, v.face) <= 0) return false;
  path.hit = intersect(path.ray, rays);
  if (!path.hit) return false;
  const auto* triangle = reinterpret_cast<const char*>(&triangles_[path.hit.triangle]);
  __builtin_prefetch(triangle);
  __builtin_prefetch(triangle + 64);
  return true;
}

// What was hit.
bool PathIntegrator::arrive(Path& path) const {
  path.surface = surfaceAt(triangles_[path.hit.triangle], path.hit.u, path.hit.v);
  const bool front = glm::dot(path.surface.geometricNormal, path.ray.direction) < 0;
  return front || frame_.scene->materials[path.surface.material].doubleSided;
}

// Where its texture lies; what is there will be needed soon.
void PathIntegrator::findTexture(Path& path) const {
  const TextureUse& use = frame_.scene->materials[path.surface.material].baseColorTexture;
  path.texture = {};
  if (use.texture >= blocks_.size() || blocks_[use.texture].width == 0) return;
  const TexelBlocks& blocks = blocks_[use.texture];
  const TexelSquare square = texelSquare(blocks.width, blocks.height, use, path.surface.uv);
  for (uint32_t i = 0; i < 4; ++i)
    path.texture.texel[i] = &texels_[blocks.at(square.column[i % 2], square.row[i / 2])];
  path.texture.right = square.right;
  path.texture.lower = square.lower;
  path.texture.srgb = blocks.srgb;
  path.texture.prefetch();
}

bool PathIntegrator::reflect(Path& path, uint32_t edges) const {
  const SurfaceHit& s = path.surface;
  const Material& material = frame_.scene->materials[s.material];
  if (const float density = emitters_.density(path.hit.triangle); density > 0) {
    const float cosineEmitter = std::abs(glm::dot(s.geometricNormal, path.ray.direction));
    const float other =
        density * path.hit.distance * path.hit.distance / std::max(cosineEmitter, 1e-12f);  // per sr
    const float own = glm::dot(path.vertex.normal, path.ray.direction) * kInversePi;
    path.light += path.throughput * emission(*frame_.scene, material, s.uv) * (own / (own + other));
  }
  if (edges + 1 == depth_) return false;
  path.vertex = vertexAt(s, path.ray.direction);
  path.vertex.reflectance = reflectanceOf(material, sample(path.texture));
  path.throughput *= path.vertex.reflectance;
  return path.throughput != glm::vec3(0);
}

// The last reflection of a path that no emitter can add to: many of these surfaces lie in shadow, and their
// textures need not be asked for.
bool PathIntegrator::lightLast(Path& path, uint32_t edges, const PathSampler& random, uint64_t& rays) const {
  path.irradiance = oneLight(vertexAt(path.surface, path.ray.direction), random, 8 * edges + 2, rays);
  if (path.irradiance == glm::vec3(0)) return false;
  findTexture(path);
  return true;
}

void PathIntegrator::reflectLast(Path& path) const {
  const Material& material = frame_.scene->materials[path.surface.material];
  path.throughput *= reflectanceOf(material, sample(path.texture));
  path.light += path.throughput * kInversePi * path.irradiance;
}

void PathIntegrator::indirect(const PathVertex& first, std::span<const PathSampler> random,
                              std::span<glm::vec3> light, uint64_t& rays) const {
  std::array<Path, kMaxPaths> paths;
  std::array<uint8_t, kMaxPaths> alive;  // their numbers
  size_t count = random.size();
  for (size_t i = 0; i < count; ++i) {
    paths[i].vertex = first;
    paths[i].throughput = first.reflectance;
    alive[i] = uint8_t(i);
  }
  const auto keepThose = [&](const auto& that) {
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i)
      if (that(alive[i])) alive[kept++] = alive[i];
    count = kept;
  };
  // Without emitters the last edge is a shadow ray.
  const uint32_t others = emitters_.empty() ? 2 : 1, bounces = std::max(depth_, others) - others;
  for (uint32_t edges = 1; edges <= bounces && count > 0; ++edges) {
    const bool last = emitters_.empty() && edges == bounces;
    const auto look = [&](uint8_t i) {
      if (!arrive(paths[i])) return false;
      if (!last) findTexture(paths[i]);
      return true;
    };
    // Each path looks at what it hit while the next one's ray is under way.
    size_t kept = 0;
    bool waits = false;
    uint8_t latest = 0;
    for (size_t n = 0; n < count; ++n) {
      const uint8_t i = alive[n];
      if (!leave(paths[i], edges, random[i], rays)) continue;
      if (waits && look(latest)) alive[kept++] = latest;
      latest = i;
      waits = true;
    }
    if (waits && look(latest)) alive[kept++] = latest;
    count = kept;
    if (last) {
      keepThose([&](uint8_t i) { return lightLast(paths[i], edges + 1, random[i], rays); });
      for (size_t n = 0; n < count; ++n) reflectLast(paths[alive[n]]);
    } else {
      keepThose([&](uint8_t i) { return reflect(paths[i], edges); });
    }
  }
  for (size_t i = 0; i < random.size(); ++i) light[i] = paths[i].light;
}

}  // namespace fovea::passes
