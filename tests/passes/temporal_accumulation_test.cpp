// The running mean over frames: it follows the surfaces, and what it takes over is theirs.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "passes/near-field/near_field_tracer.h"
#include "tests/passes/deferred_reference.h"
#include "tests/passes/ray_reference.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

constexpr glm::ivec2 kSize{48, 40};

// What a camera at `position` sees: a wall and a nearer box.
struct Eye {
  scene::Scene scene;
  scene::Geometry geometry;
  scene::View view;
  GBuffer seen;

  explicit Eye(glm::vec3 position)
      : scene(model()), geometry(scene::flatten(scene)), view(viewAt(geometry, position)), seen(look()) {}

  static scene::Scene model() {
    scene::Scene s;
    const uint32_t m = addMaterial(s, glm::vec3(0.5f));
    addBox(s, m, {-9, -9, -6}, {9, 9, -5});
    addBox(s, m, {-0.6f, -0.7f, -4}, {0.5f, 0.6f, -3});
    scene::Mover mover;  // object 1
    mover.node = uint32_t(s.nodes.size() - 1);
    mover.keys.resize(1);
    s.nodes[mover.node].dynamic = true;
    s.movers.push_back(mover);
    return s;
  }
  static scene::View viewAt(const scene::Geometry& geometry, glm::vec3 position) {
    scene::Camera camera;
    camera.position = position;
    camera.verticalFov = 0.8f;
    return scene::makeView(camera, glm::uvec2(kSize), geometry);
  }
  GBuffer look() const {
    return {kSize.x, kSize.y, [&](int x, int y) {
              SurfacePixel p;
              const glm::dvec3 ray = glm::normalize(glm::dvec3(view.rayDirection(glm::vec2(x, y) + 0.5f)));
              const RayHit hit = castRay(scene, geometry, glm::dvec3(view.eye), ray, {});
              if (!hit) return p;
              p.position = glm::vec3(glm::dvec3(view.eye) + hit.t * ray);
              p.distance = float(hit.t);
              p.normal = glm::vec3(faceNormal(geometry, hit.triangle));
              if (glm::dot(glm::dvec3(p.normal), ray) > 0) p.normal = -p.normal;
              return p;
            }};
  }
};

std::vector<uint16_t> halves(const std::vector<glm::vec4>& image) {
  std::vector<uint16_t> half;
  for (const glm::vec4& v : image)
    for (int c = 0; c < 4; ++c) half.push_back(glm::packHalf1x16(v[c]));
  return half;
}

// One frame of the pass.
std::vector<float> accumulate(const Eye& now, const Eye& before, const std::vector<glm::vec4>& samples,
                              const std::vector<glm::vec4>& history, uint32_t object = 0,
                              const std::function<void(scene::Frame&)>& change = {}, int firstSamples = 1) {
  PassTest test("temporal-accumulation");
  test.param("frames", 8.0).param("first_samples", firstSamples);
  now.seen.wire(test, "gbuffer", 2);
  before.seen.wire(test, "previous", 2);
  test.image("gbuffer.id", VK_FORMAT_R32_UINT, uint32_t(kSize.x), uint32_t(kSize.y), 1,
             std::vector<uint32_t>(size_t(kSize.x * kSize.y), object << 16));
  test.image("samples", VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(kSize.x / 2), uint32_t(kSize.y / 2), 1,
             halves(samples));
  test.image("history", VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(kSize.x), uint32_t(kSize.y), 1,
             halves(history));
  test.scene(now.scene).beforeFrame([&](PassTest&, scene::Frame& frame) {
    frame.views[0] = now.view;
    frame.views[0].previousWorldToClip = before.view.worldToClip;
    if (change) change(frame);
  });
  test.run();
  return test.floats("mean");
}

std::vector<glm::vec4> everywhere(glm::ivec2 size, glm::vec4 value) {
  return std::vector<glm::vec4>(size_t(size.x * size.y), value);
}

bool sameSurface(const SurfacePixel& a, const SurfacePixel& b) {
  return b.distance > 0 && std::abs(glm::dot(b.position - a.position, a.normal)) <= 0.005f * a.distance &&
         glm::dot(a.normal, b.normal) > 0.9f;
}

const glm::vec4 kNone(0, 0, 0, passes::sampleCode(2, {1, 0}, false));

// Stands still: of n frames each has the same weight, up to eight; then the newest one has an eighth.
TEST(TemporalAccumulation, MeanOfTheFramesSoFar) {
  const Eye eye({0, 0, 0});
  for (const auto& [count, place] :
       {std::pair(1.0f, glm::uvec2(0, 0)), {5, {1, 0}}, {8, {0, 1}}, {20, {1, 1}}}) {
    const auto got =
        accumulate(eye, eye, everywhere(kSize / 2, {4, 2, 1, passes::sampleCode(2, place, true)}),
                   everywhere(kSize, {1, 1, 3, count}));
    int own = 0, other = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        const float* v = &got[4 * size_t(y * kSize.x + x)];
        const glm::ivec2 from = glm::ivec2(x, y) / 2 * 2 + glm::ivec2(place);
        const bool mine = sameSurface(eye.seen.at(x, y), eye.seen.at(from.x, from.y));
        const float n = std::min(count + 1, 8.0f);
        const glm::vec3 sample(4, 2, 1), old(1, 1, 3);
        const glm::vec3 want = mine ? old + (sample - old) / n : old;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(v[c], want[c], 2e-3f * want[c]) << x << " " << y;
        EXPECT_EQ(v[3], mine ? n : count);
        ++(mine ? own : other);
      }
    EXPECT_GT(own, 1500);
    EXPECT_GT(other, 10);
  }
}

// Larger blocks have as much smaller weights.
TEST(TemporalAccumulation, BlocksOfEightChangeLess) {
  const Eye eye({0, 0, 0});
  const auto got =
      accumulate(eye, eye, everywhere(kSize / 2, {9, 9, 9, 8}), everywhere(kSize, {1, 1, 1, 100}));
  int own = 0;
  for (size_t i = 0; i < got.size(); i += 4) {
    EXPECT_TRUE(got[i + 3] == 100 || got[i + 3] == 32);
    EXPECT_NEAR(got[i], got[i + 3] == 32 ? 1.25 : 1, 1e-3);
    own += got[i + 3] == 32;
  }
  EXPECT_GT(own, 1000);
}

// Where there is no mean yet the samples around make one, of single rays without the brightest: so many as
// lie on the same surface count, each of a first frame for many.
TEST(TemporalAccumulation, SamplesAroundWhereThereIsNone) {
  const Eye eye({0, 0, 0});
  auto samples = everywhere(kSize / 2, {4, 2, 1, 2});
  for (int y = 1; y < kSize.y / 2; y += 3)
    for (int x = 1; x < kSize.x / 2; x += 3)
      samples[size_t(y * (kSize.x / 2) + x)] = {4000, 2000, 1000, 2};  // one of nine
  for (const int first : {1, 16}) {
    const auto got = accumulate(eye, eye, samples, everywhere(kSize, glm::vec4(0)), 0, {}, first);
    int counted = 0;
    for (int y = 2; y < kSize.y - 2; ++y)
      for (int x = 2; x < kSize.x - 2; ++x) {
        const float* v = &got[4 * size_t(y * kSize.x + x)];
        int same = 0;
        float sum = 0, all = 0;
        for (int k = 0; k < 9; ++k) {
          const glm::ivec2 block = glm::ivec2(x + 2 * (k % 3 - 1), y + 2 * (k / 3 - 1)) / 2;
          const float value = samples[size_t(block.y * (kSize.x / 2) + block.x)].z;
          const bool own = sameSurface(eye.seen.at(x, y), eye.seen.at(2 * block.x, 2 * block.y));
          same += own, sum += own ? value : 0, all += value;
        }
        EXPECT_EQ(v[3], float(same * first)) << x << " " << y;
        const float mean = same > 0 ? sum / float(same) : all / 9;
        if (first > 1) {
          for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(v[c], float(4 >> c) * mean, 1e-3 * float(4 >> c) * mean) << x << " " << y;
          }
        } else if (same != 1) {  // of one sample nobody knows
          EXPECT_EQ(glm::vec3(v[0], v[1], v[2]), glm::vec3(4, 2, 1)) << x << " " << y;
        }
        counted += same > 0;
      }
    EXPECT_GT(counted, 1200);
  }
}

// The eye moves: each pixel has the history of one of the four pixels around where it was, if there is one of
// its surface, on average of the very place; where the box has uncovered the wall there is none.
TEST(TemporalAccumulation, FollowsSurfacesAsTheEyeMoves) {
  const Eye now({0.13f, 0.05f, 0}), before({0, 0, 0});
  std::vector<glm::vec4> history;
  for (int i = 0; i < kSize.x * kSize.y; ++i) history.emplace_back(i % kSize.x + 1, i / kSize.x + 1, 1, 5);
  const auto got = accumulate(now, before, everywhere(kSize / 2, kNone), history);
  int followed = 0, lost = 0;
  std::map<bool, glm::dvec2> away;  // on the box, on the wall: sum of the differences
  std::map<bool, int> counts;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const SurfacePixel& p = now.seen.at(x, y);
      const float* v = &got[4 * size_t(y * kSize.x + x)];
      const glm::dvec4 clip = glm::dmat4(before.view.worldToClip) * glm::dvec4(p.position, 1);
      const glm::dvec2 at = (0.5 * glm::dvec2(clip) / clip.w + 0.5) * glm::dvec2(kSize) - 0.5,
                       corner = glm::floor(at);
      int candidates = 0;
      for (int k = 0; k < 4; ++k) {
        const glm::ivec2 q = glm::ivec2(corner) + glm::ivec2(k & 1, k >> 1);
        candidates += q.x >= 0 && q.y >= 0 && q.x < kSize.x && q.y < kSize.y &&
                      sameSurface(p, before.seen.at(q.x, q.y));
      }
      if (candidates == 0) {
        EXPECT_EQ(v[3], 0) << x << " " << y;
        ++lost;
        continue;
      }
      ASSERT_EQ(v[3], 5) << x << " " << y;
      const glm::dvec2 from(v[0] - 1, v[1] - 1);
      EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(from - at), glm::dvec2(1.001)))) << x << " " << y;
      EXPECT_TRUE(sameSurface(p, before.seen.at(int(from.x), int(from.y))));
      if (candidates == 4) away[p.distance < 4.5f] += from - at, ++counts[p.distance < 4.5f];
      ++followed;
    }
  EXPECT_GT(followed, 1500);
  EXPECT_GT(lost, 30);
  for (const auto& [box, sum] : away) {
    ASSERT_GT(counts[box], 80);
    EXPECT_LT(glm::length(sum / double(counts[box])), 3 * 0.5 / std::sqrt(counts[box])) << box;
  }
}

// What moves takes its light along.
TEST(TemporalAccumulation, FollowsObjects) {
  const Eye eye({0, 0, 0});
  const glm::vec3 moved(0.4f, 0, 0);  // all that is seen is object 1, since the frame before
  std::vector<glm::vec4> history;
  for (int i = 0; i < kSize.x * kSize.y; ++i) history.emplace_back(i % kSize.x + 1, i / kSize.x + 1, 1, 5);
  const auto got = accumulate(eye, eye, everywhere(kSize / 2, kNone), history, 1, [&](scene::Frame& frame) {
    scene::ObjectTransform object;
    object.toWorld = glm::translate(glm::mat4(1), moved);
    object.toObject = glm::inverse(object.toWorld);
    frame.objects.at(1) = object;
  });
  int checked = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const SurfacePixel& p = eye.seen.at(x, y);
      const float* v = &got[4 * size_t(y * kSize.x + x)];
      const glm::dvec4 clip = glm::dmat4(eye.view.worldToClip) * glm::dvec4(p.position - moved, 1);
      const double at = (0.5 * clip.x / clip.w + 0.5) * kSize.x - 0.5;
      if (v[3] == 0) continue;
      EXPECT_NEAR(v[0] - 1, at, 1.001);
      EXPECT_NEAR(v[1] - 1, y, 1.001);
      ++checked;
    }
  EXPECT_GT(checked, 1000);
}

}  // namespace
}  // namespace fovea::test
