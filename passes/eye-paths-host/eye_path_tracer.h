// Traces diffuse eye paths through the triangles: where each ends after one bounce, and the light found there. Where
// surfaces emit, some of the paths of each start are aimed at them. All paths of a start are one sample of its
// hemisphere, combined by the balance heuristic (Veach and Guibas 1995), and each says in its weight how many
// cosine-weighted paths it stands for.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/shader_twins/fovea.h"
#include "shaders/records/eye_paths.h"

namespace fovea::passes {

struct EyePathSettings {
  uint32_t region = scene::kRegionFovea;  // region of the image in which the paths start
  uint32_t imageShare64ths = 26;          // share of the whole image for the region `mixed`
  float foveaRadius = 0.25f;              // image widths
  uint32_t points = 1024;      // number of screen points, the same in every frame: scene::screenPoint()
  uint32_t bounces = 2;        // reflections of light on its way to the visible point
  bool emission = true;        // whether the ends show the light that surfaces emit themselves
  bool fullMaterials = false;  // framework/scene/materials/bounced.h
  uint32_t gathered = 2;       // rays that gather the second of these reflections
  uint32_t renewFrames = 1;    // frames in which every start is renewed once, a share of them in each
  float stray = 0;             // image widths; a start that is still seen this close to its place is kept
  uint32_t traceFrames = 1;    // frames in which every path is traced anew once, a share in each frame
  uint32_t turn = 0;           // which share has its turn, for both cycles
  double usualChange = 0;      // EyePathStatistics::change that is no reason to trace others
  uint32_t threads = 0;        // 0 uses one per core; the result does not depend on it
};

struct EyePathStatistics {
  uint64_t rays = 0, ends = 0;
  // Share of the light that has changed, in [0, 1]: the differences between what the paths find that are traced again
  // from their starts and what they found before, divided by the larger of both.
  double change = 0;
  // Share by which the light as a whole has grown or shrunk, in [0, 1]: the sum of these differences with their signs,
  // as far as its square exceeds what it would be on average if the signs of the points were random.
  double drift = 0;
};

struct EyePathLists {
  std::span<EyePathStart> starts;  // one for each screen point
  std::span<EyePathEnd> ends;      // path i starts from screen point i % points
};

// Fills the lists. If the number of a start is not `turn` modulo renewFrames, the start is kept as long as there is a
// surface; its paths are kept as well if its number is not `turn` modulo traceFrames, except that twice as large a share
// of them is traced all the same as the light of the others has changed beyond usualChange.
EyePathStatistics traceEyePaths(const scene::Frame& frame, const scene::View& view,
                                const scene::RayScene& rays, const EyePathSettings& settings,
                                const EyePathLists& lists);

// Unit in which the weighted light of all ends sums to 2^31 in the brightest channel.
float sumUnit(std::span<const EyePathEnd> ends);

}  // namespace fovea::passes
