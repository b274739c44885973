// Surface data for ray hits, laid out for millions of random accesses: one cache line per triangle, rarely more than
// one for the four texels of a texture, and all in few pages.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/texture_taps.h"
#include "passes/path-trace/huge_pages.h"

namespace fovea::path_trace {

class SurfaceTable {
 public:
  explicit SurfaceTable(const scene::Frame& frame);

  // Prefetches a triangle for which at() will be called soon.
  void prefetch(uint32_t triangle) const { __builtin_prefetch(&triangles_[triangle]); }

  // Like scene::surfaceAt(), but vertex normals have 16 bits per component, the position is the point on the ray, and
  // the object is left out.
  scene::SurfaceHit at(const scene::Ray& ray, const scene::RayHit& hit) const;
  bool doubleSided(uint32_t material) const { return looks_[material].doubleSided; }
  bool emits(uint32_t material) const { return looks_[material].emits; }

  // Finds where reflectance() will read for `material` at `uv`, and prefetches that memory.
  void find(uint32_t material, glm::vec2 uv, scene::TextureTaps& taps) const;
  glm::vec3 reflectance(uint32_t material, const scene::TextureTaps& taps) const {
    return looks_[material].factor * glm::vec3(scene::sample(taps, srgb_));
  }

 private:
  struct alignas(64) Triangle {
    glm::vec3 face{0};      // unit
    int16_t normals[3][3];  // normals of the vertices, 32767 stands for 1; zeros where the geometry has none
    glm::vec2 uvs[3];
    uint32_t material = 0;
  };
  // A texture in tiles: squares of 32 x 32 texels, which fill one page, of squares of 4 x 4, which
  // fill one cache line.
  struct Blocks {
    uint32_t width = 0, height = 0;  // 0 if there is no texture
    uint32_t perRow = 0;
    bool srgb = true;
    size_t first = 0;  // byte
    // The byte of a texel is first + column(x) + row(y).
    static size_t column(uint32_t x) { return 4 * (size_t(x / 32) * 1024 + x / 4 % 8 * 16 + x % 4); }
    size_t row(uint32_t y) const {
      return 4 * (size_t(y / 32) * perRow * 1024 + y / 4 % 8 * 128 + y % 4 * 4);
    }
  };
  struct Look {
    glm::vec3 factor{0};  // factor on the texture's colour
    bool doubleSided = false, emits = false;
    scene::TextureUse use;
    Blocks blocks;
  };
  void copyTriangles(const scene::Geometry& geometry);
  void copyTexels(const scene::Scene& scene);

  HugeVector<Triangle> triangles_;
  HugeVector<uint8_t> texels_;
  std::vector<Look> looks_;  // one for each material
  const std::array<float, 256>& srgb_ = scene::srgbTable();
};

inline scene::SurfaceHit SurfaceTable::at(const scene::Ray& ray, const scene::RayHit& hit) const {
  const Triangle& t = triangles_[hit.triangle];
  const float w = 1.0f - hit.u - hit.v;
  scene::SurfaceHit s;
  s.position = ray.origin + ray.direction * hit.distance;
  s.geometricNormal = s.shadingNormal = t.face;
  const auto normal = [&](int i) { return glm::vec3(t.normals[i][0], t.normals[i][1], t.normals[i][2]); };
  const glm::vec3 m = normal(0) * w + normal(1) * hit.u + normal(2) * hit.v;
  if (const float square = glm::dot(m, m); square > 1e-12f) s.shadingNormal = m / std::sqrt(square);
  // Some models have normals that point against their winding; the winding decides.
  if (glm::dot(s.shadingNormal, s.geometricNormal) < 0) s.shadingNormal = -s.shadingNormal;
  s.uv = t.uvs[0] * w + t.uvs[1] * hit.u + t.uvs[2] * hit.v;
  s.material = t.material;
  return s;
}

inline void SurfaceTable::find(uint32_t material, glm::vec2 uv, scene::TextureTaps& taps) const {
  const Look& look = looks_[material];
  const Blocks& blocks = look.blocks;
  taps.texel[0] = nullptr;
  if (blocks.width == 0) return;
  const scene::TexelSquare square = scene::texelSquare(blocks.width, blocks.height, look.use, uv);
  const uint8_t* texels = texels_.data() + blocks.first;
  const size_t columns[2] = {Blocks::column(square.column[0]), Blocks::column(square.column[1])};
  const size_t rows[2] = {blocks.row(square.row[0]), blocks.row(square.row[1])};
  for (uint32_t i = 0; i < 4; ++i) taps.texel[i] = texels + columns[i % 2] + rows[i / 2];
  taps.right = square.right;
  taps.lower = square.lower;
  taps.srgb = blocks.srgb;
  taps.prefetch();
}

}  // namespace fovea::path_trace
