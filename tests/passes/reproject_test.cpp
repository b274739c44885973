// Tests the warp from eye to eye: exact on planes, with holes where the first eye sees nothing, and the list of blocks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "fovea/error.h"
#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "tests/passes/deferred_reference.h"
#include "tests/passes/ray_reference.h"

namespace fovea::test {
namespace {

float random(uint32_t what, uint32_t i) { return uniformFloat(randomStream(31, 0, what, i)); }

// What a view sees of a scene, by rays.
struct Eye {
  scene::View view;
  GBuffer seen;

  Eye(const scene::Scene& s, const scene::Geometry& geometry, glm::vec3 position, glm::uvec2 size)
      : view(makeViewAt(geometry, position, size)),
        seen(int(size.x), int(size.y), scene::pixelRays(view), [&](int x, int y) {
          SurfacePixel p;
          const glm::dvec3 ray =
              glm::normalize(glm::dvec3(view.rayDirection({float(x) + 0.5f, float(y) + 0.5f})));
          const RayHit hit = castRay(s, geometry, glm::dvec3(position), ray, {});
          if (!hit) return p;
          p.position = glm::vec3(glm::dvec3(position) + hit.t * ray);
          p.distance = float(hit.t);
          p.normal = glm::vec3(faceNormal(geometry, hit.triangle));
          if (glm::dot(glm::dvec3(p.normal), ray) > 0) p.normal = -p.normal;
          return p;
        }) {}

  static scene::View makeViewAt(const scene::Geometry& geometry, glm::vec3 position, glm::uvec2 size) {
    scene::Camera camera;
    camera.position = position;
    camera.verticalFov = 1;
    return scene::makeView(camera, size, geometry);
  }

  // Image position of a point in pixels; false if it lies behind the eye.
  bool project(glm::vec3 p, glm::dvec2& at) const {
    const glm::dvec4 clip = glm::dmat4(view.worldToClip) * glm::dvec4(p, 1);
    at = (0.5 * glm::dvec2(clip) / clip.w + 0.5) * glm::dvec2(view.size);
    return clip.w > 0;
  }
};

using Field = std::function<glm::vec3(glm::vec3)>;  // irradiance by place

std::vector<glm::vec3> sample(const GBuffer& g, const Field& field) {
  std::vector<glm::vec3> image;
  for (const SurfacePixel& p : g.pixels)
    image.push_back(p.distance > 0 ? halfRound(field(p.position)) : glm::vec3(0));
  return image;
}

void wire(PassTest& test, const Eye& first, const GBuffer& second, const std::vector<glm::vec3>& irradiance) {
  std::vector<uint16_t> half;
  for (const glm::vec3& v : irradiance)
    for (const float x : {v.r, v.g, v.b, 1.0f}) half.push_back(glm::packHalf1x16(x));
  first.seen.wire(test, "source_gbuffer");
  test.image("source_irradiance", VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(first.seen.width),
             uint32_t(first.seen.height), 1, half);
  second.wire(test);
  test.param("source_view", "first");
  test.beforeFrame([view = first.view](PassTest&, scene::Frame& frame) {
    frame.views.push_back(view);
    frame.views.back().name = "first";
  });
}

// A plain version of the pass. `close` marks decisions that rounding may change.
struct Warped {
  glm::dvec3 irradiance{0};
  bool known = false, close = false;
};

Warped warp(const Eye& first, const std::vector<glm::vec3>& irradiance, const SurfacePixel& p) {
  Warped w;
  glm::dvec2 at;
  if (!first.project(p.position, at)) return w;
  at -= 0.5;
  double weights = 0;
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx) {
      const int x = int(std::floor(at.x)) + dx, y = int(std::floor(at.y)) + dy;
      if (x < 0 || y < 0 || x >= first.seen.width || y >= first.seen.height) continue;
      const double weight = (1 - std::abs(at.x - x)) * (1 - std::abs(at.y - y));
      const SurfacePixel& q = first.seen.at(x, y);
      if (q.distance <= 0) continue;
      const double plane = std::abs(
          glm::dot(glm::dvec3(q.position) - glm::dvec3(p.position), glm::normalize(glm::dvec3(p.normal))));
      const double cosine = glm::dot(glm::dvec3(q.normal), glm::dvec3(p.normal));
      const double tolerance = 0.005 * p.distance, least = std::cos(glm::radians(25.0));
      w.close |= std::abs(plane - tolerance) < 0.05 * tolerance || std::abs(cosine - least) < 1e-3;
      if (plane > tolerance || cosine < least) continue;
      weights += weight;
      w.irradiance += weight * glm::dvec3(irradiance[size_t(y * first.seen.width + x)]);
    }
  w.close |= std::abs(weights - 0.1) < 2e-3;
  w.known = weights >= 0.1;
  if (w.known) w.irradiance /= weights;
  return w;
}

constexpr glm::uvec2 kSize{96, 72};

// A room's floor and back wall, and a pillar before the wall.
struct Pillar {
  scene::Scene s;
  scene::Geometry geometry;
  Pillar() {
    s.materials.emplace_back();
    addQuad(s, 0, {-9, -1, 2}, {9, -1, 2}, {9, -1, -6}, {-9, -1, -6});
    addQuad(s, 0, {-9, -1, -6}, {9, -1, -6}, {9, 6, -6}, {-9, 6, -6});
    addQuad(s, 0, {-0.5f, -1, -3}, {0.5f, -1, -3}, {0.5f, 0.8f, -3}, {-0.5f, 0.8f, -3});
    addQuad(s, 0, {0.5f, -1, -3}, {0.5f, -1, -4}, {0.5f, 0.8f, -4}, {0.5f, 0.8f, -3});
    geometry = flatten(s);
  }
  Eye eye(float x) const { return Eye(s, geometry, {x, 0, 1.5f}, kSize); }
};

struct Result {
  std::vector<float> irradiance, mask;
  std::vector<uint32_t> blocks, dispatch;
  explicit Result(PassTest& test) {
    test.run();
    irradiance = test.floats("irradiance");
    mask = test.floats("shade.mask");
    blocks = test.values<uint32_t>("shade.blocks");
    dispatch = test.values<uint32_t>("shade.dispatch");
    blocks.resize(std::min<size_t>(blocks.size(), dispatch[3]));
  }
  bool known(size_t i) const { return irradiance[4 * i + 3] == 1; }
  glm::vec3 color(size_t i) const {
    return {irradiance[4 * i], irradiance[4 * i + 1], irradiance[4 * i + 2]};
  }
};

// ---- Planes -----------------------------------------------------------------------------------------------

// A wall seen by both eyes: even light comes out exactly, and uneven light up to the error of bilinear interpolation.
// Only the border has no source.
TEST(Reproject, WallsKeepTheirLight) {
  scene::Scene s;
  s.materials.emplace_back();
  addQuad(s, 0, {-40, -40, -8}, {40, -40, 0}, {40, 40, 0}, {-40, 40, -8});
  const scene::Geometry geometry = flatten(s);
  const Eye first(s, geometry, {-0.032f, 0.01f, 4}, kSize), second(s, geometry, {0.032f, 0, 4}, kSize);
  const Field even = [](glm::vec3) { return glm::vec3(0.25f, 3, 41); };
  const Field uneven = [](glm::vec3 p) {
    return glm::vec3(2 + std::sin(p.x), 2 + std::cos(2 * p.y), 1 + p.x * p.x);
  };
  for (const bool isEven : {true, false}) {
    const Field& field = isEven ? even : uneven;
    PassTest test("reproject");
    wire(test, first, second.seen, sample(first.seen, field));
    const Result result(test);
    size_t holes = 0;
    double worst = 0;
    for (int y = 0; y < second.seen.height; ++y)
      for (int x = 0; x < second.seen.width; ++x) {
        const size_t i = size_t(y * second.seen.width + x);
        const glm::vec3 want = field(second.seen.pixels[i].position);
        if (!result.known(i)) {
          ++holes;
          glm::dvec2 at;
          first.project(second.seen.pixels[i].position, at);
          EXPECT_TRUE(at.x < 0 || at.y < 0 || at.x > kSize.x || at.y > kSize.y) << x << "," << y;
          continue;
        }
        worst = std::max(worst, double(glm::length(result.color(i) - want) / glm::length(want)));
      }
    EXPECT_LT(worst, isEven ? 1e-6 : 0.03);  // outside the outermost texels' centres the nearest is taken
    EXPECT_LT(double(holes), 0.03 * double(result.mask.size()));
    EXPECT_EQ(test.counter("new_pixels"), double(holes));
    EXPECT_EQ(test.counter("pixels"), double(result.mask.size()));
  }
}

// With the second eye at the first one, the result is the image itself.
TEST(Reproject, TheSameEyeSeesTheSame) {
  const Pillar scene;
  const Eye eye = scene.eye(0.1f);
  const auto source = sample(eye.seen, [](glm::vec3 p) { return glm::vec3(1) + glm::abs(p); });
  PassTest test("reproject");
  wire(test, eye, eye.seen, source);
  const Result result(test);
  for (size_t i = 0; i < source.size(); ++i) {
    ASSERT_EQ(result.known(i), eye.seen.pixels[i].distance > 0);
    if (result.known(i)) {
      ASSERT_NEAR(glm::length(result.color(i) - source[i]), 0, 2e-3 * glm::length(source[i]));
    }
  }
  EXPECT_TRUE(result.blocks.empty());
}

// ---- Holes ------------------------------------------------------------------------------------------------

// A pixel's point has no source if something hides it from the first eye or it lies outside the first eye's image.
// Within a texel of a silhouette both answers are valid, as the rays around it show.
TEST(Reproject, HolesAreWhatTheFirstEyeDoesNotSee) {
  const Pillar scene;
  for (const float apart : {0.064f, -0.3f}) {
    const Eye first = scene.eye(0), second = scene.eye(apart);
    PassTest test("reproject");
    wire(test, first, second.seen, sample(first.seen, [](glm::vec3 p) { return p; }));
    const Result result(test);
    const auto visible =
        [&](glm::vec3 p, glm::dvec2 offset) {  // whether the ray of an image place reaches the point's plane
          glm::dvec2 at;
          if (!first.project(p, at)) return false;
          at += offset;
          if (at.x < 0 || at.y < 0 || at.x > kSize.x || at.y > kSize.y) return false;
          const glm::dvec3 ray = glm::normalize(glm::dvec3(first.view.rayDirection(glm::vec2(at))));
          const RayHit hit = castRay(scene.s, scene.geometry, glm::dvec3(first.view.eye), ray, {});
          const glm::dvec3 there = glm::dvec3(first.view.eye) + hit.t * ray;
          return hit && glm::length(there - glm::dvec3(p)) < 0.3;  // a pixel of the floor is up to 0.2 m deep
        };
    size_t holes = 0, borderline = 0, unexplained = 0;
    for (size_t i = 0; i < second.seen.pixels.size(); ++i) {
      const SurfacePixel& p = second.seen.pixels[i];
      if (p.distance <= 0) continue;
      const bool known = result.known(i);
      holes += !known;
      if (visible(p.position, {0, 0}) == known) continue;
      ++borderline;
      bool excused = false;
      for (int k = 0; k < 9; ++k) excused |= visible(p.position, {k % 3 - 1, k / 3 - 1}) == known;
      unexplained += !excused;
    }
    EXPECT_EQ(unexplained, 0u) << "eyes " << apart << " m apart";
    EXPECT_GT(holes, 20u);
    EXPECT_LT(double(borderline), 0.015 * double(second.seen.pixels.size()));
    EXPECT_EQ(test.counter("new_pixels"), double(holes));
  }
}

// The light of the wall must not bleed onto the pillar, nor that of the pillar onto the wall.
TEST(Reproject, SilhouettesKeepTheirOwnLight) {
  const Pillar scene;
  const Eye first = scene.eye(0), second = scene.eye(-0.25f);
  const auto onPillar = [](glm::vec3 p) { return p.z > -5 && p.y > -0.99f; };
  PassTest test("reproject");
  wire(test, first, second.seen,
       sample(first.seen, [&](glm::vec3 p) { return onPillar(p) ? glm::vec3(8) : glm::vec3(1); }));
  const Result result(test);
  for (size_t i = 0; i < second.seen.pixels.size(); ++i)
    if (result.known(i)) {
      ASSERT_EQ(result.color(i).r, onPillar(second.seen.pixels[i].position) ? 8 : 1) << "pixel " << i;
    }
}

// Light from nearby surfaces is warped like all light, but never filled in.
TEST(Reproject, NearFieldComesFromTheSamePlaces) {
  const Pillar scene;
  const Eye first = scene.eye(0), second = scene.eye(-0.25f);
  const auto source = sample(first.seen, [](glm::vec3 p) { return glm::vec3(2) + glm::sin(3.0f * p); });
  std::vector<uint16_t> half;
  for (const glm::vec3& v : source)
    for (const float x : {v.r / 4, v.g / 4, v.b / 4, 7.0f}) half.push_back(glm::packHalf1x16(x));
  PassTest test("reproject");
  test.param("fill", 2);
  wire(test, first, second.seen, source);
  test.image("source_near_field", VK_FORMAT_R16G16B16A16_SFLOAT, kSize.x, kSize.y, 1, half);
  const Result result(test);
  const auto near = test.floats("near_field");
  for (size_t i = 0; i < second.seen.pixels.size(); ++i) {
    ASSERT_EQ(near[4 * i + 3], result.known(i) ? 1.0f : 0.0f) << "pixel " << i;
    for (size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(near[4 * i + c], result.known(i) ? result.irradiance[4 * i + c] / 4 : 0.0f, 1e-3)
          << "pixel " << i;
  }
  EXPECT_GT(test.counter("filled_pixels"), 20);
}

// A pixel without a source takes the mean of its surface's light at most two pixels away in its tile, with more
// weight for nearer pixels. Only blocks that contain a pixel without any such neighbour are shaded.
TEST(Reproject, NarrowHolesAreFilledFromTheirSurface) {
  const Pillar scene;
  const Eye first = scene.eye(0), second = scene.eye(-0.25f);
  const auto source = sample(first.seen, [](glm::vec3 p) { return glm::vec3(2) + glm::sin(3.0f * p); });
  const auto run = [&](int fill) {
    PassTest test("reproject");
    test.param("fill", fill);
    wire(test, first, second.seen, source);
    Result result(test);
    return std::pair(std::move(result), test.counter("filled_pixels"));
  };
  const auto [open, none] = run(0);
  const auto [result, counted] = run(2);
  EXPECT_EQ(none, 0);
  size_t filled = 0, left = 0;
  std::vector<float> mask(open.mask.size());
  for (int y = 0; y < second.seen.height; ++y)
    for (int x = 0; x < second.seen.width; ++x) {
      const size_t i = size_t(y * second.seen.width + x);
      const SurfacePixel& p = second.seen.pixels[i];
      if (p.distance <= 0 || open.known(i)) {
        ASSERT_EQ(result.color(i), open.color(i));
        continue;
      }
      double weights = 0;
      glm::dvec3 sum(0);
      for (int v = std::max(y - 2, y / 16 * 16); v <= std::min(y + 2, y / 16 * 16 + 15); ++v)
        for (int u = std::max(x - 2, x / 16 * 16); u <= std::min(x + 2, x / 16 * 16 + 15); ++u) {
          if (u >= second.seen.width || v >= second.seen.height) continue;
          const size_t k = size_t(v * second.seen.width + u);
          const SurfacePixel& q = second.seen.pixels[k];
          if (!open.known(k) || glm::dot(q.normal, p.normal) < 0.9f ||
              std::abs(glm::dot(q.position - p.position, p.normal)) > 0.005f * p.distance)
            continue;
          const double w = 1.0 / ((u - x) * (u - x) + (v - y) * (v - y));
          weights += w;
          sum += w * glm::dvec3(open.color(k));
        }
      ASSERT_EQ(result.irradiance[4 * i + 3], weights > 0 ? 0.5f : 0.0f) << x << "," << y;
      ++(weights > 0 ? filled : left);
      if (weights > 0) {
        ASSERT_NEAR(glm::length(glm::dvec3(result.color(i)) - sum / weights), 0, 5e-3) << x << "," << y;
        continue;
      }
      for (int v = y / 4 * 4; v < std::min(y / 4 * 4 + 4, second.seen.height); ++v)
        for (int u = x / 4 * 4; u < std::min(x / 4 * 4 + 4, second.seen.width); ++u)
          mask[size_t(v * second.seen.width + u)] = 1;
    }
  EXPECT_EQ(result.mask, mask);
  EXPECT_EQ(counted, double(filled));
  EXPECT_GT(filled, 20u);
  EXPECT_GT(left, 20u);
}

TEST(Reproject, WithoutASourceEverythingIsShaded) {
  const Pillar scene;
  const Eye second = scene.eye(0);
  Eye away = scene.eye(0);  // looks the other way
  scene::Camera camera;
  camera.orientation = glm::quat(0, 0, 1, 0);
  away.view = scene::makeView(camera, kSize, scene.geometry);
  Eye blind = scene.eye(0);  // sees background only
  for (SurfacePixel& p : blind.seen.pixels) p.distance = 0;
  for (const Eye* first : {&away, &blind}) {
    PassTest test("reproject");
    wire(test, *first, second.seen, std::vector<glm::vec3>(second.seen.pixels.size(), glm::vec3(1)));
    const Result result(test);
    EXPECT_EQ(test.counter("new_pixels"), test.counter("pixels"));
    EXPECT_EQ(test.counter("shaded_pixels"), test.counter("pixels"));
    for (float x : result.irradiance) ASSERT_EQ(x, 0);
  }
}

TEST(Reproject, BackgroundIsNoHole) {
  const Pillar scene;
  const Eye first = scene.eye(0);
  Eye second = scene.eye(0);
  for (SurfacePixel& p : second.seen.pixels) p.distance = 0;
  PassTest test("reproject");
  wire(test, first, second.seen, std::vector<glm::vec3>(second.seen.pixels.size(), glm::vec3(1)));
  const Result result(test);
  EXPECT_EQ(result.dispatch, (std::vector<uint32_t>{0, 16, 1, 0}));
  for (float x : result.mask) ASSERT_EQ(x, 0);
  for (float x : result.irradiance) ASSERT_EQ(x, 0);
  for (const char* name : {"pixels", "new_pixels", "shaded_pixels"}) EXPECT_EQ(test.counter(name), 0);
}

// ---- Against the plain reference; blocks ------------------------------------------------------------------

// Surfaces shifted and turned at random against what the first eye saw.
GBuffer shaken(const GBuffer& g) {
  return GBuffer(g.width, g.height, g.camera, [&](int x, int y) {
    SurfacePixel p = g.at(x, y);
    const auto i = uint32_t(y * g.width + x), patch = uint32_t(x / 7 + 64 * (y / 5));
    if (random(0, patch) < 0.15f) p.position += p.normal * (0.012f * p.distance * (random(1, i) - 0.5f));
    if (random(2, patch) < 0.15f)
      p.normal = glm::normalize(p.normal + glm::vec3(random(3, i), random(4, i), random(5, i)) - 0.5f);
    if (random(6, patch) < 0.1f) p.distance = 0;
    return p;
  });
}

class Blocks : public testing::TestWithParam<int> {};

TEST_P(Blocks, AndIrradianceEqualTheReference) {
  const int n = GetParam();
  const Pillar scene;
  const glm::uvec2 size(93, 71);
  const Eye first(scene.s, scene.geometry, {0, 0, 1.5f}, size),
      other(scene.s, scene.geometry, {0.1f, 0, 1.5f}, size);
  const GBuffer second = shaken(other.seen);
  const auto source = sample(first.seen, [](glm::vec3 p) { return glm::vec3(2) + glm::sin(3.0f * p); });
  PassTest test("reproject");
  test.param("interleave", n);
  wire(test, first, second, source);
  const Result result(test);

  size_t close = 0, surfaces = 0, holes = 0, shaded = 0;
  std::vector<uint8_t> newBlock(size_t(((size.x - 1) / n + 1) * ((size.y - 1) / n + 1)));
  const int columns = (int(size.x) + n - 1) / n, rows = (int(size.y) + n - 1) / n;
  for (int y = 0; y < second.height; ++y)
    for (int x = 0; x < second.width; ++x) {
      const size_t i = size_t(y * second.width + x);
      if (second.pixels[i].distance <= 0) {
        ASSERT_EQ(result.color(i), glm::vec3(0));
        continue;
      }
      ++surfaces;
      holes += !result.known(i);
      if (!result.known(i)) newBlock[size_t(y / n * columns + x / n)] = 1;
      const Warped want = warp(first, source, second.pixels[i]);
      close += want.close;
      if (want.close) continue;
      ASSERT_EQ(result.known(i), want.known) << x << "," << y;
      if (want.known) {
        ASSERT_NEAR(glm::length(glm::dvec3(result.color(i)) - want.irradiance), 0, 4e-3) << x << "," << y;
      }
    }
  EXPECT_LT(double(close), 0.045 * double(surfaces));
  EXPECT_GT(double(holes), 0.03 * double(surfaces));

  // The list has tiles of 16 x 16 pixels row by row, and in each tile its blocks row by row.
  std::vector<uint32_t> list;
  for (int ty = 0; ty * 16 < second.height; ++ty)
    for (int tx = 0; tx * 16 < second.width; ++tx)
      for (int y = ty * 16 / n; y < std::min((ty + 1) * 16 / n, rows); ++y)
        for (int x = tx * 16 / n; x < std::min((tx + 1) * 16 / n, columns); ++x)
          if (newBlock[size_t(y * columns + x)]) list.push_back(uint32_t(x | y << 16));
  EXPECT_EQ(result.blocks, list);
  const auto count = uint32_t(list.size());
  EXPECT_EQ(result.dispatch, (std::vector<uint32_t>{(count + 255) / 256, uint32_t(n * n), 1, count}));
  for (int y = 0; y < second.height; ++y)
    for (int x = 0; x < second.width; ++x) {
      const size_t i = size_t(y * second.width + x);
      const bool in = newBlock[size_t(y / n * columns + x / n)];
      ASSERT_EQ(result.mask[i], in ? 1 : 0) << x << "," << y;
      shaded += in && second.pixels[i].distance > 0;
    }
  EXPECT_EQ(test.counter("pixels"), double(surfaces));
  EXPECT_EQ(test.counter("new_pixels"), double(holes));
  EXPECT_EQ(test.counter("shaded_pixels"), double(shaded));

  PassTest again("reproject");
  again.param("interleave", n);
  wire(again, first, second, source);
  const Result repeated(again);
  EXPECT_EQ(repeated.irradiance, result.irradiance);
  EXPECT_EQ(repeated.blocks, result.blocks);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Blocks, testing::Values(1, 2, 4, 8));

// An eye that sees more pixels than the other.
TEST(Reproject, EyesMayDifferInResolution) {
  const Pillar scene;
  const Eye first(scene.s, scene.geometry, {0, 0, 1.5f}, {50, 40}),
      second(scene.s, scene.geometry, {0.05f, 0, 1.5f}, {96, 77});
  const auto source = sample(first.seen, [](glm::vec3 p) { return glm::vec3(2) + 0.1f * p; });
  PassTest test("reproject");
  wire(test, first, second.seen, source);
  const Result result(test);
  size_t known = 0;
  for (size_t i = 0; i < second.seen.pixels.size(); ++i) {
    if (!result.known(i)) continue;
    ++known;
    const glm::vec3 want = glm::vec3(2) + 0.1f * second.seen.pixels[i].position;
    ASSERT_NEAR(glm::length(result.color(i) - want), 0, 0.08);
  }
  EXPECT_GT(double(known), 0.8 * test.counter("pixels"));
}

TEST(Reproject, WrongParametersAreRefused) {
  const Pillar scene;
  const Eye eye = scene.eye(0);
  const auto expectRefused = [&](const std::function<void(PassTest&)>& change, const std::string& why) {
    PassTest test("reproject");
    wire(test, eye, eye.seen, std::vector<glm::vec3>(eye.seen.pixels.size()));
    change(test);
    try {
      test.run();
      ADD_FAILURE() << "accepted: " << why;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::BadInput);
      EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
    }
  };
  expectRefused([](PassTest& t) { t.param("interleave", 3); }, "one of 1, 2, 4, 8");
  expectRefused([](PassTest& t) { t.beforeFrame([](PassTest&, scene::Frame&) {}); }, "source_view `first`");
}

}  // namespace
}  // namespace fovea::test
