// The path tracer against closed forms, its statistics, and the rules it shares with the raster passes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "framework/scene/load.h"
#include "framework/scene/ray_scene.h"
#include "passes/path-trace/path_tracer.h"
#include "tests/support/pass_test.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

constexpr double kPi = glm::pi<double>();

using passes::PathTraceSettings;

struct Traced {
  glm::uvec2 size{0};
  std::vector<glm::vec4> radiance, direct, indirect, variance, halfA, halfB;
  passes::PathTraceStatistics statistics;
};

Traced trace(const scene::Scene& s, uint32_t side, const PathTraceSettings& settings) {
  const scene::Geometry g = flatten(s);
  const scene::Frame frame = makeFrame(s, g, {side, side}, 0, 1);
  const scene::RayScene rays(s, g);
  Traced t;
  t.size = {side, side};
  for (auto* image : {&t.radiance, &t.direct, &t.indirect, &t.variance, &t.halfA, &t.halfB})
    image->resize(size_t(side) * side);
  t.statistics = tracePaths(frame, frame.views[0], rays, settings,
                            {t.radiance, t.direct, t.indirect, t.variance, t.halfA, t.halfB});
  return t;
}

PathTraceSettings independent(uint32_t depth, uint32_t samples, uint32_t seed = 1) {
  PathTraceSettings settings;
  settings.depth = depth;
  settings.samples = samples;
  settings.seed = seed;
  settings.independent = true;
  return settings;
}

glm::dvec3 meanOf(const std::vector<glm::vec4>& image) {
  glm::dvec3 sum(0);
  for (const glm::vec4& v : image) sum += glm::dvec3(v);
  return sum / double(image.size());
}

// Standard error of the mean over the picture: pixels are independent of each other.
glm::dvec3 errorOfMean(const Traced& t) { return glm::sqrt(meanOf(t.variance) / double(t.variance.size())); }

// Within 4 standard errors and 0.5%; and the estimate must be sharp enough for the 0.5% to mean something.
void expectMean(const Traced& t, glm::dvec3 expected, const char* what) {
  const glm::dvec3 mean = meanOf(t.radiance), error = errorOfMean(t);
  for (int c = 0; c < 3; ++c) {
    EXPECT_LE(std::abs(mean[c] - expected[c]), 4 * error[c] + 2e-5 * expected[c])
        << what << ", channel " << c;
    EXPECT_NEAR(mean[c], expected[c], 0.005 * expected[c]) << what << ", channel " << c;
    EXPECT_LE(4 * error[c], 0.005 * expected[c]) << what << ", channel " << c;
  }
}

void lookAlong(scene::Scene& s, glm::vec3 eye, glm::vec3 towards, float verticalFov) {
  s.cameras.resize(1);
  s.cameras[0].position = eye;
  const glm::vec3 d = glm::normalize(towards);
  s.cameras[0].orientation =
      glm::quatLookAt(d, std::abs(d.y) > 0.9f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0));
  s.cameras[0].verticalFov = verticalFov;
}

// ---- Closed forms
// --------------------------------------------------------------------------------------------------

// Looks down on the plane y = 0; pixel -> point of the plane.
scene::Scene plane(glm::vec3 rho) {
  scene::Scene s;
  addMaterial(s, rho);
  addQuad(s, 0, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
  lookAlong(s, {0, 3, 0}, {0, -1, 0}, 1);
  return s;
}

glm::dvec3 onPlane(const scene::Scene& s, uint32_t side, size_t pixel) {
  const scene::View view = makeView(s.cameras[0], {side, side}, flatten(s));
  const glm::vec3 d = view.rayDirection({float(pixel % side) + 0.5f, float(pixel / side) + 0.5f});
  return glm::dvec3(view.eye - d * (view.eye.y / d.y));
}

void expectOnPlane(const scene::Light& light, const std::function<double(glm::dvec3)>& irradiance) {
  const glm::vec3 rho(0.7f, 0.5f, 0.2f);
  scene::Scene s = plane(rho);
  s.lights = {light};
  const Traced t = trace(s, 16, independent(4, 2));
  for (size_t i = 0; i < t.direct.size(); ++i) {
    const double e = irradiance(onPlane(s, 16, i));
    for (int c = 0; c < 3; ++c) {
      const double expected = rho[c] / kPi * light.color[c] * e;
      ASSERT_NEAR(t.direct[i][c], expected, 2e-4 * expected + 1e-7) << "pixel " << i;
      ASSERT_EQ(t.radiance[i][c], t.direct[i][c]);  // a plane lights nothing
    }
    ASSERT_EQ(t.variance[i], glm::vec4(0, 0, 0, 1));
  }
}

TEST(PathTrace, DirectionalLightOnAPlane) {
  const glm::vec3 direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
  expectOnPlane(sun(direction, {3, 2, 1}), [&](glm::dvec3) { return -double(direction.y); });
}

TEST(PathTrace, PointLightOnAPlane) {
  const glm::dvec3 at(0.4, 1.5, -0.3);
  const auto inverseSquare = [&](glm::dvec3 p) { return at.y / std::pow(glm::distance(at, p), 3); };
  expectOnPlane(pointLight(at, {30, 20, 10}), inverseSquare);
  scene::Light ranged = pointLight(at, {30, 20, 10});
  ranged.range = 2.5f;
  expectOnPlane(ranged, [&](glm::dvec3 p) {
    return inverseSquare(p) * std::max(0.0, 1 - std::pow(glm::distance(at, p) / 2.5, 4));
  });
}

TEST(PathTrace, SpotLightOnAPlane) {
  const glm::dvec3 at(0.4, 2, -0.3), axis = glm::normalize(glm::dvec3(-0.2, -1, 0.1));
  expectOnPlane(spotLight(at, axis, 0.2f, 0.5f, {30, 20, 10}), [&](glm::dvec3 p) {
    const glm::dvec3 w = glm::normalize(p - at);
    const double c = glm::dot(w, axis), edge = (c - std::cos(0.5)) / (std::cos(0.2) - std::cos(0.5));
    return std::pow(std::clamp(edge, 0.0, 1.0), 2) * -w.y / glm::dot(p - at, p - at);
  });
}

// Form factor from a small surface to a parallel rectangle whose corner lies on its normal, a and b long, c
// away (Howell, catalogue of configuration factors, B-3).
double cornerFactor(double a, double b, double c) {
  const double x = a / c, y = b / c, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
}

// Emissive rectangle over a plane: irradiance pi L F at every point. Close above it, so that both ways of
// sampling count.
TEST(PathTrace, EmissiveTrianglesOnAPlane) {
  for (const double height : {0.25, 2.0}) {
    scene::Scene s = plane(glm::vec3(0.5f));
    addMaterial(s, glm::vec3(0));
    s.materials[1].emission = {4, 2, 1};
    const float h = float(height);
    addQuad(s, 1, {-1, h, -0.5f}, {2, 0, 0}, {0, 0, 1});  // shines down: cross(x, z) = -y
    // From below the rectangle, which would hide the plane otherwise (single-sided: the eye looks through its
    // back).
    const Traced t = trace(s, 24, independent(2, 2048));
    double expected = 0, z2 = 0;
    for (size_t i = 0; i < t.radiance.size(); ++i) {
      const glm::dvec3 p = onPlane(s, 24, i);
      const double x0 = -1 - p.x, x1 = 1 - p.x, z0 = -0.5 - p.z, z1 = 0.5 - p.z;
      const double factor = cornerFactor(x1, z1, height) - cornerFactor(x0, z1, height) -
                            cornerFactor(x1, z0, height) + cornerFactor(x0, z0, height);
      expected += 0.5 * factor / double(t.radiance.size());
      z2 += std::pow(t.radiance[i].r - 4 * 0.5 * factor, 2) / t.variance[i].r / double(t.radiance.size());
      ASSERT_EQ(t.direct[i], glm::vec4(0, 0, 0, 1));
    }
    expectMean(t, expected * glm::dvec3(4, 2, 1), "rectangle");
    EXPECT_NEAR(z2, 1, 4 * std::sqrt(2.0 / double(t.radiance.size())))
        << height;  // every pixel, and its variance
  }
}

// Two facing unit squares one apart. Seen along the normal pixels cover equal areas of a square, so the mean
// over the picture is the mean over the square: rho L F.
TEST(PathTrace, FacingSquaresExchangeTheirFormFactor) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0.6f, 0.4f, 0.2f));
  addMaterial(s, glm::vec3(0));
  s.materials[1].emission = glm::vec3(2, 3, 5);
  addQuad(s, 0, {-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1});  // faces up
  addQuad(s, 1, {-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1});  // faces down
  lookAlong(s, {0, 0.5f, 0}, {0, -1, 0}, glm::half_pi<float>());
  PathTraceSettings settings = independent(4, 256);
  settings.box = true;
  // Parallel squares of side 1 at distance 1 (Howell, C-11).
  const double f = 2 / kPi *
                   (std::log(std::sqrt(4.0 / 3)) + 2 * std::sqrt(2.0) * std::atan(1 / std::sqrt(2.0)) -
                    2 * std::atan(1.0));
  EXPECT_NEAR(f, 0.19982, 1e-5);
  expectMean(trace(s, 48, settings), f * glm::dvec3(0.6 * 2, 0.4 * 3, 0.2 * 5), "squares");
}

// In a closed room whose walls all shine and reflect alike the light is the same everywhere, whatever the
// room's shape: e (1 + rho + ... + rho^(depth - 1)). Paths that end on emitters by chance and those sent
// there must share correctly.
TEST(PathTrace, EmissiveFurnaceFormsAGeometricSeries) {
  const glm::dvec3 rho(0.9, 0.5, 0.2), e(1, 2, 3);
  scene::Scene s;
  addMaterial(s, rho);
  s.materials[0].emission = e;
  const uint32_t walls[6] = {};
  addRoom(s, walls, 1);
  s.materials.push_back(s.materials[0]);
  s.materials[1].doubleSided = true;
  addQuad(s, 1, {-0.5f, -0.4f, 0.5f}, {0.7f, 0.2f, 0}, {0, 0, -1});  // a board
  lookAlong(s, {0.2f, 0.3f, 0.6f}, {0, -0.2f, -1}, 1.4f);
  for (const uint32_t depth : {1u, 2u, 3u, 4u, 6u, 12u}) {
    glm::dvec3 series(0), term = e;
    for (uint32_t k = 0; k < depth; ++k, term *= rho) series += term;
    const Traced t = trace(s, 32, independent(depth, 128));
    expectMean(t, series, "furnace");
    EXPECT_EQ(meanOf(t.direct), e);
  }
}

// Without what smooth normals would add to its form: a body of flat facets.
void useFlatNormals(scene::Primitive& p) {
  scene::Primitive flat;
  flat.material = p.material;
  for (size_t i = 0; i < p.indices.size(); ++i) {
    const size_t first = i - i % 3;
    const auto corner = [&](size_t k) { return p.positions[p.indices[first + k]]; };
    flat.positions.push_back(p.positions[p.indices[i]]);
    flat.normals.push_back(glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0))));
    flat.uvs.push_back(glm::vec2(0));
    flat.indices.push_back(uint32_t(i));
  }
  p = std::move(flat);
}

// A light in the middle of a closed body of one albedo: the light that it sends out is all absorbed and
// reflected once, so that the mean irradiance on the area A is 4 pi I / A, and that after k more reflections
// rho^k of it: exactly, whatever the body. It is a sphere but for facets of 2 degrees: what comes by way of
// other facets is the same everywhere. Only the first reflection shows them: I cos / d^2 at each pixel.
TEST(PathTrace, FurnaceWithALightFormsAGeometricSeries) {
  const glm::dvec3 rho(0.9, 0.5, 0.2);
  scene::Scene s;
  addMaterial(s, rho);
  addHollowSphere(s, 0, glm::vec3(0), 2, 192, 96);
  useFlatNormals(s.meshes.back().primitives.back());
  s.lights = {pointLight(glm::vec3(0), glm::vec3(10))};
  lookAlong(s, {0.3f, 0.2f, 1}, {0, -0.1f, -1}, 1.2f);
  constexpr uint32_t kSide = 32;
  const scene::Geometry g = flatten(s);
  const scene::RayScene rays(s, g);
  const scene::View view = makeView(s.cameras[0], {kSide, kSide}, g);
  double seen = 0;  // irradiance from the light, mean over the pixels
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    scene::Ray ray;
    ray.origin = view.eye;
    ray.direction = view.rayDirection({float(i % kSide) + 0.5f, float(i / kSide) + 0.5f});
    const scene::SurfaceHit hit = surfaceAt(g, rays.intersect(ray));
    const glm::dvec3 p(hit.position);
    seen +=
        -10 * glm::dot(p, glm::dvec3(hit.geometricNormal)) / std::pow(glm::length(p), 3) / (kSide * kSide);
  }
  const double irradiance = 4 * kPi * 10 / rays.surfaceArea();
  EXPECT_NEAR(irradiance, 10.0 / 4, 0.002 * 10 / 4);
  for (const uint32_t depth : {2u, 3u, 4u, 6u}) {
    glm::dvec3 series = rho / kPi * seen, term = rho * rho / kPi * irradiance;
    for (uint32_t k = 3; k <= depth; ++k, term *= rho) series += term;
    expectMean(trace(s, kSide, independent(depth, 32)), series, "sphere");
  }
}

// ---- Statistics
// ----------------------------------------------------------------------------------------------------

TEST(PathTrace, MeanOfTheCornellBoxDoesNotDependOnTheSeed) {
  const scene::Scene s = scene::builtin("cornellbox");
  std::vector<Traced> runs;
  for (const bool lowDiscrepancy : {false, true})
    for (uint32_t seed = 0; seed < 6; ++seed) {
      PathTraceSettings settings = independent(4, 32, seed);
      settings.independent = !lowDiscrepancy;
      runs.push_back(trace(s, 32, settings));
    }
  double largest = 0, z2 = 0;
  int pairs = 0;
  for (size_t i = 0; i < runs.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const double a = meanOf(runs[i].radiance).g, b = meanOf(runs[j].radiance).g;
      const double ea = errorOfMean(runs[i]).g, eb = errorOfMean(runs[j]).g;
      const double z = std::abs(a - b) / std::sqrt(ea * ea + eb * eb);
      largest = std::max(largest, z);
      z2 += z * z;
      ++pairs;
      EXPECT_NE(a, b);
    }
  EXPECT_LT(largest, 4.2);
  EXPECT_LT(z2 / pairs, 2.5);  // 1 on average; pairs are not independent
  EXPECT_GT(z2 / pairs, 0.3);
}

// MSE(h1, h2) / 4 is the squared error of the mean: it falls as 1 / spp, and the variance says the same.
TEST(PathTrace, ErrorFallsAsOneOverTheSamples) {
  const scene::Scene s = scene::builtin("cornellbox");
  std::vector<double> x, y;
  for (const uint32_t samples : {8u, 32u, 128u, 512u}) {
    const Traced t = trace(s, 40, independent(4, samples));
    double halves = 0;
    for (size_t i = 0; i < t.halfA.size(); ++i)
      halves += std::pow(double(t.halfA[i].g) - t.halfB[i].g, 2) / 4 / double(t.halfA.size());
    EXPECT_NEAR(halves, meanOf(t.variance).g, 0.25 * halves) << samples;
    x.push_back(std::log2(samples));
    y.push_back(std::log2(meanOf(t.variance).g));
    for (size_t i = 0; i < t.halfA.size(); ++i)
      ASSERT_NEAR(t.radiance[i].g, (t.halfA[i].g + t.halfB[i].g) / 2, 1e-5f * t.radiance[i].g + 1e-6f);
    if (samples < 512) continue;
    PathTraceSettings settings = independent(4, samples);
    settings.independent = false;
    EXPECT_LT(meanOf(trace(s, 40, settings).variance).g,
              0.8 * meanOf(t.variance).g);  // what Sobol' points are for
  }
  double slope = 0;
  for (size_t i = 1; i < x.size(); ++i) slope += (y[i] - y[i - 1]) / (x[i] - x[i - 1]) / double(x.size() - 1);
  EXPECT_NEAR(slope, -1, 0.05);
}

// Also with low-discrepancy sampling, over many seeds: the variance that is put out is the one there is.
TEST(PathTrace, VarianceIsThatBetweenSeeds) {
  const scene::Scene s = scene::builtin("cornellbox");
  constexpr uint32_t kSeeds = 24, kSide = 24;
  for (const bool box : {false, true}) {
    std::vector<glm::dvec3> sum(kSide * kSide), squares(kSide * kSide);
    double claimed = 0, found = 0;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
      PathTraceSettings settings = independent(4, 32, seed);
      settings.independent = false;
      settings.box = box;
      const Traced t = trace(s, kSide, settings);
      claimed += meanOf(t.variance).g / kSeeds;
      for (size_t i = 0; i < sum.size(); ++i) {
        sum[i] += glm::dvec3(t.radiance[i]);
        squares[i] += glm::dvec3(t.radiance[i]) * glm::dvec3(t.radiance[i]);
      }
    }
    for (size_t i = 0; i < sum.size(); ++i)
      found += (squares[i].g - sum[i].g * sum[i].g / kSeeds) / (kSeeds - 1) / double(sum.size());
    EXPECT_NEAR(claimed, found, 0.1 * found) << box;
  }
}

// ---- Determinism and interruption
// ----------------------------------------------------------------------------------

TEST(PathTrace, SameBitsForAnyNumberOfThreads) {
  const scene::Scene s = scene::builtin("cornellbox");
  for (const bool lowDiscrepancy : {false, true}) {
    PathTraceSettings settings = independent(4, 21);
    settings.independent = !lowDiscrepancy;
    settings.threads = 1;
    const Traced one = trace(s, 33, settings);
    for (const uint32_t threads : {2u, 5u}) {
      settings.threads = threads;
      const Traced many = trace(s, 33, settings);
      EXPECT_EQ(one.radiance, many.radiance);
      EXPECT_EQ(one.indirect, many.indirect);
      EXPECT_EQ(one.variance, many.variance);
      EXPECT_EQ(one.halfB, many.halfB);
      EXPECT_EQ(one.statistics.rays, many.statistics.rays);
    }
    settings.seed = 2;
    EXPECT_NE(one.radiance, trace(s, 33, settings).radiance);
  }
}

TEST(PathTrace, StoppedEarlyItKeepsWhatItHas) {
  const scene::Scene s = scene::builtin("cornellbox");
  PathTraceSettings settings = independent(4, 1 << 24);
  double last = 0;
  int calls = 0;
  settings.progress = [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return ++calls < 3;
  };
  const Traced t = trace(s, 48, settings);
  EXPECT_EQ(calls, 3);
  EXPECT_GE(t.statistics.samples, 2);
  EXPECT_LT(t.statistics.samples, 1 << 20);
  const Traced whole = trace(s, 48, independent(4, 64));
  EXPECT_NEAR(meanOf(t.radiance).g, meanOf(whole.radiance).g, 5 * (errorOfMean(t).g + errorOfMean(whole).g));
  for (const glm::vec4& v : t.variance) ASSERT_TRUE(std::isfinite(v.r));
}

// ---- Rules shared with the raster passes
// ---------------------------------------------------------------------------

// A floor, and halfway up to the eye and the lights a sheet with holes where its texture is transparent.
scene::Scene withSheet() {
  scene::Scene s = plane(glm::vec3(0.5f));
  addMaterial(s, glm::vec3(0.8f, 0.1f, 0.1f));
  scene::Texture holes;
  holes.width = holes.height = 2;
  holes.rgba = {255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 0, 255, 255, 255, 255};
  s.textures.push_back(holes);
  scene::Material& sheet = s.materials[1];
  sheet.baseColorTexture.texture = 0;
  sheet.masked = sheet.doubleSided = true;
  addQuad(s, 1, {-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
  return s;
}

std::vector<float> differences(const Traced& t, const std::vector<float>& image) {
  std::vector<float> d;
  for (size_t i = 0; i < t.direct.size(); ++i)
    d.push_back(
        glm::length(glm::vec3(t.direct[i]) - glm::vec3(image[4 * i], image[4 * i + 1], image[4 * i + 2])) /
        (glm::length(glm::vec3(t.direct[i])) + 0.01f));
  std::sort(d.begin(), d.end());
  return d;
}

// Visibility, materials, textures, masks, normals, lights: everything but the texels of the shadow maps along
// the shadows' edges.
TEST(PathTrace, DirectLightIsThatOfTheRasterPasses) {
  scene::Scene s = withSheet();
  addMaterial(s, glm::vec3(0.2f, 0.3f, 0.9f));
  addHollowSphere(s, 2, {1.2f, 0.5f, 0.4f}, 0.4f, 32, 16);  // its front is inside
  s.materials[2].emission = {0, 0.1f, 0};
  s.environment = {0.1f, 0.2f, 0.3f};
  s.lights = {sun({0.3f, -1, 0.2f}, {1, 1, 0.5f}), pointLight({0.5f, 2, 0}, glm::vec3(2)),
              spotLight({-1, 2.5f, 0}, {0.3f, -1, 0}, 0.3f, 0.5f, {0, 5, 5})};
  for (const bool fromAside : {false, true}) {
    if (fromAside) lookAlong(s, {6, 3, 8}, {-0.5f, -0.2f, -0.8f}, 1);
    PathTraceSettings settings = independent(2, 2);
    const Traced t = trace(s, 96, settings);
    GraphRunOptions options;
    options.size = {96, 96};
    options.outputs = {"direct"};
    const auto d = differences(t, toFloats(runGraph("direct", s, options).outputs.at("direct")));
    EXPECT_LT(d[d.size() * 9 / 10], 0.003f) << fromAside;
    EXPECT_LT(d[d.size() * 98 / 100], 0.1f) << fromAside;
  }
}

TEST(PathTrace, HolesOfMasksLetEyeAndLightThrough) {
  scene::Scene s = withSheet();
  s.lights = {sun({0.5f, -1, 0.2f}, glm::vec3(1))};
  const double e = 1 / std::sqrt(1.29) / kPi;
  const Traced t = trace(s, 64, independent(2, 2));
  int sheet = 0, lit = 0, shadowed = 0;
  for (const glm::vec4& v : t.direct) {
    if (std::abs(v.r - 0.8 * e) < 1e-3) ++sheet;
    if (std::abs(v.r - 0.5 * e) < 1e-3) ++lit;
    if (v.r == 0) ++shadowed;
  }
  // The sheet spans (64 / 2 / tan 0.5 / 2)^2 pixels a quarter, half of them holes (edges at the cutoff of a
  // bilinear ramp).
  const double spans = std::pow(64 / (2 * std::tan(0.5)), 2);
  EXPECT_NEAR(sheet, 0.5 * spans, 0.08 * spans);
  EXPECT_GT(lit, 200);
  EXPECT_GT(shadowed, 20);
  EXPECT_EQ(sheet + lit + shadowed, 64 * 64);
}

// The back of a single-sided board: the eye looks through it, it stops light and is black.
TEST(PathTrace, BacksOfSingleSidedMaterialsAreBlackAndUnseen) {
  const auto at = [](const Traced& t) { return t.radiance[t.radiance.size() / 2 + t.size.x / 2].r; };
  scene::Scene s = plane(glm::vec3(0.5f));
  addMaterial(s, glm::vec3(1));
  s.lights = {sun({0, -1, 0}, glm::vec3(1))};
  const float lit = at(trace(s, 17, independent(2, 2)));
  EXPECT_NEAR(lit, 0.5 / kPi, 1e-5);
  addQuad(s, 1, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2});  // faces down, between the eye and the floor
  const Traced shadow = trace(s, 17, independent(4, 64));
  EXPECT_EQ(shadow.direct[17 * 8 + 8].r, 0);
  EXPECT_GT(shadow.indirect[17 * 8 + 8].r, 0);  // the lit floor around, by way of the board's front
  s.materials[1].doubleSided = true;
  EXPECT_NEAR(at(trace(s, 17, independent(2, 2))), 1 / kPi, 1e-5);  // now the board is seen
  // Light that the floor sends up to a back does not come down again.
  s = plane(glm::vec3(0.5f));
  addMaterial(s, glm::vec3(1));
  addQuad(s, 1, {-9, 1, 9}, {18, 0, 0}, {0, 0, -18});  // faces up
  lookAlong(s, {0, 0.5f, 0}, {0, -1, 0}, 1);
  s.lights = {pointLight({0, 0.9f, 0}, glm::vec3(1))};
  EXPECT_EQ(meanOf(trace(s, 8, independent(4, 64)).indirect), glm::dvec3(0));
  s.materials[1].doubleSided = true;
  EXPECT_GT(meanOf(trace(s, 8, independent(4, 64)).indirect).r, 0.1);
}

TEST(PathTrace, EnvironmentIsSeenButLightsNothing) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
  s.environment = {1, 2, 3};
  lookAlong(s, {0, 1, 0}, {0, 0, -1}, 1);
  const Traced t = trace(s, 8, independent(4, 4));
  EXPECT_EQ(t.radiance.front(), glm::vec4(1, 2, 3, 1));
  EXPECT_EQ(t.halfB.front(), glm::vec4(1, 2, 3, 1));
  EXPECT_EQ(t.radiance.back(), glm::vec4(0, 0, 0, 1));
}

// ---- As a pass
// -----------------------------------------------------------------------------------------------------

TEST(PathTracePass, PutsOutWhatTheTracerMakes) {
  const scene::Scene s = scene::builtin("cornellbox");
  PassTest test("path-trace");
  test.param("spp", 16).param("sampling", "independent").viewSize(24, 24).scene(s).seed(5);
  test.run();
  const auto radiance = test.values<glm::vec4>("radiance"), direct = test.values<glm::vec4>("direct"),
             indirect = test.values<glm::vec4>("indirect"), variance = test.values<glm::vec4>("variance"),
             halfA = test.values<glm::vec4>("half_a"), halfB = test.values<glm::vec4>("half_b");
  const Traced t = trace(s, 24, independent(4, 256));
  glm::dvec3 error(0);
  for (size_t i = 0; i < radiance.size(); ++i) {
    ASSERT_EQ(direct[i], t.direct[i]);
    ASSERT_NEAR(radiance[i].r, direct[i].r + indirect[i].r, 1e-6f);
    ASSERT_NEAR(radiance[i].r, (halfA[i].r + halfB[i].r) / 2, 1e-5f);
    error += glm::dvec3(variance[i]) / double(radiance.size() * radiance.size());
  }
  EXPECT_NEAR(meanOf(radiance).r, meanOf(t.radiance).r, 5 * std::sqrt(error.r));
  EXPECT_EQ(test.counter("paths"), 16 * 24 * 24);
  EXPECT_EQ(test.counter("samples"), 16);
  EXPECT_GT(test.counter("rays"), 16 * 24 * 24);
}

TEST(PathTracePass, EmptySceneIsTheEnvironment) {
  PassTest test("path-trace");
  scene::Scene s;
  s.materials.emplace_back();
  s.cameras.emplace_back();
  s.environment = {0.25f, 0.5f, 1};
  test.param("spp", 2).viewSize(4, 4).scene(s);
  test.run();
  for (const glm::vec4& v : test.values<glm::vec4>("radiance")) EXPECT_EQ(v, glm::vec4(0.25f, 0.5f, 1, 1));
}

// A board that comes between the sun and the floor, and new noise every frame.
TEST(PathTracePass, FollowsWhatMoves) {
  scene::Scene s = plane(glm::vec3(0.5f));
  s.lights = {sun({0, -1, 0}, glm::vec3(1))};
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 1, {-0.5f, 4, 0.5f}, {1, 0, 0}, {0, 0, -1});  // above the eye
  s.nodes[1].dynamic = true;
  scene::Mover mover;
  mover.node = 1;
  mover.smooth = false;
  mover.keys.resize(2);
  mover.keys[0].translation = {3, 0, 0};
  mover.keys[1].time = 1 / 42.0f;
  s.movers = {mover};
  PassTest test("path-trace");
  test.param("spp", 2).viewSize(33, 33).scene(s);
  test.run();
  const auto before = test.values<glm::vec4>("direct");
  test.run();
  const auto after = test.values<glm::vec4>("direct");
  const size_t centre = 33 * 16 + 16;
  EXPECT_NEAR(before[centre].r, 0.5 / kPi, 1e-5);
  EXPECT_EQ(after[centre].r, 0);
  // 1 m of the floor is 33 / (2 * 3 * tan 0.5) pixels.
  const auto dark = std::count_if(after.begin(), after.end(), [](const glm::vec4& v) { return v.r == 0; });
  EXPECT_NEAR(std::sqrt(double(dark)), 33 / (6 * std::tan(0.5)), 1);
}

TEST(PathTracePass, NoiseChangesWithTheFrameUnlessToldNotTo) {
  for (const bool perFrame : {true, false}) {
    PassTest test("path-trace");
    test.param("spp", 2).param("per_frame", perFrame).viewSize(16, 16).scene(scene::builtin("cornellbox"));
    test.run();
    const auto first = test.bytes("indirect");
    test.run();
    EXPECT_EQ(first == test.bytes("indirect"), !perFrame);
  }
}

TEST(PathTracePass, GraphHasTheLayersOfTheOthers) {
  GraphRunOptions options;
  options.size = {32, 32};
  options.set = {"spp=8"};
  const GraphRun run = runGraph("reference", scene::builtin("cornellbox"), options);
  for (const char* name : {"image", "radiance", "direct", "indirect", "variance", "half_a", "half_b"})
    EXPECT_EQ(run.outputs.count(name), 1u) << name;
}

}  // namespace
}  // namespace fovea::test
