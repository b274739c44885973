// Compares eye paths through triangles, where they end and what they find there, with plain rays and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "passes/path-trace/directions.h"
#include "passes/regions.h"
#include "shaders/records/eye_paths.h"
#include "shaders/records/rays.h"
#include "tests/passes/full_materials_reference.h"
#include "tests/passes/vpl_intensity_reference.h"
#include "tests/references/fovea.h"
#include "tests/support/path_reference.h"

namespace fovea::test {
namespace {

using passes::EyePathEnd;
using passes::EyePathStart;

struct Settings {
  const char* region = "fovea";
  double imageShare = 0.4, foveaRadius = 0.25;
  int points = 1024, bounces = 2, gathered = 2;
  bool emission = true, fullMaterials = false;
  glm::vec2 gaze{0.5f};
};

struct Paths {
  std::vector<EyePathStart> starts;
  std::vector<EyePathEnd> ends;
  double rays = 0, found = 0;  // counters
};

Paths pathsOf(const PassTest& test) {
  return {test.values<EyePathStart>("paths.starts"), test.values<EyePathEnd>("paths.ends"),
          test.counter("rays"), test.counter("ends")};
}

// A scene as its first camera sees it, and the paths that the pass traces from there in a first frame.
struct Look {
  scene::Scene scene;
  scene::Geometry geometry;
  scene::View view;

  explicit Look(scene::Scene s, glm::uvec2 size = glm::uvec2(64)) : scene(std::move(s)) {
    if (scene.cameras.empty()) scene.cameras.emplace_back();
    geometry = scene::flatten(scene);
    view = scene::makeView(scene.cameras[0], size, geometry);
  }
  void wire(PassTest& test, const Settings& settings, int paths) const {
    test.viewSize(view.size.x, view.size.y).scene(scene).raysOnHost(true);
    test.view("materials", settings.fullMaterials ? "full" : "diffuse");
    test.view("fovea_radius", settings.foveaRadius);
    test.param("region", settings.region).param("image_share", settings.imageShare);
    test.param("points", settings.points).param("paths", paths).param("bounces", settings.bounces);
    test.param("gathered", settings.gathered).param("emission", settings.emission);
    test.beforeFrame([gaze = settings.gaze](PassTest&, scene::Frame& frame) { frame.views[0].gaze = gaze; });
  }
  Paths trace(const Settings& settings, int paths = 4096, uint32_t seed = 1) const {
    PassTest test("eye-paths");
    wire(test, settings, paths);
    test.seed(seed).run();
    return pathsOf(test);
  }
};

scene::Scene litRoom(bool block) {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), red = addMaterial(s, {0.6f, 0.2f, 0.1f});
  const uint32_t walls[6] = {red, grey, grey, red, grey, grey};
  addRoom(s, walls, 2);
  if (block) addBox(s, grey, {-1.1f, -2, -1.6f}, {0.2f, -0.4f, -0.7f});
  s.lights = {pointLight({0.4f, 1.2f, 0.3f}, {10, 20, 30}), pointLight({-1, 0, 0.5f}, {5, 5, 1})};
  return s;
}

TEST(EyePaths, StartFromTheScreenPointsOfPassWeights) {
  const Room room = closedRoom(true);
  const Look look(room.scene, glm::uvec2(room.size));
  for (const auto& [name, region] :
       {std::pair("fovea", scene::kRegionFovea), std::pair("image", scene::kRegionImage),
        std::pair("mixed", scene::kRegionMixed)}) {
    WeightSettings settings;
    settings.region = region;
    PassTest test("eye-paths");
    look.wire(test, {.region = name, .imageShare = settings.imageShare, .points = int(settings.points)},
              int(settings.points));
    test.beforeFrame([&](PassTest&, scene::Frame& frame) { frame.views[0].gaze = settings.gaze; });
    for (const glm::vec2 gaze : {glm::vec2(0.5f), glm::vec2(0.95f, 0.1f), glm::vec2(3, -2)}) {
      settings.gaze = gaze;
      const auto points = screenPoints(room, settings);
      test.run();
      const auto starts = test.values<EyePathStart>("paths.starts");
      ASSERT_EQ(starts.size(), points.size());
      for (uint32_t i = 0; i < points.size(); ++i)
        EXPECT_LT(glm::distance(points[i].position, starts[i].position), 1e-3f) << name << " " << i;
    }
  }
}

// Light that the ends find where no shadow falls: the reflectance of their own surface times the lights' irradiance,
// divided by pi.
TEST(EyePaths, EndsAreLitAsPlainRaysSay) {
  const Look look(litRoom(true));
  const auto ends = look.trace({.bounces = 1}).ends;
  int lit = 0, dark = 0;
  for (const EyePathEnd& e : ends) {
    ASSERT_GT(e.kind, 0);  // the room is closed
    glm::dvec3 irradiance(0);
    for (const scene::Light& light : look.scene.lights) {
      const glm::dvec3 from = glm::dvec3(e.position) + 1e-4 * glm::dvec3(e.normal),
                       to = glm::dvec3(light.position) - from;
      const double d2 = glm::dot(to, to), cosine = glm::dot(glm::dvec3(e.normal), to) / std::sqrt(d2);
      if (cosine <= 0 || castRay(look.scene, look.geometry, from, to, {.tMax = 1})) continue;
      irradiance += glm::dvec3(light.color) * double(light.intensity) * cosine / d2;
    }
    const RayHit at = castRay(look.scene, look.geometry, glm::dvec3(e.position) + 0.01 * glm::dvec3(e.normal),
                              -glm::dvec3(e.normal));
    ASSERT_TRUE(at);
    EXPECT_NEAR(at.t, 0.01, 1e-4);  // ends lie on surfaces
    const glm::dvec3 rho(look.scene.materials[look.geometry.triangles[at.triangle].material()].baseColor);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(e.radiance[c], rho[c] * irradiance[c] / glm::pi<double>(), 2e-3 * e.radiance[c] + 1e-6);
    (e.radiance == glm::vec3(0) ? dark : lit)++;
    EXPECT_EQ(e.kind, e.radiance == glm::vec3(0) ? 1 : 2);
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(dark, 20);
}

// With full materials the ends send light back as their material says, of which the smoothest are treated as a little
// rougher. The Fresnel curve of dielectrics is a polynomial there, within 0.002 of the exact one.
TEST(EyePaths, FullMaterialsSendLightBackAsTheyAre) {
  scene::Scene s = litRoom(false);
  for (scene::Material& m : s.materials) m.roughness = m.baseColor.r > 0.55f ? 0.1f : 0.6f;
  s.materials[0].metallic = 1;
  const Look look(std::move(s));
  const Paths paths = look.trace({.bounces = 1, .fullMaterials = true});
  const std::vector<EyePathEnd>& ends = paths.ends;
  double got = 0, wanted = 0;
  int lit = 0, off = 0;
  for (size_t i = 0; i < ends.size(); ++i) {
    const EyePathEnd& e = ends[i];
    if (!(e.kind > 0)) continue;
    const RayHit at = castRay(look.scene, look.geometry, glm::dvec3(e.position) + 0.01 * glm::dvec3(e.normal),
                              -glm::dvec3(e.normal));
    ASSERT_TRUE(at);
    const scene::Material& m = look.scene.materials[look.geometry.triangles[at.triangle].material()];
    const path_trace::BsdfParameters parameters =
        bsdfParameters(glm::vec3(m.baseColor), m.metallic, std::max(m.roughness, scene::kBounceRoughness));
    const glm::mat3 axes = path_trace::frameAround(e.normal);
    const auto local = [&](glm::vec3 to) {
      return glm::normalize(path_trace::toLocal(axes, to - e.position));
    };
    const path_trace::Bsdf bsdf(parameters, local(paths.starts[i % paths.starts.size()].position));
    glm::dvec3 want(0);
    for (const scene::Light& light : look.scene.lights) {
      const glm::vec3 to = light.position - e.position;
      want += glm::dvec3(light.color * light.intensity * bsdf.evaluate(local(light.position))) /
              double(glm::dot(to, to));
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(e.radiance[c], want[c], 0.04 * want[c] + 1e-5) << i;
    off += glm::distance(glm::dvec3(e.radiance), want) > 5e-3 * glm::length(want) + 1e-5;
    got += double(e.radiance.g);
    wanted += want.g;
    lit += e.radiance != glm::vec3(0);
  }
  EXPECT_NEAR(got / wanted, 1, 5e-3);
  EXPECT_LE(off, lit / 20);  // at grazing angles
  EXPECT_GT(lit, 3000);
}

// The light that the paths bring to the surfaces of the points is their indirect light.
TEST(EyePaths, MeanIsTheIndirectLightOfThePoints) {
  const Look look(litRoom(true));
  const PathReference reference(look.scene, look.geometry);
  constexpr uint32_t kPoints = 64;
  const auto ends = look.trace({.points = int(kPoints)}, 65536).ends;
  const scene::View& view = look.view;
  const scene::Fovea fovea = scene::makeFovea(view.gaze, glm::vec2(view.size), 0.25f);
  glm::dvec3 want(0), got(0);
  for (uint32_t i = 0; i < kPoints; ++i) {
    const glm::ivec2 p = scene::screenPoint(scene::kRegionFovea, 0, i, kPoints, fovea, glm::ivec2(view.size));
    const glm::vec3 d = view.rayDirection(glm::vec2(p) + 0.5f);
    const RayHit hit = castRay(look.scene, look.geometry, view.eye, d);
    const glm::dvec3 rho(look.scene.materials[look.geometry.triangles[hit.triangle].material()].baseColor);
    want += reference.indirect(view.eye, glm::normalize(d), i, 4000) / rho / double(kPoints);
  }
  for (const EyePathEnd& e : ends) got += glm::dvec3(e.radiance) / double(ends.size());
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 0.01 * want[c]) << "channel " << c;
}

// In a closed room with emissive walls, each bounce adds one more term of the series; the paths that are aimed at the
// walls and those that hit them by chance together count as often as there are paths. The median of several seeds is
// taken, since the last bounce rests on one point of a wall, which beside an edge of the room may lie very close.
TEST(EyePaths, Furnace) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f));
  s.materials[m].emission = {1, 2, 4};
  const uint32_t walls[6] = {m, m, m, m, m, m};
  addRoom(s, walls, 2);
  const Look look(std::move(s));
  const double series[] = {1.5, 1.75, 1.875};
  constexpr uint32_t kSeeds = 9;
  for (uint32_t bounces = 1; bounces <= 3; ++bounces) {
    std::vector<double> means[3];
    PassTest test("eye-paths");
    look.wire(test, {.bounces = int(bounces)}, 8192);
    test.beforeFrame([](PassTest&, scene::Frame& frame) { frame.seed = uint32_t(frame.index + 1); });
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
      glm::dvec3 mean(0);
      double weights = 0;
      test.run();
      const auto ends = test.values<EyePathEnd>("paths.ends");
      for (const EyePathEnd& e : ends) {
        EXPECT_EQ(e.kind, e.weight > 0 ? 3 : 0);
        weights += double(e.weight) / double(ends.size());
        mean += double(e.weight) * glm::dvec3(e.radiance) / double(ends.size());
      }
      EXPECT_NEAR(weights, 1, 0.02);
      for (int c = 0; c < 3; ++c) means[c].push_back(mean[c] / series[bounces - 1] / (1 << c));
    }
    for (std::vector<double>& of : means) {
      std::nth_element(of.begin(), of.begin() + kSeeds / 2, of.end());
      EXPECT_NEAR(of[kSeeds / 2], 1, 0.02) << bounces;
    }
  }
}

// Without the emission of the ends none of them is emissive and no path is aimed, but surfaces lit by lights still
// count: it is what passes say of the same room less its own emission.
TEST(EyePaths, WithoutEmission) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f));
  s.materials[m].emission = {1, 2, 4};
  const uint32_t walls[6] = {m, m, m, m, m, m};
  addRoom(s, walls, 2);
  const Look look(std::move(s));
  glm::dvec3 mean(0);
  const auto ends = look.trace({.emission = false}, 8192).ends;
  for (const EyePathEnd& e : ends) {
    EXPECT_EQ(e.kind, 4);  // lit by emissive surfaces
    EXPECT_EQ(e.weight, 1);
    mean += glm::dvec3(e.radiance) / double(ends.size());
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / 0.75 / (1 << c), 1, 0.03);
}

// A lamp so small that one path in some thousands hits it by chance. All starts have a path aimed at it, and together
// they bring the light that it sends to the starts.
TEST(EyePaths, AimedAtALamp) {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), lamp = addMaterial(s, glm::vec3(0));
  const uint32_t walls[6] = {grey, grey, grey, grey, grey, grey};
  s.materials[lamp].emission = {100, 200, 400};
  addRoom(s, walls, 2);
  addQuad(s, lamp, {0.5f, 1.8f, -0.5f}, {0.1f, 0, 0}, {0, 0, 0.1f});  // shines downwards
  const Look look(std::move(s));
  const auto [starts, ends, rays, hits] = look.trace({.bounces = 1});
  double want = 0, got = 0;
  int aimed = 0;
  for (const EyePathStart& start : starts) {
    const glm::dvec3 to = glm::dvec3(0.55, 1.8, -0.45) - glm::dvec3(start.position);
    const double d2 = glm::dot(to, to), cosine = glm::dot(glm::dvec3(start.normal), to) / std::sqrt(d2);
    if (cosine <= 0 || to.y <= 0) continue;
    want += 100 * 0.01 * cosine * to.y / std::sqrt(d2) / d2 / glm::pi<double>() / double(starts.size());
    ++aimed;
  }
  int found = 0;
  for (const EyePathEnd& e : ends) {
    if (e.kind != 3) continue;
    ++found;
    EXPECT_LT(e.weight, 4.0 / 3 + 1e-5);
    got += double(e.weight) * double(e.radiance.r) / double(ends.size());
  }
  EXPECT_NEAR(found, aimed, 3);
  EXPECT_GT(aimed, 100);
  EXPECT_NEAR(got / want, 1, 0.02);
}

// Whatever thread traces which of them.
TEST(EyePaths, TheSameInEveryRunUnlessTheSeedIsAnother) {
  const Look look(litRoom(true));
  const Paths one = look.trace({}), same = look.trace({}), other = look.trace({}, 4096, 2);
  EXPECT_EQ(std::memcmp(one.ends.data(), same.ends.data(), one.ends.size() * sizeof one.ends[0]), 0);
  EXPECT_EQ(one.rays, same.rays);
  EXPECT_EQ(one.found, double(one.ends.size()));
  int others = 0;
  for (size_t i = 0; i < one.ends.size(); ++i) others += one.ends[i].position != other.ends[i].position;
  EXPECT_GT(others, int(one.ends.size()) * 9 / 10);
}

// More rays gather the same light.
TEST(EyePaths, GatherWithAsManyRaysAsTheyAreTold) {
  const Look look(litRoom(false));
  const Paths few = look.trace({.gathered = 1}), many = look.trace({.gathered = 5});
  EXPECT_NEAR(many.rays - few.rays, (few.rays - look.trace({.bounces = 1}).rays) * 4, 0.02 * many.rays);
  double sums[2] = {};
  for (size_t i = 0; i < few.ends.size(); ++i) {
    sums[0] += double(few.ends[i].radiance.r);
    sums[1] += double(many.ends[i].radiance.r);
  }
  EXPECT_NEAR(sums[1] / sums[0], 1, 0.02);
}

// The unit of the sums is chosen so that the sum of all the light fits in 31 bits.
TEST(EyePaths, SumsFitIntoTheirUnit) {
  const Look look(litRoom(false));
  const auto ends = look.trace({}).ends;
  glm::dvec3 sum(0);
  for (const EyePathEnd& e : ends) {
    EXPECT_EQ(e.unit, ends[0].unit);
    sum += glm::dvec3(e.radiance) / double(e.unit);
  }
  EXPECT_NEAR(std::max({sum.r, sum.g, sum.b}) / 2147483648.0, 1, 1e-5);
}

// Paths from a floor under the open sky hit nothing, and neither do those of an empty scene or of one behind the eye.
// A black back reflects nothing.
TEST(EyePaths, NothingToFind) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f));
  addQuad(s, m, {-50, -1, -50}, {0, 0, 100}, {100, 0, 0});
  s.lights = {sun({0, -1, 0}, glm::vec3(3))};
  const EyePathEnd none;
  for (const EyePathEnd& e : Look(std::move(s)).trace({}, 256).ends)
    EXPECT_EQ(std::memcmp(&e, &none, sizeof e), 0);
  PassTest empty("eye-paths");
  empty.param("paths", 64);
  empty.viewSize(8, 8);
  empty.run();
  for (const EyePathEnd& e : empty.values<EyePathEnd>("paths.ends"))
    EXPECT_EQ(std::memcmp(&e, &none, sizeof e), 0);
  EXPECT_EQ(empty.counter("ends"), 0);
}

// After a jump of the gaze a share of the points moves in each frame and the others stay.
TEST(EyePaths, StartsMoveOnInTurns) {
  const Look look(litRoom(true), {32, 32});
  Settings settings;
  settings.points = 100;
  settings.foveaRadius = 0.1;
  const auto before = look.trace(settings, 500).ends;
  settings.gaze = {0.12f, 0.8f};
  const auto after = look.trace(settings, 500).ends;
  PassTest test("eye-paths");
  look.wire(test, settings, 500);
  test.param("renew_frames", 4);
  test.beforeFrame([](PassTest&, scene::Frame& f) {
    f.views[0].gaze = f.index < 3 ? glm::vec2(0.5f) : glm::vec2(0.12f, 0.8f);
  });
  test.run(2);
  for (uint32_t moved = 0; moved <= 4; ++moved) {
    test.run();  // the jump comes with the fourth frame, number 3
    const auto got = test.values<EyePathEnd>("paths.ends");
    for (uint32_t i = 0; i < got.size(); ++i) {
      const bool anew = (i % 100 + 4 - 3) % 4 < moved;  // frame f renews the points f, f + 4..
      const EyePathEnd& want = anew ? after[i] : before[i];
      EXPECT_EQ(got[i].position, want.position) << moved << " " << i;
      EXPECT_EQ(got[i].radiance, want.radiance) << moved << " " << i;
      EXPECT_EQ(got[i].unit, got[0].unit);
    }
  }
  EXPECT_NE(before[0].position, after[0].position);
}

// The eye moves past the block. A start that is due stays where the eye still sees it, at most `stray` from its place.
TEST(EyePaths, StartsStayUntilTheyStray) {
  const Look before(litRoom(true));
  scene::Scene moved = litRoom(true);
  moved.cameras.emplace_back().position = {0.1f, -0.25f, -0.1f};
  const Look after(std::move(moved));
  const scene::View& view = after.view;
  const glm::vec2 size(view.size);
  const Settings settings{.region = "mixed"};
  const uint32_t points = uint32_t(settings.points);
  const auto startsOf = [&](const Look& look) { return look.trace(settings, settings.points).starts; };
  const auto startsAfter = [&](float stray) {
    PassTest test("eye-paths");
    before.wire(test, settings, settings.points);
    test.param("stray", double(stray)).beforeFrame([&](PassTest&, scene::Frame& frame) {
      if (frame.index == 1) frame.views[0] = view;
    });
    test.run(2);
    return test.values<EyePathStart>("paths.starts");
  };
  const auto old = startsOf(before), fresh = startsOf(after);
  EXPECT_NE(old[0].position, fresh[0].position);
  const scene::Fovea fovea = scene::makeFovea(view.gaze, size, float(settings.foveaRadius));
  for (const float stray : {0.0f, 0.17f, 0.25f}) {
    const auto got = startsAfter(stray);
    int kept = 0, hidden = 0, strayed = 0;
    for (uint32_t i = 0; i < got.size(); ++i) {
      const glm::dvec3 eye(view.eye), to = glm::dvec3(old[i].position) - eye;
      // In the plane of the picture, from the camera's angle; the camera looks along -Z.
      const glm::dvec2 at =
          (glm::dvec2(to.x, -to.y) / (-to.z * 2 * std::tan(view.verticalFov / 2.0)) + 0.5) * double(size.x);
      const double off = glm::distance(
          at, glm::dvec2(scene::screenPoint(scene::kRegionMixed, passes::imageShare64ths(settings.imageShare),
                                            i, points, fovea, view.size)) +
                  0.5);
      if (std::abs(off - stray * size.x) < 0.01) continue;
      const bool isHidden = bool(castRay(after.scene, after.geometry, eye, to, {.tMax = 1 - 1e-3})),
                 isOutside = at.x < 0 || at.y < 0 || at.x >= size.x || at.y >= size.y,
                 strays = off > stray * size.x || isOutside;
      EXPECT_EQ(got[i].position, isHidden || strays ? fresh[i].position : old[i].position)
          << stray << " " << i;
      kept += !isHidden && !strays;
      strayed += strays;
      hidden += isHidden && !strays;
    }
    EXPECT_EQ(kept > 100, stray > 0) << stray;
    EXPECT_GT(strayed, 100);
    if (stray == 0.25f) {
      EXPECT_GT(hidden, 3);
    }
  }
}

// For the frames after a jump of the gaze, points move on as fast as `saccade_renew_frames` says.
TEST(EyePaths, StartsHurryAfterASaccade) {
  const Look look(litRoom(true), {32, 32});
  const auto ends = [&](uint32_t renewFrames, float saccade) {
    PassTest test("eye-paths");
    test.raysOnHost(true);
    test.param("paths", 256).param("points", 64).param("renew_frames", int(renewFrames));
    test.param("saccade_renew_frames", 2).viewSize(32, 32).scene(look.scene);
    test.beforeFrame([saccade](PassTest&, scene::Frame& f) {
      f.views[0].gaze = f.index < 2 ? glm::vec2(0.5f) : glm::vec2(0.12f, 0.8f);
      f.saccade = f.index < 2 ? 0 : saccade;
    });
    test.run(4);
    std::vector<glm::vec3> positions;
    for (const EyePathEnd& e : test.values<EyePathEnd>("paths.ends")) positions.push_back(e.position);
    return positions;
  };
  const auto all = ends(1, 0);
  EXPECT_EQ(ends(64, 0.125f), all);
  EXPECT_NE(ends(64, 0), all);
}

// After a cut of the camera nothing stays.
TEST(EyePaths, ACutMovesAllStarts) {
  const Look look(litRoom(true), {32, 32});
  const auto ends = [&](uint32_t renewFrames, bool cut) {
    PassTest test("eye-paths");
    test.raysOnHost(true);
    test.param("paths", 256).param("points", 64).param("renew_frames", int(renewFrames));
    test.viewSize(32, 32).scene(look.scene);
    test.beforeFrame([cut](PassTest&, scene::Frame& f) {
      f.views[0].gaze = f.index < 2 ? glm::vec2(0.5f) : glm::vec2(0.12f, 0.8f);
      f.cameraCut = cut && f.index == 2;
    });
    test.run(3);
    std::vector<glm::vec3> positions;
    for (const EyePathEnd& e : test.values<EyePathEnd>("paths.ends")) positions.push_back(e.position);
    return positions;
  };
  const auto all = ends(1, false);
  EXPECT_EQ(ends(50, true), all);
  EXPECT_NE(ends(50, false), all);
}

}  // namespace
}  // namespace fovea::test
