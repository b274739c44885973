#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "framework/base/low_discrepancy.h"
#include "tests/passes/weights_reference.h"

namespace fovea::test {
namespace {

scene::VplState vplAt(const Room& room, uint32_t side) {
  const scene::VoxelSide& s = room.voxels.surface[side];
  scene::VplState vpl;
  vpl.position = s.position;
  vpl.normal = s.normal;
  vpl.reflectance = s.reflectance;
  vpl.side = side;
  vpl.life = 1;
  return vpl;
}

glm::vec3 cosineDirection(glm::vec3 n, float u, float v) {
  const glm::vec3 t =
      glm::normalize(glm::cross(std::abs(n.x) > 0.5f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), n));
  const float phi = glm::two_pi<float>() * v, r = std::sqrt(u);
  return glm::normalize(r * std::cos(phi) * t + r * std::sin(phi) * glm::cross(n, t) + std::sqrt(1 - u) * n);
}

// As pass candidates: a pixel of the region, one diffuse bounce.
std::vector<scene::Candidate> candidatesOf(const Room& room, uint32_t count, const WeightSettings& settings) {
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

std::vector<scene::VplState> vplsOf(const Room& room, const std::vector<scene::Candidate>& candidates) {
  std::vector<scene::VplState> vpls;
  for (const scene::Candidate& c : candidates)
    if (c.side != scene::kNoSide) vpls.push_back(vplAt(room, c.side));
  return vpls;
}

// Inputs of the pass; radiosity and radiance 1 everywhere until changed.
struct Inputs {
  const Room* room = nullptr;
  std::vector<scene::VplState> vpls;
  std::vector<glm::vec4> radiosity, radiance;
  Maps maps;  // without texels: nothing hides anything
};

// As pass place.
std::vector<scene::Vpl> placed(const Inputs& in) {
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

Inputs inputs(const Room& room, std::vector<scene::VplState> vpls) {
  Inputs in;
  in.room = &room;
  in.radiosity.assign(vpls.size(), glm::vec4(1));
  in.radiance.assign(std::max<size_t>(room.voxels.surface.size(), 1), glm::vec4(1 / glm::pi<float>()));
  in.vpls = std::move(vpls);
  return in;
}

void wire(PassTest& test, const Inputs& in, const char* strategy, const WeightSettings& settings) {
  const Room& room = *in.room;
  std::vector<float> position;
  std::vector<uint16_t> normal;
  std::vector<int16_t> face;
  for (const Seen& s : room.pixels) {
    position.insert(position.end(), {s.position.x, s.position.y, s.position.z, s.there ? 1.0f : 0.0f});
    for (const float x : {s.normal.x, s.normal.y, s.normal.z, 0.0f}) normal.push_back(glm::packHalf1x16(x));
    // All faces of the test scenes are axis-parallel.
    const glm::vec2 oct = s.normal.z >= -0.5f ? glm::vec2(s.normal) : glm::vec2(1);
    for (const float x : {oct.x, oct.y}) face.push_back(int16_t(std::lround(32767 * x)));
  }
  const auto w = uint32_t(room.size.x), h = uint32_t(room.size.y);
  test.param("strategy", strategy)
      .param("region", settings.region == kRegionMixed          ? "mixed"
                       : settings.region == scene::kRegionImage ? "image"
                                                                : "fovea");
  test.param("fovea_radius", double(settings.foveaRadius)).param("points", int(settings.points));
  test.param("area_cap", settings.areaCap).param("normal_weight", settings.normalWeight);
  test.param("sides", settings.litOnly ? "lit" : "all");
  test.param("kernel", settings.clamp > 0 ? "clamp" : "disc");
  if (settings.clamp > 0) test.param("clamp_distance", settings.clamp);
  test.viewSize(w, h).scene(room.scene);
  test.image("gbuffer.position", VK_FORMAT_R32G32B32A32_SFLOAT, w, h, 1, position);
  test.image("gbuffer.normal", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, normal);
  test.image("gbuffer.face", VK_FORMAT_R16G16_SNORM, w, h, 1, face);
  setVoxels(test, room.voxels);
  test.buffer("vpls", in.vpls, "VplState").buffer("radiosity", in.radiosity, "VplRadiosity");
  test.buffer("radiance", in.radiance, "VoxelRadiance").buffer("placed", placed(in), "Vpl");
  const Maps maps = in.maps.texels.empty() ? emptyMaps(in.vpls.size()) : in.maps;
  const auto side = uint32_t(maps.size);
  test.image("atlas", VK_FORMAT_R32_UINT, side, side, uint32_t(in.vpls.size()), maps.texels);
}

std::vector<scene::Vpl> weigh(const Inputs& in, const char* strategy, const WeightSettings& settings = {}) {
  PassTest test("weights");
  wire(test, in, strategy, settings);
  if (settings.gaze != glm::vec2(0.5f))
    test.beforeFrame([&](PassTest&, scene::Frame& frame) { frame.views[0].gaze = settings.gaze; });
  test.run();
  return test.values<scene::Vpl>("emitters");
}

double sumOfAreas(const std::vector<scene::Vpl>& list) {
  double sum = 0;
  for (const scene::Vpl& v : list) sum += v.area;
  return sum;
}

// Slots whose area is off by more than `tolerance`, relative; what is not area must be right in all of them.
int wrongAreas(const std::vector<scene::Vpl>& got, const Inputs& in, const std::vector<double>& want,
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

// Irradiance at a point from all VPLs, with the disc kernel or clamped; nothing stands in between.
double irradiance(const std::vector<scene::Vpl>& list, const Seen& s, double clamp = 0) {
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

TEST(Weights, PdfEqualsTheReference) {
  const Room room = closedRoom(true);
  for (const uint32_t region : {scene::kRegionFovea, scene::kRegionImage}) {
    WeightSettings settings;
    settings.region = region;
    settings.points = region == scene::kRegionFovea ? 1024 : 100;
    settings.gaze =
        region == scene::kRegionFovea ? glm::vec2(0.4f, 0.8f) : glm::vec2(0.5f);  // a clipped disc
    const auto candidates = candidatesOf(room, 400, settings);
    Inputs in = inputs(room, vplsOf(room, candidates));
    ASSERT_GT(in.vpls.size(), 300u);
    for (size_t i = 0; i < in.vpls.size(); i += 7) in.vpls[i] = {};
    for (size_t i = 0; i < in.radiosity.size(); ++i) in.radiosity[i] = {0.1f * i, 2, 0.5f, 1};
    const auto p = densities(room, in.vpls, screenPoints(room, settings));
    // A test of visibility or a pixel may fall to the other side by rounding.
    // A ray that loses one of 64 shares by rounding changes an area by a percent or two.
    const double share = escaping(room, screenPoints(room, settings));
    EXPECT_LE(wrongAreas(weigh(in, "pdf", settings), in, pdfAreas(in.vpls, p, 4, share), 3e-4), 8);
  }
}

// The share that escapes belongs to the paths: a room of which only two walls are left.
TEST(Weights, PathsThatEscapeCount) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {-2, -2, -2}, {4, 0, 0}, {0, 4, 0});  // looked at
  addQuad(s, 0, {-2, -2, 2}, {4, 0, 0}, {0, 0, -4});  // the floor
  const Room room = lookInto(std::move(s), 32, glm::ivec2(64));
  WeightSettings settings;
  const auto candidates = candidatesOf(room, 3000, settings);
  const Inputs in = inputs(room, vplsOf(room, candidates));
  const auto points = screenPoints(room, settings);
  const double share = escaping(room, points);
  EXPECT_GT(share, 2);
  EXPECT_NEAR(share, double(candidates.size()) / double(in.vpls.size()), 0.1 * share);
  const auto want = pdfAreas(in.vpls, densities(room, in.vpls, points), 4, share);
  EXPECT_LE(wrongAreas(weigh(in, "pdf", settings), in, want, 3e-4), int(want.size() / 50));
}

TEST(Weights, PdfSpreadsOverTheSurfaceThatIsReached) {
  const Room room = closedRoom(false, 32);
  WeightSettings settings;
  settings.areaCap = 16;  // few VPLs in edges, between two walls, are hardly seen
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 2000, settings)));
  const auto list = weigh(in, "pdf", settings);
  // The wall that is looked at: most of it is reached by no path of its own region, 5/6 of 96 m^2 are.
  EXPECT_NEAR(sumOfAreas(list), 80, 8);
}

// Light that is the same everywhere in a closed room: irradiance B on every surface, pi L with L = B / pi.
TEST(Weights, FurnaceOfDensities) {
  const Room room = closedRoom(false, 32);
  WeightSettings settings;
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 2000, settings)));
  const auto list = weigh(in, "pdf", settings);
  const scene::Fovea fovea = scene::makeFovea(settings.gaze, room.size, settings.foveaRadius);
  double mean = 0;
  for (uint32_t i = 0; i < 500; ++i) {  // other points than the densities'
    const glm::ivec2 p = scene::regionSample(scene::kRegionFovea, fovea, room.size, randomStream(8, 0, 0, i));
    mean += irradiance(list, room.pixels[size_t(p.y) * room.size.x + p.x]) / 500;
  }
  EXPECT_NEAR(mean, 1, 0.04);
}

// Discs of many cells, close to what they light: what a disc sends less than a point, the VPL makes good.
TEST(Weights, FurnaceOfFewVpls) {
  const Room room = closedRoom(false, 32);
  WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 40, settings)));
  const auto list = weigh(in, "importance-area", settings);
  double mean = 0;
  const auto points = screenPoints(room, settings);
  for (const Seen& s : points) mean += irradiance(list, s) / double(points.size());
  EXPECT_NEAR(mean, 1, 0.02);
}

// A list that something else has picked: the VPLs of one half of the room are four times as many. The
// furnace's light stays, which 1 / (N p) gets wrong; and where the light is not the same everywhere, the
// paths bring it to whichever VPL is there.
TEST(Weights, FurnaceOfImportanceAreasWhateverPickedTheVpls) {
  const Room room = closedRoom(false, 32);
  WeightSettings settings;
  std::vector<scene::Candidate> picked;
  const auto candidates = candidatesOf(room, 3000, settings);
  for (size_t i = 0; i < candidates.size(); ++i)
    if (candidates[i].position.y < 0 || i % 4 == 0) picked.push_back(candidates[i]);
  Inputs in = inputs(room, vplsOf(room, picked));
  const scene::Fovea fovea = scene::makeFovea(settings.gaze, room.size, settings.foveaRadius);
  const auto meanIrradiance = [&](const char* strategy) {
    const auto list = weigh(in, strategy, settings);
    double mean = 0;
    for (uint32_t i = 0; i < 500; ++i) {
      const glm::ivec2 p =
          scene::regionSample(scene::kRegionFovea, fovea, room.size, randomStream(8, 0, 0, i));
      mean += irradiance(list, room.pixels[size_t(p.y) * room.size.x + p.x], settings.clamp) / 500;
    }
    return mean;
  };
  EXPECT_NEAR(meanIrradiance("importance-area"), 1, 0.04);
  settings.clamp = 1.5;
  EXPECT_NEAR(meanIrradiance("importance-area"), 1, 0.02);
  settings.clamp = 0;
  for (size_t i = 0; i < in.vpls.size(); ++i)
    if (in.vpls[i].position.y > 0) in.radiosity[i] = glm::vec4(0);
  EXPECT_NEAR(meanIrradiance("importance-area"), 0.5, 0.03);
  EXPECT_GT(meanIrradiance("pdf"), 0.6);
}

// VPLs that hardly anything sees, within boxes with a slit: what their paths find goes to the others, and
// none is lost.
TEST(Weights, LightOfHiddenVplsGoesToOthers) {
  const Room room = closedRoom(false, 32);
  WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 300, settings)));
  in.maps = {16, std::vector<uint32_t>(256 * in.vpls.size(), scene::kParaboloidEmpty)};
  const auto meanIrradiance = [&](const std::vector<scene::Vpl>& list) {
    double mean = 0;
    const auto points = screenPoints(room, settings);
    for (const Seen& s : points)
      for (size_t i = 0; i < list.size(); ++i)
        if (seesVpl(in.maps, s, in.vpls[i], i)) mean += irradiance({list[i]}, s) / double(points.size());
    return mean;
  };
  const double open = meanIrradiance(weigh(in, "importance-area", settings));
  EXPECT_NEAR(open, 1, 0.02);
  for (size_t i = 0; i < in.vpls.size(); i += 2)
    for (int texel = 0; texel < 256; ++texel) {
      const glm::vec3 d = scene::paraboloidTexelDirection({texel % 16, texel / 16}, 16);
      if (d.x < 0.8f) in.maps.texels[256 * i + size_t(texel)] = 0;
    }
  const auto list = weigh(in, "importance-area", settings);
  EXPECT_NEAR(meanIrradiance(list), open, 0.03);
}

// Every VPL twice as bright as the surface around it: it is the surface that counts.
TEST(Weights, ImportanceAreasTakeTheLightFromTheEndsOfPaths) {
  const Room room = closedRoom(false, 32);
  WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 300, settings)));
  const auto even = weigh(in, "importance-area", settings);
  for (size_t i = 0; i < in.vpls.size(); ++i) {
    in.radiosity[i] = glm::vec4(2);
    in.radiance[in.vpls[i].side] = glm::vec4(2 / glm::pi<float>());
  }
  const auto uneven = weigh(in, "importance-area", settings);
  double before = 0, after = 0;
  for (size_t i = 0; i < even.size(); ++i) {
    EXPECT_FLOAT_EQ(even[i].area, uneven[i].area);
    before += even[i].intensity.x;
    after += uneven[i].intensity.x;
  }
  EXPECT_NEAR(after / before, 1, 0.15);  // the sides of the VPLs themselves are brighter
}

TEST(Weights, ImportanceAreasEqualTheReference) {
  const Room room = closedRoom(true);
  for (const double clamp : {0.0, 1.5}) {
    WeightSettings settings;
    settings.clamp = clamp;
    Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 300, settings)));
    for (size_t i = 0; i < in.vpls.size(); i += 5) in.vpls[i] = {};
    for (uint32_t i = 0; i < in.vpls.size(); ++i)  // off the lattice, where many are equally near
      if (in.vpls[i].life > 0)
        in.vpls[i].position += 0.1f * (glm::vec3(sobol(i, 0, 1), sobol(i, 1, 1), sobol(i, 2, 1)) - 0.5f);
    for (size_t s = 0; s < in.radiance.size(); ++s)
      in.radiance[s] = glm::vec4(std::max(room.voxels.surface[s].position.x, 0.0f));
    for (size_t i = 0; i < in.vpls.size(); ++i)  // half of it is direct light
      in.radiosity[i] = glm::vec4(2 * glm::pi<float>() * in.radiance[in.vpls[i].side].w + 0.1f);
    const auto points = screenPoints(room, settings);
    in.maps = tracedMaps(room, in.vpls);
    const auto p = seenDensities(room, in.vpls, points, in.maps, float(clamp));
    const auto open = seenDensities(room, in.vpls, points, emptyMaps(in.vpls.size()), float(clamp));
    double seen = 0, whole = 0;
    for (size_t i = 0; i < p.size(); ++i) seen += p[i], whole += open[i];
    EXPECT_LT(seen, 0.99 * whole);  // the block hides something
    const SharedAreas want = sharedAreas(room, in.vpls, in.radiance, points, in.maps, 8192, settings);
    EXPECT_GT(want.passed, 20);
    const auto got = weigh(in, "importance-area", settings);
    int wrong = 0;
    double off = 0, all = 0;
    for (size_t i = 0; i < got.size(); ++i) {
      if (!(in.vpls[i].life > 0)) continue;
      off += std::abs(got[i].area - want.area[i]);
      all += want.area[i];
      const double own = glm::pi<double>() * in.radiance[in.vpls[i].side].w;
      const double direct = own / in.radiosity[i].w, gain = own > 0 ? 1 + direct * (want.light[i] - 1) : 1;
      const double intensity = in.radiosity[i].x * want.area[i] * gain * want.gain[i] / glm::pi<double>();
      wrong += std::abs(got[i].intensity.x - intensity) > 2e-3 * intensity + 1e-7;
    }
    EXPECT_LT(off, 0.01 * all);
    EXPECT_LE(wrong,
              int(got.size() / 20));  // a path falls to the other side
    EXPECT_LT(want.doubtful, 80);
  }
}

// The whole view's share of the points counts in the densities and in the paths.
TEST(Weights, ImportanceAreasOfTheMixedRegion) {
  const Room room = closedRoom(true);
  WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 200, settings)));
  for (uint32_t i = 0; i < in.vpls.size(); ++i)
    in.vpls[i].position += 0.1f * (glm::vec3(sobol(i, 0, 1), sobol(i, 1, 1), sobol(i, 2, 1)) - 0.5f);
  settings.region = kRegionMixed;
  const auto points = screenPoints(room, settings);
  in.maps = tracedMaps(room, in.vpls);
  const SharedAreas want = sharedAreas(room, in.vpls, in.radiance, points, in.maps, 8192, settings);
  const auto got = weigh(in, "importance-area", settings);
  double off = 0, all = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    off += std::abs(got[i].area - want.area[i]);
    all += want.area[i];
  }
  EXPECT_LT(off, 0.01 * all);
}

// A VPL that comes into a list takes its share step by step, never in a jump, and all of it in the end.
TEST(Weights, TheShareOfANewVplGrows) {
  const Room room = closedRoom(false, 32);
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 200, {})));
  for (scene::VplState& vpl : in.vpls) vpl.life = 100;
  std::vector<double> grown;
  for (int life = 1; life <= 10; ++life) {
    for (size_t i = 0; i < in.vpls.size(); i += 20) in.vpls[i].life = float(life);
    PassTest test("weights");
    wire(test, in, "importance-area", {});
    test.param("fade_frames", 8);
    test.run();
    const auto list = test.values<scene::Vpl>("emitters");
    double sum = 0;
    for (size_t i = 0; i < list.size(); i += 20) sum += list[i].area;
    grown.push_back(sum);
  }
  const double whole = grown.back();
  ASSERT_GT(whole, 0);
  EXPECT_LT(grown[0], 0.35 * whole);
  for (size_t k = 1; k < grown.size(); ++k) {
    EXPECT_GE(grown[k], grown[k - 1]) << k;
    EXPECT_LT(grown[k] - grown[k - 1], 0.3 * whole) << k;
  }
  EXPECT_EQ(grown[8], whole);
}

// Here paths have to reach every surface: one that no VPL lies on gives its area to VPLs that shine
// elsewhere.
TEST(Weights, FurnaceOfAreas) {
  const Room room = closedRoom(false, 32, glm::ivec2(64), 2.2f);
  WeightSettings settings;
  settings.region = scene::kRegionImage;
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 2000, settings)));
  const auto list = weigh(in, "area", settings);
  double mean = 0;
  for (uint32_t i = 0; i < 500; ++i) {
    const glm::ivec2 p = scene::regionSample(scene::kRegionImage, {}, room.size, randomStream(8, 0, 0, i));
    mean += irradiance(list, room.pixels[size_t(p.y) * room.size.x + p.x]) / 500;
  }
  EXPECT_NEAR(mean, 1, 0.05);
}

TEST(Weights, AreasEqualASearchOfAllVpls) {
  const Room room = closedRoom(true);
  for (const bool litOnly : {true, false}) {
    WeightSettings settings;
    settings.litOnly = litOnly;
    settings.region = scene::kRegionImage;
    Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 1500, settings)));
    for (size_t i = 0; i < in.vpls.size(); i += 5) in.vpls[i] = {};
    for (uint32_t i = 0; i < in.vpls.size(); ++i)  // off the lattice, where many are equally near
      if (in.vpls[i].life > 0)
        in.vpls[i].position += 0.1f * (glm::vec3(sobol(i, 0, 1), sobol(i, 1, 1), sobol(i, 2, 1)) - 0.5f);
    double lit = 0;
    for (size_t s = 0; s < in.radiance.size(); ++s) {
      if (room.voxels.surface[s].position.x > 0.3f) in.radiance[s] = glm::vec4(0);
      if (!litOnly || in.radiance[s].w > 0) lit += room.voxels.surface[s].area;
    }
    double doubtful = 0;
    const auto want = voronoiAreas(room, in.vpls, in.radiance, settings, &doubtful);
    const auto got = weigh(in, "area", settings);
    double off = 0;
    for (size_t i = 0; i < want.size(); ++i) off += std::abs(got[i].area - want[i]);
    EXPECT_LE(off, 2 * doubtful + 1e-4 * lit);
    EXPECT_LT(doubtful, 0.01 * lit);  // the test tests something
    wrongAreas(got, in, want, 1);
    EXPECT_NEAR(sumOfAreas(got), lit, 1e-5 * lit);
  }
}

TEST(Weights, AConstantStaysWhatTheFirstFrameMadeIt) {
  const Room room = closedRoom(true);
  WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 200, settings)));
  for (size_t i = 0; i < in.radiosity.size(); ++i) in.radiosity[i] = glm::vec4(float(i % 7));
  const auto points = screenPoints(room, settings);
  const auto areas = pdfAreas(in.vpls, densities(room, in.vpls, points), 4, escaping(room, points));
  double flux = 0, sum = 0;
  for (size_t i = 0; i < areas.size(); ++i) {
    flux += in.radiosity[i].w * areas[i];
    sum += in.radiosity[i].w;
  }
  const double total = double(in.vpls.size()) * flux / sum;

  PassTest test("weights");
  wire(test, in, "constant", settings);
  uint32_t frame = 0;
  test.beforeFrame([&](PassTest& t, scene::Frame&) {
    if (frame == 0)
      t.set("radiosity", std::vector<glm::vec4>(in.radiosity.size(), glm::vec4(0)));  // no flux: waits
    if (frame == 1) t.set("radiosity", in.radiosity);
    if (frame == 2) {  // others, and half of them: the total is divided among those
      for (size_t i = 0; i < in.vpls.size(); ++i) in.vpls[i] = i % 2 ? in.vpls[0] : scene::VplState{};
      t.set("vpls", in.vpls);
      t.set("placed", placed(in));
    }
    ++frame;
  });
  for (const uint32_t frames : {1u, 2u, 3u}) {
    test.run(1);
    const auto list = test.values<scene::Vpl>("emitters");
    double alive = 0;
    for (const scene::VplState& vpl : in.vpls) alive += vpl.life > 0;
    for (size_t i = 0; i < list.size(); ++i) {
      const double want = frames > 1 && in.vpls[i].life > 0 ? total / alive : 0;
      ASSERT_NEAR(list[i].area, want, 2e-3 * want) << frames << " " << i;
    }
  }
}

TEST(Weights, AVplOutOfSightHasTheLargestArea) {
  const Room room = closedRoom(true);
  WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 100, settings)));
  in.vpls[3].position = {0, -1.9f, 1.9f};  // turned away from all that is looked at
  in.vpls[3].normal = {0, 0, 1};
  const auto list = weigh(in, "pdf", settings);
  float largest = 0;
  std::vector<float> areas;
  for (const scene::Vpl& v : list) areas.push_back(v.area);
  largest = *std::max_element(areas.begin(), areas.end());
  EXPECT_EQ(list[3].area, largest);
  std::sort(areas.begin(), areas.end());
  EXPECT_NEAR(largest, 4 * areas[areas.size() / 2], 0.15f * largest);
}

TEST(Weights, NothingToWeigh) {
  const Room room = closedRoom(false, 12, glm::ivec2(16));
  const scene::VplState empty;
  for (const char* strategy : {"constant", "pdf", "area", "importance-area"}) {
    SCOPED_TRACE(strategy);
    for (const size_t count : {1, 70}) {
      const auto list = weigh(inputs(room, std::vector<scene::VplState>(count, empty)), strategy);
      ASSERT_EQ(list.size(), count);
      for (const scene::Vpl& v : list) EXPECT_EQ(std::memcmp(&v, &empty, sizeof v), 0);
    }
  }
}

TEST(Weights, OneVplStandsForAll) {
  const Room room = closedRoom(false, 12, glm::ivec2(16));
  WeightSettings settings;
  const auto candidates = candidatesOf(room, 1, settings);
  const Inputs in = inputs(room, {vplAt(room, candidates[0].side)});
  double all = 0;
  for (const scene::VoxelSide& s : room.voxels.surface) all += s.area;
  EXPECT_NEAR(weigh(in, "area")[0].area, all, 1e-5 * all);
  const auto p = densities(room, in.vpls, screenPoints(room, settings));
  const double want = 1 / (p[0] * escaping(room, screenPoints(room, settings)));
  EXPECT_NEAR(weigh(in, "pdf", settings)[0].area, want, 1e-3 * want);
  EXPECT_NEAR(weigh(in, "constant", settings)[0].area, want, 1e-3 * want);
  EXPECT_NEAR(weigh(in, "importance-area", settings)[0].area, want, 0.01 * want);
}

TEST(Weights, NothingLit) {
  const Room room = closedRoom(false, 12, glm::ivec2(16));
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 50, {})));
  for (glm::vec4& r : in.radiance) r = glm::vec4(0);
  for (glm::vec4& r : in.radiosity) r = glm::vec4(0);
  for (const char* strategy : {"constant", "pdf", "area", "importance-area"})
    for (const scene::Vpl& v : weigh(in, strategy)) EXPECT_EQ(v.intensity, glm::vec3(0)) << strategy;
}

// The eye looks elsewhere: the region is the whole image then. No surface on screen: no path starts.
TEST(Weights, FoveaOutsideAndBackground) {
  Room room = closedRoom(true, 16, glm::ivec2(32));
  WeightSettings settings;
  settings.gaze = {3, -2};
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 100, settings)));
  const auto p = densities(room, in.vpls, screenPoints(room, settings));
  EXPECT_LE(wrongAreas(weigh(in, "pdf", settings), in,
                       pdfAreas(in.vpls, p, 4, escaping(room, screenPoints(room, settings))), 3e-4),
            4);
  for (Seen& s : room.pixels) s.there = false;
  for (const char* strategy : {"constant", "pdf", "importance-area"})
    for (const scene::Vpl& v : weigh(in, strategy)) EXPECT_EQ(v.area, 0) << strategy;
}

TEST(Weights, NoVoxels) {
  scene::Scene s;
  s.materials.emplace_back();
  const Room room = lookInto(s, 8, glm::ivec2(8));
  ASSERT_EQ(room.voxels.info.voxels, 0u);
  scene::VplState vpl;
  vpl.life = 1;
  vpl.normal = {0, 1, 0};
  vpl.side = 7;  // of another scene
  for (const char* strategy : {"constant", "pdf", "area", "importance-area"})
    for (const scene::Vpl& v : weigh(inputs(room, {vpl, {}}), strategy)) EXPECT_EQ(v.area, 0) << strategy;
}

// Whatever comes in, what goes out to the shading is a number.
TEST(Weights, OutputsAreFinite) {
  const Room room = closedRoom(true, 16, glm::ivec2(32));
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 60, {})));
  in.radiosity[0] = glm::vec4(nan);
  in.radiosity[1] = glm::vec4(1, inf, 1, inf);
  in.radiosity[2] = glm::vec4(3e38f);
  in.radiosity[3] = glm::vec4(-1);
  in.vpls[4].position.y = nan;
  in.vpls[5].normal.z = inf;
  in.vpls[6].normal = glm::vec3(0);
  in.vpls[7].position = glm::vec3(1e30f);
  in.vpls[8].side = 0xfffffffeu;
  in.vpls[9].position = room.pixels[room.pixels.size() / 2].position;  // on a point of the screen
  in.radiance[room.voxels.surface.size() / 2] = glm::vec4(nan);
  for (const char* strategy : {"constant", "pdf", "area", "importance-area"}) {
    SCOPED_TRACE(strategy);
    const auto list = weigh(in, strategy);
    for (size_t i = 0; i < list.size(); ++i) {
      const scene::Vpl& v = list[i];
      for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isfinite(v.position[c]) && std::isfinite(v.normal[c]) &&
                    std::isfinite(v.intensity[c]))
            << i;
        EXPECT_GE(v.intensity[c], 0) << i;
        EXPECT_LE(v.intensity[c], 1e18f) << i;
      }
      EXPECT_TRUE(std::isfinite(v.area) && v.area >= 0) << i;
    }
    const scene::Vpl none;
    for (const int i : {0, 1, 4, 5}) EXPECT_EQ(std::memcmp(&list[i], &none, sizeof none), 0) << i;
    EXPECT_GT(list[20].area, 0);
  }
}

TEST(Weights, TheSameBitsEveryTime) {
  const Room room = closedRoom(true);
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 300, {})));
  for (const char* strategy : {"constant", "pdf", "area", "importance-area"}) {
    const auto a = weigh(in, strategy), b = weigh(in, strategy);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0) << strategy;
  }
}

}  // namespace
}  // namespace fovea::test
