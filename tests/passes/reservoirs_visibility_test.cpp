// Compares the visibility of samples with plain rays.
#include <gtest/gtest.h>

#include <cmath>

#include "fovea/error.h"
#include "tests/passes/reservoir_reference.h"
#include "tests/passes/where_rays_run.h"

namespace fovea::test {
namespace {

class ReservoirsVisibility : public WhereRaysRun {};
INSTANTIATE_TEST_SUITE_P(Rays, ReservoirsVisibility, testing::Bool(), nameOfPlace);

constexpr glm::ivec2 kSize(27, 18);
constexpr int kSources = 3;

struct Input {
  Room room = closedRoom(true, 8, kSize, 2.2f);
  GBuffer seen = gbufferOf(room), before = seen;
  std::vector<Reservoir> own, others;
  std::vector<uint32_t> sources;

  // Samples lie where other pixels see something; the sources are any pixels, or none.
  Input() {
    Numbers numbers;
    const int count = kSize.x * kSize.y;
    for (int i = 0; i < count; ++i) {
      for (std::vector<Reservoir>* list : {&own, &others}) {
        const Seen& there = room.pixels[size_t(numbers.below(count))];
        Reservoir r;
        r.position = there.position;
        r.normal = there.normal;
        r.weight = numbers.next() < 0.1f ? 0.0f : 1.0f;
        list->push_back(r);
      }
      // What the sources show is not what this frame's pixels show.
      before.pixels[size_t(i)] = seen.pixels[size_t((i + 37) % count)];
      for (int k = 0; k < kSources; ++k) {
        const uint32_t source = packPixel(numbers.below(kSize.x), numbers.below(kSize.y));
        sources.push_back(numbers.next() < 0.2f ? kNoPixel : source);
      }
    }
  }
  void wire(PassTest& test, uint32_t sourceColumns = uint32_t(kSources * kSize.x)) const {
    const uint32_t height = uint32_t(kSize.y);
    seen.wire(test);
    before.wire(test, "moved");
    test.scene(room.scene);
    test.buffer("own", own, "Reservoir");
    test.buffer("others", others, "Reservoir");
    test.image("sources", VK_FORMAT_R32_UINT, sourceColumns, height, 1, sources);
  }
};

enum class Sees { No, Yes, Grazes };

// Grazes: too close to call in single precision.
Sees seesPoint(const Room& room, const SurfacePixel& from, const Reservoir& r) {
  if (!(r.weight > 0)) return Sees::No;
  const glm::dvec3 x(from.position), y(r.position), n(from.normal), m(r.normal);
  const double length = glm::distance(x, y);
  if (length < 0.1) return Sees::Grazes;
  const glm::dvec3 d = (y - x) / length;
  const double out = glm::dot(d, n), in = -glm::dot(d, m);
  if (std::min(out, in) < -0.01) return Sees::No;
  if (std::min(out, in) < 0.1) return Sees::Grazes;
  // Rays beside the ray, that begin and end above the surfaces.
  const glm::dvec3 across = glm::normalize(glm::cross(d, glm::dvec3(0.31, 0.77, 0.55))),
                   along = glm::cross(d, across);
  int free = 0;
  for (const glm::dvec3& shift : {across, -across, along, -along}) {
    const RayHit hit =
        castRay(room.scene, room.geometry, x + 0.06 * d + 4e-3 * shift, d, {.tMax = length - 0.12});
    free += !hit;
  }
  return free == 4 ? Sees::Yes : free == 0 ? Sees::No : Sees::Grazes;
}

TEST_P(ReservoirsVisibility, EqualsPlainRays) {
  const Input in;
  RayPassTest test("reservoirs-visibility");
  in.wire(test);
  test.run();
  const auto visibility = test.values<uint32_t>("seen");
  int seen = 0, hidden = 0, grazing = 0, nobody = 0;
  for (size_t i = 0; i < visibility.size(); ++i)
    for (size_t k = 0; k < kSources; ++k) {
      const uint32_t bits = visibility[i] >> 2 * k & 3u, source = in.sources[i * kSources + k];
      if (source == kNoPixel) {
        EXPECT_EQ(bits, 0u);
        ++nobody;
        continue;
      }
      const size_t j = size_t(source >> 16) * kSize.x + (source & 0xffffu);
      const Sees expected[] = {seesPoint(in.room, in.seen.pixels[i], in.others[j]),
                               seesPoint(in.room, in.before.pixels[j], in.own[i])};
      for (uint32_t way = 0; way < 2; ++way) {
        grazing += expected[way] == Sees::Grazes;
        if (expected[way] == Sees::Grazes) continue;
        EXPECT_EQ((bits >> way & 1u) != 0, expected[way] == Sees::Yes)
            << i << ", source " << k << ", " << way;
        (expected[way] == Sees::Yes ? seen : hidden) += 1;
      }
    }
  std::printf("%d seen, %d hidden, %d too close to call\n", seen, hidden, grazing);
  EXPECT_GT(seen, 500);
  EXPECT_GT(hidden, 300);
  EXPECT_GT(nobody, 100);
  EXPECT_LT(grazing, (seen + hidden) / 2);
  EXPECT_GT(test.counter("rays"), test.counter("hidden"));
  EXPECT_GT(test.counter("hidden"), 0);
}

TEST_P(ReservoirsVisibility, RefusesSourcesOfAnotherSize) {
  Input in;
  in.sources.resize(in.sources.size() - size_t(kSize.y));
  RayPassTest test("reservoirs-visibility");
  in.wire(test, uint32_t(kSources * kSize.x - 1));
  EXPECT_THROW(test.run(), Error);
}

TEST_P(ReservoirsVisibility, NobodySeesAnythingInAnEmptyScene) {
  Input in;
  in.room.scene = {};
  RayPassTest test("reservoirs-visibility");
  in.wire(test);
  test.run();
  for (const uint32_t bits : test.values<uint32_t>("seen")) EXPECT_EQ(bits, 0u);
}

}  // namespace
}  // namespace fovea::test
