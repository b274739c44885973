#include "passes/path-trace/path_integrator.h"

#include <algorithm>
#include <cmath>
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

std::array<float, 4> PathSampler::group(uint32_t number) const {
  if (!independent) return sobolGroup(index, number, stream);
  std::array<float, 4> u;
  for (uint32_t k = 0; k < 4; ++k) u[k] = uniformFloat(hashCombine(stream, 4 * number + k));
  return u;
}

// One path under way.
struct PathIntegrator::Path {
  PathVertex vertex;
  glm::vec3 light{0}, throughput{0};
  Ray ray;  // from the vertex
  RayHit hit;
  SurfaceHit surface;
  TextureTaps texture;
};

PathIntegrator::PathIntegrator(const Frame& frame, const View& view, const RayScene& rays, uint32_t depth)
    : frame_(frame), view_(view), rays_(rays), emitters_(frame), depth_(depth) {
  triangles_.reserve(frame.geometry->triangles.size());
  for (uint32_t t = 0; t < frame.geometry->triangles.size(); ++t)
    triangles_.push_back(triangleVertices(*frame.geometry, t));
  copyTexels();
}

void PathIntegrator::copyTexels() {
  const Scene& scene = *frame_.scene;
  firstTexel_.assign(scene.textures.size(), 0);
  std::vector<bool> used(scene.textures.size());
  size_t size = 0;
  for (const Material& m : scene.materials) {
    const uint32_t texture = m.baseColorTexture.texture;
    if (texture >= scene.textures.size() || used[texture]) continue;
    used[texture] = true;
    firstTexel_[texture] = size;
    size += scene.textures[texture].rgba.size();
  }
  texels_.resize(size);
  for (size_t i = 0; i < used.size(); ++i)
    if (used[i])
      std::copy(scene.textures[i].rgba.begin(), scene.textures[i].rgba.end(), &texels_[firstTexel_[i]]);
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

PathVertex PathIntegrator::vertexAt(const SurfaceHit& s, const Material& material, glm::vec3 direction,
                                    glm::vec3 texture) const {
  const float side = glm::dot(s.geometricNormal, direction) < 0 ? 1.0f : -1.0f;
  PathVertex v;
  v.normal = side * s.shadingNormal;
  v.face = side * s.geometricNormal;
  v.position = s.position;
  // Off the surface and back along the ray, where there is nothing: also where two walls meet, whose seam a
  // step away from one of them would not leave.
  v.origin = s.position + (v.face - direction) * rays_.epsilon();
  v.reflectance = glm::vec3(material.baseColor) * texture * (1.0f - material.metallic);
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
    point.vertex = vertexAt(s, material, glm::normalize(ray.direction),
                            glm::vec3(sampleTexture(*frame_.scene, material.baseColorTexture, s.uv)));
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
glm::vec3 PathIntegrator::oneLight(const PathVertex& v, float u, uint64_t& rays) const {
  glm::vec3 chosen(0);
  Ray shadowRay;
  float sum = 0, chosenWeight = 0;
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
// join the vertex to the eye; the light that it reflects has come along one more at least.
bool PathIntegrator::leave(Path& path, uint32_t edges, const PathSampler& random, uint64_t& rays) const {
  const PathVertex& v = path.vertex;
  const std::array<float, 4> u = random.group(2 * edges);
  if (edges > 1) path.light += path.throughput * kInversePi * oneLight(v, u[2], rays);
  if (!emitters_.empty()) {
    const std::array<float, 4> w = random.group(2 * edges + 1);
    path.light += path.throughput * emitterLight(v, w[2], w[0], w[1], rays);
  } else if (edges + 1 == depth_) {
    return false;  // nothing a further hit could add
  }
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

// What was hit, and where its texture lies.
bool PathIntegrator::arrive(Path& path) const {
  path.surface = surfaceAt(triangles_[path.hit.triangle], path.hit.u, path.hit.v);
  const bool front = glm::dot(path.surface.geometricNormal, path.ray.direction) < 0;
  const Material& material = frame_.scene->materials[path.surface.material];
  if (!front && !material.doubleSided) return false;
  path.texture = textureTaps(*frame_.scene, material.baseColorTexture, path.surface.uv);
  if (path.texture.texel[0] != nullptr) {
    const uint32_t texture = material.baseColorTexture.texture;
    const uint8_t *from = frame_.scene->textures[texture].rgba.data(), *to = &texels_[firstTexel_[texture]];
    for (const uint8_t*& texel : path.texture.texel) texel = to + (texel - from);
    path.texture.prefetch();
  }
  return true;
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
  path.vertex = vertexAt(s, material, path.ray.direction, glm::vec3(sample(path.texture)));
  path.throughput *= path.vertex.reflectance;
  return path.throughput != glm::vec3(0);
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
  for (uint32_t edges = 1; edges < depth_ && count > 0; ++edges) {
    keepThose([&](uint8_t i) { return leave(paths[i], edges, random[i], rays); });
    keepThose([&](uint8_t i) { return arrive(paths[i]); });
    keepThose([&](uint8_t i) { return reflect(paths[i], edges); });
  }
  for (size_t i = 0; i < random.size(); ++i) light[i] = paths[i].light;
}

}  // namespace fovea::passes
