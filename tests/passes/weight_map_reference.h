// A plain CPU version of pass `weight-map`, and pictures as input of both.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "fovea/test.h"
#include "tests/references/fovea.h"
#include "tests/support/pixel_rays.h"
#include "tests/support/voxels.h"

namespace fovea::test {

struct WeighedPixel {
  glm::vec3 position{0};
  float distance = 0;  // 0 in the background
  glm::vec3 face{0, 0, 1};
};

struct WeighedPicture {
  int width, height;
  scene::PixelRays camera;
  std::vector<WeighedPixel> pixels;
  WeighedPicture(int w, int h, const scene::PixelRays& rays)
      : width(w), height(h), camera(rays), pixels(size_t(w * h)) {}
  WeighedPixel& at(int x, int y) { return pixels[size_t(y * width + x)]; }
  const WeighedPixel& at(int x, int y) const { return pixels[size_t(y * width + x)]; }

  std::vector<float> distances() const {
    std::vector<glm::vec4> list;
    for (const WeighedPixel& p : pixels) list.emplace_back(p.position, p.distance);
    return distancesOf(camera, width, list);
  }
  void wire(PassTest& test) const {
    std::vector<uint32_t> face;
    for (const WeighedPixel& p : pixels) {
      const glm::vec3 n = p.face / (std::abs(p.face.x) + std::abs(p.face.y) + std::abs(p.face.z));
      const glm::vec2 folded =
          (1.0f - glm::abs(glm::vec2(n.y, n.x))) * glm::vec2(n.x < 0 ? -1 : 1, n.y < 0 ? -1 : 1);
      const glm::vec2 oct = n.z >= 0 ? glm::vec2(n) : folded;
      face.push_back(glm::packSnorm2x16(oct));
    }
    test.viewSize(uint32_t(width), uint32_t(height));
    test.image("gbuffer.distance", VK_FORMAT_R32_SFLOAT, uint32_t(width), uint32_t(height), 1, distances());
    test.buffer("gbuffer.camera", std::vector{camera}, "PixelRays");
    test.image("gbuffer.face", VK_FORMAT_R16G16_SNORM, uint32_t(width), uint32_t(height), 1, face);
  }
};

struct SideWeights {
  std::vector<float> weights;
  double visible = 0, unassigned = 0;
};

// The definition of the weights (passes/vpls.md, weight-map), one pixel after the other. radius: in widths of the
// picture. With that of one pixel, the weights are those of `falloff` `centre`.
inline SideWeights weightsReference(const WeighedPicture& picture, const VoxelArrays& voxels, glm::vec3 eye,
                                    glm::vec2 gaze, float radius, int spacing = 1) {
  SideWeights e;
  e.weights.resize(voxels.surface.size());
  const scene::Fovea fovea = scene::makeFovea(gaze, {picture.width, picture.height}, radius);
  const int r = voxels.resolution;
  for (int y = 0; y < picture.height; y += spacing)
    for (int x = 0; x < picture.width; x += spacing) {
      const WeighedPixel& p = picture.at(x, y);
      if (p.distance <= 0) continue;
      const glm::ivec3 cell(glm::floor(voxels.grid.worldToVoxel(p.position)));
      uint32_t voxel = 0;
      if (cell == glm::clamp(cell, glm::ivec3(0), glm::ivec3(r - 1)))
        voxel = voxels.index[size_t(cell.x + r * (cell.y + r * cell.z))];
      uint32_t side = 2 * (voxel - 1) + scene::voxelSideOf(p.face);
      bool seen = voxel != 0;
      if (seen && voxels.surface[side].area <= 0) {
        side ^= 1u;
        const scene::VoxelSide& s = voxels.surface[side];
        seen = s.area > 0 && glm::dot(s.normal, eye - s.position) > 0;
      }
      if (!seen) {
        ++e.unassigned;
        continue;
      }
      e.weights[side] = std::max(e.weights[side], scene::foveaWeight(fovea, {x + 0.5f, y + 0.5f}));
    }
  for (const float w : e.weights) e.visible += w > 0;
  return e;
}

}  // namespace fovea::test
