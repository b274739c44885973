// Tests strategy `importance-area` of pass vpl-intensity.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/passes/vpl_intensity_scene.h"
#include "tests/references/eye_paths.h"

namespace fovea::test {
namespace {

// Discs of many cells, close to the surfaces that they light: the VPL compensates for the light that a disc sends less
// than a point would.
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

// A list chosen by another rule, in which one half of the room has four times as many VPLs. The furnace's light
// stays the same, which 1 / (N p) gets wrong; and where the light is not uniform, the paths assign it to whichever
// VPL is there.
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

// VPLs that hardly anything sees, within boxes with a slit: what their paths find is passed to the others, and
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

// With every VPL twice as bright as the surface around it, only the surface counts.
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

// The share of points over the whole view counts in the densities and in the paths.
TEST(Weights, ImportanceAreasOfTheMixedRegion) {
  const Room room = closedRoom(true);
  WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 200, settings)));
  for (uint32_t i = 0; i < in.vpls.size(); ++i)
    in.vpls[i].position += 0.1f * (glm::vec3(sobol(i, 0, 1), sobol(i, 1, 1), sobol(i, 2, 1)) - 0.5f);
  settings.region = scene::kRegionMixed;
  settings.imageShare = 0.3;
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

// A VPL that enters a list takes its share step by step, never in a jump, and has all of it in the end.
TEST(Weights, TheShareOfANewVplGrows) {
  const Room room = closedRoom(false, 32);
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 200, {})));
  for (scene::VplState& vpl : in.vpls) vpl.life = 100;
  std::vector<double> grown;
  for (int life = 1; life <= 10; ++life) {
    for (size_t i = 0; i < in.vpls.size(); i += 20) in.vpls[i].life = float(life);
    PassTest test("vpl-intensity-importance-area");
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

// Where light is lost, a new VPL has its whole share at once.
TEST(Weights, ANewVplDoesNotWaitWhenTheLightHasChanged) {
  const Room room = closedRoom(false, 32);
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 200, {})));
  const auto sum = [&](float life, float lost) {
    for (size_t i = 0; i < in.vpls.size(); ++i) in.vpls[i].life = i % 20 == 0 ? life : 100;
    PassTest test("vpl-intensity-importance-area");
    wire(test, in, "importance-area", {});
    test.buffer("change", std::vector<glm::vec4>{{0, 0, lost, 0}}, "LightChange").param("fade_frames", 8);
    test.run();
    const auto list = test.values<scene::Vpl>("emitters");
    double areas = 0;
    for (size_t i = 0; i < list.size(); i += 20) areas += list[i].area;
    return areas;
  };
  const double whole = sum(100, 0), young = sum(1, 0);
  EXPECT_LT(young, 0.35 * whole);
  EXPECT_EQ(sum(1, 1), whole);
  EXPECT_GT(sum(1, 0.5f), 1.2 * young);
}

// Ends that bring their own light, in colour, and use none of the light of the VPLs themselves.
std::vector<passes::EyePathEnd> colouredEnds(const Room& room, const std::vector<Seen>& points,
                                             uint32_t count) {
  std::vector<passes::EyePathEnd> ends(count);
  for (uint32_t i = 0; i < count; ++i) {
    const Seen& from = points[i % points.size()];
    const uint32_t stream = randomStream(3, 0, 0, i);
    const scene::VoxelHit hit = scene::traceVoxels(
        room.view(), from.position,
        cosineDirection(from.normal, uniformFloat(stream), uniformFloat(hashPcg(stream))), from.normal);
    if (hit.side == scene::kNoSide) continue;
    const scene::VoxelSide& side = room.voxels.surface[hit.side];
    ends[i].position = side.position;
    ends[i].normal = side.normal;
    ends[i].kind = 2;
    ends[i].radiance = glm::max(glm::vec3(side.position.x, side.position.y, 1) * 40.0f, glm::vec3(0));
    ends[i].weight = 1;
  }
  const float unit = passes::sumUnit(ends);
  for (passes::EyePathEnd& e : ends) e.unit = unit;
  return ends;
}

std::vector<scene::Vpl> weighTraced(const Inputs& in, const std::vector<Seen>& points,
                                    const std::vector<passes::EyePathEnd>& ends,
                                    const WeightSettings& settings, float nearArea,
                                    std::vector<float>* worth = nullptr) {
  PassTest test("vpl-intensity-importance-area");
  wire(test, in, "importance-area", settings);
  std::vector<passes::EyePathStart> starts;
  for (const Seen& s : points)
    starts.push_back({s.position, s.there ? 1.0f : 0.0f, s.normal, 0, s.normal, 0});
  test.buffer("traced.starts", starts, "ScreenPoint").buffer("traced.ends", ends, "EyePathEnd");
  if (nearArea > 0) test.buffer("spread", std::vector<glm::vec4>{{nearArea, 0, 0, 0}}, "VplSpread");
  test.run();
  if (worth) *worth = test.values<float>("worth");
  return test.values<scene::Vpl>("emitters");
}

// How much VPLs matter follows from how well the region sees them and from the light of their paths relative to the
// mean, not from how many VPLs there are or how bright the scene is. What is hidden from the region does not matter.
TEST(Weights, WorthIsSightTimesLight) {
  const Room room = closedRoom(false, 32);
  const WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 300, settings)));
  in.vpls[4] = {};
  const auto points = screenPoints(room, settings);
  const auto p = seenDensities(room, in.vpls, points, emptyMaps(in.vpls.size()));
  std::vector<double> sorted;
  for (const double x : p)
    if (x > 0) sorted.push_back(x);
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[(sorted.size() - 1) / 2];
  for (const float brightness : {1.0f, 30.0f, 0.0f}) {
    auto ends = colouredEnds(room, points, 8192);
    double lit = 0, all = 0;
    for (passes::EyePathEnd& e : ends) {  // half of the room is dark
      e.radiance = glm::vec3(e.position.x > 0 ? brightness : 0.0f);
      all += e.kind > 0;
      lit += e.position.x > 0 && e.kind > 0;
    }
    const float unit = passes::sumUnit(ends);
    for (passes::EyePathEnd& e : ends) e.unit = unit;
    for (size_t side = 0; side < in.radiance.size(); ++side)  // stands in for paths where there are none
      in.radiance[side] = glm::vec4(room.voxels.surface[side].position.x > 0 ? brightness : 0.0f);
    std::vector<float> worth;
    weighTraced(in, points, ends, settings, 0, &worth);
    ASSERT_EQ(worth.size(), in.vpls.size());
    EXPECT_EQ(worth[4], 0);
    int checked = 0;
    for (size_t i = 0; i < worth.size(); ++i) {
      const float x = in.vpls[i].position.x;
      if (!(in.vpls[i].life > 0) || std::abs(x) < 0.6f || !(p[i] > 0)) continue;
      const double relative = x > 0 ? all / lit : 0, light = brightness > 0 ? (relative + 0.25) / 1.25 : 1;
      const double w = p[i] / median * light;
      EXPECT_NEAR(worth[i], w / (1 + w), 0.02) << i << ", " << brightness;
      ++checked;
    }
    EXPECT_GT(checked, 100);
  }
  in.maps = {16, std::vector<uint32_t>(256 * in.vpls.size(), scene::kParaboloidEmpty)};
  std::fill_n(in.maps.texels.begin() + 256 * 7, 256, 0);
  std::vector<float> worth;
  weighTraced(in, points, colouredEnds(room, points, 8192), settings, 0, &worth);
  EXPECT_EQ(worth[7], 0);
  EXPECT_GT(worth[8], 0);
}

// The region gets the mean light of the paths' ends, channel by channel, whatever the emission of the VPLs.
TEST(Weights, TracedPathsBringTheirOwnLight) {
  const Room room = closedRoom(false, 32);
  WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 300, settings)));
  for (size_t i = 0; i < in.vpls.size(); ++i) in.radiosity[i] = glm::vec4(float(i % 7));
  WeightSettings elsewhere = settings;  // the paths' own points count, not what the picture shows now
  elsewhere.gaze = {0.1f, 0.8f};
  const auto points = screenPoints(room, elsewhere);
  auto ends = colouredEnds(room, points, 4096);
  for (size_t i = 0; i < ends.size(); i += 5)
    ends[i].kind = i % 2 == 0 ? 3 : 4;  // emissive, or lit by other surfaces, although no VPL is
  const double pi = glm::pi<double>();
  for (const float nearArea : {0.0f, 0.1f}) {
    glm::dvec3 want(0), got(0);  // without the light of pass near-field
    for (size_t i = 0; i < ends.size(); ++i) {
      const double d = glm::distance(ends[i].position, points[i % points.size()].position);
      want += glm::dvec3(ends[i].radiance) * (pi * d * d / (pi * d * d + nearArea)) / double(ends.size());
    }
    for (const scene::Vpl& v : weighTraced(in, points, ends, settings, nearArea)) {
      EXPECT_GE(v.area, nearArea);
      for (const Seen& s : points) {
        const glm::dvec3 to = glm::dvec3(v.position) - glm::dvec3(s.position);
        const double d2 = glm::dot(to, to);
        const double cosines = std::max(glm::dot(glm::dvec3(s.normal), to), 0.0) *
                               std::max(-glm::dot(glm::dvec3(v.normal), to), 0.0);
        if (!(cosines > 1e-12 * d2)) continue;
        got += glm::dvec3(v.intensity) * (cosines / d2 / (pi * d2 + v.area) / double(points.size()));
      }
    }
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(got[c], want[c], 0.01 * want[c]) << "channel " << c << ", " << nearArea;
  }
}

// A single VPL gets the light of all paths. Its disc sends less to what is close than its density says, for which it
// makes up, but by no more than a factor of two where pass near-field is wired.
TEST(Weights, NearFieldLimitsTheGainOfDiscs) {
  const Room room = closedRoom(false, 32);
  const WeightSettings settings;
  const auto points = screenPoints(room, settings);
  auto ends = colouredEnds(room, points, 4096);
  ends.resize(4 * ends.size());  // most paths escape, so that the disc of the VPL's own light is small
  const double pi = glm::pi<double>(), nearArea = 0.1;
  glm::dvec3 light(0);
  double found = 0;
  for (size_t i = 0; i < ends.size(); ++i) {
    const double d = glm::distance(ends[i].position, points[i % points.size()].position);
    light += glm::dvec3(ends[i].radiance) * (pi * d * d / (pi * d * d + nearArea)) / double(ends.size());
    found += (ends[i].kind > 0) / double(ends.size());
  }
  for (const bool close : {false, true}) {
    Inputs in = inputs(room, {vplsOf(room, candidatesOf(room, 20, settings)).front()});
    scene::VplState& vpl = in.vpls[0];
    vpl.normal = -points[0].normal;
    vpl.position = points[0].position + (close ? 0.02f : 0.8f) * points[0].normal;
    in.maps = emptyMaps(1);
    const double before = seenDensities(room, in.vpls, points, in.maps)[0];
    const std::vector<double> areas{std::max(nearArea, found / before)};
    const double after = seenDensities(room, in.vpls, points, in.maps, 0, &areas)[0];
    if (close)
      EXPECT_GT(before / after, 3);
    else
      EXPECT_LT(before / after, 2);
    const auto got = weighTraced(in, points, ends, settings, float(nearArea))[0];
    for (int c = 0; c < 3; ++c) {
      const double want = light[c] / before * std::min(before / after, 2.0);
      EXPECT_NEAR(got.intensity[c], want, 0.02 * want) << "channel " << c << ", " << close;
    }
  }
}

// Otherwise near-field light would be in the picture twice.
TEST(Weights, SpreadNeedsPathsAndDiscs) {
  const Room room = closedRoom(false, 32);
  WeightSettings settings;
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 100, settings)));
  const auto points = screenPoints(room, settings);
  const auto ends = colouredEnds(room, points, 256);
  for (const bool traced : {false, true}) try {
      PassTest test("vpl-intensity-importance-area");
      settings.clamp = traced ? 1.5f : 0;
      wire(test, in, "importance-area", settings);
      test.buffer("spread", std::vector<glm::vec4>{{0.1f, 0, 0, 0}}, "VplSpread");
      if (traced)
        test.buffer("traced.starts", std::vector<passes::EyePathStart>(points.size()), "ScreenPoint")
            .buffer("traced.ends", ends, "EyePathEnd");
      test.run();
      FAIL();
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::BadInput);
      EXPECT_NE(std::string(e.what()).find("`spread`"), std::string::npos) << e.what();
    }
}

// Behind a block some VPLs are seen from here and others from there; a path is assigned to one that its own start sees.
TEST(Weights, TracedPathsGoToVplsThatTheirStartsSee) {
  const Room room = closedRoom(true);
  const WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 200, settings)));
  for (uint32_t i = 0; i < in.vpls.size(); ++i)
    in.vpls[i].position += 0.1f * (glm::vec3(sobol(i, 0, 1), sobol(i, 1, 1), sobol(i, 2, 1)) - 0.5f);
  const auto points = screenPoints(room, settings);
  in.maps = tracedMaps(room, in.vpls);
  std::vector<passes::EyePathEnd> ends(8192);
  for (uint32_t i = 0; i < ends.size(); ++i) {
    const uint32_t side = endOfPath(room, points, i);
    if (side == scene::kNoSide) continue;
    ends[i].position = room.voxels.surface[side].position;
    ends[i].normal = room.voxels.surface[side].normal;
    ends[i].kind = 2;
    ends[i].weight = 1;
    ends[i].radiance = glm::vec3(1);
  }
  const float unit = passes::sumUnit(ends);
  for (passes::EyePathEnd& e : ends) e.unit = unit;
  const auto got = weighTraced(in, points, ends, settings, 0);
  const auto want = sharedAreas(room, in.vpls, in.radiance, points, in.maps, 8192, settings, true).area,
             nearest = sharedAreas(room, in.vpls, in.radiance, points, in.maps, 8192, settings).area;
  double off = 0, other = 0, all = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    off += std::abs(got[i].area - want[i]);
    other += std::abs(nearest[i] - want[i]);
    all += want[i];
  }
  EXPECT_LT(off, 0.01 * all);
  EXPECT_GT(other, 0.02 * all);  // it makes a difference
}

// Paths that hit nothing count among those tried; if none hits anything, there is no light.
TEST(Weights, TracedPathsThatEndNowhere) {
  const Room room = closedRoom(false, 16, glm::ivec2(32));
  const WeightSettings settings;
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 60, settings)));
  const auto points = screenPoints(room, settings);
  auto ends = colouredEnds(room, points, 2048);
  const auto all = weighTraced(in, points, ends, settings, 0);
  ends.resize(4096);  // as many again escape
  const auto half = weighTraced(in, points, ends, settings, 0);
  for (size_t i = 0; i < all.size(); ++i)
    EXPECT_NEAR(half[i].area, all[i].area / 2, 1e-5f * all[i].area) << i;
  for (const scene::Vpl& v : weighTraced(in, points, std::vector<passes::EyePathEnd>(64), settings, 1))
    EXPECT_EQ(v.intensity, glm::vec3(0));
}

}  // namespace
}  // namespace fovea::test
