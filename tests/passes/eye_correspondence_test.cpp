// Tests where the other eye sees the surface of each pixel, against a plain version in double precision.
#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random.h"
#include "tests/passes/eye_scene.h"

namespace fovea::test {
namespace {

constexpr double kLeastWeight = 0.5;

using Ids = std::vector<uint32_t>;  // of the pixels, material | object << 16

Ids oneId() { return Ids(size_t(kSize.x * kSize.y), 7); }

void run(PassTest& test, const GBuffer& seen, const Eye& other, const Ids& ids, const Ids& otherIds) {
  seen.wire(test);
  other.seen.wire(test, "other");
  const auto wireIds = [&](const char* name, const Ids& values) {
    test.image(name, VK_FORMAT_R32_UINT, uint32_t(kSize.x), uint32_t(kSize.y), 1, values);
  };
  wireIds("gbuffer.id", ids);
  wireIds("other.id", otherIds);
  test.beforeFrame([&](PassTest&, scene::Frame& frame) { frame.views[0] = other.view; });
  test.run();
}

// One texel of the output.
struct Place {
  glm::dvec2 at{0};
  uint32_t shown = 0;
  double weight = 0;
};

std::vector<Place> placesOf(const GBuffer& seen, const Eye& other, const Ids& ids, const Ids& otherIds) {
  PassTest test("eye-correspondence");
  run(test, seen, other, ids, otherIds);
  const std::vector<float> values = test.floats("correspondence");
  std::vector<Place> places;
  for (size_t i = 0; i < values.size(); i += 4)
    places.push_back({{values[i], values[i + 1]}, uint32_t(values[i + 2]), values[i + 3]});
  return places;
}

std::vector<Place> placesOf(const GBuffer& seen, const Eye& other) {
  return placesOf(seen, other, oneId(), oneId());
}

// The place of a point in the eye's picture, pixels from the top left corner.
glm::dvec2 projected(const Eye& eye, glm::vec3 point) {
  const glm::dvec4 clip = glm::dmat4(eye.view.worldToClip) * glm::dvec4(point, 1);
  return (0.5 * glm::dvec2(clip) / clip.w + 0.5) * glm::dvec2(kSize);
}

// A plain version of the pass. `close` marks decisions that rounding may change.
struct Reference : Place {
  bool close = false;
};

Reference referenceOf(const SurfacePixel& p, uint32_t id, const Eye& other, const Ids& otherIds) {
  Reference r;
  if (p.distance <= 0) return r;
  r.at = projected(other, p.position);
  const glm::dvec2 corner = glm::floor(r.at - 0.5);
  for (uint32_t i = 0; i < 4; ++i) {
    const glm::dvec2 centre = corner + glm::dvec2(i & 1, i >> 1) + 0.5;
    const glm::dvec2 w = 1.0 - glm::abs(centre - r.at);
    const glm::ivec2 q(centre);
    if (centre.x < 0 || centre.y < 0 || q.x >= kSize.x || q.y >= kSize.y) continue;
    const SurfacePixel& s = other.seen.at(q.x, q.y);
    if (s.distance <= 0 || otherIds[size_t(q.y * kSize.x + q.x)] != id) continue;
    const double plane = std::abs(
        glm::dot(glm::dvec3(s.position) - glm::dvec3(p.position), glm::normalize(glm::dvec3(p.normal))));
    const double cosine = glm::dot(glm::dvec3(s.normal), glm::dvec3(p.normal)),
                 tolerance = 0.005 * p.distance;
    r.close |= std::abs(plane - tolerance) < 0.05 * tolerance || std::abs(cosine - 0.9) < 1e-3;
    if (plane > tolerance || cosine < 0.9) continue;
    r.shown |= 1u << i;
    r.weight += w.x * w.y;
  }
  r.close |= std::abs(r.weight - kLeastWeight) < 2e-3;
  if (r.weight < kLeastWeight) r = {{}, r.close};
  return r;
}

// Checks every pixel, and returns how many the other eye sees.
size_t expectTheReference(const GBuffer& seen, const Eye& other, const Ids& ids, const Ids& otherIds) {
  const std::vector<Place> places = placesOf(seen, other, ids, otherIds);
  size_t found = 0, close = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    const Reference want = referenceOf(seen.pixels[i], ids[i], other, otherIds);
    close += want.close;
    if (want.close) continue;
    EXPECT_EQ(places[i].shown > 0, want.weight > 0) << "pixel " << i;
    EXPECT_NEAR(places[i].weight, want.weight, 2e-3) << "pixel " << i;
    EXPECT_NEAR(glm::distance(places[i].at, want.at), 0, 2e-3) << "pixel " << i;
    found += want.weight > 0;
    // Pixels with hardly any weight may be left out, as those of the other row are where both eyes see the same one.
    const glm::dvec2 between = glm::fract(want.at - 0.5);
    if (glm::all(glm::lessThan(glm::abs(between - 0.5), glm::dvec2(0.495)))) {
      EXPECT_EQ(places[i].shown, want.shown) << "pixel " << i;
    }
  }
  EXPECT_LT(double(close), 0.05 * double(places.size()));
  return found;
}

TEST(EyeCorrespondence, EqualsTheReference) {
  const Eye left({-0.1f, 0, 0});
  for (const glm::vec3 to : {glm::vec3(0.1f, 0, 0), glm::vec3(0.13f, 0.05f, -0.2f), glm::vec3(-0.6f, 0, 0)}) {
    const Eye right(to);
    const size_t found = expectTheReference(left.seen, right, oneId(), oneId());
    EXPECT_GT(double(found), 0.5 * double(left.seen.pixels.size()));
  }
}

// Surfaces shifted and turned at random, and parts of the picture with materials of their own.
TEST(EyeCorrespondence, ShakenSurfacesEqualTheReference) {
  const auto random = [](uint32_t what, uint32_t i) { return uniformFloat(randomStream(37, 0, what, i)); };
  const Eye left({-0.1f, 0, 0});
  Eye right({0.1f, 0.03f, 0});
  const GBuffer shaken(kSize.x, kSize.y, left.seen.camera, [&](int x, int y) {
    SurfacePixel p = left.seen.at(x, y);
    const auto patch = uint32_t(x / 7 + 64 * (y / 5));
    if (random(0, patch) < 0.2f) p.position += p.normal * (0.014f * p.distance * (random(1, patch) - 0.5f));
    if (random(2, patch) < 0.2f)
      p.normal =
          glm::normalize(p.normal + glm::vec3(random(3, patch), random(4, patch), random(5, patch)) - 0.5f);
    if (random(6, patch) < 0.1f) p.distance = 0;
    return p;
  });
  Ids ids = oneId(), otherIds = oneId();
  for (size_t i = 0; i < ids.size(); ++i) {
    ids[i] = i / 9 % 5 == 0 ? 8 : 7;
    otherIds[i] = i / 11 % 4 == 0 ? 8 : 7;
    if (i / 13 % 4 == 0) right.seen.pixels[i].normal = halfRound(glm::vec3(0.6f, 0, 0.8f));
  }
  const size_t found = expectTheReference(shaken, right, ids, otherIds);
  EXPECT_GT(double(found), 0.2 * double(ids.size()));
  EXPECT_LT(double(found), 0.9 * double(ids.size()));
}

TEST(EyeCorrespondence, TheSameEyeSeesTheSamePixels) {
  const Eye eye({0.1f, 0.2f, 0});
  const std::vector<Place> places = placesOf(eye.seen, eye);
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const Place& place = places[size_t(y * kSize.x + x)];
      ASSERT_NEAR(glm::distance(place.at, glm::dvec2(x, y) + 0.5), 0, 1e-3) << x << "," << y;
      ASSERT_NEAR(place.weight, 1, 1e-3) << x << "," << y;
    }
}

// The box hides a strip of the wall from the other eye, and another strip is outside its picture. Within a pixel of an
// edge both answers are valid.
TEST(EyeCorrespondence, WhatIsHiddenOrOutsideIsNotSeen) {
  const Eye left({-0.15f, 0, 0}), right({0.15f, 0, 0});
  const std::vector<Place> places = placesOf(left.seen, right);
  size_t hidden = 0, outside = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    const glm::vec3 point = left.seen.pixels[i].position;
    const glm::dvec2 at = projected(right, point);
    const auto visible = [&](glm::dvec2 offset) {
      const glm::dvec3 ray = glm::normalize(glm::dvec3(right.view.rayDirection(glm::vec2(at + offset))));
      const RayHit hit = castRay(right.scene, right.geometry, glm::dvec3(right.view.eye), ray, {});
      return hit && glm::distance(glm::dvec3(right.view.eye) + hit.t * ray, glm::dvec3(point)) < 0.5;
    };
    const bool inside = at.x > 0 && at.x < kSize.x;
    const bool seen = places[i].shown > 0;
    if (!inside) {
      EXPECT_TRUE(!seen || std::abs(at.x - glm::clamp(at.x, 0.0, double(kSize.x))) < 0.5) << "pixel " << i;
      outside += !seen;
    } else if (visible({0, 0}) != seen) {
      bool excused = at.x < 1 || at.x > kSize.x - 1;
      for (int k = 0; k < 9; ++k) excused |= visible({k % 3 - 1, k / 3 - 1}) == seen;
      EXPECT_TRUE(excused) << "pixel " << i;
    }
    hidden += inside && !seen;
  }
  EXPECT_GT(hidden, 20u);
  EXPECT_GT(outside, 50u);
}

TEST(EyeCorrespondence, BackgroundCorrespondsToNothing) {
  const Eye right({0.1f, 0, 0});
  Eye blind({-0.1f, 0, 0});
  for (SurfacePixel& p : blind.seen.pixels) p.distance = 0;
  for (const Place& place : placesOf(blind.seen, right)) ASSERT_EQ(place.shown, 0u);
  for (const Place& place : placesOf(right.seen, blind)) ASSERT_EQ(place.weight, 0);
}

// Behind the other eye nothing is seen, either.
TEST(EyeCorrespondence, AnEyeThatLooksAwaySeesNothing) {
  const Eye left({-0.1f, 0, 0});
  Eye away({0.1f, 0, 0});
  scene::Camera camera;
  camera.orientation = glm::quat(0, 0, 1, 0);
  away.view = scene::makeView(camera, glm::uvec2(kSize), away.geometry);
  for (const Place& place : placesOf(left.seen, away)) ASSERT_EQ(place.shown, 0u);
}

TEST(EyeCorrespondence, LeastWeightDecides) {
  const Eye left({-0.1f, 0, 0}), right({0.1f, 0, 0});
  const auto seenWith = [&](double least) {
    PassTest test("eye-correspondence");
    test.param("least_weight", least);
    run(test, left.seen, right, oneId(), oneId());
    const std::vector<float> values = test.floats("correspondence");
    size_t seen = 0;
    for (size_t i = 3; i < values.size(); i += 4) {
      EXPECT_TRUE(values[i] == 0 || values[i] >= least);
      seen += values[i] > 0;
    }
    return seen;
  };
  EXPECT_GT(seenWith(0.001), seenWith(0.5));
  EXPECT_GT(seenWith(0.5), seenWith(0.99));
}

}  // namespace
}  // namespace fovea::test
