#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fovea/scene.h"
#include "framework/base/random.h"
#include "framework/scene/load.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/scene.h"
#include "passes/path-trace/directions.h"
#include "passes/path-trace/lights.h"
#include "shaders/records/vpl.h"
#include "tests/passes/voxel_light.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

const glm::vec3 kRho(0.5f, 0.25f, 0.75f);

scene::VplState vplOf(const scene::VoxelSide& side, uint32_t number) {
  scene::VplState v;
  v.position = side.position;
  v.normal = side.normal;
  v.reflectance = side.reflectance;
  v.side = number;
  v.life = 1;
  return v;
}

// A VPL on every `stride`-th side that has a surface.
std::vector<scene::VplState> vplsOn(const VoxelScene& s, uint32_t stride) {
  std::vector<scene::VplState> vpls;
  uint32_t seen = 0;
  for (uint32_t i = 0; i < s.sides().size(); ++i)
    if (s.sides()[i].area > 0 && seen++ % stride == 0) vpls.push_back(vplOf(s.sides()[i], i));
  return vpls;
}

std::vector<glm::vec4> radiosity(const VoxelScene& s, const std::vector<glm::vec4>& radiance,
                                 const MipRun& mips, const std::vector<scene::VplState>& vpls,
                                 const char* terms) {
  PassTest test("radiance");
  test.scene(s.scene).param("terms", terms).seed(3);
  setVoxels(test, s.voxels);
  test.buffer("radiance", radiance, "VoxelRadiance");
  test.buffer("vpls", vpls, "VplState");
  setMips(test, mips);
  test.run();
  return test.values<glm::vec4>("radiosity");
}

float turnOf(uint32_t slot) { return glm::two_pi<float>() * uniformFloat(randomStream(3, 0, 0x4ad, slot)); }

scene::Scene room(float h = 1) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, kRho);
  const uint32_t all[6] = {m, m, m, m, m, m};
  addRoom(s, all, h);
  return s;
}

scene::Scene hollowSphere() {
  scene::Scene s;
  addHollowSphere(s, addMaterial(s, kRho), glm::vec3(0.1f, 0, 0), 1, 48, 24);
  return s;
}

// A room with a ball, a slanted board and a two-sided thin one, lit unevenly.
scene::Scene cluttered() {
  scene::Scene s = room();
  s.materials[addMaterial(s, glm::vec3(0.3f))].doubleSided = true;
  addQuad(s, 1, {-0.5f, -1, -0.2f}, {0.9f, 0, 0.5f}, {0, 1.2f, 0});
  addQuad(s, 0, {-0.9f, -0.4f, -0.9f}, {0, 0.3f, 0.8f}, {0.8f, 0.2f, 0});
  return s;
}

glm::vec3 uneven(const scene::VoxelSide& v) {
  return glm::vec3(1.5f, 1, 0.5f) * (2.0f + v.position.x + 0.5f * v.normal.y);
}

// If every surface emits the radiance L, the irradiance is pi L everywhere, also in the corners.
void expectFurnace(const scene::Scene& model, bool directional) {
  const VoxelScene s(model, 64);
  const glm::vec3 light(2, 1, 0.5f);
  const auto radiance = radianceOf(s, [&](auto&) { return light; });
  const std::vector<scene::VplState> vpls = vplsOn(s, 7);
  const auto got = radiosity(s, radiance, runMips(s, radiance, directional), vpls, "cones");
  double mean = 0;
  size_t dim = 0;
  for (const glm::vec4& b : got) {
    const double ratio = b.g / (glm::pi<double>() * kRho.g * light.g);
    if (b.g > 0) {
      EXPECT_NEAR(b.r / b.g, kRho.r * light.r / (kRho.g * light.g), 5e-3);
    }
    EXPECT_LT(ratio, 1.01);
    mean += ratio / double(got.size());
    dim += ratio < 0.98;
  }
  std::printf("furnace, %s: mean %.4f, %zu of %zu VPLs below 0.98\n", directional ? "faces" : "one volume",
              mean, dim, got.size());
  EXPECT_NEAR(mean, 1, 0.01);
  // Where walls meet, a voxel has the average of their normals, and some cones miss them all.
  EXPECT_LT(double(dim), 0.03 * double(got.size()));
}

TEST(RadianceFurnace, BoxWithFaces) { expectFurnace(room(), true); }
TEST(RadianceFurnace, BoxWithOneVolume) { expectFurnace(room(), false); }
TEST(RadianceFurnace, SphereWithFaces) { expectFurnace(hollowSphere(), true); }
TEST(RadianceFurnace, SphereWithOneVolume) { expectFurnace(hollowSphere(), false); }

TEST(Radiance, ConesEqualTheReference) {
  for (const bool directional : {true, false}) {
    const VoxelScene s(cluttered(), 32);
    const auto radiance = radianceOf(s, uneven);
    const MipRun mips = runMips(s, radiance, directional);
    const std::vector<scene::VplState> vpls = vplsOn(s, 5);
    ASSERT_GT(vpls.size(), 400u);
    const auto got = radiosity(s, radiance, mips, vpls, "cones");
    double error = 0, total = 0;
    size_t off = 0;
    for (size_t i = 0; i < vpls.size(); ++i) {
      const glm::vec3 e =
          referenceGather(s, mips.mips, radiance, vpls[i].position, vpls[i].normal, turnOf(uint32_t(i)));
      const glm::vec3 want = vpls[i].reflectance * e;
      const double d = glm::length(glm::vec3(got[i]) - want);
      // Rounding may select another level or voxel.
      off += d > 5e-3 * glm::length(want);
      error += d;
      total += glm::length(want);
      EXPECT_NEAR(got[i].w, luminance(got[i]), 1e-4 * got[i].w);
    }
    EXPECT_LT(off, vpls.size() / 50);
    EXPECT_LT(error / total, 2e-3);
  }
}

TEST(Radiance, TermsAddUp) {
  const VoxelScene s(cluttered(), 32);
  const auto radiance = radianceOf(s, uneven);
  const MipRun mips = runMips(s, radiance, true);
  const std::vector<scene::VplState> vpls = vplsOn(s, 11);
  const auto both = radiosity(s, radiance, mips, vpls, "both"),
             direct = radiosity(s, radiance, mips, vpls, "direct"),
             cones = radiosity(s, radiance, mips, vpls, "cones");
  for (size_t i = 0; i < vpls.size(); ++i) {
    const glm::vec3 want = glm::pi<float>() * glm::vec3(radiance[vpls[i].side]);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(direct[i][c], want[c], 1e-5f * want[c]);
      EXPECT_NEAR(both[i][c], direct[i][c] + cones[i][c], 1e-5f * both[i][c]);
    }
  }
}

TEST(Radiance, EmptySlotsAndSidesOutOfRange) {
  const VoxelScene s(room(), 16);
  const auto radiance = radianceOf(s, uneven);
  std::vector<scene::VplState> vpls = vplsOn(s, 50);
  vpls.insert(vpls.begin() + 1, scene::VplState{});
  vpls[0].side = scene::kNoSide;
  const auto got = radiosity(s, radiance, runMips(s, radiance, true), vpls, "direct");
  EXPECT_EQ(got[0], glm::vec4(0));
  EXPECT_EQ(got[1], glm::vec4(0));
  EXPECT_GT(got[2].w, 0);
}

// Without cones the pass needs no mips; with cones a missing input is reported.
TEST(Radiance, DirectTermNeedsNoMips) {
  const VoxelScene s(cluttered(), 32);
  const auto radiance = radianceOf(s, uneven);
  const std::vector<scene::VplState> vpls = vplsOn(s, 11);
  const auto run = [&](const char* terms) {
    PassTest test("radiance");
    test.scene(s.scene).param("terms", terms).seed(3);
    setVoxels(test, s.voxels);
    test.buffer("radiance", radiance, "VoxelRadiance").buffer("vpls", vpls, "VplState");
    test.run();
    return test.values<glm::vec4>("radiosity");
  };
  EXPECT_EQ(run("direct"), radiosity(s, radiance, runMips(s, radiance, true), vpls, "direct"));
  EXPECT_THROW(run("both"), Error);
  EXPECT_THROW(run("cones"), Error);
}

TEST(Radiance, NothingThere) {
  const VoxelScene s({}, 8);
  const std::vector<glm::vec4> radiance(2, glm::vec4(0));
  scene::VplState lost;
  lost.life = 1;
  lost.normal = {0, 1, 0};
  lost.reflectance = glm::vec3(1);
  lost.side = scene::kNoSide;
  for (const glm::vec4& b : radiosity(s, radiance, runMips(s, radiance, true), {lost, {}, {}}, "both"))
    EXPECT_EQ(b, glm::vec4(0));
}

// A board of no thickness between a lit and a dark half of a room, and how much of the light reaches the dark side.
double leak(bool directional, float wall) {
  scene::Scene model = room();
  const uint32_t thin = addMaterial(model, kRho);
  model.materials[thin].doubleSided = true;
  addQuad(model, thin, {wall, -1, -1}, {0, 2, 0}, {0, 0, 2});
  const VoxelScene s(model, 64);
  const auto radiance = radianceOf(s, [&](const scene::VoxelSide& v) {
    const bool board = std::abs(v.position.x - wall) < 0.01f && std::abs(v.normal.x) > 0.9f;
    return glm::vec3((board ? v.normal.x < 0 : v.position.x < wall) ? 1.0f : 0.0f);
  });
  std::vector<scene::VplState> vpls;
  for (const scene::VplState& v : vplsOn(s, 5)) {
    const bool board = std::abs(v.position.x - wall) < 0.01f;
    // Voxels in which the wall ends have light of both halves.
    if (board ? v.normal.x > 0.9f : v.position.x > wall + 0.04f) vpls.push_back(v);
  }
  double sum = 0;
  for (const glm::vec4& b : radiosity(s, radiance, runMips(s, radiance, directional), vpls, "cones"))
    sum += b.g / (glm::pi<double>() * kRho.g) / double(vpls.size());
  return sum;
}

TEST(Radiance, ThinWallsDoNotLeak) {
  for (const float wall : {0.0f, 0.02f, 0.3f}) {
    const double faces = leak(true, wall), one = leak(false, wall);
    std::printf("leak through a thin wall at %.2f: faces %.4f, one volume %.4f of the lit side\n", wall,
                faces, one);
    EXPECT_LT(faces, 0.06);  // the cells of the cones reach past the wall's edge
    EXPECT_LT(one, 0.16);    // also, half of what the wall shows is its other side
  }
}

// Compares the gather with many rays over the hemisphere through the same voxels.
TEST(Radiance, ConesAgreeWithManyRays) {
  const VoxelScene s(cluttered(), 64);
  const auto radiance = radianceOf(s, uneven);
  const std::vector<scene::VplState> vpls = vplsOn(s, 37);
  for (const bool directional : {true, false}) {
    const auto got = radiosity(s, radiance, runMips(s, radiance, directional), vpls, "cones");
    double total = 0, wanted = 0, off = 0;
    for (size_t i = 0; i < vpls.size(); ++i) {
      const glm::mat3 frame = path_trace::frameAround(vpls[i].normal);
      double e = 0;
      constexpr int kRays = 512;
      for (int k = 0; k < kRays; ++k) {
        const float u = (float(k) + 0.5f) / kRays,
                    phi = glm::two_pi<float>() * glm::fract(0.618034f * float(k));
        const glm::vec3 d =
            frame * glm::vec3(std::sqrt(u) * std::cos(phi), std::sqrt(u) * std::sin(phi), std::sqrt(1 - u));
        const scene::VoxelHit hit =
            traceVoxels(s.trace(), vpls[i].position, glm::normalize(d), vpls[i].normal);
        if (hit.side != scene::kNoSide) e += glm::pi<double>() * radiance[hit.side].g / kRays;
      }
      const double b = vpls[i].reflectance.g * e;
      total += got[i].g;
      wanted += b;
      off += std::abs(got[i].g - b);
    }
    std::printf("six cones against 512 rays, %s: total %.3f, mean error %.3f\n",
                directional ? "faces" : "one volume", total / wanted, off / wanted);
    EXPECT_NEAR(total / wanted, 1, directional ? 0.05 : 0.15);
    EXPECT_LT(off / wanted, directional ? 0.12 : 0.25);
  }
}

// VPLs at random points of the scene's surfaces.
std::vector<scene::VplState> vplsOnSurfaces(const VoxelScene& s, size_t count) {
  std::vector<scene::VplState> vpls;
  const scene::RayScene rays(s.scene, s.geometry);
  const glm::vec3 low = s.geometry.boundsMin, size = s.geometry.boundsMax - low;
  for (uint32_t k = 0; vpls.size() < count; ++k) {
    auto random = [&](uint32_t i) { return uniformFloat(randomStream(7, 0, i, k)); };
    const glm::vec3 to(random(3) - 0.5f, random(4) - 0.5f, random(5) - 0.5f);
    const scene::RayHit hit =
        rays.intersect({low + size * glm::vec3(random(0), random(1), random(2)), glm::normalize(to)});
    if (!hit) continue;
    const scene::SurfaceHit surface = surfaceAt(s.geometry, hit);
    if (glm::dot(surface.geometricNormal, to) >= 0) continue;
    const uint32_t voxel = s.voxels.voxelAt(glm::ivec3(s.voxels.grid.worldToVoxel(surface.position)));
    if (!voxel) continue;
    scene::VplState v;
    v.side = 2 * (voxel - 1) + scene::voxelSideOf(surface.geometricNormal);
    v.position = surface.position;
    v.normal = surface.geometricNormal;
    v.reflectance = s.sides()[v.side].reflectance;
    v.life = 1;
    vpls.push_back(v);
  }
  return vpls;
}

// Green irradiance by light that has been reflected once, from traced paths.
double tracedSecondBounce(const VoxelScene& s, const scene::RayScene& rays, const scene::VplState& vpl) {
  const glm::mat3 frame = path_trace::frameAround(vpl.normal);
  constexpr int kRays = 512;
  double e = 0;
  for (int k = 0; k < kRays; ++k) {
    const float u = (float(k) + 0.5f) / kRays, phi = glm::two_pi<float>() * glm::fract(0.618034f * float(k));
    const glm::vec3 d =
        frame * glm::vec3(std::sqrt(u) * std::cos(phi), std::sqrt(u) * std::sin(phi), std::sqrt(1 - u));
    const float gap = 4 * rays.epsilon();
    const scene::RayHit hit = rays.intersect({vpl.position + gap * vpl.normal, d});
    if (!hit) continue;
    const scene::SurfaceHit at = surfaceAt(s.geometry, hit);
    if (glm::dot(at.geometricNormal, d) >= 0) continue;
    const scene::Material& material = s.scene.materials[at.material];
    double arriving = 0;
    for (const scene::Light& light : s.scene.lights) {
      const path_trace::IncidentLight l = path_trace::incidentLight(light, at.position);
      const float cosine = glm::dot(at.geometricNormal, l.direction);
      if (cosine <= 0 || l.irradiance.g <= 0) continue;
      const scene::Ray shadow{at.position + gap * at.geometricNormal, l.direction, 0,
                              std::min(l.distance, 1e4f) * 0.9999f};
      if (!rays.occluded(shadow)) arriving += l.irradiance.g * cosine;
    }
    e += (reflectance(s.scene, material, at.uv).g * arriving +
          glm::pi<double>() * emission(s.scene, material, at.uv).g) /
         kRays;
  }
  return e;
}

// From the lights to the radiosity with the passes alone.
TEST(Radiance, SecondBounceInTheCornellBoxAgreesWithRays) {
  const VoxelScene s(scene::builtin("cornellbox"), 64);
  const scene::RayScene rays(s.scene, s.geometry);
  const auto radiance = inject(s, {.shadows = true});
  const std::vector<scene::VplState> vpls = vplsOnSurfaces(s, 300);
  const auto got = radiosity(s, radiance, runMips(s, radiance, true), vpls, "cones");
  double total = 0, wanted = 0, off = 0;
  for (size_t i = 0; i < vpls.size(); ++i) {
    const double want = vpls[i].reflectance.g * tracedSecondBounce(s, rays, vpls[i]);
    total += got[i].g;
    wanted += want;
    off += std::abs(got[i].g - want);
  }
  std::printf("second bounce in the Cornell box: %.3f of what rays find, mean error %.3f\n", total / wanted,
              off / wanted);
  EXPECT_NEAR(total / wanted, 1, 0.12);
  EXPECT_LT(off / wanted, 0.35);  // the light is a pool on the floor: six directions are few
}

}  // namespace
}  // namespace fovea::test
