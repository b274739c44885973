// Compares every candidate with the CPU, which uses the same random numbers, and pixels and bounces
// with their distributions.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "tests/passes/candidates_reference.h"
#include "tests/passes/ray_reference.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

using scene::Candidate;
using scene::kNoSide;

bool isEmpty(const Candidate& c) {
  Candidate empty;
  return std::memcmp(&c, &empty, sizeof(c)) == 0;
}

float random(uint32_t what, uint32_t i) { return uniformFloat(randomStream(23, 0, what, i)); }

// A room without its front wall and a box in it; each face of the box may be an object of its own.
scene::Scene makeRoom(bool moving = false) {
  scene::Scene s;
  s.materials.clear();
  uint32_t m[6];
  for (uint32_t i = 0; i < 6; ++i)
    m[i] = addMaterial(s, {0.1f + 0.1f * float(i), 0.5f, 0.9f - 0.1f * float(i)});
  addRoom(s, m, 1);
  s.nodes.pop_back();  // +z is open
  const glm::vec3 low(-0.4f, -1, -0.5f), x(0.5f, 0, 0.2f), z(-0.2f, 0, 0.5f), y(0, 0.7f, 0);
  addQuad(s, m[5], low, y, x);
  addQuad(s, m[5], low, z, y);
  addQuad(s, m[5], low + x, y, z);
  addQuad(s, m[5], low + z, x, y);
  addQuad(s, m[5], low + y, z, x);
  for (size_t i = 5; moving && i < s.nodes.size(); ++i) {
    s.nodes[i].dynamic = true;
    s.nodes[i].translation = {0.1f, 0.05f, 0.2f};
    s.nodes[i].rotation = glm::angleAxis(0.3f, glm::normalize(glm::vec3(0.1f, 1, 0)));
    s.nodes[i].scale = {0.9f, 1.1f, 1};
  }
  s.cameras.emplace_back();
  return s;
}

// A G-buffer of a camera's view, made with rays. Normals lean by up to 50 degrees, as shading normals may.
SeenImage seen(const scene::Scene& s, const scene::Geometry& g, const scene::Camera& camera,
               glm::ivec2 size) {
  const scene::View view = scene::makeView(camera, glm::uvec2(size), g);
  SeenImage image(size, scene::pixelRays(view));
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec3 ray(view.rayDirection({float(x) + 0.5f, float(y) + 0.5f}));
      const RayHit hit = castRay(s, g, glm::dvec3(view.eye), ray);
      if (!hit) continue;
      const scene::Triangle& t = g.triangles[hit.triangle];
      SeenPixel& p = image.at({x, y});
      p.position = glm::vec3(glm::dvec3(view.eye) + hit.t * ray);
      p.distance = glm::distance(p.position, view.eye);
      p.face = glm::normalize(
          glm::cross(g.positions[t.v[1]] - g.positions[t.v[0]], g.positions[t.v[2]] - g.positions[t.v[0]]));
      if (glm::dot(p.face, glm::vec3(ray)) > 0) p.face = -p.face;
      const uint32_t i = uint32_t(y * size.x + x);
      p.normal =
          glm::normalize(p.face + 0.7f * (2.0f * glm::vec3(random(0, i), random(1, i), random(2, i)) - 1.0f));
    }
  return image;
}

struct Counts {
  double candidates = 0, escaped = 0, background = 0, moving = 0;
};

void expectCounters(const PassTest& test, const Counts& want, double count) {
  EXPECT_EQ(test.counter("attempts"), count);
  EXPECT_EQ(test.counter("rays"), want.candidates + want.escaped);
  EXPECT_EQ(test.counter("candidates"), want.candidates);
  EXPECT_EQ(test.counter("escaped"), want.escaped);
  EXPECT_EQ(test.counter("background"), want.background);
}

// ---- Against the replay -----------------------------------------------------------------------------------

void expectReplay(const CandidateReference& reference, const PassTest& test,
                  const std::vector<glm::vec4>& radiance, Counts& counts) {
  const auto list = test.values<Candidate>("candidates");
  int rounded = 0;
  for (uint32_t i = 0; i < list.size(); ++i) {
    const Candidate& c = list[i];
    const auto attempt = reference.attempt(i);
    ASSERT_GE(glm::dot(attempt.direction, attempt.face), -1e-6f);
    ASSERT_GE(glm::dot(attempt.direction, attempt.normal), -1e-6f);
    if (attempt.background) {
      ASSERT_TRUE(isEmpty(c)) << "attempt " << i;
      ++counts.background;
      continue;
    }
    if (c.side != attempt.side) {
      ++rounded;
      ASSERT_TRUE(reference.mayMeet(i, c.side))
          << "attempt " << i << ": side " << c.side << " instead of " << attempt.side;
    }
    if (c.side == kNoSide) {
      ASSERT_TRUE(isEmpty(c)) << "attempt " << i;
      ++counts.escaped;
      continue;
    }
    ++counts.candidates;
    ASSERT_LT(c.side, reference.voxels.surface.size());
    const scene::VoxelSide& side = reference.voxels.surface[c.side];
    ASSERT_EQ(c.position, side.position);
    ASSERT_EQ(c.normal, side.normal);
    ASSERT_EQ(c.reflectance, side.reflectance);
    ASSERT_EQ(c.object, side.object);
    ASSERT_EQ(c.luminance, radiance.empty() ? 0 : radiance[c.side].w);
    const scene::ObjectTransform& object = test.lastFrame().objects.at(size_t(c.object));
    ASSERT_LT(glm::distance(c.localPosition, object.intoObject(side.position)),
              c.object > 0 ? 1e-6f : 1e-30f);
    counts.moving += c.object > 0;
    ASSERT_EQ(c.unused, 0);
  }
  EXPECT_LE(rounded, int(list.size() / 500) + 1) << "bounces that rounding sent elsewhere";
}

// Share of the bounces for which a ray through voxels and a ray through the triangles end within two cells of each
// other, or both escape. Backs of single-sided triangles hide nothing from a voxel ray, so the rays through triangles
// pass them, too.
double agreement(const CandidateReference& reference, const scene::Scene& s, const scene::Geometry& g,
                 uint32_t count) {
  double bounces = 0, same = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const auto a = reference.attempt(i);
    if (a.background) continue;
    ++bounces;
    const glm::dvec3 origin(a.origin + 1e-4f * a.face);
    const RayHit hit = castRay(s, g, origin, glm::dvec3(a.direction), {.cullSingleSided = true});
    if (!hit || a.side == kNoSide) {
      same += !hit == (a.side == kNoSide);
      continue;
    }
    const glm::dvec3 met(reference.voxels.surface[a.side].position);
    same +=
        glm::distance(met, origin + hit.t * glm::dvec3(a.direction)) < 2 * double(reference.voxels.grid.cell);
  }
  return same / bounces;
}

enum class Where { InFront, InsideTheBox, Outside, InFrontOfMovers };
constexpr const char* kCameras[] = {"InFront", "InsideTheBox", "Outside", "InFrontOfMovers"};

class Replay : public testing::TestWithParam<Where> {};

TEST_P(Replay, EveryCandidateIsTheCpus) {
  const bool moving = GetParam() == Where::InFrontOfMovers;
  const scene::Scene s = makeRoom(moving);
  const scene::Geometry g = scene::flatten(s);
  scene::Camera camera;
  camera.position = {0.1f, 0, 1.8f};
  if (GetParam() == Where::InsideTheBox) camera.position = {-0.2f, -0.7f, -0.15f};
  if (GetParam() == Where::Outside) camera.position = {0.3f, 0.2f, 6};  // much background
  SeenImage image = seen(s, g, camera, {48, 36});
  const VoxelArrays voxels = voxelizeReference(s, g, 24);
  std::vector<glm::vec4> radiance;
  for (uint32_t i = 0; i < voxels.surface.size(); ++i) radiance.push_back(glm::vec4(random(5, i)));

  constexpr int kCount = 3000;
  const glm::vec2 gaze(0.4f, 0.55f);
  PassTest test("candidates");
  test.scene(s).viewSize(48, 36).seed(9).param("count", kCount).view("fovea_radius", 0.3);
  test.beforeFrame([&](PassTest&, scene::Frame& frame) { frame.views[0].gaze = gaze; });
  image.wire(test);
  setVoxels(test, voxels);
  test.buffer("radiance", radiance, "VoxelRadiance");
  for (uint32_t frame = 0; frame < 2; ++frame) {
    test.run();
    Counts counts;
    const CandidateReference reference{.image = image,
                                       .voxels = voxels,
                                       .fovea = scene::makeFovea(gaze, image.size, 0.3f),
                                       .seed = 9,
                                       .frame = frame};
    expectReplay(reference, test, radiance, counts);
    expectCounters(test, counts, kCount);
    EXPECT_GT(agreement(reference, s, g, kCount), 0.9);
    EXPECT_GT(counts.candidates, GetParam() == Where::Outside ? 100 : 500);
    EXPECT_GT(counts.escaped, GetParam() == Where::InFront ? 100 : -1);
    EXPECT_GT(counts.moving, moving ? 50 : -1);
    EXPECT_GT(counts.background, GetParam() == Where::Outside ? 500 : -1);
  }
}

INSTANTIATE_TEST_SUITE_P(Cameras, Replay,
                         testing::Values(Where::InFront, Where::InsideTheBox, Where::Outside,
                                         Where::InFrontOfMovers),
                         [](const auto& info) { return kCameras[int(info.param)]; });

TEST(Candidates, PerFrameOrAlwaysTheSame) {
  const scene::Scene s = makeRoom();
  const scene::Geometry g = scene::flatten(s);
  scene::Camera camera;
  camera.position = {0, 0, 1.8f};
  SeenImage image = seen(s, g, camera, {16, 16});
  for (const bool perFrame : {true, false}) {
    PassTest test("candidates");
    test.scene(s).viewSize(16, 16).param("count", 200).param("region", "image").param("per_frame", perFrame);
    image.wire(test);
    setVoxels(test, voxelizeReference(s, g, 12));
    std::vector<std::vector<std::byte>> lists;
    for (int frame = 0; frame < 2; ++frame) {
      test.run();
      lists.push_back(test.bytes("candidates"));
    }
    EXPECT_EQ(lists[0] == lists[1], !perFrame);
  }
}

// ---- Pixels: each starts in a chamber of its own, so that a candidate tells where it comes from -----------

constexpr glm::ivec2 kSize{24, 16};

struct Chambers {
  scene::Scene scene;
  VoxelArrays voxels;
  SeenImage image{kSize};

  // Pixel (x, y) lies on the floor of cell (2x + 1, 1, 2y + 1). All cells around it are wall.
  Chambers() {
    scene.materials.emplace_back();
    scene.cameras.emplace_back();
    addQuad(scene, 0, {0, 0, 0}, {0, 0, 50}, {50, 0, 0});  // only sets the bounds
    const scene::Geometry g = scene::flatten(scene);
    voxels.resolution = 50;
    voxels.grid = scene::voxelGrid(g.boundsMin, g.boundsMax, 50);
    voxels.index.resize(50 * 50 * 50);
    for (int y = 1; y <= 2; ++y)
      for (int z = 0; z <= 2 * kSize.y; ++z)
        for (int x = 0; x <= 2 * kSize.x; ++x) {
          const bool wallX = x % 2 == 0, wallZ = z % 2 == 0;
          if (y == 1 && wallX == wallZ) continue;  // a chamber, or where four walls meet
          const glm::vec3 normal = y == 2  ? glm::vec3(0, 1, 0)
                                   : wallX ? glm::vec3(1, 0, 0)
                                           : glm::vec3(0, 0, 1);
          scene::VoxelSide side;
          side.area = 1;
          for (const float sign : {1.0f, -1.0f}) {
            side.normal = sign * normal;
            side.position = voxels.grid.voxelToWorld(glm::vec3(x, y, z) + 0.5f + 0.49f * side.normal);
            voxels.surface.push_back(side);
          }
          voxels.index[size_t(x + 50 * (y + 50 * z))] = uint32_t(voxels.surface.size() / 2);
        }
    const auto place = [&](int x, int y) {
      return voxels.grid.voxelToWorld(glm::vec3(2 * x + 1.5f, 1.05f, 2 * y + 1.5f));
    };
    image.camera = raysOnto({25, 50, 25}, place(0, 0), place(1, 0) - place(0, 0), place(0, 1) - place(0, 0));
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        SeenPixel& p = image.at({x, y});
        p.position = place(x, y);
        p.distance = 1;
      }
  }

  glm::ivec2 pixelOf(const Candidate& c) const {
    const glm::vec3 chamber = voxels.grid.worldToVoxel(c.position) + 0.5f * c.normal;
    return (glm::ivec2(glm::floor(chamber.x), glm::floor(chamber.z)) - 1) / 2;
  }
};

std::vector<double> coverage(const scene::Fovea& fovea) {
  std::vector<double> part;
  for (int i = 0; i < kSize.x * kSize.y; ++i) {
    int inside = 0;
    for (int k = 0; k < 32 * 32; ++k) {
      const glm::vec2 p(float(i % kSize.x) + (float(k % 32) + 0.5f) / 32,
                        float(i / kSize.x) + (float(k / 32) + 0.5f) / 32);
      inside += glm::distance(p, fovea.centre) <= fovea.radius;
    }
    part.push_back(inside / 1024.0);
  }
  return part;
}

// Chi-square in standard deviations from its mean. Bins with an expected count under 8 are merged.
double deviation(const std::vector<double>& part, const std::vector<double>& counted) {
  double sum = 0, draws = 0, chi2 = 0, rest = 0, restCounted = 0;
  for (size_t i = 0; i < part.size(); ++i) sum += part[i], draws += counted[i];
  int bins = 0;
  for (size_t i = 0; i < part.size(); ++i) {
    const double expected = draws * part[i] / sum;
    if (expected < 8) {
      rest += expected;
      restCounted += counted[i];
      continue;
    }
    chi2 += (counted[i] - expected) * (counted[i] - expected) / expected;
    ++bins;
  }
  if (rest > 0) chi2 += (restCounted - rest) * (restCounted - rest) / std::max(rest, 1.0);
  return (chi2 - bins) / std::sqrt(2.0 * bins);
}

struct PixelCase {
  const char* name;
  const char* region;
  glm::vec2 gaze;
  double radius;
  bool everywhere;
};

class Pixels : public testing::TestWithParam<PixelCase> {};

TEST_P(Pixels, AreUniformOverTheRegion) {
  const PixelCase& c = GetParam();
  Chambers chambers;
  constexpr int kCount = 30000;
  PassTest test("candidates");
  test.scene(chambers.scene).viewSize(uint32_t(kSize.x), uint32_t(kSize.y));
  test.param("count", kCount).param("region", c.region).view("fovea_radius", c.radius);
  test.param("image_share", 0.25);
  test.beforeFrame([&](PassTest&, scene::Frame& frame) { frame.views[0].gaze = c.gaze; });
  chambers.image.wire(test);
  setVoxels(test, chambers.voxels);
  test.run();
  expectCounters(test, {.candidates = kCount}, kCount);  // nothing gets out of a chamber
  std::vector<double> counted(size_t(kSize.x * kSize.y));
  for (const Candidate& candidate : test.values<Candidate>("candidates")) {
    const glm::ivec2 p = chambers.pixelOf(candidate);
    counted.at(size_t(p.y * kSize.x + p.x)) += 1;
  }
  std::vector<double> part = c.everywhere ? std::vector<double>(counted.size(), 1)
                                          : coverage(scene::makeFovea(c.gaze, kSize, float(c.radius)));
  if (c.region == std::string("mixed")) {  // three quarters of the samples in the disc, one anywhere
    double sum = 0;
    for (const double x : part) sum += x;
    for (double& x : part) x = 0.75 * x / sum + 0.25 / double(part.size());
  }
  EXPECT_LT(std::abs(deviation(part, counted)), 5);
}

INSTANTIATE_TEST_SUITE_P(Regions, Pixels,
                         testing::Values(PixelCase{"Disc", "fovea", {0.5f, 0.5f}, 0.25, false},
                                         PixelCase{"AtTheCorner", "fovea", {0.97f, 0.05f}, 0.25, false},
                                         PixelCase{
                                             "OutsideButReachingIn", "fovea", {1.1f, 0.4f}, 0.25, false},
                                         PixelCase{"Outside", "fovea", {-2, 0.4f}, 0.25, true},
                                         PixelCase{"CoveringAll", "fovea", {0.4f, 0.6f}, 2, true},
                                         PixelCase{"Image", "image", {0.4f, 0.6f}, 0.1, true},
                                         PixelCase{"Mixed", "mixed", {0.4f, 0.6f}, 0.2, false}),
                         [](const auto& info) { return info.param.name; });

TEST(Candidates, TwoEyesTakeTurns) {
  Chambers chambers;
  const glm::vec2 gazes[2] = {{0.25f, 0.5f}, {0.75f, 0.5f}};
  PassTest test("candidates");
  test.scene(chambers.scene)
      .viewSize(uint32_t(kSize.x), uint32_t(kSize.y))
      .param("count", 2000)
      .view("fovea_radius", 0.1);
  test.beforeFrame([&](PassTest&, scene::Frame& frame) {
    for (scene::View& view : frame.views) view.gaze = gazes[view.name == "right"];
  });
  chambers.image.wire(test);
  chambers.image.wire(test, "gbuffer2");
  setVoxels(test, chambers.voxels);
  test.run();
  const auto list = test.values<Candidate>("candidates");
  for (size_t i = 0; i < list.size(); ++i) {
    const glm::vec2 p = glm::vec2(chambers.pixelOf(list[i])) + 0.5f;
    ASSERT_LT(glm::distance(p, gazes[i % 2] * glm::vec2(kSize)), 0.1f * float(kSize.x) + 0.71f)
        << "attempt " << i;
  }
}

// ---- Bounces: from one point into a hemisphere of voxels --------------------------------------------------

TEST(Candidates, BouncesAreCosineDistributed) {
  constexpr int kResolution = 96, kCount = 40000, kRings = 8, kSectors = 12;
  scene::Scene s;
  s.materials.emplace_back();
  s.cameras.emplace_back();
  addQuad(s, 0, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  const scene::Geometry g = scene::flatten(s);
  VoxelArrays voxels;
  voxels.resolution = kResolution;
  voxels.grid = scene::voxelGrid(g.boundsMin, g.boundsMax, kResolution);
  voxels.index.resize(size_t(kResolution) * kResolution * kResolution);
  const glm::vec3 normal = glm::normalize(glm::vec3(1, 2, -1.5f)),
                  centre = voxels.grid.voxelToWorld(glm::vec3(kResolution / 2.0f));
  const glm::mat3 frame = scene::orthonormalFrame(normal);
  for (int i = 0; i < kResolution * kResolution * kResolution; ++i) {  // cells that the sphere passes through
    const glm::vec3 cell(float(i % kResolution), float(i / kResolution % kResolution),
                         float(i / kResolution / kResolution));
    const glm::vec3 d = cell + 0.5f - kResolution / 2.0f;
    if (std::abs(glm::length(d) - 0.45f * kResolution) > 0.9f) continue;
    scene::VoxelSide side;
    side.area = 1;
    side.normal = -glm::normalize(d);
    side.position = voxels.grid.voxelToWorld(cell + 0.5f);
    voxels.surface.push_back(side);
    voxels.surface.push_back({});
    voxels.index[size_t(i)] = uint32_t(voxels.surface.size() / 2);
  }
  SeenImage image({1, 1}, raysOnto(centre + normal, centre, glm::vec3(0), glm::vec3(0)));
  image.pixels[0] = {centre, 1, normal, normal};
  PassTest test("candidates");
  test.scene(s).viewSize(1, 1).param("count", kCount);
  image.wire(test);
  setVoxels(test, voxels);
  test.run();
  std::vector<double> counted(kRings * kSectors);
  for (const Candidate& c : test.values<Candidate>("candidates")) {
    if (c.side == kNoSide) continue;
    const glm::vec3 d = scene::toLocal(frame, glm::normalize(c.position - centre));
    ASSERT_GT(d.z, -0.02f);
    // A cosine density is uniform in sin^2 of the angle to the normal, and around it.
    const int ring = std::min(int((1 - d.z * d.z) * kRings), kRings - 1);
    const int sector =
        std::min(int((std::atan2(d.y, d.x) / glm::two_pi<float>() + 0.5f) * kSectors), kSectors - 1);
    counted[size_t(ring * kSectors + sector)] += 1;
  }
  EXPECT_LT(test.counter("escaped"), 0.01 * kCount);  // along the plane they start from
  EXPECT_LT(deviation(std::vector<double>(counted.size(), 1), counted), 5);
}

// ---- Little or nothing to work on -------------------------------------------------------------------------

TEST(Candidates, EmptyScene) {
  PassTest test("candidates");
  SeenImage image({8, 8});
  VoxelArrays voxels;
  voxels.index.resize(1);
  test.viewSize(8, 8).param("count", 70);
  image.wire(test);
  setVoxels(test, voxels);
  test.run();
  for (const Candidate& c : test.values<Candidate>("candidates")) EXPECT_TRUE(isEmpty(c));
  expectCounters(test, {.background = 70}, 70);
}

TEST(Candidates, OnlyTheFoveaCounts) {
  Chambers chambers;
  const scene::Fovea f = scene::makeFovea({0.5f, 0.5f}, kSize, 0.2f);
  for (int i = 0; i < kSize.x * kSize.y; ++i)
    if (glm::distance(glm::vec2(i % kSize.x, i / kSize.x) + 0.5f, f.centre) < f.radius + 1)
      chambers.image.pixels[size_t(i)].distance = 0;
  PassTest test("candidates");
  test.scene(chambers.scene)
      .viewSize(uint32_t(kSize.x), uint32_t(kSize.y))
      .param("count", 300)
      .view("fovea_radius", 0.2);
  chambers.image.wire(test);
  setVoxels(test, chambers.voxels);
  test.run();
  for (const Candidate& c : test.values<Candidate>("candidates")) EXPECT_TRUE(isEmpty(c));
  expectCounters(test, {.background = 300}, 300);
}

TEST(Candidates, OneAttempt) {
  Chambers chambers;
  PassTest test("candidates");
  test.scene(chambers.scene).viewSize(uint32_t(kSize.x), uint32_t(kSize.y)).param("count", 1);
  chambers.image.wire(test);
  setVoxels(test, chambers.voxels);
  test.run();
  const auto list = test.values<Candidate>("candidates");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_NE(list[0].side, kNoSide);
  EXPECT_EQ(list[0].luminance, 0);  // no radiance is wired
  expectCounters(test, {.candidates = 1}, 1);
}

}  // namespace
}  // namespace fovea::test
