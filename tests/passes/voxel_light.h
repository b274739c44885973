// Light on voxels for the tests of the passes that make and read it: chains of passes, and the cone gather on the CPU.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "fovea/test.h"
#include "framework/scene/scene.h"
#include "shaders/records/hemisphere_rays.h"
#include "tests/passes/shadow_view.h"
#include "tests/references/paraboloid.h"
#include "tests/references/voxel_trace.h"
#include "tests/support/voxels.h"

namespace fovea::test {

// A scene with its voxels.
struct VoxelScene {
  scene::Scene scene;
  scene::Geometry geometry;
  VoxelArrays voxels;

  VoxelScene(scene::Scene s, int resolution)
      : scene(std::move(s)),
        geometry(scene::flatten(scene)),
        voxels(voxelizeReference(scene, geometry, resolution)) {}
  const std::vector<scene::VoxelSide>& sides() const { return voxels.surface; }
  scene::Voxels trace() const { return {voxels.grid, voxels.index, voxels.surface}; }
};

// The sides of an empty scene are those of one empty voxel, because buffers are never empty.
inline size_t sideCount(const VoxelScene& s) { return std::max<size_t>(s.sides().size(), 2); }

// Radiance of every side as a function of the side; empty sides have none.
template <class F>
std::vector<glm::vec4> radianceOf(const VoxelScene& s, F f) {
  std::vector<glm::vec4> result(sideCount(s), glm::vec4(0));
  for (size_t i = 0; i < s.sides().size(); ++i)
    if (s.sides()[i].area > 0) result[i] = glm::vec4(glm::vec3(f(s.sides()[i])), 0);
  return result;
}

// Pass light-inject with the maps of pass shadow-map.
struct Inject {
  int taps = 6;
  double offset = 0.25;
  bool shadows = false, emission = true;
  const char* filter = "bilinear";
  int mapSize = 1024;
};

inline std::vector<glm::vec4> inject(const VoxelScene& s, const Inject& options = {}, uint32_t frames = 1) {
  PassTest test("light-inject");
  test.scene(s.scene)
      .param("taps", options.taps)
      .param("emission", options.emission)
      .param("offset", options.offset)
      .param("filter", options.filter);
  setVoxels(test, s.voxels);
  if (options.shadows) {
    PassTest maps("shadow-map");
    maps.scene(s.scene).param("size", options.mapSize);
    maps.run();
    const graph::ResourceDesc& d = maps.desc("maps.depth");
    test.image("maps.depth", VK_FORMAT_D32_SFLOAT, d.width, d.height, d.layers, maps.floats("maps.depth"));
    test.buffer("maps.views", maps.values<ShadowView>("maps.views"), "ShadowView");
  }
  test.run(frames);
  auto result = test.values<glm::vec4>("radiance");
  result.resize(s.sides().size());
  return result;
}

// The bundle "voxel-mips", level after level, with the faces side by side in x.
struct Mips {
  uint32_t width = 0, size = 0, levels = 0;
  std::vector<float> color, weight;  // 4 and 1 per texel

  uint32_t widthAt(uint32_t level) const { return std::max(1u, width >> level); }
  uint32_t sizeAt(uint32_t level) const { return std::max(1u, size >> level); }
  size_t texel(uint32_t level, uint32_t x, uint32_t y, uint32_t z) const {
    size_t first = 0;
    for (uint32_t l = 0; l < level; ++l) first += size_t(widthAt(l)) * sizeAt(l) * sizeAt(l);
    return first + x + size_t(widthAt(level)) * (y + size_t(sizeAt(level)) * z);
  }
  glm::vec4 at(uint32_t level, uint32_t x, uint32_t y, uint32_t z) const {
    const float* c = &color[4 * texel(level, x, y, z)];
    return {c[0], c[1], c[2], c[3]};
  }
  uint32_t halvings() const {  // levels that are halves of each other
    uint32_t n = 1;
    while (size >> (n - 1) > 1 && (size >> (n - 1)) % 2 == 0) ++n;
    return n;
  }
};

struct MipRun {
  Mips mips;
  std::vector<uint16_t> colorHalves;
};

inline MipRun runMips(const VoxelScene& s, const std::vector<glm::vec4>& radiance, bool directional,
                      const std::vector<float>& weights = {}) {
  PassTest test("mipmap");
  test.scene(s.scene).param("directional", directional);
  setVoxels(test, s.voxels);
  test.buffer("radiance", radiance, "VoxelRadiance");
  if (!weights.empty()) test.buffer("weights", weights, "VoxelWeight");
  test.run();
  const graph::ResourceDesc& d = test.desc("mips.color");
  return {{d.width, d.height, d.mips, test.floats("mips.color"), test.floats("mips.weight")},
          test.values<uint16_t>("mips.color")};
}

inline void setMips(PassTest& test, const MipRun& run) {
  const Mips& m = run.mips;
  test.volume("mips.color", VK_FORMAT_R16G16B16A16_SFLOAT, m.width, m.size, m.size, run.colorHalves,
              m.levels);
}

// ---- The gather of shaders/voxels/cone.glsl, with its own filter ------------------------------------------

inline glm::vec4 filterMips(const Mips& m, glm::vec3 p, int face, uint32_t level) {
  const float size = float(m.sizeAt(level)), cell = float(1u << level);
  const glm::vec3 at = glm::clamp(p / cell, glm::vec3(0.5f), glm::vec3(size - 0.5f)) - 0.5f;
  const glm::vec3 base = glm::floor(at), f = at - base;
  glm::vec4 sum(0);
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
    const glm::ivec3 t = glm::min(glm::ivec3(base) + corner, glm::ivec3(int(size) - 1));
    const glm::vec3 w = glm::mix(1.0f - f, f, glm::vec3(corner));
    sum += w.x * w.y * w.z *
           m.at(level, uint32_t(t.x) + uint32_t(face) * m.sizeAt(level), uint32_t(t.y), uint32_t(t.z));
  }
  return sum;
}

inline glm::vec4 filterMips(const Mips& m, glm::vec3 p, int face, float level) {
  const uint32_t low = uint32_t(level), high = uint32_t(std::ceil(level));
  // Not closer to a face's rim than the coarser level allows.
  const float half = 0.5f * float(1u << high);
  const glm::vec3 at = glm::clamp(p, glm::vec3(half), glm::vec3(float(m.size) - half));
  return glm::mix(filterMips(m, at, face, low), filterMips(m, at, face, high), level - float(low));
}

inline glm::vec4 referenceCone(const Mips& m, glm::vec3 origin, glm::vec3 direction, float start,
                               float growth) {
  glm::vec4 sum(0);
  const int last = int(m.halvings()) - 1;
  for (float t = start; sum.a < 0.999f;) {
    const float level = std::clamp(std::log2(std::max(growth * t, 1.0f)), 0.0f, float(last));
    const float width = 0.5f * std::exp2(level);
    const glm::vec3 p = origin + (t + 0.5f * width) * direction;
    const glm::vec3 out = glm::max(-p, p - float(m.size));
    if (std::max({out.x, out.y, out.z}) > width) break;
    glm::vec4 s(0);
    if (m.width == m.size) {
      s = filterMips(m, p, 0, level);
    } else {
      for (int k = 0; k < 3; ++k)
        s += std::abs(direction[k]) * filterMips(m, p, 2 * k + (direction[k] > 0 ? 1 : 0), level);
    }
    sum += std::min(0.5f + 0.25f * growth, (1 - sum.a) / std::max(s.a, 1e-6f)) * s;
    t += width;
  }
  return sum;
}

// Irradiance by six cones whose near part is a ray.
inline glm::vec3 referenceGather(const VoxelScene& s, const Mips& m, const std::vector<glm::vec4>& radiance,
                                 glm::vec3 position, glm::vec3 normal, float turn) {
  const scene::VoxelGrid& grid = s.voxels.grid;
  const float cell = 2 * grid.cell;
  const glm::mat3 frame = scene::orthonormalFrame(normal);
  glm::vec3 sum(0);
  for (const glm::vec3& ray : scene::kHemisphereRay) {
    const glm::vec3 local(std::cos(turn) * ray.x - std::sin(turn) * ray.y,
                          std::sin(turn) * ray.x + std::cos(turn) * ray.y, ray.z);
    const glm::vec3 direction = glm::normalize(frame * local);
    const float start = 1.5f / ray.z;
    const scene::VoxelHit hit = traceVoxels(s.trace(), position, direction, normal, (start + 3) * cell);
    sum += ray.z *
           (hit.side != scene::kNoSide
                ? glm::vec3(radiance[hit.side])
                : glm::vec3(referenceCone(m, (position - grid.origin) / cell, direction, start, ray.z / 3)));
  }
  return glm::pi<float>() * sum / 3.5f;
}

inline float luminance(glm::vec3 c) { return glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

}  // namespace fovea::test
