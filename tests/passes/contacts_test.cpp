// Compares the pixels where surfaces meet with a plain search around each pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "tests/passes/eye_scene.h"

namespace fovea::test {
namespace {

constexpr float kArea = 0.5f, kRise = 0.3f;

// Whether the box rises over the tangent plane of a pixel, within `reach` metres and `widest` pixels. Rows of four
// directions along the axes alternate with rows between them.
bool inContact(const GBuffer& seen, int x, int y, float reach, int widest) {
  const SurfacePixel& p = seen.at(x, y);
  bool axes = true;
  for (int step = 1; step <= widest; step *= 2, axes = !axes)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if ((dx == 0 && dy == 0) || (dx == 0 || dy == 0) != axes) continue;
        const SurfacePixel& q = seen.at(std::clamp(x + step * dx, 0, seen.width - 1),
                                        std::clamp(y + step * dy, 0, seen.height - 1));
        const glm::vec3 to = q.position - p.position;
        if (q.distance > 0 && glm::dot(to, p.normal) > kRise * glm::length(to) && glm::length(to) < reach)
          return true;
      }
  return false;
}

std::vector<glm::uvec2> find(const GBuffer& seen, double reach, double width, double foveaRadius = 2) {
  PassTest test("contacts");
  test.view("fovea_radius", foveaRadius).param("width", width).param("rise", double(kRise));
  test.param("reach", reach / std::sqrt(kArea / glm::pi<double>()));
  seen.wire(test);
  test.buffer("spread", std::vector<glm::vec4>{{kArea, 0, 0, 0}}, "VplSpread");
  test.run();
  return test.values<glm::uvec2>("contacts");
}

// A floor 1.5 m below the eye, seen up to the horizon.
GBuffer makeGrazingFloor() {
  const scene::PixelRays rays =
      raysOnto({0, 0, 0}, {-0.5f, 0.5f, -1}, {1 / float(kSize.x), 0, 0}, {0, -1 / float(kSize.y), 0});
  return {kSize.x, kSize.y, rays, [](int x, int y) {
            SurfacePixel p;
            if (y <= kSize.y / 2) return p;
            const float depth = 1.5f * float(kSize.y) / float(y - kSize.y / 2);
            p.position = {depth * (float(x) / float(kSize.x) - 0.5f), -1.5f, -depth};
            p.distance = glm::length(p.position);
            return p;
          }};
}

// Calls check(x, y, contact) for all pixels.
template <class Check>
void forAll(const std::vector<glm::uvec2>& contacts, const Check& check) {
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) check(x, y, contacts[size_t(y * kSize.x + x)]);
}

TEST(Contacts, SurfacesThatRiseCloseBy) {
  const Eye eye({0.3f, 0.2f, 0});
  const struct {
    float reach;
    int widest;
  } cases[] = {{3, 1}, {3, 4}, {2.2f, 8}};
  for (const auto& c : cases) {
    int found = 0;
    forAll(find(eye.seen, c.reach, (c.widest + 0.5) / kSize.x), [&](int x, int y, glm::uvec2 contact) {
      const SurfacePixel& p = eye.seen.at(x, y);
      ASSERT_EQ(contact.x != 0, inContact(eye.seen, x, y, c.reach, c.widest)) << x << ", " << y;
      if (contact.x == 0) {
        EXPECT_EQ(contact.y, 0u);
        return;
      }
      ++found;
      EXPECT_EQ(std::bit_cast<float>(contact.x), p.distance);
      EXPECT_EQ(glm::unpackSnorm2x16(contact.y),
                glm::unpackSnorm2x16(glm::packSnorm2x16(octEncode(p.normal))));
    });
    EXPECT_GT(found, 30) << c.reach << ", " << c.widest;
  }
}

TEST(Contacts, NothingThatIsFarAway) {
  const Eye eye({0.3f, 0.2f, 0});  // the box is at least a metre in front of the wall
  forAll(find(eye.seen, 0.9, 0.2),
         [](int x, int y, glm::uvec2 contact) { EXPECT_EQ(contact, glm::uvec2(0)) << x << ", " << y; });
}

TEST(Contacts, OnlyInTheFovea) {
  const Eye eye({0.3f, 0.2f, 0});
  constexpr double kRadius = 0.2;
  int found = 0;
  forAll(find(eye.seen, 3, 0.1, kRadius), [&](int x, int y, glm::uvec2 contact) {
    const double r = glm::distance(glm::dvec2(x, y) + 0.5, 0.5 * glm::dvec2(kSize)) / kSize.x;
    EXPECT_EQ(contact.x != 0, r <= kRadius && inContact(eye.seen, x, y, 3, 4)) << x << ", " << y;
    found += contact.x != 0;
  });
  EXPECT_GT(found, 10);
}

// A plane rises nowhere, however obliquely it is seen and however its position is rounded.
TEST(Contacts, NotOnAPlane) {
  const GBuffer floor = makeGrazingFloor();
  forAll(find(floor, 300, 0.2),
         [](int x, int y, glm::uvec2 contact) { EXPECT_EQ(contact, glm::uvec2(0)) << x << ", " << y; });
}

}  // namespace
}  // namespace fovea::test
