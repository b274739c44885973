// A plain CPU version of pass `candidates` that uses the same random numbers, and the input of both.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>
#include <string>
#include <vector>

#include "fovea/test.h"
#include "framework/base/random.h"
#include "shaders/records/vpl.h"
#include "tests/references/fovea.h"
#include "tests/references/paraboloid.h"
#include "tests/references/voxel_trace.h"
#include "tests/support/pixel_rays.h"
#include "tests/support/voxels.h"

namespace fovea::test {

constexpr uint32_t kCandidateStream = 0x63616e64u;

// What the eye sees, as stored in the G-buffer.
struct SeenPixel {
  glm::vec3 position{0};
  float distance = 0;  // 0 in the background
  glm::vec3 normal{0, 1, 0}, face{0, 1, 0};
};

struct SeenImage {
  glm::ivec2 size{1};
  scene::PixelRays camera;
  std::vector<SeenPixel> pixels;

  explicit SeenImage(glm::ivec2 s, const scene::PixelRays& rays = {})
      : size(s), camera(rays), pixels(size_t(s.x * s.y)) {}
  const SeenPixel& at(glm::ivec2 p) const { return pixels[size_t(p.y * size.x + p.x)]; }
  SeenPixel& at(glm::ivec2 p) { return pixels[size_t(p.y * size.x + p.x)]; }

  // Rounds the values as the formats do.
  void wire(PassTest& test, const std::string& port = "gbuffer") {
    std::vector<glm::vec4> position;
    std::vector<uint16_t> normal;
    std::vector<int16_t> face;
    for (SeenPixel& p : pixels) {
      position.emplace_back(p.position, p.distance);
      for (int k = 0; k < 3; ++k) {
        normal.push_back(glm::packHalf1x16(p.normal[k]));
        p.normal[k] = glm::unpackHalf1x16(normal.back());
      }
      normal.push_back(0);
      glm::vec3 n = p.face / (std::abs(p.face.x) + std::abs(p.face.y) + std::abs(p.face.z));
      glm::vec2 oct(n);
      if (n.z < 0)
        oct = (1.0f - glm::abs(glm::vec2(n.y, n.x))) * glm::vec2(n.x < 0 ? -1 : 1, n.y < 0 ? -1 : 1);
      for (int k = 0; k < 2; ++k) {
        face.push_back(int16_t(std::lround(oct[k] * 32767)));
        oct[k] = float(face.back()) / 32767.0f;
      }
      n = glm::vec3(oct, 1 - std::abs(oct.x) - std::abs(oct.y));
      if (n.z < 0)
        n = glm::vec3(
            (1.0f - glm::abs(glm::vec2(oct.y, oct.x))) * glm::vec2(oct.x < 0 ? -1 : 1, oct.y < 0 ? -1 : 1),
            n.z);
      p.face = glm::normalize(n);
    }
    const auto w = uint32_t(size.x), h = uint32_t(size.y);
    wireSurfaces(test, port, camera, size.x, size.y, position);
    test.image(port + ".normal", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, normal);
    test.image(port + ".face", VK_FORMAT_R16G16_SNORM, w, h, 1, face);
  }
};

struct CandidateReference {
  const SeenImage& image;
  const VoxelArrays& voxels;
  scene::Fovea fovea;
  uint32_t region = scene::kRegionFovea, seed = 1, frame = 0;

  struct Attempt {
    bool background = false;
    glm::vec3 origin{0}, direction{0}, normal{0}, face{0};
    uint32_t side = scene::kNoSide;
    float distance = 0;  // to the side's plane
  };

  // nudge turns the direction slightly.
  Attempt attempt(uint32_t i, glm::vec3 nudge = glm::vec3(0)) const {
    const uint32_t stream = randomStream(seed, frame, kCandidateStream, i);
    const SeenPixel& p = image.at(scene::regionSample(region, fovea, image.size, stream));
    Attempt a;
    a.background = p.distance == 0;
    if (a.background) return a;
    const glm::dvec2 u(scene::streamPoint(stream, scene::kRegionDraws));
    const double r = std::sqrt(u.x), phi = glm::two_pi<double>() * u.y;
    const glm::dvec3 local(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x));
    a.normal = glm::normalize(p.normal);
    glm::vec3 d(glm::dmat3(scene::orthonormalFrame(a.normal)) * local);
    if (const float below = glm::dot(d, p.face); below < 0) d -= 2 * below * p.face;
    a.origin = p.position;
    a.direction = glm::normalize(d + nudge);
    a.face = p.face;
    const scene::Voxels v{voxels.grid, voxels.index, voxels.surface};
    const scene::VoxelHit hit = scene::traceVoxels(v, a.origin, a.direction, p.face);
    a.side = hit.side, a.distance = hit.distance;
    return a;
  }

  // Whether a direction within single precision of the exact one could have met `side`.
  bool mayMeet(uint32_t i, uint32_t side) const {
    if (attempt(i).side == side) return true;
    for (int k = 0; k < 6; ++k) {
      glm::vec3 nudge(0);
      nudge[k / 2] = k % 2 ? 3e-6f : -3e-6f;
      if (attempt(i, nudge).side == side) return true;
    }
    return false;
  }
};

}  // namespace fovea::test
