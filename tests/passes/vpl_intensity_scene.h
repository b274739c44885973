// Shared by the tests of pass vpl-intensity: a room with VPLs in it, and how the pass is run there.
#pragma once

#include <gtest/gtest.h>

#include "framework/base/low_discrepancy.h"
#include "tests/passes/vpl_intensity_reference.h"

namespace fovea::test {

inline scene::VplState vplAt(const Room& room, uint32_t side) {
  const scene::VoxelSide& s = room.voxels.surface[side];
  scene::VplState vpl;
  vpl.position = s.position;
  vpl.normal = s.normal;
  vpl.reflectance = s.reflectance;
  vpl.side = side;
  vpl.life = 1;
  return vpl;
}

inline glm::vec3 cosineDirection(glm::vec3 n, float u, float v) {
  const glm::vec3 t =
      glm::normalize(glm::cross(std::abs(n.x) > 0.5f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), n));
  const float phi = glm::two_pi<float>() * v, r = std::sqrt(u);
  return glm::normalize(r * std::cos(phi) * t + r * std::sin(phi) * glm::cross(n, t) + std::sqrt(1 - u) * n);
}

// A pixel of the region and one diffuse bounce, as in pass candidates.
inline std::vector<scene::Candidate> candidatesOf(const Room& room, uint32_t count,
                                                  const WeightSettings& settings) {
  const scene::Fovea fovea = scene::makeFovea(settings.gaze, room.size, settings.foveaRadius);
  std::vector<scene::Candidate> list;
  for (uint32_t i = 0; i < count; ++i) {
    scene::Candidate candidate;
    const uint32_t stream = randomStream(5, 0, 0, i);
    const glm::ivec2 pixel = scene::regionSample(settings.region, fovea, room.size, stream);
    const Seen& seen = room.pixels[size_t(pixel.y) * room.size.x + pixel.x];
    scene::VoxelHit hit;
    if (seen.there)
      hit = scene::traceVoxels(room.view(), seen.position,
                               cosineDirection(seen.normal, sobol(i, 0, 3), sobol(i, 1, 3)), seen.normal);
    candidate.side = hit.side;
    if (hit.side != scene::kNoSide) {
      candidate.position = room.voxels.surface[hit.side].position;
      candidate.normal = room.voxels.surface[hit.side].normal;
    }
    list.push_back(candidate);
  }
  return list;
}

inline std::vector<scene::VplState> vplsOf(const Room& room,
                                           const std::vector<scene::Candidate>& candidates) {
  std::vector<scene::VplState> vpls;
  for (const scene::Candidate& c : candidates)
    if (c.side != scene::kNoSide) vpls.push_back(vplAt(room, c.side));
  return vpls;
}

// Inputs of the pass. Radiosity and radiance are 1 everywhere until changed.
struct Inputs {
  const Room* room = nullptr;
  std::vector<scene::VplState> vpls;
  std::vector<glm::vec4> radiosity, radiance;
  Maps maps;  // if empty, nothing hides anything
};

// As in pass vpl-origins.
inline std::vector<scene::Vpl> placed(const Inputs& in) {
  std::vector<scene::Vpl> list(in.vpls.size());
  for (size_t i = 0; i < list.size(); ++i) {
    const scene::VplState& v = in.vpls[i];
    float sum = 0;
    for (int c = 0; c < 3; ++c) sum += 0 * (v.position[c] + v.normal[c] + in.radiosity[i][c]);
    if (!(v.life > 0) || sum != 0) continue;
    list[i].position = v.position;
    list[i].area = 1;
    list[i].normal = v.normal;
    list[i].intensity = glm::max(glm::vec3(in.radiosity[i]), glm::vec3(0)) / glm::pi<float>();
  }
  return list;
}

inline Inputs inputs(const Room& room, std::vector<scene::VplState> vpls) {
  Inputs in;
  in.room = &room;
  in.radiosity.assign(vpls.size(), glm::vec4(1));
  in.radiance.assign(std::max<size_t>(room.voxels.surface.size(), 1), glm::vec4(1 / glm::pi<float>()));
  in.vpls = std::move(vpls);
  return in;
}

inline void wire(PassTest& test, const Inputs& in, const char* strategy, const WeightSettings& settings) {
  const Room& room = *in.room;
  std::vector<glm::vec4> position;
  std::vector<uint16_t> normal;
  std::vector<int16_t> face;
  for (const Seen& s : room.pixels) {
    position.emplace_back(s.position, s.there ? 1 : 0);
    for (const float x : {s.normal.x, s.normal.y, s.normal.z, 0.0f}) normal.push_back(glm::packHalf1x16(x));
    // All faces of the test scenes are axis-parallel.
    const glm::vec2 oct = s.normal.z >= -0.5f ? glm::vec2(s.normal) : glm::vec2(1);
    for (const float x : {oct.x, oct.y}) face.push_back(int16_t(std::lround(32767 * x)));
  }
  const auto w = uint32_t(room.size.x), h = uint32_t(room.size.y);
  const std::string chosen = strategy;
  test.param("region", settings.region == scene::kRegionMixed   ? "mixed"
                       : settings.region == scene::kRegionImage ? "image"
                                                                : "fovea");
  test.view("fovea_radius", double(settings.foveaRadius));
  if (chosen != "area")
    test.param("image_share", settings.imageShare)
        .param("points", int(settings.points))
        .param("area_cap", settings.areaCap);
  if (chosen == "area") test.param("sides", settings.litOnly ? "lit" : "all");
  if (chosen == "area" || chosen == "importance-area") test.param("normal_weight", settings.normalWeight);
  if (chosen == "importance-area") test.param("kernel", settings.clamp > 0 ? "clamp" : "disc");
  if (chosen == "importance-area" && settings.clamp > 0) test.param("clamp_distance", settings.clamp);
  test.viewSize(w, h).scene(room.scene);
  wireSurfaces(test, "gbuffer", room.camera, room.size.x, room.size.y, position);
  test.image("gbuffer.normal", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, normal);
  test.image("gbuffer.face", VK_FORMAT_R16G16_SNORM, w, h, 1, face);
  setVoxels(test, room.voxels);
  test.buffer("vpls", in.vpls, "VplState").buffer("radiosity", in.radiosity, "VplRadiosity");
  test.buffer("radiance", in.radiance, "VoxelRadiance").buffer("placed", placed(in), "Vpl");
  const Maps maps = in.maps.texels.empty() ? emptyMaps(in.vpls.size()) : in.maps;
  const auto side = uint32_t(maps.size);
  test.image("atlas", VK_FORMAT_R32_UINT, side, side, uint32_t(in.vpls.size()), maps.texels);
}

inline std::vector<scene::Vpl> weigh(const Inputs& in, const char* strategy,
                                     const WeightSettings& settings = {}) {
  PassTest test(std::string("vpl-intensity-") + strategy);
  wire(test, in, strategy, settings);
  if (settings.gaze != glm::vec2(0.5f))
    test.beforeFrame([&](PassTest&, scene::Frame& frame) { frame.views[0].gaze = settings.gaze; });
  test.run();
  return test.values<scene::Vpl>("emitters");
}

inline double sumOfAreas(const std::vector<scene::Vpl>& list) {
  double sum = 0;
  for (const scene::Vpl& v : list) sum += v.area;
  return sum;
}

// Number of slots whose area is off by more than `tolerance`, relative. Everything that is not area must be correct
// in all of them.
inline int wrongAreas(const std::vector<scene::Vpl>& got, const Inputs& in, const std::vector<double>& want,
                      double tolerance) {
  EXPECT_EQ(got.size(), want.size());
  int wrong = 0;
  for (size_t i = 0; i < want.size(); ++i) {
    wrong += std::abs(got[i].area - want[i]) > tolerance * want[i] + 1e-7;
    const scene::Vpl none;
    if (!(in.vpls[i].life > 0)) {
      EXPECT_EQ(std::memcmp(&got[i], &none, sizeof none), 0) << i;
      continue;
    }
    EXPECT_EQ(got[i].position, in.vpls[i].position);
    EXPECT_EQ(got[i].normal, in.vpls[i].normal);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(got[i].intensity[c], in.radiosity[i][c] * got[i].area / glm::pi<float>(),
                  1e-6f * got[i].intensity[c]);
  }
  return wrong;
}

// Irradiance at a point from all VPLs, with the disc kernel or clamped, without any occlusion.
inline double irradiance(const std::vector<scene::Vpl>& list, const Seen& s, double clamp = 0) {
  double e = 0;
  for (const scene::Vpl& v : list) {
    const glm::dvec3 to = glm::dvec3(v.position) - glm::dvec3(s.position);
    const double d2 = std::max(glm::dot(to, to), 1e-12);
    const double cosines = std::max(glm::dot(glm::dvec3(s.normal), to), 0.0) *
                           std::max(-glm::dot(glm::dvec3(v.normal), to), 0.0);
    e += v.intensity.x * cosines / d2 /
         (clamp > 0 ? std::max(d2, clamp * clamp) : d2 + v.area / glm::pi<double>());
  }
  return e;
}

}  // namespace fovea::test
