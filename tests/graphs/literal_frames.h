// A few frames of `ours_literal` over a small scene, with everything that its passes hand to each other.
#pragma once

#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "fovea/scene.h"
#include "framework/scene/scene.h"
#include "places.h"
#include "shaders/records/vpl.h"
#include "tests/passes/candidates_reference.h"
#include "tests/passes/voxel_light.h"
#include "tests/references/octahedral.h"
#include "tests/support/graph_run.h"

namespace fovea::test {

constexpr int kLiteralVoxels = 24, kLiteralMap = 16;
constexpr uint32_t kLiteralFrames = 6;
constexpr double kLiteralCell = 0.05;          // of the density grid, so wide that candidates meet full cells
constexpr double kLiteralRefreshShare = 0.25;  // so that several maps are redrawn in a frame

// What one frame leaves in the ports between the passes.
struct LiteralFrame {
  scene::Frame moment;
  SeenImage seen{glm::ivec2(1)};
  VoxelArrays voxels;
  std::vector<glm::vec4> voxelRadiance, radiosity;
  Mips mips;
  std::vector<scene::Candidate> candidates;
  std::vector<float> weights, candidateImportance, vplImportance;
  std::vector<scene::VplState> moved, list;
  std::vector<scene::Vpl> placed, emitters;
  std::vector<uint32_t> atlas;
  std::vector<float> irradiance;
  std::map<std::string, double> counters;

  const scene::View& view() const { return moment.views[0]; }
  double counter(const std::string& name) const {
    const auto found = counters.find(name);
    EXPECT_NE(found, counters.end()) << "no counter " << name;
    return found == counters.end() ? -1 : found->second;
  }
};

// The Cornell box with a cube that flies and turns.
inline scene::Scene literalScene() {
  scene::Scene s = scene::builtin("cornellbox");
  s.preExposure = 1;  // light is then stored in the units in which it is read back
  const auto cube = std::find_if(s.nodes.begin(), s.nodes.end(),
                                 [](const auto& node) { return node.name == "yellow cube"; });
  cube->dynamic = true;
  scene::MotionKey from, to;
  from.translation = cube->translation;
  from.rotation = cube->rotation;
  to.time = float(kLiteralFrames) / 42;
  to.translation = {-1.3f, 0.9f, -0.2f};
  to.rotation = glm::angleAxis(glm::radians(60.0f), glm::vec3(0, 1, 0));
  s.movers = {{uint32_t(cube - s.nodes.begin()), false, scene::Repeat::Once, {from, to}}};
  return s;
}

// The gaze drifts over the picture and jumps in frame 3.
inline glm::vec2 literalGaze(uint64_t frame) {
  const glm::vec2 drift = float(frame) * glm::vec2(0.02f, -0.01f);
  return (frame < 3 ? glm::vec2(0.33f, 0.62f) : glm::vec2(0.62f, 0.45f)) + drift;
}

template <class T>
std::vector<T> valuesOf(const graph::FrameResult& frame, const std::string& output) {
  const std::vector<std::byte>& bytes = frame.outputs.at(output).bytes;
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

inline SeenImage seenIn(const graph::FrameResult& frame) {
  const graph::OutputData& output = frame.outputs.at("gbuffer.distance");
  const glm::ivec2 size(output.desc.width, output.desc.height);
  const std::vector<float> distance = toFloats(output), normal = toFloats(frame.outputs.at("gbuffer.normal")),
                           face = toFloats(frame.outputs.at("gbuffer.face"));
  SeenImage image(size, valuesOf<scene::PixelRays>(frame, "gbuffer.camera").at(0));
  const size_t faceChannels = face.size() / distance.size();
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const size_t i = size_t(y * size.x + x);
      SeenPixel& pixel = image.at({x, y});
      pixel.distance = distance[i];
      pixel.position = pointOn(image.camera, x, y, distance[i]);
      pixel.normal = {normal[4 * i], normal[4 * i + 1], normal[4 * i + 2]};
      pixel.face = scene::octDecode({face[faceChannels * i], face[faceChannels * i + 1]});
    }
  return image;
}

inline VoxelArrays voxelsIn(const graph::FrameResult& frame, const scene::Geometry& geometry) {
  VoxelArrays voxels;
  voxels.grid = scene::voxelGrid(geometry.boundsMin, geometry.boundsMax, kLiteralVoxels);
  voxels.resolution = kLiteralVoxels;
  voxels.index = valuesOf<uint32_t>(frame, "voxels.index");
  voxels.surface = valuesOf<scene::VoxelSide>(frame, "voxels.surface");
  voxels.info = valuesOf<scene::VoxelInfo>(frame, "voxels.info").at(0);
  voxels.surface.resize(2 * size_t(voxels.info.voxels));  // the rest is room for more
  return voxels;
}

inline LiteralFrame literalFrame(const graph::FrameResult& frame, const scene::Frame& moment,
                                 const scene::Geometry& geometry) {
  LiteralFrame f;
  f.moment = moment;
  f.seen = seenIn(frame);
  f.voxels = voxelsIn(frame, geometry);
  f.voxelRadiance = valuesOf<glm::vec4>(frame, "voxel_radiance");
  const graph::OutputData& mips = frame.outputs.at("mips.color");
  f.mips = {mips.desc.width, mips.desc.height, mips.desc.mips, toFloats(mips), {}};
  f.candidates = valuesOf<scene::Candidate>(frame, "candidates");
  f.weights = valuesOf<float>(frame, "weights");
  f.candidateImportance = valuesOf<float>(frame, "candidate_importance");
  f.vplImportance = valuesOf<float>(frame, "vpl_importance");
  f.moved = valuesOf<scene::VplState>(frame, "moved");
  f.list = valuesOf<scene::VplState>(frame, "list");
  f.radiosity = valuesOf<glm::vec4>(frame, "radiosity");
  f.placed = valuesOf<scene::Vpl>(frame, "placed");
  f.atlas = valuesOf<uint32_t>(frame, "atlas");
  f.emitters = valuesOf<scene::Vpl>(frame, "emitters");
  f.irradiance = toFloats(frame.outputs.at("irradiance"));
  f.counters.insert(frame.counters.begin(), frame.counters.end());
  return f;
}

// Runs tests/data/graphs/literal.json over the scene, with some parameters changed.
inline std::vector<LiteralFrame> literalFrames(const scene::Scene& scene,
                                               const std::vector<std::string>& changes) {
  const scene::Geometry geometry = scene::flatten(scene);
  std::vector<scene::Frame> moments;
  GraphRunOptions options;
  options.size = {64, 48};
  options.frames = kLiteralFrames;
  options.everyFrame = true;
  options.outputs = {"gbuffer.distance",
                     "gbuffer.camera",
                     "gbuffer.normal",
                     "gbuffer.face",
                     "voxels.index",
                     "voxels.surface",
                     "voxels.info",
                     "voxel_radiance",
                     "mips.color",
                     "candidates",
                     "weights",
                     "moved",
                     "list",
                     "candidate_importance",
                     "vpl_importance",
                     "radiosity",
                     "placed",
                     "atlas",
                     "emitters",
                     "irradiance"};
  options.set = {"vpl_count=48",
                 "attempts=200",
                 "voxels=" + std::to_string(kLiteralVoxels),
                 "map_size=" + std::to_string(kLiteralMap),
                 "shadow_map_size=256",
                 "interleave=1",  // a pixel sums over all VPLs, as the paper's equation does
                 "manage.cell=" + std::to_string(kLiteralCell),
                 "refresh_share=" + std::to_string(kLiteralRefreshShare)};
  options.set.insert(options.set.end(), changes.begin(), changes.end());
  options.beforeFrame = [&](scene::Frame& frame) {
    for (scene::View& view : frame.views) view.gaze = literalGaze(frame.index);
    moments.push_back(frame);
  };
  const GraphRun run = runGraph(FOVEA_TEST_DATA "/graphs/literal.json", scene, options);
  std::vector<LiteralFrame> frames;
  for (size_t i = 0; i < run.frames.size(); ++i)
    frames.push_back(literalFrame(run.frames[i], moments.at(i), geometry));
  return frames;
}

}  // namespace fovea::test
