// Compares the path tracer with closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "tests/passes/path_trace_run.h"
#include "tests/support/sky.h"

namespace fovea::test {
namespace {

// The result must be within 4 standard errors and within 0.5%, and the estimate must be precise enough for the 0.5%
// to mean something.
void expectMean(const Traced& t, glm::dvec3 expected, const char* what) {
  const glm::dvec3 mean = meanOf(t.radiance), error = errorOfMean(t);
  for (int c = 0; c < 3; ++c) {
    EXPECT_LE(std::abs(mean[c] - expected[c]), 4 * error[c] + 2e-5 * expected[c])
        << what << ", channel " << c;
    EXPECT_NEAR(mean[c], expected[c], 0.005 * expected[c]) << what << ", channel " << c;
    EXPECT_LE(4 * error[c], 0.005 * expected[c]) << what << ", channel " << c;
  }
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

// An open plane under a sky with a sun, alone and beside an emissive rectangle that shares the aimed rays with it.
TEST(PathTrace, EnvironmentOnAPlane) {
  const glm::vec3 rho(0.7f, 0.5f, 0.2f);
  scene::Scene s = plane(rho);
  s.environmentMap = skyWithSun();
  const glm::dvec3 open = glm::dvec3(rho) / kPi * irradianceFrom(*s.environmentMap, {0, 1, 0});
  PathTraceSettings settings = independent(4, 8192);
  expectMean(trace(s, 16, settings), open, "a sky");
  settings.independent = false;
  expectMean(trace(s, 16, settings), open, "a sky, Sobol' points");

  // A rectangle below the plane takes half of the aimed rays but sends nothing here.
  const uint32_t lamp = addMaterial(s, glm::vec3(0));
  s.materials[lamp].emission = glm::vec3(5);
  addQuad(s, lamp, {-1, -1, -1}, {2, 0, 0}, {0, 0, 2});
  expectMean(trace(s, 16, settings), open, "a sky and a hidden lamp");
}

TEST(PathTrace, TheEyeSeesTheEnvironment) {
  scene::Scene s = plane(glm::vec3(0));
  s.environmentMap = skyWithSun();
  lookAlong(s, {0, 1, 0}, {0.6f, 0.5f, -0.3f}, 1.2f);
  for (const bool full : {false, true}) {
    PathTraceSettings settings = independent(4, 2);
    settings.full = full;
    const Traced t = trace(s, 16, settings);
    const scene::View view = makeView(s.cameras[0], {16, 16}, flatten(s));
    for (size_t i = 0; i < t.direct.size(); ++i) {
      const glm::vec3 d = glm::normalize(view.rayDirection({float(i % 16) + 0.5f, float(i / 16) + 0.5f}));
      ASSERT_LT(glm::distance(glm::vec3(t.direct[i]), s.environmentMap->radiance(d)), 1e-4f) << i;
    }
  }
}

// Full materials that are white reflect all light of an even sky, whatever their roughness.
TEST(PathTrace, EnvironmentMakesAFurnaceOfFullMaterials) {
  for (const float roughness : {0.05f, 0.3f, 1.0f})
    for (const float metallic : {0.0f, 1.0f}) {
      scene::Scene s = plane(glm::vec3(1));
      s.materials[0].roughness = roughness;
      s.materials[0].metallic = metallic;
      s.environmentMap =
          std::make_shared<const scene::EnvironmentMap>(8, 4, std::vector<glm::vec3>(32, glm::vec3(2)));
      PathTraceSettings settings = independent(4, 4096);
      settings.full = true;
      const Traced t = trace(s, 8, settings);
      EXPECT_NEAR(meanOf(t.radiance).g, 2, 0.02) << roughness << ' ' << metallic;
      EXPECT_LT(errorOfMean(t).g, 0.005) << roughness << ' ' << metallic;
    }
}

// Form factor from a small surface to a parallel rectangle whose corner lies on its normal, a and b long, c
// away (Howell, catalogue of configuration factors, B-3).
double cornerFactor(double a, double b, double c) {
  const double x = a / c, y = b / c, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
}

// Emissive rectangle over a plane: the irradiance is pi L F at every point. It is tested close above the plane, so
// that both ways of sampling count.
TEST(PathTrace, EmissiveTrianglesOnAPlane) {
  for (const double height : {0.25, 2.0}) {
    scene::Scene s = plane(glm::vec3(0.5f));
    addMaterial(s, glm::vec3(0));
    s.materials[1].emission = {4, 2, 1};
    const float h = float(height);
    addQuad(s, 1, {-1, h, -0.5f}, {2, 0, 0}, {0, 0, 1});  // shines down: cross(x, z) = -y
    // Seen from below the rectangle, which would hide the plane otherwise (it is single-sided, and the eye looks
    // through its back).
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

// Two facing unit squares one metre apart. Seen along the normal, pixels cover equal areas of a square, so the mean
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

// In a closed room whose walls all emit and reflect alike, the light is the same everywhere, whatever the room's
// shape: e (1 + rho + ... + rho^(depth - 1)). Paths that reach emitters by chance and those sent there must be
// weighted correctly against each other.
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

// Removes smooth normals, which leaves a body of flat facets.
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

// A light in the middle of a closed body of one albedo. Its light is all absorbed and reflected once, so the mean
// irradiance on the area A is 4 pi I / A, and after k more reflections rho^k of it, exactly and for any body. The
// body is a sphere except for facets of 2 degrees, so the light that comes by way of other facets is the same
// everywhere. Only the first reflection shows the facets: I cos / d^2 at each pixel.
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

}  // namespace
}  // namespace fovea::test
