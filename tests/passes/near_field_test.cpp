// Compares near-field light, the part that discs leave out, with plain rays in emissive rooms.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>

#include "fovea/error.h"
#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "passes/near-field/near_field_tracer.h"
#include "tests/passes/vpl_intensity_reference.h"

namespace fovea::test {
namespace {

using passes::NearFieldSettings;
using passes::NearFieldStatistics;

// Walls that emit {1, 2, 4} and reflect half of what they get: with light of up to n reflections a wall sends
// (2 - 1 / 2^n) times its own emission.
scene::Scene shiningRoom(bool block) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f)), walls[6] = {m, m, m, m, m, m};
  s.materials[m].emission = {1, 2, 4};
  addRoom(s, walls, 2);
  if (block) addBox(s, m, {-1.1f, -2, -1.6f}, {0.2f, -0.4f, -0.7f});
  return s;
}

struct Look {
  Room room;
  std::unique_ptr<scene::RayScene> rays;
  scene::Frame frame;

  explicit Look(scene::Scene s, glm::ivec2 size = glm::ivec2(32)) : room(lookInto(std::move(s), 8, size)) {
    rays = std::make_unique<scene::RayScene>(room.scene, room.geometry);
    frame = scene::makeFrame(room.scene, room.geometry, glm::uvec2(size), 0, 1);
  }
  std::vector<glm::vec4> trace(const NearFieldSettings& settings) {
    std::vector<glm::vec4> image(size_t((room.size.x + 1) / 2) * size_t((room.size.y + 1) / 2),
                                 glm::vec4(-1));
    statistics = passes::traceNearField(frame, frame.views[0], *rays, settings, image);
    return image;
  }
  // Means of A / (pi d^2 + A) and of d over the cosine-weighted hemisphere of a pixel.
  std::pair<double, double> part(const Seen& seen, double area, int count) const {
    double sum = 0, length = 0;
    for (int i = 0; i < count; ++i) {
      const float u = (float(i) + 0.5f) / float(count), v = uniformFloat(uint32_t(i) * 2654435769u);
      const float r = std::sqrt(u), phi = glm::two_pi<float>() * v;
      const glm::dvec3 d(scene::toWorld(scene::orthonormalFrame(seen.normal),
                                        {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)}));
      const RayHit hit =
          castRay(room.scene, room.geometry, glm::dvec3(seen.position) + 1e-5 * glm::dvec3(seen.normal), d);
      EXPECT_TRUE(hit);
      sum += area / (glm::pi<double>() * hit.t * hit.t + area);
      length += hit.t;
    }
    return {sum / count, length / count};
  }
  NearFieldStatistics statistics;
};

// All of what the walls emit, and of what they reflect the part that discs leave out.
TEST(NearField, ThePartThatDiscsLeaveOut) {
  Look look(shiningRoom(true), glm::ivec2(8));
  NearFieldSettings settings;
  settings.foveaRadius = 2;
  settings.samples = 16384;  // each pixel of a block gets a quarter of them
  const double series[] = {1.5, 1.75, 1.875};
  const struct {
    float area;
    uint32_t bounces;
  } cases[] = {{0.05f, 2}, {0.5f, 1}, {0.5f, 2}, {0.5f, 3}, {5, 2}};
  for (const auto& [area, bounces] : cases) {
    settings.area = area;
    settings.bounces = bounces;
    const auto got = look.trace(settings);
    double all = 0, wantAll = 0;
    // A ray goes on with a probability of at most four times its part.
    const auto bound = [&](double part, int texels) {
      return 0.01 + 4.5 / std::sqrt(4 * part * settings.samples * texels);
    };
    for (uint32_t i = 0; i < 16; ++i) {
      const glm::uvec2 block(i % 4, i / 4);
      const auto seenAt = [&](glm::uvec2 p) {
        return look.room.pixels[(2 * block.y + p.y) * 8 + 2 * block.x + p.x];
      };
      const Seen first = seenAt(passes::samplePixel(0, 2, block));
      double want = 0, least = 1;
      for (uint32_t k = 0; k < 4; ++k) {
        Seen seen = seenAt({k % 2, k / 2});
        const bool same = seen.normal == first.normal &&
                          std::abs(glm::dot(seen.position - first.position, first.normal)) < 1e-3f;
        const double reflected = look.part(same ? seen : first, area, 2000).first;
        want += (1 + (series[bounces - 1] - 1) * reflected) / 4;
        least = std::min(least, reflected);
      }
      EXPECT_EQ(int(got[i].a) & 15, 2);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(got[i][c] / ((1 << c) * want), 1, bound(least, 1))
            << i << ", area " << area << ", bounces " << bounces;
      wantAll += want / 16;
      all += got[i].r / 16;
    }
    EXPECT_NEAR(all / wantAll, 1, bound(area / (area + 12), 16))
        << "area " << area << ", bounces " << bounces;
  }
}

// Irradiance / pi at a plane, from a parallel rectangle of the given half widths at the distance h that emits L = 1, at
// (x, y) from its middle: its configuration factor, a sum over its corners.
double fromRectangle(glm::dvec2 half, double h, double x, double y) {
  const auto corner = [h](double a, double b) {
    a /= h, b /= h;
    const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
    return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * glm::pi<double>());
  };
  return corner(half.x - x, half.y - y) + corner(half.x + x, half.y - y) + corner(half.x - x, half.y + y) +
         corner(half.x + x, half.y + y);
}

// Large, small and thin lamps before a wall, close to it and far from it, alone and among others that are hidden in
// boxes. The wall and the lamps are black, so nothing else adds light, and the eye looks through their backs.
TEST(NearField, AllLightOfALamp) {
  const struct {
    glm::vec2 half;
    float height;
  } lamps[] = {{{0.5f, 0.5f}, 0.3f}, {{0.02f, 0.02f}, 0.5f}, {{0.8f, 0.01f}, 0.1f}, {{1, 1}, 1.5f}};
  for (const auto& [half, height] : lamps)
    for (const bool others : {false, true}) {
      scene::Scene s;
      const uint32_t black = addMaterial(s, glm::vec3(0)), lamp = addMaterial(s, glm::vec3(0));
      s.materials[lamp].emission = {1, 2, 3};
      addQuad(s, black, {-9, -9, -3}, {18, 0, 0}, {0, 18, 0});
      addQuad(s, lamp, {-half.x, -half.y, -3 + height}, {0, 2 * half.y, 0}, {2 * half.x, 0, 0});
      for (int i = 0; others && i < 12; ++i) {
        const glm::vec3 corner(i < 6 ? -4.5f : 3.5f, -6 + 2 * float(i % 6), -1);
        addQuad(s, lamp, corner, {0, 1, 0}, {1, 0, 0});
        addBox(s, black, corner - 0.1f, corner + 1.1f);
      }
      Look look(std::move(s), glm::ivec2(16));
      NearFieldSettings settings;
      settings.foveaRadius = 2;
      settings.area = 0.05f;
      settings.samples = 4096;
      const auto got = look.trace(settings);
      double all = 0, wantAll = 0;
      for (uint32_t i = 0; i < 64; ++i) {
        double want = 0;
        for (uint32_t k = 0; k < 4; ++k) {
          const glm::vec3 d =
              look.frame.views[0].rayDirection(glm::vec2(i % 8 * 2 + k % 2, i / 8 * 2 + k / 2) + 0.5f);
          want += 0.25 * fromRectangle(half, height, -3 * d.x / d.z, -3 * d.y / d.z);
        }
        EXPECT_NEAR(got[i].r, want, 0.1 * want + 5e-4) << i << ", lamp " << half.x << ", " << others;
        EXPECT_NEAR(got[i].b, 3 * got[i].r, 1e-3f * got[i].b);
        all += got[i].r;
        wantAll += want;
      }
      EXPECT_NEAR(all / wantAll, 1, 0.02) << "lamp " << half.x << ", height " << height << ", " << others;
    }
}

// Where several samples are taken at once, the ones on other surfaces do not count: a bright table does not light the
// dark floor beside it.
TEST(NearField, SamplesDoNotMixSurfaces) {
  scene::Scene s;
  const uint32_t black = addMaterial(s, glm::vec3(0)), lamp = addMaterial(s, glm::vec3(0));
  s.materials[lamp].emission = glm::vec3(1);
  addQuad(s, black, {-9, -9, -3}, {18, 0, 0}, {0, 18, 0});       // a wall that gets no light
  addQuad(s, black, {0.07f, -9, -2.5f}, {9, 0, 0}, {0, 18, 0});  // covers its right half, and is lit
  addQuad(s, lamp, {8.5f, -9, -2.4f}, {0, 0, 3}, {0, 18, 0});    // shines to the left
  addBox(s, black, {0.05f, -9, -2.999f}, {0.06f, 9, -1.5f});     // hides the lamp from the left half
  Look look(std::move(s), glm::ivec2(36, 32));
  NearFieldSettings settings;
  settings.foveaRadius = 1e-3f;
  settings.spacing = 8;
  settings.area = 0.05f;
  settings.samples = 32;
  const auto got = look.trace(settings);
  int dark = 0, mixed = 0;
  for (uint32_t row = 0; row < 4; ++row)
    for (uint32_t column = 0; column < 5; ++column) {
      const glm::uvec2 tile(column, row);
      const glm::uvec2 own = passes::samplePixel(0, 8, tile) + 8u * tile;
      if (own.x >= 36) continue;
      bool other = false;
      for (uint32_t k = 0; k < 64; ++k) {
        const glm::uvec2 p = 8u * tile + glm::uvec2(k % 8, k / 8);
        other = other || (p.x < 36 && look.room.pixels[p.y * 36 + p.x].position.z > -2.9f);
      }
      const Seen& seen = look.room.pixels[own.y * 36 + own.x];
      if (!seen.there || seen.position.z > -2.9f) continue;
      EXPECT_EQ(glm::vec3(got[4 * row * 18 + 4 * column]), glm::vec3(0)) << column << " " << row;
      ++dark;
      mixed += other;
    }
  EXPECT_GT(dark, 4);
  EXPECT_GT(mixed, 0);
}

// Close to a lamp its light differs within a wide block, so it is divided; what shows the lamp itself is not.
TEST(NearField, NarrowBlocksCloseToALamp) {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), lamp = addMaterial(s, glm::vec3(0));
  s.materials[lamp].emission = glm::vec3(1);
  addQuad(s, grey, {-9, -9, -3}, {18, 0, 0}, {0, 18, 0});
  addQuad(s, lamp, {-0.4f, -0.4f, -2.99f}, {0.8f, 0, 0}, {0, 0.8f, 0});
  Look look(std::move(s), glm::ivec2(128));
  NearFieldSettings settings;
  settings.foveaRadius = 1e-3f;
  settings.spacing = 8;
  const auto got = look.trace(settings);
  int wide = 0, narrow = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const Seen& seen = look.room.pixels[size_t((8 * y + 4) * 128 + 8 * x + 4)];
      const float away =
          std::max(std::abs(seen.position.x), std::abs(seen.position.y));  // from the middle of the lamp
      const int side = int(got[size_t(4 * y * 64 + 4 * x)].a) & 15;
      if (glm::distance(glm::vec2(x, y), glm::vec2(7.5f)) < 1) continue;  // the fovea
      if (away < 0.39f || away > 1.4f) {
        EXPECT_EQ(side, 8) << x << " " << y;
        ++wide;
      } else if (away > 0.41f && away < 0.6f) {
        EXPECT_EQ(side, 2) << x << " " << y;
        ++narrow;
      }
    }
  EXPECT_GT(wide, 15);
  EXPECT_GT(narrow, 8);
}

// Few rays go far, and yet on average they go as far as if all of them did.
TEST(NearField, MeanLengthWithoutItsRays) {
  Look look(shiningRoom(true));
  NearFieldSettings settings;
  settings.foveaRadius = 2;
  settings.area = 0;
  settings.samples = 16;
  look.trace(settings);
  double want = 0;
  for (const Seen& seen : look.room.pixels)
    want += look.part(seen, 1, 64).second / double(look.room.pixels.size());
  EXPECT_NEAR(look.statistics.length / look.statistics.hits, want, 0.02 * want);
  EXPECT_EQ(look.statistics.shaded, 0u);
  settings.area = 0.2f;
  settings.samples = 256;
  look.trace(settings);
  EXPECT_NEAR(look.statistics.length / look.statistics.hits, want, 0.04 * want);
  EXPECT_LT(look.statistics.shaded, 65536u / 4);
}

// One sample for 2 x 2 pixels in the fovea and for a tile outside it; none where the pixel shows the background.
TEST(NearField, SamplesWhereTheEyeLooks) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f));
  s.materials[m].emission = glm::vec3(1);
  addBox(s, m, {-0.8f, -0.8f, -4}, {0.8f, 0.8f, -3});
  addBox(s, m, {-0.8f, -1.6f, -3.2f}, {0.8f, -0.8f, -2});
  Look look(std::move(s), glm::ivec2(70, 50));  // tiles extend past the image
  NearFieldSettings settings;
  settings.foveaRadius = 0.1f;
  settings.spacing = 8;
  for (settings.turn = 0; settings.turn < 64; settings.turn += 7) {
    settings.foveaFactor = 1 + settings.turn % 3;  // several rays leave the same pixel
    const auto got = look.trace(settings);
    const scene::Fovea fovea = scene::makeFovea(glm::vec2(0.5f), look.room.size, settings.foveaRadius);
    int counts[3] = {};
    for (int y = 0; y < 25; ++y)
      for (int x = 0; x < 35; ++x) {
        const glm::ivec2 tile = glm::ivec2(x, y) / 4 * 8;
        const glm::vec2 nearest = glm::clamp(fovea.centre, glm::vec2(tile), glm::vec2(tile + 8));
        const bool inside = glm::distance(nearest, fovea.centre) <= fovea.radius;
        const int side = inside ? 2 : 8;
        const glm::ivec2 block = glm::ivec2(2 * x, 2 * y) / side;
        const glm::uvec2 own = passes::samplePixel(settings.turn, uint32_t(side), glm::uvec2(block));
        const glm::ivec2 p = block * side + glm::ivec2(own);
        const bool there = p.x < 70 && p.y < 50 && look.room.pixels[size_t(p.y * 70 + p.x)].there;
        const glm::vec4 v = got[size_t(y * 35 + x)];
        ASSERT_EQ(glm::unpackHalf1x16(glm::packHalf1x16(v.a)), v.a);
        const int code = int(v.a);
        ASSERT_EQ(code % 16, side);
        ASSERT_EQ(glm::uvec2(code / 16 % 8, code / 128 % 8), own);
        ASSERT_EQ(code / 1024, there ? 0 : 1) << x << " " << y;
        if (!there) {
          EXPECT_EQ(glm::vec3(v), glm::vec3(0));
        }
        if (!inside) {
          EXPECT_EQ(v, got[size_t(y / 4 * 4 * 35 + x / 4 * 4)]);
        }
        ++counts[!there ? 0 : inside ? 1 : 2];
      }
    for (const int n : counts) EXPECT_GT(n, 10);
  }
}

// Mean and variance of the red channel of samples.
glm::dvec2 meanAndVariance(const std::vector<float>& samples) {
  glm::dvec2 sums(0);
  for (const float v : samples) sums += glm::dvec2(v, double(v) * v) / double(samples.size());
  return {sums.x, sums.y - sums.x * sums.x};
}

// Outside the fovea single rays, many of which bring nothing, become means over what lies on the same wall.
TEST(NearField, BlocksOutsideTheFoveaShareTheirRays) {
  Look look(shiningRoom(false), glm::ivec2(256));  // the far wall fills the picture
  NearFieldSettings settings;
  settings.foveaRadius = 1e-3f;
  settings.spacing = 8;
  settings.area = 0.1f;
  std::vector<float> alone, shared;
  std::vector<glm::uvec2> pixels;
  for (uint32_t y = 4; y < 256; y += 8)
    for (uint32_t x = 4; x < 256; x += 8) pixels.emplace_back(x, y);
  std::vector<glm::vec4> light(pixels.size());
  passes::traceNearFieldPixels(look.frame, look.frame.views[0], *look.rays, settings, pixels, light);
  for (const glm::vec4& v : light) alone.push_back(v.r);
  const auto image = look.trace(settings);
  for (const glm::uvec2 p : pixels) shared.push_back(image[p.y / 2 * 128 + p.x / 2].r);
  const glm::dvec2 one = meanAndVariance(alone), many = meanAndVariance(shared);
  EXPECT_NEAR(many.x, one.x, 4 * std::sqrt(one.y / double(pixels.size())));
  EXPECT_LT(many.y, 0.25 * one.y) << "weights of 1, 3, 1 in either direction leave 0.19 of it";
}

TEST(NearField, EveryPixelOfABlockHasItsTurn) {
  for (const uint32_t side : {2u, 4u, 8u})
    for (const glm::uvec2 block : {glm::uvec2(0, 0), {5, 0}, {2, 3}, {1, 1}}) {
      std::set<uint32_t> seen;
      for (uint32_t turn = 0; turn < side * side; ++turn) {
        const glm::uvec2 p = passes::samplePixel(turn, side, block);
        ASSERT_TRUE(p.x < side && p.y < side);
        seen.insert(p.y * side + p.x);
        EXPECT_EQ(passes::samplePixel(turn + side * side, side, block), p);
      }
      EXPECT_EQ(seen.size(), side * side);
    }
}

// Every column and every row of two neighbouring blocks.
TEST(NearField, NarrowStripsAreMetInEveryFrame) {
  for (uint32_t turn = 0; turn < 4; ++turn)
    for (uint32_t i = 0; i < 4; ++i) {
      const glm::uvec2 block(i & 1, i >> 1), p = passes::samplePixel(turn, 2, block);
      EXPECT_NE(p.x, passes::samplePixel(turn, 2, block + glm::uvec2(0, 1)).x);
      EXPECT_NE(p.y, passes::samplePixel(turn, 2, block + glm::uvec2(1, 0)).y);
    }
}

TEST(NearField, TheSameWhateverTheThreads) {
  Look look(shiningRoom(true));
  NearFieldSettings settings;
  settings.turn = 3;
  settings.threads = 1;
  const auto one = look.trace(settings);
  const NearFieldStatistics statistics = look.statistics;
  settings.threads = 5;
  EXPECT_EQ(look.trace(settings), one);
  EXPECT_EQ(look.statistics.rays, statistics.rays);
  EXPECT_EQ(look.statistics.length, statistics.length);
}

// A new fovea takes more rays for each sample, all of them from the pixel whose turn it is; outside nothing changes.
TEST(NearField, MoreRaysForANewFovea) {
  Look look(shiningRoom(true));
  NearFieldSettings settings;
  settings.spacing = 8;
  settings.turn = 3;
  const auto one = look.trace(settings);
  settings.foveaFactor = 4;
  const auto four = look.trace(settings);
  int inside = 0, differ = 0;
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(four[i].a, one[i].a) << i;
    const bool fine = (int(one[i].a) & 15) == 2;
    inside += fine;
    differ += four[i] != one[i];
    EXPECT_TRUE(fine || four[i] == one[i]) << i;
  }
  EXPECT_GT(inside, 20);
  EXPECT_LT(inside, int(one.size()) - 20);
  EXPECT_GT(differ, inside / 2);
}

// Rays on the host and on the device.
class NearFieldPasses : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Tracers, NearFieldPasses, testing::Values("near-field-host", "near-field-device"),
                         [](const auto& test) { return std::string(test.param).substr(11); });

// When light changes, samples in the fovea are of more rays, and what the cache knows of the old light is forgotten.
TEST_P(NearFieldPasses, MoreRaysForChangedLight) {
  const Look look(shiningRoom(true), glm::ivec2(16));
  struct Counters {
    double shaded, gathered;
  };
  const auto after = [&](float ageing) {
    PassTest test(GetParam());
    test.viewSize(16, 16).scene(look.room.scene).param("saccade_samples", 5).param("vpls", 10);
    test.view("fovea_radius", 2.0).param("first_samples", 1024);  // which fill the cache
    test.buffer("change", std::vector<glm::vec4>{glm::vec4(0)}, "LightChange");
    test.beforeFrame([ageing](PassTest& t, scene::Frame& f) {
      if (f.index == 1)
        t.buffer("change", std::vector<glm::vec4>{{0, ageing, ageing / (1 + ageing), 0}}, "LightChange");
    });
    test.run(2);
    return Counters{test.counter("shaded"), test.counter("gathered")};
  };
  const Counters same = after(0), half = after(1), all = after(1e6f);
  EXPECT_NEAR(half.shaded, 3 * same.shaded, 0.5 * same.shaded);
  EXPECT_NEAR(all.shaded, 5 * same.shaded, 0.5 * same.shaded);
  EXPECT_LT(same.gathered, 0.8 * same.shaded);
  EXPECT_EQ(all.gathered, all.shaded);
}

TEST_P(NearFieldPasses, DiscsAreAsLargeAsDistancesSay) {
  const Look look(shiningRoom(false), glm::ivec2(16));
  double length = 0;
  for (const Seen& seen : look.room.pixels) length += look.part(seen, 1, 64).second / 256;
  for (const int vpls : {100, 1000}) {
    PassTest test(GetParam());
    test.viewSize(16, 16).scene(look.room.scene).param("vpls", vpls).view("fovea_radius", 2.0);
    test.run(3);
    const double want = 50 * length * length / vpls;
    EXPECT_NEAR(test.values<glm::vec4>("spread")[0].x, want, 0.1 * want);
  }
}

TEST_P(NearFieldPasses, SpacingIsAPowerOfTwo) {
  PassTest test(GetParam());
  test.viewSize(16, 16).scene(shiningRoom(false)).param("spacing", 6);
  try {
    test.run();
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("spacing 6"), std::string::npos) << e.what();
  }
}

// The G-buffer has to be that of the view, and to know full materials.
TEST_P(NearFieldPasses, RefusesAnotherGBuffer) {
  const struct {
    uint32_t normal, specular;
    const char* says;
  } cases[] = {{8, 8, "`gbuffer.normal` has 8x8 pixels, its view has 16x16"},
               {16, 1, "those of the G-buffer are not"}};
  for (const auto& [normal, specular, says] : cases) {
    PassTest test(GetParam());
    test.viewSize(16, 16).scene(shiningRoom(false)).view("materials", "full");
    test.image("gbuffer.normal", VK_FORMAT_R16G16B16A16_SFLOAT, normal, normal, 1,
               std::vector<uint64_t>(normal * normal));
    test.image("gbuffer.specular", VK_FORMAT_R16G16B16A16_SFLOAT, specular, specular, 1,
               std::vector<uint64_t>(specular * specular));
    try {
      test.run();
      FAIL() << "no error";
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::BadInput);
      EXPECT_NE(std::string(e.what()).find(says), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace fovea::test
