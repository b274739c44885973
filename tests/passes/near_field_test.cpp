// Compares near-field light, the part that discs leave out, with plain rays in emissive rooms.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>
#include <tuple>
#include <utility>

#include "fovea/error.h"
#include "framework/base/random.h"
#include "tests/passes/near_field_run.h"
#include "tests/passes/vpl_intensity_reference.h"
#include "tests/passes/where_rays_run.h"
#include "tests/references/blocks.h"

namespace fovea::test {
namespace {

class NearField : public WhereRaysRun {};
INSTANTIATE_TEST_SUITE_P(Rays, NearField, testing::Bool(), nameOfPlace);

// Walls that emit {1, 2, 4} and reflect half of what they get: with light of up to n reflections a wall sends
// (2 - 1 / 2^n) times its own emission.
scene::Scene emissiveRoom(bool block) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f)), walls[6] = {m, m, m, m, m, m};
  s.materials[m].emission = {1, 2, 4};
  addRoom(s, walls, 2);
  if (block) addBox(s, m, {-1.1f, -2, -1.6f}, {0.2f, -0.4f, -0.7f});
  s.cameras.emplace_back().verticalFov = 0.8f;
  return s;
}

// Means of A / (pi d^2 + A) and of d over the cosine-weighted hemisphere of a pixel.
std::pair<double, double> partOf(const Room& room, const Seen& seen, double area, int count) {
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

// Mean distance between visible surfaces and what is seen from them, m.
double meanLength(const Room& room) {
  double sum = 0;
  for (const Seen& seen : room.pixels) sum += partOf(room, seen, 1, 64).second / double(room.pixels.size());
  return sum;
}

Room look(scene::Scene s, glm::ivec2 size) { return lookInto(std::move(s), 8, size); }

// All of what the walls emit, and of what they reflect the part that discs leave out.
TEST(LongNearFieldLight, ThePartThatDiscsLeaveOut) {
  const Room room = look(emissiveRoom(true), glm::ivec2(8));
  constexpr uint32_t kFrames = 128, kSamples = kFrames * NearFieldMeans::kRays;
  const double series[] = {1.5, 1.75, 1.875};
  const struct {
    double share;  // area of a disc, in squares of the mean length
    int bounces;
  } cases[] = {{0.1, 1}, {0.1, 2}, {0.1, 3}, {1, 2}, {10, 2}};
  for (const auto& [share, bounces] : cases) {
    NearFieldTest test(room.scene, glm::uvec2(8));
    test.param("vpls", 1).param("share", share).param("bounces", bounces);
    const NearFieldMeans means(test, kFrames);
    const std::vector<glm::vec4>& got = means.samples;
    const double area = means.area;
    double all = 0, wantAll = 0;
    // A ray goes on with a probability of at most four times its part.
    const auto bound = [&](double part, int texels) {
      return 0.01 + 4.5 / std::sqrt(4 * part * kSamples * texels);
    };
    for (uint32_t i = 0; i < 16; ++i) {
      const glm::uvec2 block(i % 4, i / 4);
      const auto seenAt = [&](glm::uvec2 p) {
        return room.pixels[(2 * block.y + p.y) * 8 + 2 * block.x + p.x];
      };
      const Seen first = seenAt(passes::samplePixel(0, 2, block));
      double want = 0, least = 1;
      for (uint32_t k = 0; k < 4; ++k) {
        Seen seen = seenAt({k % 2, k / 2});
        const bool same = seen.normal == first.normal &&
                          std::abs(glm::dot(seen.position - first.position, first.normal)) < 1e-3f;
        const double reflected = partOf(room, same ? seen : first, area, 2000).first;
        want += (1 + (series[bounces - 1] - 1) * reflected) / 4;
        least = std::min(least, reflected);
      }
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(got[i][c] / ((1 << c) * want), 1, bound(least, 1))
            << i << ", share " << share << ", bounces " << bounces;
      wantAll += want / 16;
      all += got[i].r / 16;
    }
    EXPECT_NEAR(all / wantAll, 1, bound(area / (area + 12), 16))
        << "share " << share << ", bounces " << bounces;
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
TEST(LongNearFieldLight, AllLightOfALamp) {
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
      s.cameras.emplace_back().verticalFov = 0.8f;
      const scene::View view = scene::makeView(s.cameras[0], glm::uvec2(16), scene::flatten(s));
      NearFieldTest test(s, glm::uvec2(16));
      test.param("emitter_points", 16);
      const std::vector<glm::vec4> got = NearFieldMeans(test, 256).samples;
      double all = 0, wantAll = 0;
      for (uint32_t i = 0; i < 64; ++i) {
        double want = 0;
        for (uint32_t k = 0; k < 4; ++k) {
          const glm::vec3 d = view.rayDirection(glm::vec2(i % 8 * 2 + k % 2, i / 8 * 2 + k / 2) + 0.5f);
          want += 0.25 * fromRectangle(half, height, -3 * d.x / d.z, -3 * d.y / d.z);
        }
        EXPECT_NEAR(got[i].r, want, 0.1 * want + 5e-4) << i << ", lamp " << half.x << ", " << others;
        EXPECT_NEAR(got[i].b, 3 * got[i].r, 1e-3f * got[i].b + 3e-7f);  // the least halves are coarser
        all += got[i].r;
        wantAll += want;
      }
      EXPECT_NEAR(all / wantAll, 1, 0.02) << "lamp " << half.x << ", height " << height << ", " << others;
    }
}

// Where several samples are taken at once, the ones on other surfaces do not count: a bright table does not light the
// dark floor beside it.
TEST_P(NearField, SamplesDoNotMixSurfaces) {
  scene::Scene s;
  const uint32_t black = addMaterial(s, glm::vec3(0)), lamp = addMaterial(s, glm::vec3(0));
  s.materials[lamp].emission = glm::vec3(1);
  addQuad(s, black, {-9, -9, -3}, {18, 0, 0}, {0, 18, 0});       // a wall that gets no light
  addQuad(s, black, {0.07f, -9, -2.5f}, {9, 0, 0}, {0, 18, 0});  // covers its right half, and is lit
  addQuad(s, lamp, {8.5f, -9, -2.4f}, {0, 0, 3}, {0, 18, 0});    // shines to the left
  addBox(s, black, {0.05f, -9, -2.999f}, {0.06f, 9, -1.5f});     // hides the lamp from the left half
  const Room room = look(std::move(s), glm::ivec2(36, 32));
  NearFieldTest test(room.scene, glm::uvec2(36, 32), GetParam());
  test.view("fovea_radius", 0.001).param("spacing", 8).param("first_samples", 32);
  const std::vector<glm::vec4> got = test.samples();
  int dark = 0, mixed = 0;
  for (uint32_t row = 0; row < 4; ++row)
    for (uint32_t column = 0; column < 5; ++column) {
      const glm::uvec2 tile(column, row);
      const glm::uvec2 own = passes::samplePixel(0, 8, tile) + 8u * tile;
      if (own.x >= 36) continue;
      bool other = false;
      for (uint32_t k = 0; k < 64; ++k) {
        const glm::uvec2 p = 8u * tile + glm::uvec2(k % 8, k / 8);
        other = other || (p.x < 36 && room.pixels[p.y * 36 + p.x].position.z > -2.9f);
      }
      const Seen& seen = room.pixels[own.y * 36 + own.x];
      if (!seen.there || seen.position.z > -2.9f) continue;
      EXPECT_EQ(glm::vec3(got[4 * row * 18 + 4 * column]), glm::vec3(0)) << column << " " << row;
      ++dark;
      mixed += other;
    }
  EXPECT_GT(dark, 4);
  EXPECT_GT(mixed, 0);
}

// Close to a lamp its light differs within a wide block, so it is divided; what shows the lamp itself is not.
TEST_P(NearField, NarrowBlocksCloseToALamp) {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), lamp = addMaterial(s, glm::vec3(0));
  s.materials[lamp].emission = glm::vec3(1);
  addQuad(s, grey, {-9, -9, -3}, {18, 0, 0}, {0, 18, 0});
  addQuad(s, lamp, {-0.4f, -0.4f, -2.99f}, {0.8f, 0, 0}, {0, 0.8f, 0});
  const Room room = look(std::move(s), glm::ivec2(128));
  NearFieldTest test(room.scene, glm::uvec2(128), GetParam());
  test.view("fovea_radius", 0.001).param("spacing", 8).param("first_samples", 1);
  const std::vector<glm::vec4> got = test.samples();
  int wide = 0, narrow = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const Seen& seen = room.pixels[size_t((8 * y + 4) * 128 + 8 * x + 4)];
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
TEST(NearFieldLight, DiscsAreAsLargeAsDistancesSay) {
  const Room room = look(emissiveRoom(true), glm::ivec2(64));
  const double length = meanLength(room);
  for (const int vpls : {100, 1000}) {
    NearFieldTest test(room.scene, glm::uvec2(64));
    test.param("vpls", vpls).param("first_samples", 1);
    test.run(12);
    const double want = 50 * length * length / vpls;
    EXPECT_NEAR(test.area(), want, 0.08 * want);
    EXPECT_LT(test.counter("shaded"), vpls == 100 ? 1024 : 1024 / 4);
  }
}

// One sample for 2 x 2 pixels in the fovea and for a tile outside it; none where the pixel shows the background.
// Of two views with the same VPLs, one says how large their discs are.
TEST_P(NearField, TakesTheAreaOfAnotherView) {
  const scene::Scene s = emissiveRoom(true);
  NearFieldTest first(s, glm::uvec2(8), GetParam()), second(s, glm::uvec2(8), GetParam()),
      other(s, glm::uvec2(8), GetParam());
  for (NearFieldTest* test : {&first, &second, &other})
    test->param("vpls", 1).param("share", test == &first ? 0.1 : 10.0);
  const std::vector<glm::vec4> samples = first.samples();
  second.buffer("least_area", std::vector<glm::vec4>{{first.area(), 0, 0, 0}}, "VplSpread");
  EXPECT_EQ(second.samples(), samples);
  EXPECT_EQ(second.area(), first.area());
  EXPECT_NE(other.samples(), samples);
}

TEST_P(NearField, SamplesWhereTheEyeLooks) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f));
  s.materials[m].emission = glm::vec3(1);
  addBox(s, m, {-0.8f, -0.8f, -4}, {0.8f, 0.8f, -3});
  addBox(s, m, {-0.8f, -1.6f, -3.2f}, {0.8f, -0.8f, -2});
  const Room room = look(std::move(s), glm::ivec2(70, 50));  // tiles extend past the image
  NearFieldTest test(room.scene, glm::uvec2(70, 50), GetParam());
  test.view("fovea_radius", 0.1).param("spacing", 8).param("first_samples", 1).param("saccade_samples", 3);
  test.beforeFrame([](PassTest&, scene::Frame& frame) {  // in some, several rays leave the same pixel
    frame.saccade = frame.index % 4 < 2 ? 1.0f : 0.0f;
  });
  const scene::Fovea fovea = scene::makeFovea(glm::vec2(0.5f), room.size, 0.1f);
  for (uint32_t turn = 0; turn < 64; turn += 7) {
    const std::vector<glm::vec4> got = test.samples(turn == 0 ? 1 : 7);
    int counts[3] = {};
    for (int y = 0; y < 25; ++y)
      for (int x = 0; x < 35; ++x) {
        const glm::ivec2 pixel(2 * x, 2 * y), tile = passes::blockCorner(pixel, 8, turn);
        const glm::vec2 nearest = glm::clamp(fovea.centre, glm::vec2(tile), glm::vec2(tile + 8));
        const bool inside = glm::distance(nearest, fovea.centre) <= fovea.radius;
        const int side = inside ? 2 : 8;
        const glm::ivec2 corner = inside ? pixel : tile,
                         block = (corner + glm::ivec2(passes::latticeOffset(turn, uint32_t(side)))) / side;
        const glm::uvec2 own = passes::samplePixel(turn, uint32_t(side), glm::uvec2(block));
        const glm::ivec2 p = glm::clamp(corner + glm::ivec2(own), glm::ivec2(0), glm::ivec2(69, 49));
        const auto isThere = [&](glm::ivec2 at) {
          const glm::ivec2 inView = glm::clamp(at, glm::ivec2(0), glm::ivec2(69, 49));
          return room.pixels[size_t(inView.y * 70 + inView.x)].there;
        };
        const bool there = isThere(p);
        const glm::vec4 v = got[size_t(y * 35 + x)];
        ASSERT_EQ(glm::unpackHalf1x16(glm::packHalf1x16(v.a)), v.a);
        const int code = int(v.a);
        ASSERT_EQ(code % 16, side);
        ASSERT_EQ(glm::uvec2(code / 16 % 8, code / 128 % 8), own);
        // At a silhouette, rounding decides whether the pixel shows a surface.
        if (isThere(p - glm::ivec2(1, 0)) != isThere(p + glm::ivec2(1, 0))) continue;
        ASSERT_EQ(code / 1024, there ? 0 : 1) << x << " " << y;
        if (!there) {
          EXPECT_EQ(glm::vec3(v), glm::vec3(0));
        }
        if (!inside) {
          const glm::ivec2 first = glm::max(tile, glm::ivec2(0)) / 2;
          EXPECT_EQ(v, got[size_t(first.y * 35 + first.x)]);
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
TEST(NearFieldLight, BlocksOutsideTheFoveaShareTheirRays) {
  const auto firstSamples = [](double foveaRadius) {
    NearFieldTest test(emissiveRoom(false), glm::uvec2(256));  // the far wall fills the picture
    test.view("fovea_radius", foveaRadius).param("spacing", 8).param("first_samples", 1).param("share", 25.0);
    std::vector<float> red;
    const std::vector<glm::vec4> image = test.samples();
    for (size_t y = 0; y < 128; y += 4)
      for (size_t x = 0; x < 128; x += 4) red.push_back(image[y * 128 + x].r);
    return meanAndVariance(red);
  };
  const glm::dvec2 one = firstSamples(2), many = firstSamples(0.001);
  EXPECT_NEAR(many.x, one.x, 4 * std::sqrt(one.y / 1024));
  EXPECT_LT(many.y, 0.3 * one.y) << "weights of 1, 3, 1 in either direction leave 0.19 of it";
}

// The pixels of which a frame has samples: of the picture's blocks of 2 x 2 pixels around the gaze, and of wide ones.
std::vector<glm::uvec3> sampled(NearFieldTest& test) {  // x, y and width of the block
  std::vector<glm::uvec3> pixels;
  for (const glm::vec4& texel : test.samples()) {
    const uint32_t code = uint32_t(texel.a);
    pixels.emplace_back(code / 16 % 8, code / 128 % 8, code % 16);
  }
  return pixels;
}

// A small picture in which one tile alone is in the fovea.
void lookAtOneTile(NearFieldTest& test, int spacing) {
  test.view("fovea_radius", 0.001).param("spacing", spacing).param("first_samples", 1);
  test.beforeFrame([](PassTest&, scene::Frame& frame) { frame.views[0].gaze = {0.1f, 0.1f}; });
}

// In four frames, each pixel of a block of 2 x 2 pixels is sampled. Wide blocks lie elsewhere in each frame, and their
// pixels are sampled in no regular order.
TEST_P(NearField, EveryPixelHasItsTurn) {
  for (const uint32_t spacing : {4u, 8u}) {
    const int texels = int(2 * spacing), size = 2 * texels;
    const glm::ivec2 gaze(glm::vec2(0.1f * float(size)));
    NearFieldTest test(emissiveRoom(false), glm::uvec2(size), GetParam());
    lookAtOneTile(test, int(spacing));
    std::set<std::pair<int, int>> seen, gazedAt;
    for (uint32_t turn = 0; turn < 8 * spacing * spacing; ++turn) {
      const auto pixels = sampled(test);
      ASSERT_EQ(pixels.size(), size_t(texels * texels));
      for (int i = 0; i < texels * texels; ++i) {
        const glm::ivec2 pixel(2 * (i % texels), 2 * (i / texels)),
            tile = passes::blockCorner(pixel, spacing, turn);
        const glm::uvec3 p = pixels[size_t(i)];
        ASSERT_EQ(p.z, tile == passes::blockCorner(gaze, spacing, turn) ? 2 : spacing);
        ASSERT_TRUE(p.x < p.z && p.y < p.z);
        const glm::ivec2 at = glm::ivec2(p) + (p.z == 2 ? pixel : tile);
        seen.emplace(at.x, at.y);
        if (turn < 4 && pixel == gaze / 2 * 2) gazedAt.emplace(at.x, at.y);
      }
    }
    EXPECT_EQ(gazedAt.size(), 4u);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) EXPECT_TRUE(seen.contains({x, y})) << x << " " << y;
  }
}

// Over 64 frames, blocks of 8 x 8 pixels begin in each of the 16 possible places. SamplesWhereTheEyeLooks shows that the
// pass does as this reference does.
TEST(NearFieldLight, BlocksLieEverywhereInTheirTurn) {
  std::map<std::pair<uint32_t, uint32_t>, int> counts;
  for (uint32_t frame = 0; frame < 64; ++frame) {
    const glm::uvec2 offset = passes::latticeOffset(frame, 8);
    ++counts[{offset.x, offset.y}];
  }
  EXPECT_EQ(counts.size(), 16u);
  for (const auto& [offset, count] : counts) EXPECT_NEAR(count, 4, 2) << offset.first << " " << offset.second;
}

// Every column and every row of two neighbouring blocks.
TEST_P(NearField, NarrowStripsAreMetInEveryFrame) {
  NearFieldTest test(emissiveRoom(false), glm::uvec2(8), GetParam());
  test.param("first_samples", 1);
  for (uint32_t turn = 0; turn < 4; ++turn) {
    const auto pixels = sampled(test);
    for (size_t i = 0; i < 16; ++i) {
      if (i % 4 < 3) {
        EXPECT_NE(pixels[i].y, pixels[i + 1].y);
      }
      if (i < 12) {
        EXPECT_NE(pixels[i].x, pixels[i + 4].x);
      }
    }
  }
}

TEST_P(NearField, TheSameEveryTime) {
  const auto once = [] {
    NearFieldTest test(emissiveRoom(true), glm::uvec2(32), GetParam());
    test.view("fovea_radius", 0.25).run(4);
    return std::tuple(test.bytes("samples"), test.area(), test.counter("rays"));
  };
  EXPECT_EQ(once(), once());
}

// A new fovea takes more rays for each sample, all of them from the pixel whose turn it is; outside nothing changes.
TEST_P(NearField, MoreRaysForANewFovea) {
  const auto second = [](float saccade) {
    NearFieldTest test(emissiveRoom(true), glm::uvec2(32), GetParam());
    test.view("fovea_radius", 0.25).param("spacing", 8).param("saccade_samples", 4);
    test.beforeFrame([&](PassTest&, scene::Frame& f) { f.saccade = f.index == 1 ? saccade : 0.0f; });
    return test.samples(2);
  };
  const auto one = second(0), four = second(1);
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

// When light changes, samples in the fovea are of more rays, and what the cache knows of the old light is forgotten.
TEST(NearFieldLight, MoreRaysForChangedLight) {
  struct Counters {
    double shaded, gathered;
  };
  const auto after = [&](float ageing, int usual = 1) {
    NearFieldTest test(emissiveRoom(true), glm::uvec2(16));
    test.param("fovea_samples", usual);
    test.param("saccade_samples", 5).param("vpls", 10).param("first_samples", 1024);  // which fill the cache
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
  EXPECT_NEAR(after(0, 3).shaded, 3 * same.shaded, 0.5 * same.shaded);
  EXPECT_NEAR(after(1, 3).shaded, 4 * same.shaded, 0.5 * same.shaded);
  EXPECT_NEAR(after(1e6f, 8).shaded, 8 * same.shaded, 0.5 * same.shaded) << "no fewer than usual";
}

TEST_P(NearField, SpacingIsAPowerOfTwo) {
  NearFieldTest test(emissiveRoom(false), glm::uvec2(16), GetParam());
  test.param("spacing", 6);
  try {
    test.run();
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("one of 2, 4, 8, found 6"), std::string::npos) << e.what();
  }
}

// The G-buffer has to be that of the view, and to know full materials.
TEST_P(NearField, RefusesAnotherGBuffer) {
  const struct {
    uint32_t normal, specular;
    const char* says;
  } cases[] = {
      {8, 8, "`gbuffer.normal` is not of the size of its view (gbuffer.normal.width is 8, view.width is 16"},
      {16, 1, "those of the G-buffer are not"}};
  for (const auto& [normal, specular, says] : cases) {
    NearFieldTest test(emissiveRoom(false), glm::uvec2(16), GetParam());
    test.view("materials", "full");
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
