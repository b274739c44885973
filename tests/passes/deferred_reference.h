// A plain CPU version of pass deferred, and G-buffers as input for both.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "fovea/test.h"
#include "shaders/records/vpl.h"
#include "tests/references/paraboloid.h"
#include "tests/support/pixel_rays.h"

namespace fovea::test {

inline glm::vec2 octEncode(glm::vec3 n) {
  n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (n.z >= 0) return glm::vec2(n);
  return {(1 - std::abs(n.y)) * (n.x >= 0 ? 1.0f : -1.0f), (1 - std::abs(n.x)) * (n.y >= 0 ? 1.0f : -1.0f)};
}

inline float halfRound(float x) { return glm::unpackHalf1x16(glm::packHalf1x16(x)); }
inline glm::vec3 halfRound(glm::vec3 v) { return {halfRound(v.x), halfRound(v.y), halfRound(v.z)}; }

struct SurfacePixel {
  glm::vec3 position{0};
  float distance = 0;  // to the eye; 0 in the background
  glm::vec3 normal{0, 1, 0};
  glm::vec3 albedo{0.5f};
  glm::vec4 specular{0};            // rgb: reflectance at normal incidence, a: roughness
  float grazing = 0, metallic = 0;  // in alpha of the normal and of the albedo
};

struct GBuffer {
  int width = 0, height = 0;
  std::vector<SurfacePixel> pixels;
  const SurfacePixel& at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }

  scene::PixelRays camera;

  // Without a camera, a pass can only read the other members, or background.
  GBuffer(int w, int h, const std::function<SurfacePixel(int, int)>& pixel) : width(w), height(h) {
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        SurfacePixel p = pixel(x, y);
        p.normal = halfRound(p.normal);
        p.albedo = halfRound(p.albedo);
        pixels.push_back(p);
      }
    }
  }

  // Surfaces that do not lie on the rays of their pixels are moved onto them, at the same distance from the eye.
  GBuffer(int w, int h, const scene::PixelRays& rays, const std::function<SurfacePixel(int, int)>& pixel)
      : GBuffer(w, h, pixel) {
    camera = rays;
    for (int i = 0; i < w * h; ++i) {
      SurfacePixel& p = pixels[size_t(i)];
      if (p.distance > 0) p.distance = glm::distance(p.position, rays.eye);
      p.position = pointOn(rays, i % w, i / w, p.distance);
    }
  }

  bool full = false;  // materials

  // Those members of the bundle at `port` that the pass reads.
  void wire(PassTest& test, const std::string& port = "gbuffer") const {
    std::vector<glm::vec4> position;
    std::vector<float> distance;
    std::vector<uint16_t> normal, face, albedo, specular;
    const auto half = [](std::vector<uint16_t>& to, std::initializer_list<float> values) {
      for (float v : values) to.push_back(glm::packHalf1x16(v));
    };
    for (const SurfacePixel& p : pixels) {
      position.emplace_back(p.position, p.distance);
      distance.push_back(p.distance);
      half(normal, {p.normal.x, p.normal.y, p.normal.z, p.grazing});
      const glm::vec2 oct = octEncode(glm::normalize(p.normal));
      for (const float v : {oct.x, oct.y}) face.push_back(glm::packSnorm1x16(v));
      half(albedo, {p.albedo.r, p.albedo.g, p.albedo.b, p.metallic});
      if (full || specular.empty()) half(specular, {p.specular.r, p.specular.g, p.specular.b, p.specular.a});
    }
    const auto w = uint32_t(width), h = uint32_t(height);
    test.viewSize(w, h);
    for (const graph::MemberSpec& m : test.declaration().findPort(port)->members) {
      const std::string name = port + "." + m.name;
      if (m.name == "position") test.image(name, VK_FORMAT_R32G32B32A32_SFLOAT, w, h, 1, position);
      if (m.name == "distance") wireSurfaces(test, port, camera, width, height, distance);
      if (m.name == "normal") test.image(name, VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, normal);
      if (m.name == "face") test.image(name, VK_FORMAT_R16G16_SNORM, w, h, 1, face);
      if (m.name == "albedo") test.image(name, VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, albedo);
      if (m.name == "specular")
        test.image(name, VK_FORMAT_R16G16B16A16_SFLOAT, full ? w : 1, full ? h : 1, 1, specular);
    }
  }
};

struct DeferredReference {
  bool disc = false;
  double clampDistance = 1.5;
  int interleave = 1;
  double filterPlane = 0.005, filterAngle = 25;
  const std::vector<uint32_t>* atlas = nullptr;  // `size` x `size` x VPLs, the bits of floats
  int size = 0;
  const std::vector<uint8_t>* mask = nullptr;    // which pixels are shaded; all if null
  const std::vector<glm::vec3>* base = nullptr;  // irradiance / pi of the others
  int nearTies = 0;                              // shadow comparisons too close to call in single precision

  // E / pi at a surface from the VPLs first, first + step, ...
  glm::dvec3 shade(const SurfacePixel& p, const std::vector<scene::Vpl>& vpls, size_t first, size_t step) {
    glm::dvec3 sum(0);
    for (size_t i = first; i < vpls.size(); i += step) {
      const scene::Vpl& v = vpls[i];
      const glm::dvec3 to = glm::dvec3(p.position) - glm::dvec3(v.position);
      const double d = glm::length(to);
      const double cosines = std::max(-glm::dot(glm::dvec3(p.normal), to) / d, 0.0) *
                             std::max(glm::dot(glm::dvec3(v.normal), to) / d, 0.0);
      if (cosines == 0 || (atlas && !lit(p, v, i))) continue;
      const double clamped = std::max(d, clampDistance);
      const double kernel = disc ? 1 / (d * d + v.area / glm::pi<double>()) : 1 / (clamped * clamped);
      sum += cosines * kernel * glm::dvec3(v.intensity) / glm::pi<double>();
    }
    return sum;
  }

  // Compares the map's distance with that of the receiver's tangent plane along the direction of the texel's centre.
  bool lit(const SurfacePixel& p, const scene::Vpl& v, size_t slot) {
    const glm::mat3 frame = scene::orthonormalFrame(v.normal);
    const glm::vec3 local = scene::toLocal(frame, p.position - v.position);
    const float length = glm::length(local);
    const glm::ivec2 texel = scene::paraboloidTexel(scene::paraboloidProject(local, length), size);
    const uint32_t bits = (*atlas)[(slot * size_t(size) + size_t(texel.y)) * size_t(size) + size_t(texel.x)];
    if (bits == scene::kParaboloidEmpty) return true;
    float stored;
    std::memcpy(&stored, &bits, sizeof stored);
    const glm::vec3 centre = scene::paraboloidTexelDirection(texel, size);
    const glm::vec3 face = scene::toLocal(frame, glm::normalize(p.normal));
    const float facing = -glm::dot(face, centre);
    const float plane = facing > 1e-3f ? -glm::dot(face, local) / facing : length;
    const float footprint = length * 2.0f / float(size) * (1 + centre.z);
    const float limit = std::min(plane, length) - (0.5f * footprint + 1e-3f);
    if (std::abs(stored - limit) < 2e-3f * length) ++nearTies;
    return stored >= limit;
  }

  // The filter, first per subset and then over subsets.
  std::vector<glm::dvec3> irradiance(const GBuffer& g, const std::vector<scene::Vpl>& vpls) {
    const int n = interleave;
    std::vector<glm::dvec3> partial(g.pixels.size()), result(g.pixels.size());
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x)
        if (g.at(x, y).distance > 0)
          partial[size_t(y * g.width + x)] =
              double(n * n) * shade(g.at(x, y), vpls, size_t((y % n) * n + x % n), size_t(n * n));
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x)
        if (g.at(x, y).distance > 0) {
          const size_t i = size_t(y * g.width + x);
          result[i] = mask && !(*mask)[i] ? glm::dvec3((*base)[i])
                      : n == 1            ? partial[i]
                                          : filter(g, partial, x, y);
        }
    return result;
  }

  // The same if only one pixel in each square of 2 x 2 is shaded.
  std::vector<glm::dvec3> coarseIrradiance(const GBuffer& g, const std::vector<scene::Vpl>& vpls) {
    const int n = interleave;
    const GBuffer grid((g.width + 1) / 2, (g.height + 1) / 2, [&](int x, int y) {
      return g.at(std::min(2 * x + (y & 1), g.width - 1), std::min(2 * y + (x & 1), g.height - 1));
    });
    std::vector<glm::dvec3> partial(grid.pixels.size()), result(g.pixels.size());
    for (int y = 0; y < grid.height; ++y)
      for (int x = 0; x < grid.width; ++x)
        if (grid.at(x, y).distance > 0)
          partial[size_t(y * grid.width + x)] =
              double(n * n) * shade(grid.at(x, y), vpls, size_t((y % n) * n + x % n), size_t(n * n));
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x)
        if (g.at(x, y).distance > 0)
          result[size_t(y * g.width + x)] = coarseFilter(grid, partial, x / 2, y / 2, g.at(x, y));
    return result;
  }

 private:
  struct Search {
    const GBuffer& g;
    const std::vector<glm::dvec3>& partial;
    SurfacePixel centre;
    int x, y;  // where its window lies
    double plane, least;
    const std::vector<uint8_t>* mask;

    bool shaded(int qx, int qy) const { return !mask || (*mask)[size_t(qy * g.width + qx)]; }
    bool sameSurface(int qx, int qy) const {
      if (qx < 0 || qy < 0 || qx >= g.width || qy >= g.height || g.at(qx, qy).distance <= 0) return false;
      const SurfacePixel& q = g.at(qx, qy);
      return std::abs(glm::dot(q.position - centre.position, centre.normal)) <= plane &&
             glm::dot(q.normal, centre.normal) >= least;
    }
    glm::dvec3 value(int qx, int qy) const { return partial[size_t(qy * g.width + qx)]; }

    // A subset's sample from the other side of the pixel, or else from the wide window, where nearer samples have
    // more weight; a says whether there is one.
    glm::dvec4 wide(int ax, int ay, int n) const {
      glm::dvec4 s(0);
      const auto add = [&](int dx, int dy) {
        if (sameSurface(x + dx, y + dy) && shaded(x + dx, y + dy))
          s += glm::dvec4(value(x + dx, y + dy), 1) / double(std::max(dx * dx + dy * dy, 1));
      };
      const int inX = ax < n - n / 2 ? ax : ax - n, inY = ay < n - n / 2 ? ay : ay - n;
      const int acrossX = inX < 0 ? inX + n : inX - n, acrossY = inY < 0 ? inY + n : inY - n;
      add(acrossX, inY);
      add(inX, acrossY);
      add(acrossX, acrossY);
      if (s.w == 0)
        for (int j = -2; j < 2; ++j)
          for (int i = -2; i < 2; ++i) add(ax + n * i, ay + n * j);
      return s.w > 0 ? s / s.w : s;
    }
  };

  Search strictly(const GBuffer& g, const std::vector<glm::dvec3>& partial, int x, int y,
                  const SurfacePixel& centre) const {
    return {g,   partial, centre, x, y, filterPlane * centre.distance, std::cos(glm::radians(filterAngle)),
            mask};
  }
  static Search relaxed(Search how) {
    how.plane *= 8;
    how.least = 0.5;
    return how;
  }
  // Adds what is found of the missing subsets, and removes them from the list.
  static void search(const Search& how, int n, std::vector<glm::ivec2>& missing, glm::dvec4& sum) {
    std::erase_if(missing, [&](const glm::ivec2& m) {
      const glm::dvec4 v = how.wide(m.x, m.y, n);
      sum += v;
      return v.w > 0;
    });
  }

  glm::dvec3 coarseFilter(const GBuffer& grid, const std::vector<glm::dvec3>& partial, int x, int y,
                          const SurfacePixel& centre) const {
    const int n = interleave;
    const Search strict = strictly(grid, partial, x, y, centre), loose = relaxed(strict);
    glm::dvec4 sum(0), others(0), all(0);
    std::vector<glm::ivec2> missing;
    for (int dy = -(n / 2); dy < n - n / 2; ++dy)
      for (int dx = -(n / 2); dx < n - n / 2; ++dx) {
        const int atX = std::clamp(x + dx, 0, grid.width - 1), atY = std::clamp(y + dy, 0, grid.height - 1);
        all += glm::dvec4(partial[size_t(atY * grid.width + atX)], 1);
        // Beyond the border the window goes on at its other side.
        const auto within = [n](int q, int size) { return q < 0 ? q + n : q >= size ? q - n : q; };
        const int qx = within(x + dx, grid.width), qy = within(y + dy, grid.height);
        if (strict.sameSurface(qx, qy)) {
          sum += glm::dvec4(strict.value(qx, qy), 1);
          continue;
        }
        missing.push_back({(dx + n) % n, (dy + n) % n});
        if (loose.sameSurface(qx, qy)) others += glm::dvec4(strict.value(qx, qy), 1);
      }
    if (4 * (sum.w + others.w) >= n * n) return glm::dvec3(sum + others) / (sum.w + others.w);
    search(strict, n, missing, sum);
    if (2 * sum.w < n * n) search(loose, n, missing, sum);
    return glm::dvec3(sum.w > 0 ? sum : all) / (sum.w > 0 ? sum.w : all.w);
  }

  glm::dvec3 filter(const GBuffer& g, const std::vector<glm::dvec3>& partial, int x, int y) const {
    const int n = interleave;
    const Search strict = strictly(g, partial, x, y, g.at(x, y));
    glm::dvec4 sum(0), outside(0);  // outside: the base where the window leaves the mask
    std::vector<glm::ivec2> missing;
    for (int dy = -n / 2; dy < n / 2; ++dy)
      for (int dx = -n / 2; dx < n / 2; ++dx) {
        const bool same = strict.sameSurface(x + dx, y + dy);
        if (same && strict.shaded(x + dx, y + dy))
          sum += glm::dvec4(strict.value(x + dx, y + dy), 1);
        else
          missing.push_back({(dx + n) % n, (dy + n) % n});
        if (same && !strict.shaded(x + dx, y + dy))
          outside += glm::dvec4(glm::dvec3((*base)[size_t((y + dy) * g.width + x + dx)]), 1);
      }
    const double inside = sum.w;
    if (outside.w > 0) {  // what the window lacks, from the block of the pixel
      for (int qy = y / n * n; qy < y / n * n + n; ++qy)
        for (int qx = x / n * n; qx < x / n * n + n; ++qx) {
          const auto at =
              std::find(missing.begin(), missing.end(), glm::ivec2((qx - x + n) % n, (qy - y + n) % n));
          if (at == missing.end() || !strict.sameSurface(qx, qy)) continue;
          sum += glm::dvec4(strict.value(qx, qy), 1);
          missing.erase(at);
        }
    }
    if (outside.w == 0) search(strict, n, missing, sum);
    if (outside.w > 0) {
      const glm::dvec3 rest = glm::dvec3(outside) / outside.w;
      const glm::dvec3 all = (glm::dvec3(sum) + (double(n * n) - sum.w) * rest) / double(n * n);
      return (inside * all + glm::dvec3(outside)) / (inside + outside.w);
    }
    if (2 * sum.w < n * n) search(relaxed(strict), n, missing, sum);
    return glm::dvec3(sum) / sum.w;
  }
};

}  // namespace fovea::test
