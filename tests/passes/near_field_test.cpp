// Light of what is near: every ray against the same one on the CPU, and what there must be none of.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>

#include "framework/base/random.h"
#include "tests/passes/weights_reference.h"

namespace fovea::test {
namespace {

struct Near {
  Room room = closedRoom(true, 24, glm::ivec2(96, 72));
  std::vector<glm::vec4> radiance;
  float area = 0.5f, foveaRadius = 0.15f;
  double reach = 2, most = 0;

  Near() {
    for (const scene::VoxelSide& side : room.voxels.surface)
      radiance.emplace_back(glm::abs(side.position) + 0.1f, 1.0f);
  }
  std::vector<float> run() const {
    PassTest test("near-field");
    std::vector<float> position;
    std::vector<uint16_t> normal;
    std::vector<int16_t> face;
    for (const Seen& s : room.pixels) {
      position.insert(position.end(), {s.position.x, s.position.y, s.position.z, s.there ? 1.0f : 0.0f});
      for (const float x : {s.normal.x, s.normal.y, s.normal.z, 0.0f}) normal.push_back(glm::packHalf1x16(x));
      const glm::vec2 oct = s.normal.z >= -0.5f ? glm::vec2(s.normal) : glm::vec2(1);
      for (const float x : {oct.x, oct.y}) face.push_back(int16_t(std::lround(32767 * x)));
    }
    const auto w = uint32_t(room.size.x), h = uint32_t(room.size.y);
    test.viewSize(w, h).scene(room.scene).param("reach", reach).param("fovea_radius", double(foveaRadius));
    test.param("most", most);
    test.image("gbuffer.position", VK_FORMAT_R32G32B32A32_SFLOAT, w, h, 1, position);
    test.image("gbuffer.normal", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, normal);
    test.image("gbuffer.face", VK_FORMAT_R16G16_SNORM, w, h, 1, face);
    setVoxels(test, room.voxels);
    test.buffer("radiance", radiance, "VoxelRadiance");
    test.buffer("spread", std::vector<glm::vec4>{{area, 0, 0, 0}}, "VplSpread");
    test.run();
    return test.floats("irradiance");
  }
};

glm::vec2 stratified(glm::uvec2 at, uint32_t side) {
  const uint32_t bits = randomStream(side, 0x6e656172u, at.x, at.y), x = at.x % side, y = at.y % side;
  return (glm::vec2(x, (y + 2 * x + x / 2) % side) +
          glm::vec2(uniformFloat(bits), uniformFloat(hashPcg(bits)))) /
         float(side);
}

glm::vec3 lightOf(const Near& in, const Seen& seen, glm::vec2 u) {
  if (!seen.there) return glm::vec3(0);
  const float r = std::sqrt(u.x), phi = glm::two_pi<float>() * u.y, radius2 = in.area / glm::pi<float>();
  const glm::vec3 d = glm::normalize(scene::toWorld(
      scene::orthonormalFrame(seen.normal), {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x)}));
  const scene::VoxelHit hit =
      scene::traceVoxels(in.room.view(), seen.position, d, seen.normal, float(in.reach) * std::sqrt(radius2));
  if (hit.side == scene::kNoSide) return glm::vec3(0);
  return glm::vec3(in.radiance[hit.side]) * radius2 / (hit.distance * hit.distance + radius2);
}

// A ray for each pixel of the work groups (16 x 16 pixels) that the fovea reaches into, one for four
// elsewhere.
TEST(NearField, EveryRayEqualsTheReference) {
  const Near in;
  const auto got = in.run();
  const scene::Fovea fovea = scene::makeFovea(glm::vec2(0.5f), in.room.size, in.foveaRadius);
  int wrong = 0, lit = 0, sparse = 0;
  for (int y = 0; y < in.room.size.y; ++y)
    for (int x = 0; x < in.room.size.x; ++x) {
      const glm::vec2 low(x / 16 * 16, y / 16 * 16), high = low + glm::vec2(16);
      const bool each = glm::distance(glm::clamp(fovea.centre, low, high), fovea.centre) <= fovea.radius;
      const int px = each ? x : x / 2 * 2, py = each ? y : y / 2 * 2;
      const glm::vec2 u = each ? stratified({x, y}, 4) : stratified({x / 2, y / 2}, 2);
      const glm::vec3 want = lightOf(in, in.room.pixels[size_t(py) * in.room.size.x + px], u);
      const float* pixel = &got[4 * (size_t(y) * in.room.size.x + x)];
      wrong +=
          glm::distance(want, glm::vec3(pixel[0], pixel[1], pixel[2])) > 2e-3f * glm::length(want) + 1e-6f;
      lit += want != glm::vec3(0);
      sparse += !each;
    }
  EXPECT_GT(lit, 500);
  EXPECT_GT(sparse, 1000);
  EXPECT_LT(sparse, in.room.size.x * in.room.size.y / 2 + 2000);
  EXPECT_LE(wrong, in.room.size.x * in.room.size.y / 200);  // rays that graze a voxel
}

// No pixel is brighter than so many times the mean of its work group; those that are not stay as they are.
TEST(NearField, NoSparksWithALimit) {
  Near in;
  in.room = closedRoom(true, 24, glm::ivec2(96, 80));
  for (size_t i = 0; i < in.radiance.size(); i += 40) in.radiance[i] *= 100;
  const auto free = in.run();
  in.most = 3;
  const auto got = in.run();
  const auto at = [&](const std::vector<float>& image, int x, int y) {
    const float* p = &image[4 * (size_t(y) * in.room.size.x + x)];
    return glm::vec3(p[0], p[1], p[2]);
  };
  const auto luminance = [](glm::vec3 v) { return glm::dot(v, glm::vec3(0.2126f, 0.7152f, 0.0722f)); };
  int limited = 0, wrong = 0;
  for (int y = 0; y < in.room.size.y; ++y)
    for (int x = 0; x < in.room.size.x; ++x) {
      float mean = 0;
      for (int k = 0; k < 256; ++k)
        mean += luminance(at(free, x / 16 * 16 + k % 16, y / 16 * 16 + k / 16)) / 256;
      const glm::vec3 was = at(free, x, y),
                      want = was * std::min(1.0f, 3 * mean / std::max(luminance(was), 1e-30f));
      limited += luminance(was) > 3 * mean;
      wrong += glm::distance(at(got, x, y), want) > 3e-3f * glm::length(want) + 1e-6f;
    }
  EXPECT_GT(limited, 50);
  EXPECT_EQ(wrong, 0);
}

// In a closed room of one radiance the discs' light and this add up: with a reach that ends nowhere, the mean
// over the pixels is that of A / (pi d^2 + A), and a larger disc leaves more to it.
TEST(NearField, GrowsWithTheDisc) {
  Near in;
  in.radiance.assign(in.radiance.size(), glm::vec4(1));
  in.reach = 100;
  double before = 0;
  for (const float area : {0.01f, 1.0f, 100.0f, 1e6f}) {
    in.area = area;
    double mean = 0;
    const auto got = in.run();
    for (size_t i = 0; i < got.size(); i += 4) mean += got[i] / double(got.size() / 4);
    EXPECT_GT(mean, before);
    before = mean;
  }
  EXPECT_NEAR(before, 1, 5e-3);  // all of it, but for rays from within a quarter of a cell of an edge
}

TEST(NearField, NoneWithoutDiscsOrSurfaces) {
  Near in;
  in.area = 0;
  for (const float x : in.run()) EXPECT_EQ(x, 0);
  in.area = 1;
  for (Seen& s : in.room.pixels) s.there = false;
  for (const float x : in.run()) EXPECT_EQ(x, 0);
}

}  // namespace
}  // namespace fovea::test
