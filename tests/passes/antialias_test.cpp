// Compares antialiasing with plain loops in double precision: what is taken from the history, from where, and how far
// it may be from the colours of the pixels around.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "framework/base/random.h"
#include "tests/passes/eye_scene.h"

namespace fovea::test {
namespace {

constexpr uint32_t kNone = 0xffffffffu;
constexpr double kExposure = 2;
constexpr int kPixels = kSize.x * kSize.y;
const glm::vec3 kMoved(0.11f, -0.07f, 0);  // by how much the box has moved since the frame before, m

std::vector<uint16_t> halves(const std::vector<glm::vec4>& image) {
  std::vector<uint16_t> half;
  for (const glm::vec4& v : image)
    for (int c = 0; c < 4; ++c) half.push_back(glm::packHalf1x16(v[c]));
  return half;
}

struct Input {
  Eye now, before;
  std::vector<glm::vec4> light, history;
  std::vector<uint32_t> id, previousId, origin;
  std::vector<bool> veiled = std::vector<bool>(kPixels);  // whether the pixel shows a transparent surface
  double frames = 8, deviations = 1.25;

  // Random light and history. The view of `now` is jittered, by what the matrices of both eyes contain.
  Input(glm::vec3 eyeNow, glm::vec3 eyeBefore) : now(eyeNow), before(eyeBefore) {
    const glm::vec2 jitterNow(0.3f, -0.2f), jitterBefore(-0.4f, 0.1f);
    scene::jitter(before.view, jitterBefore, {});
    scene::jitter(now.view, jitterNow, jitterBefore);
    now.view.previousWorldToClip = before.view.worldToClip;
    now.seen = now.look(), before.seen = before.look();
    for (int i = 0; i < kPixels; ++i) {
      const auto random = [&](uint32_t stream) {
        return uniformFloat(randomStream(5, 0, stream, uint32_t(i)));
      };
      const auto colour = [&](uint32_t stream) {
        return halfRound(random(stream) *
                         glm::vec3(random(stream + 1), random(stream + 2), random(stream + 3)));
      };
      light.emplace_back(4.0f * colour(0), 1);
      history.emplace_back(4.0f * colour(10), 5);
      const bool box = now.seen.pixels[size_t(i)].distance < 4.5f;
      id.push_back(box ? 1u << 16 : 0);
      previousId.push_back(id.back());
      origin.push_back(random(20) < 0.2f ? uint32_t(i) : kNone);
    }
  }
  size_t index(glm::ivec2 p) const {
    const glm::ivec2 q = glm::clamp(p, glm::ivec2(0), kSize - 1);
    return size_t(q.y * kSize.x + q.x);
  }
};

void run(PassTest& test, const Input& in) {
  const auto w = uint32_t(kSize.x), h = uint32_t(kSize.y);
  const auto distances = [](const GBuffer& seen) {
    std::vector<float> list;
    for (const SurfacePixel& p : seen.pixels) list.push_back(p.distance);
    return list;
  };
  test.viewSize(w, h).param("frames", in.frames).param("deviations", in.deviations);
  wireSurfaces(test, "gbuffer", in.now.seen.camera, kSize.x, kSize.y, distances(in.now.seen));
  std::vector<glm::vec4> normal;
  for (const bool veiled : in.veiled) normal.emplace_back(0, 0, 1, veiled ? -0.5f : 0.5f);
  test.image("gbuffer.normal", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, halves(normal));
  test.image("gbuffer.id", VK_FORMAT_R32_UINT, w, h, 1, in.id);
  test.image("gbuffer.triangle", VK_FORMAT_R32_UINT, w, h, 1, std::vector<uint32_t>(size_t(w) * h));
  wireSurfaces(test, "previous", in.before.seen.camera, kSize.x, kSize.y, distances(in.before.seen));
  test.image("previous.id", VK_FORMAT_R32_UINT, w, h, 1, in.previousId);
  test.image("origin", VK_FORMAT_R32_UINT, w, h, 1, in.origin);
  test.image("radiance", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, halves(in.light));
  test.image("history", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, halves(in.history));
  scene::Scene scene = in.now.scene;
  scene.exposure = float(kExposure);
  test.scene(scene).beforeFrame([&in](PassTest&, scene::Frame& frame) {
    frame.views[0] = in.now.view;
    frame.objects.at(1).previousToWorld = glm::translate(glm::mat4(1), -kMoved);
  });
  test.run();
}

// ---- The reference ----------------------------------------------------------------------------------------

double luminance(const glm::dvec3& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }
// linear: at transparent surfaces
glm::dvec3 compress(const glm::dvec3& light, bool linear = false) {
  return kExposure * light / (linear ? 1 : 1 + kExposure * luminance(light));
}
glm::dvec3 expand(const glm::dvec3& c, bool linear = false) {
  return c / (kExposure * (linear ? 1 : 1 - luminance(c)));
}
glm::dvec3 toYCoCg(const glm::dvec3& c) {
  return {c.r / 4 + c.g / 2 + c.b / 4, (c.r - c.b) / 2, -c.r / 4 + c.g / 2 - c.b / 4};
}
glm::dvec3 fromYCoCg(const glm::dvec3& c) { return {c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z}; }

// The pixels around one that it is compared with.
std::vector<glm::ivec2> around(const Input& in, glm::ivec2 p) {
  const int reach = in.veiled[in.index(p)] ? 2 : 1;
  std::vector<glm::ivec2> list;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) list.push_back(p + glm::ivec2(x, y));
  return list;
}

// Where the picture of a pixel was, in pixels with centres at whole numbers, and whether any of it was seen before.
struct Place {
  glm::dvec2 at;
  bool seen = false;
};
Place placeBefore(const Input& in, glm::ivec2 p) {
  Place place;
  const SurfacePixel* nearest = nullptr;
  size_t of = 0;
  for (const glm::ivec2 at : around(in, p)) {
    const size_t q = in.index(at);
    const SurfacePixel& s = in.now.seen.pixels[q];
    place.seen |= s.distance == 0 || in.origin[q] != kNone;
    const bool follows = !in.veiled[in.index(p)] || at == p;
    if (follows && s.distance > 0 && (!nearest || s.distance < nearest->distance)) nearest = &s, of = q;
  }
  glm::dvec4 point(glm::dvec3(in.now.view.rayDirection(glm::vec2(p) + 0.5f)), 0);
  if (nearest) point = glm::dvec4(glm::dvec3(nearest->position - (in.id[of] ? kMoved : glm::vec3(0))), 1);
  const glm::dvec4 clip = glm::dmat4(in.before.view.worldToClip) * point;
  place.at = (0.5 * glm::dvec2(clip) / clip.w + 0.5) * glm::dvec2(kSize) - 0.5;
  place.at += glm::dvec2(in.before.view.jitter - in.now.view.jitter);
  if (nearest) place.at += glm::dvec2(p - glm::ivec2(int(of) % kSize.x, int(of) / kSize.x));
  return place;
}

// Whether the history of a place shows something that is no longer near the pixel.
bool hasLeft(const Input& in, glm::ivec2 p, glm::ivec2 from) {
  for (int i = 0; i < 9; ++i) {
    const size_t q = in.index(from + glm::ivec2(i % 3, i / 3) - 1);
    const SurfacePixel& s = in.before.seen.pixels[q];
    bool here = s.distance == 0;
    for (const glm::ivec2 at : around(in, p)) here |= in.id[in.index(at)] == in.previousId[q];
    if (here) continue;
    const glm::dvec4 clip = glm::dmat4(in.now.view.worldToClip) * glm::dvec4(s.position, 1);
    glm::dvec2 at = (0.5 * glm::dvec2(clip) / clip.w + 0.5) * glm::dvec2(kSize) - 0.5;
    at += glm::dvec2(in.now.view.jitter - in.before.view.jitter);
    const bool moves = in.previousId[q] >> 16 != 0,
               near = glm::all(glm::lessThan(glm::abs(at - glm::dvec2(p)), glm::dvec2(3.5)));
    if (moves || !near) return true;
  }
  return false;
}

double catmullRom(int i, double t) {
  const double weights[] = {-0.5 * t + t * t - 0.5 * t * t * t, 1 - 2.5 * t * t + 1.5 * t * t * t,
                            0.5 * t + 2 * t * t - 1.5 * t * t * t, -0.5 * t * t + 0.5 * t * t * t};
  return weights[i];
}

// What a pixel begins with.
glm::dvec4 first(const Input& in, glm::ivec2 p) {
  if (!in.veiled[in.index(p)])
    return {in.light[in.index(p)].r, in.light[in.index(p)].g, in.light[in.index(p)].b, 1};
  glm::dvec4 sum(0);
  for (const glm::ivec2 at : around(in, p))
    if (in.veiled[in.index(at)]) sum += glm::dvec4(glm::dvec3(in.light[in.index(at)]), 1);
  return {glm::dvec3(sum) / sum.a, 8};
}

glm::dvec4 expected(const Input& in, glm::ivec2 p) {
  const glm::dvec3 light(in.light[in.index(p)]);
  const Place place = placeBefore(in, p);
  const bool inside =
      place.at.x >= -0.5 && place.at.y >= -0.5 && place.at.x < kSize.x - 0.5 && place.at.y < kSize.y - 0.5;
  const bool veiled = in.veiled[in.index(p)];
  const double count = std::min(double(in.history[in.index(glm::ivec2(glm::round(place.at)))].a),
                                (veiled ? 2 : 1) * in.frames - 1);
  const bool left = hasLeft(in, p, glm::ivec2(glm::round(place.at)));
  if (!inside || !place.seen || left || count == 0) return first(in, p);
  const glm::dvec2 corner = glm::floor(place.at), t = place.at - corner;
  glm::dvec3 old(0), mean(0), squares(0);
  for (int i = 0; i < 16; ++i) {
    const glm::ivec2 q = glm::ivec2(corner) + glm::ivec2(i % 4, i / 4) - 1;
    old += catmullRom(i % 4, t.x) * catmullRom(i / 4, t.y) * compress(in.history[in.index(q)], veiled);
  }
  const auto near = around(in, p);
  for (const glm::ivec2 at : near) {
    const glm::dvec3 c = toYCoCg(compress(in.light[in.index(at)], veiled));
    mean += c / double(near.size()), squares += c * c / double(near.size());
  }
  const glm::dvec3 extent = in.deviations * glm::sqrt(glm::max(squares - mean * mean, 0.0));
  const glm::dvec3 away = toYCoCg(old) - mean;
  double beyond = 1;
  for (int c = 0; c < 3; ++c) beyond = std::max(beyond, std::abs(away[c]) / std::max(extent[c], 1e-5));
  const glm::dvec3 kept = fromYCoCg(mean + away / beyond);
  const glm::dvec3 result = kept + (compress(light, veiled) - kept) / (count + 1);
  return {glm::max(expand(result, veiled), 0.0), count + 1};
}

void expectReference(const Input& in, PassTest& test, bool onlyVeils = false) {
  const std::vector<float> got = test.floats("smoothed");
  for (int i = 0; i < kPixels; ++i) {
    const glm::ivec2 p(i % kSize.x, i / kSize.x);
    const glm::dvec4 want = onlyVeils && !in.veiled[size_t(i)] ? first(in, p) : expected(in, p);
    EXPECT_EQ(got[4 * size_t(i) + 3], float(want.a)) << i % kSize.x << " " << i / kSize.x;
    for (int c = 0; c < 3; ++c)  // a half has 11 bits; places in the picture are known to some 1e-4 pixels
      EXPECT_NEAR(got[4 * size_t(i) + size_t(c)], want[c], 2e-3 * want[c] + 2e-3)
          << i % kSize.x << " " << i / kSize.x << " " << c;
  }
}

// ---- Tests ------------------------------------------------------------------------------------------------

// The eye and the box move; some pixels show only background. Each branch is met by many pixels.
TEST(Antialias, EqualsTheReference) {
  for (const double deviations : {1.25, 1000.0}) {
    Input in({0.13f, 0.05f, 0}, {0, 0, 0});
    in.deviations = deviations;
    for (int i = 0; i < kPixels; ++i)
      if (i % kSize.x < 7 && i / kSize.x > 4) in.now.seen.pixels[size_t(i)].distance = 0;
    // Something else was seen before: far away from where it is now, by another material, or on an object that moves.
    for (int i = 0; i < kPixels; ++i) {
      const int x = i % kSize.x, y = i / kSize.x;
      if (x > 34 && x < 38 && y > 5) in.previousId[size_t(i)] = 7;
      if (x > 42 && y > 5 && y < 15) {
        SurfacePixel& before = in.before.seen.pixels[size_t(i)];
        before.distance *= 0.2f;  // so near that it is seen elsewhere by the other eye
        before.position = pointOn(in.before.seen.camera, x, y, before.distance);
        in.previousId[size_t(i)] = 7;
      }
      if (x > 42 && y > 20 && y < 30) in.previousId[size_t(i)] = 1u << 16 | 9;
    }
    int fresh = 0, seen = 0, edge = 0, left = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        const Place place = placeBefore(in, {x, y});
        fresh += !place.seen, seen += place.seen;
        left += hasLeft(in, {x, y}, glm::ivec2(glm::round(place.at)));
        edge += place.at.x < -0.5 || place.at.y >= kSize.y - 0.5 || place.at.x >= kSize.x - 0.5;
      }
    EXPECT_GT(fresh, 100);
    EXPECT_GT(seen, 1000);
    EXPECT_GT(edge, 20);
    EXPECT_GT(left, 50);
    EXPECT_LT(left, 500);
    PassTest test("antialias");
    run(test, in);
    expectReference(in, test);
  }
}

// At transparent surfaces, means are those of uncompressed light, over more frames and pixels, and begin with those of
// several pixels. Nothing else changes if only they are asked for.
TEST(Antialias, VeiledPixelsEqualTheReference) {
  Input in({0.13f, 0.05f, 0}, {0, 0, 0});
  for (int i = 0; i < kPixels; ++i) {
    const int x = i % kSize.x, y = i / kSize.x;
    in.veiled[size_t(i)] = x % 24 > 8;
    if (x < 40) in.origin[size_t(i)] = 0;
    in.history[size_t(i)].a = 12;  // more than half of the longer mean
    if (x > 20 && x < 24 && y > 5 && y < 15) in.previousId[size_t(i)] = 1u << 16 | 9;
  }
  for (const bool onlyVeils : {false, true}) {
    PassTest test("antialias");
    test.param("only_veils", onlyVeils);
    run(test, in);
    expectReference(in, test, onlyVeils);
    int longer = 0;
    for (int i = 0; i < kPixels; ++i) longer += test.floats("smoothed")[4 * size_t(i) + 3] > 8;
    EXPECT_GT(longer, 100);
  }
}

// What stands still keeps the history of its own pixel, without any of its neighbours', although the jitter moves what
// is seen by more than half a pixel.
TEST(Antialias, StandingStillDoesNotBlur) {
  Input in({0, 0, 0}, {0, 0, 0});
  in.deviations = 1000;
  std::fill(in.id.begin(), in.id.end(), 0);
  in.previousId = in.id;
  std::fill(in.origin.begin(), in.origin.end(), 0);
  PassTest test("antialias");
  run(test, in);
  const std::vector<float> got = test.floats("smoothed");
  for (size_t i = 0; i < size_t(kPixels); ++i) {
    const glm::dvec3 old = compress(in.history[i]);
    const glm::dvec3 want = expand(old + (compress(in.light[i]) - old) / 6.0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[4 * i + size_t(c)], want[c], 1e-3 * want[c] + 1e-4) << i;
    EXPECT_EQ(got[4 * i + 3], 6);
  }
}

// Where the history shows an object that has gone, it is not used, whatever the colours around the pixel are. A thin
// surface that this frame misses and the frame before met does not count as gone.
TEST(Antialias, WhatHasLeftIsForgotten) {
  Input in({0, 0, 0}, {0, 0, 0});
  std::fill(in.origin.begin(), in.origin.end(), 0);
  std::fill(in.id.begin(), in.id.end(), 0);
  in.previousId = in.id;
  const glm::ivec2 gone(10, 10), thin(30, 20);
  in.previousId[in.index(gone)] = 1u << 16;
  in.previousId[in.index(thin)] = 3;
  PassTest test("antialias");
  run(test, in);
  const std::vector<float> got = test.floats("smoothed");
  for (int i = 0; i < kPixels; ++i) {
    const glm::ivec2 away = glm::abs(glm::ivec2(i % kSize.x, i / kSize.x) - gone);
    EXPECT_EQ(got[4 * size_t(i) + 3], std::max(away.x, away.y) <= 1 ? 1 : 6) << i;
  }
}

// Without a history, the picture of this frame comes out unchanged, and the count begins.
TEST(Antialias, TheFirstFrameIsAsItIs) {
  Input in({0, 0, 0}, {0, 0, 0});
  std::fill(in.origin.begin(), in.origin.end(), 0);
  std::fill(in.history.begin(), in.history.end(), glm::vec4(0));
  in.light[7] = glm::vec4(60000, 0, 100, 1);
  PassTest test("antialias");
  run(test, in);
  const std::vector<float> got = test.floats("smoothed");
  for (size_t i = 0; i < size_t(kPixels); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(got[4 * i + size_t(c)], halfRound(in.light[i][c])) << i;
    EXPECT_EQ(got[4 * i + 3], 1);
  }
  EXPECT_EQ(test.counter("non_finite"), 0);
}

// A broken pixel neither stays in the history nor reaches the pixels around it.
TEST(Antialias, BrokenPixelsAreBlackAndCounted) {
  Input in({0, 0, 0}, {0, 0, 0}), zero = in;
  for (const size_t i : {size_t(100), size_t(1000)}) {
    in.light[i].g =
        i == 100 ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
    zero.light[i] = glm::vec4(0);
  }
  PassTest test("antialias");
  run(test, in);
  expectReference(zero, test);
  EXPECT_EQ(test.counter("non_finite"), 2);
}

}  // namespace
}  // namespace fovea::test
