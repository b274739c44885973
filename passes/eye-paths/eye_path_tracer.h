// Where diffuse eye paths end after one bounce, and the light that they find there, by rays through the
// triangles themselves.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/shader_twins/fovea.h"

namespace fovea::passes {

struct EyePathSettings {
  uint32_t region = scene::kRegionFovea;  // of the image that the paths start in
  uint32_t imageShare64ths = 26;          // of region `mixed`, of the whole image
  float foveaRadius = 0.25f;              // image widths
  uint32_t points = 1024;                 // screen points, the same in every frame: scene::screenPoint()
  uint32_t bounces = 2;                   // reflections of light on its way to the point that the eye sees
  uint32_t gathered = 2;                  // rays by which the second of them is found
  uint32_t renewFrames = 1;               // in which all starts are looked for anew, a share in each
  float stray = 0;           // image widths from where it is due: a start that is still seen there stays
  uint32_t traceFrames = 1;  // in which all paths are traced anew, likewise
  uint32_t turn = 0;         // of both
  uint32_t threads = 0;      // 0: one a core; the result does not depend on it
};

// What a screen point shows; as the screen points of shaders/vpl-intensity/points.comp. All zeros: the background.
struct EyePathStart {
  glm::vec3 position{0};  // world space, m
  float there = 0;        // 1: a surface
  glm::vec3 normal{0};    // for shading, unit, on the side of the eye
  float unused0 = 0;
  glm::vec3 face{0};  // of the triangle, unit
  float unused1 = 0;
};
static_assert(sizeof(EyePathStart) == 48);

// The same layout as in shaders/vpl-intensity/vpl_intensity.glsl. All zeros: the path ends nowhere.
struct EyePathEnd {
  glm::vec3 position{0};  // world space, m
  float kind = 0;         // 1: no direct light there, 2: some
  glm::vec3 normal{0};    // unit, the side that the path came to
  float luminance = 0;    // of `radiance`
  glm::vec3 radiance{0};  // that leaves towards the point where the path started, W/(sr m^2)
  float unit = 0;         // the same for all: of sums as whole numbers, W/(sr m^2), see sumUnit()
};
static_assert(sizeof(EyePathEnd) == 48);

struct EyePathStatistics {
  uint64_t rays = 0, ends = 0;
};

struct EyePathLists {
  std::span<EyePathStart> starts;  // `points` of them
  std::span<EyePathEnd> ends;      // path i starts from screen point i % points
};

// Fills the lists. A start whose number is not `turn` modulo renewFrames stays where it is as long as there
// is a surface; its paths stay, too, if its number is not `turn` modulo traceFrames.
EyePathStatistics traceEyePaths(const scene::Frame& frame, const scene::View& view,
                                const scene::RayScene& rays, const EyePathSettings& settings,
                                const EyePathLists& lists);

// The unit in which the light of all the ends sums up to 2^31 in the brightest channel.
float sumUnit(std::span<const EyePathEnd> ends);

}  // namespace fovea::passes
