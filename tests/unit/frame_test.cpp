// Tests views and frames: Vulkan's clip space, rays that agree with it, and gaze and camera over time.
#include "framework/scene/frame.h"
#include "framework/scene/tables/blocks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtx/component_wise.hpp>

namespace fovea::scene {
namespace {

Geometry bounds(glm::vec3 low, glm::vec3 high) {
  Geometry g;
  g.triangles.emplace_back();
  g.boundsMin = low;
  g.boundsMax = high;
  return g;
}

glm::vec3 project(const View& v, glm::vec3 p) {
  const glm::vec4 c = v.worldToClip * glm::vec4(p, 1.0f);
  return glm::vec3(c) / c.w;
}

TEST(View, ClipSpaceIsVulkans) {
  Camera c;
  c.verticalFov = 1.0f;
  c.zNear = 0.5f;
  c.zFar = 20.0f;
  const View v = makeView(c, {200, 100}, bounds(glm::vec3(-1), glm::vec3(1)));
  EXPECT_NEAR(project(v, {0, 0, -0.5f}).z, 0, 1e-5f);
  EXPECT_NEAR(project(v, {0, 0, -20}).z, 1, 1e-5f);
  EXPECT_GT(project(v, {1, 0, -5}).x, 0);
  EXPECT_LT(project(v, {0, 1, -5}).y, 0);  // up in the world is up in the image, whose y points down
  const float t = std::tan(0.5f);
  EXPECT_NEAR(project(v, {0, 5 * t, -5}).y, -1, 1e-5f);
  EXPECT_NEAR(project(v, {10 * t, 0, -5}).x, 1, 1e-5f);  // the image is twice as wide as high
}

// glTF 2.0, 3.10.3: where the picture has another shape, nothing of the author's view should be cut off.
TEST(View, ANarrowPictureShowsBothSidesOfTheAuthorsFrame) {
  Camera c;
  c.verticalFov = 0.7f;
  c.aspectRatio = 16.0f / 9.0f;
  const Geometry geometry = bounds(glm::vec3(-1), glm::vec3(1));
  const float up = std::tan(0.35f), side = up * c.aspectRatio;
  const float clip = 1 + 1e-5f;
  for (const glm::uvec2 size :
       {glm::uvec2(64, 64), glm::uvec2(9, 100), glm::uvec2(160, 90), glm::uvec2(300, 100)}) {
    const View v = makeView(c, size, geometry);
    const glm::vec3 corner = project(v, {side, up, -1});
    EXPECT_LE(corner.x, clip);
    EXPECT_LE(-corner.y, clip);
    EXPECT_NEAR(std::max(corner.x, -corner.y), 1, 1e-4f);  // and nothing more than is necessary
    EXPECT_NEAR(v.viewToClip[1][1], -1 / std::tan(0.5f * v.verticalFov), 1e-4f);
  }
}

TEST(View, RaysHitWhatIsProjectedThere) {
  Camera c;
  c.position = {1, 2, 3};
  c.orientation = glm::normalize(glm::quat(0.8f, 0.1f, -0.5f, 0.2f));
  c.verticalFov = 0.9f;
  const View v = makeView(c, {320, 180}, bounds(glm::vec3(-50), glm::vec3(50)));
  for (const glm::vec2 pixel : {glm::vec2(0.5f, 0.5f), glm::vec2(100.5f, 20.5f), glm::vec2(319.5f, 179.5f)}) {
    const glm::vec3 p = v.eye + 7.0f * v.rayDirection(pixel);
    const glm::vec3 ndc = project(v, p);
    EXPECT_NEAR((ndc.x * 0.5f + 0.5f) * 320, pixel.x, 1e-3f);
    EXPECT_NEAR((ndc.y * 0.5f + 0.5f) * 180, pixel.y, 1e-3f);
    const glm::vec4 back = v.clipToWorld * glm::vec4(ndc, 1.0f);
    EXPECT_LT(glm::distance(glm::vec3(back) / back.w, p), 2e-3f);
  }
}

// The edges of each eye's picture are where the lens has them, mirrored from eye to eye. Rays agree with clip space,
// and the line of sight does not pass through the middle of the picture.
TEST(View, ALensSeesFurtherOutThanIn) {
  const Lens lens{glm::radians(60.0f), glm::radians(40.0f), glm::radians(50.0f), glm::radians(55.0f)};
  Camera c;
  c.position = {1, 2, 3};
  for (const bool left : {true, false}) {
    const View v = makeView(c, {320, 300}, bounds(glm::vec3(-50), glm::vec3(50)), glm::vec2(0.5f),
                            frustumOf(lens, left));
    const auto angles = [&](glm::vec2 pixel) {
      const glm::vec3 d = v.rayDirection(pixel);
      return glm::degrees(glm::vec2(std::atan2(d.x, -d.z), std::atan2(d.y, -d.z)));
    };
    EXPECT_NEAR(angles({0, 150}).x, left ? -60 : -40, 1e-3f);
    EXPECT_NEAR(angles({320, 150}).x, left ? 40 : 60, 1e-3f);
    EXPECT_NEAR(angles({160, 0}).y, 50, 1e-3f);
    EXPECT_NEAR(angles({160, 300}).y, -55, 1e-3f);
    EXPECT_NEAR(v.verticalFov, glm::radians(105.0f), 1e-5f);
    EXPECT_NEAR(project(v, {1, 2, -4}).x, left ? 0.3473f : -0.3473f,
                1e-4f);  // (tan 60 - tan 40) / (tan 60 + tan 40)
    for (const glm::vec2 pixel : {glm::vec2(0.5f), glm::vec2(100.5f, 20.5f), glm::vec2(319.5f, 299.5f)}) {
      const glm::vec3 ndc = project(v, v.eye + 7.0f * v.rayDirection(pixel));
      EXPECT_NEAR((ndc.x * 0.5f + 0.5f) * 320, pixel.x, 2e-3f);
      EXPECT_NEAR((ndc.y * 0.5f + 0.5f) * 300, pixel.y, 2e-3f);
    }
  }
}

TEST(View, FarPlaneHoldsTheWholeScene) {
  Camera c;
  c.position = {100, 0, 0};
  const Geometry g = bounds({-300, -10, -20}, {50, 10, 20});
  const View v = makeView(c, {64, 64}, g);
  // Look at the corner that is farthest from the camera.
  c.orientation = glm::quat(glm::vec3(0, glm::radians(90.0f), 0));
  const View w = makeView(c, {64, 64}, g);
  EXPECT_LT(project(w, {-300, 10, 20}).z, 1.0f);
  EXPECT_GT(project(w, {-300, 10, 20}).z, 0.9f);
  EXPECT_EQ(v.size, glm::uvec2(64, 64));
}

Scene sceneWithPath() {
  Scene s;
  s.exposure = 3;
  for (int i = 0; i < 4; ++i) {
    CameraKey k;
    k.time = float(i);
    k.camera.position = {2.0f * float(i), 0, 0};
    k.camera.orientation = glm::angleAxis(0.4f * float(i), glm::vec3(0, 1, 0));
    k.camera.verticalFov = 0.5f + 0.1f * float(i);
    s.cameraPath.push_back(k);
  }
  s.cameras.push_back(s.cameraPath.front().camera);
  return s;
}

TEST(Frame, PathGoesThroughItsKeysAndHoldsAtItsEnds) {
  const Scene s = sceneWithPath();
  const Geometry g = bounds(glm::vec3(-1), glm::vec3(1));
  for (int i = 0; i < 4; ++i) {
    const Frame f = makeFrame(s, g, {64, 64}, uint64_t(i) * 10, 0, 10.0);
    EXPECT_LT(glm::distance(f.views[0].eye, s.cameraPath[size_t(i)].camera.position), 1e-4f);
    EXPECT_NEAR(f.views[0].verticalFov, 0.5f + 0.1f * float(i), 1e-5f);
  }
  EXPECT_LT(glm::distance(makeFrame(s, g, {64, 64}, 99, 0, 10.0).views[0].eye, glm::vec3(6, 0, 0)), 1e-5f);
  // The steps are equal: the spline runs at constant speed, for position and direction alike.
  const Frame middle = makeFrame(s, g, {64, 64}, 15, 0, 10.0);
  EXPECT_LT(glm::distance(middle.views[0].eye, glm::vec3(3, 0, 0)), 1e-4f);
  const glm::vec3 forward = middle.views[0].rayDirection({32, 32});
  EXPECT_LT(glm::distance(glm::normalize(forward), glm::vec3(-std::sin(0.6f), 0, -std::cos(0.6f))), 1e-3f);
}

TEST(Frame, PathHasNoJumpsInSpeedAtItsKeys) {
  Scene s = sceneWithPath();
  s.cameraPath[2].camera.position = {1, 5, 2};  // a bend
  const Geometry g = bounds(glm::vec3(-1), glm::vec3(1));
  const auto eye = [&](uint64_t i) { return makeFrame(s, g, {8, 8}, i, 0, 1000.0).views[0].eye; };
  for (const uint64_t key : {1000u, 2000u}) {
    const glm::vec3 before = (eye(key) - eye(key - 1)) * 1000.0f, after = (eye(key + 1) - eye(key)) * 1000.0f;
    EXPECT_LT(glm::distance(before, after), 0.1f) << key;
  }
}

TEST(Frame, QuaternionSignsDoNotMatter) {
  Scene s = sceneWithPath();
  const Geometry g = bounds(glm::vec3(-1), glm::vec3(1));
  const glm::mat4 expected = makeFrame(s, g, {8, 8}, 15, 0, 10.0).views[0].worldToView;
  for (size_t flip = 0; flip < 4; ++flip) {
    s.cameraPath[flip].camera.orientation = -s.cameraPath[flip].camera.orientation;
    const glm::mat4 m = makeFrame(s, g, {8, 8}, 15, 0, 10.0).views[0].worldToView;
    for (int i = 0; i < 4; ++i) EXPECT_LT(glm::distance(m[i], expected[i]), 1e-5f) << flip;
  }
}

TEST(Frame, PreviousMatrixIsTheLastFrames) {
  const Scene s = sceneWithPath();
  const Geometry g = bounds(glm::vec3(-1), glm::vec3(1));
  const Frame first = makeFrame(s, g, {64, 64}, 0, 0), second = makeFrame(s, g, {64, 64}, 1, 0);
  EXPECT_TRUE(first.cameraCut);
  EXPECT_FALSE(second.cameraCut);
  EXPECT_EQ(first.views[0].previousWorldToClip, first.views[0].worldToClip);
  EXPECT_EQ(second.views[0].previousWorldToClip, first.views[0].worldToClip);
  EXPECT_DOUBLE_EQ(second.time, 1.0 / 42.0);
  EXPECT_EQ(second.exposure, 3);
}

// A jittered view shows at the centre of a pixel what a view without jitter shows beside it. Its matrices and rays agree,
// and the previous matrix is that of the frame before, with its own jitter.
TEST(View, JitterLooksBesideThePixelCentres) {
  const Scene s = sceneWithPath();
  const Geometry g = bounds(glm::vec3(-1), glm::vec3(1));
  const glm::vec2 now(0.25f, -0.4f), before(-0.1f, 0.3f);
  for (const char* name : kViewNames) {
    const View plain = *makeFrame(s, g, {64, 48}, 15, 0).findView(name);
    View v = plain, last = *makeFrame(s, g, {64, 48}, 14, 0).findView(name);
    jitter(last, before, {});
    jitter(v, now, before);
    EXPECT_EQ(v.jitter, now);
    EXPECT_EQ(v.previousJitter, before);
    EXPECT_EQ(v.previousWorldToClip, last.worldToClip);
    const PixelRays rays = pixelRays(v);
    EXPECT_EQ(rays.eye, v.eye);
    for (const glm::vec2 pixel : {glm::vec2(0.5f, 0.5f), glm::vec2(31.5f, 20.5f), glm::vec2(63.5f, 47.5f)}) {
      EXPECT_LT(glm::distance(v.rayDirection(pixel), plain.rayDirection(pixel + now)), 1e-6f);
      const glm::vec3 onDevice = rays.corner + pixel.x * rays.right + pixel.y * rays.down;
      EXPECT_LT(glm::distance(v.rayDirection(pixel), onDevice), 1e-6f);
      const glm::vec3 ndc = project(v, v.eye + 7.0f * v.rayDirection(pixel));
      EXPECT_NEAR((ndc.x * 0.5f + 0.5f) * 64, pixel.x, 1e-3f);
      EXPECT_NEAR((ndc.y * 0.5f + 0.5f) * 48, pixel.y, 1e-3f);
      const glm::vec4 back = v.clipToWorld * glm::vec4(ndc, 1.0f);
      EXPECT_LT(glm::distance(glm::vec3(back) / back.w, v.eye + 7.0f * v.rayDirection(pixel)), 2e-3f);
    }
    View same = plain;
    jitter(same, glm::vec2(0), glm::vec2(0));
    EXPECT_EQ(same.worldToClip, plain.worldToClip);
    EXPECT_EQ(same.previousWorldToClip, plain.previousWorldToClip);
  }
}

// The places of a turn lie in the pixel, are centred on it, and fill it evenly: each half has half of them.
TEST(View, JitterFillsThePixel) {
  EXPECT_EQ(jitterAt(5, 0), glm::vec2(0));
  EXPECT_EQ(jitterAt(5, 1), glm::vec2(0));
  for (const uint32_t count : {8u, 16u}) {
    glm::vec2 sum(0);
    uint32_t left = 0, top = 0;
    for (uint32_t i = 0; i < count; ++i) {
      const glm::vec2 place = jitterAt(i, count);
      EXPECT_LT(glm::compMax(glm::abs(place)), 0.56f);
      for (uint32_t other = 0; other < i; ++other)
        EXPECT_GT(glm::distance(place, jitterAt(other, count)), 0.12f);
      EXPECT_EQ(place, jitterAt(i + 3 * count, count));
      sum += place, left += place.x < 0, top += place.y < 0;
    }
    EXPECT_LT(glm::length(sum), 1e-5f);
    EXPECT_NEAR(left, count / 2, 1);
    EXPECT_NEAR(top, count / 2, 1);
  }
}

TEST(Frame, GazeHoldsThroughBlinks) {
  Scene s;
  s.cameras.emplace_back();
  s.gaze = {{0.1f, {0.9f, 0.9f}, false},
            {0.2f, {0.25f, 0.3f}, true},
            {0.4f, {0, 0}, false},
            {0.6f, {0.7f, 0.8f}, true}};
  const Geometry g = bounds(glm::vec3(-1), glm::vec3(1));
  const auto gaze = [&](uint64_t i) { return makeFrame(s, g, {8, 8}, i, 0, 10.0).views[0].gaze; };
  EXPECT_EQ(gaze(0), glm::vec2(0.25f, 0.3f));  // before the first valid sample: that one
  EXPECT_EQ(gaze(2), glm::vec2(0.25f, 0.3f));
  EXPECT_EQ(gaze(5), glm::vec2(0.25f, 0.3f));  // blinking
  EXPECT_EQ(gaze(7), glm::vec2(0.7f, 0.8f));
  s.gaze.clear();
  EXPECT_EQ(gaze(3), glm::vec2(0.5f));
}

// 1 in the frame in which the gaze has jumped, falling to 0 over 8 frames; a later jump begins anew. A gaze that drifts
// by less than 5% of the picture from frame to frame does not jump, and neither does anything before the first frame.
TEST(Frame, SaccadesFade) {
  Scene s;
  s.cameras.emplace_back();
  s.gaze = {{0.0f, {0.2f, 0.3f}, true},
            {0.3f, {0.24f, 0.3f}, true},
            {1.0f, {0.6f, 0.3f}, true},
            {2.5f, {0.6f, 0.8f}, true},
            {2.8f, {0.1f, 0.8f}, true}};
  const Geometry g = bounds(glm::vec3(-1), glm::vec3(1));
  const auto saccade = [&](uint64_t i) { return makeFrame(s, g, {8, 8}, i, 0, 10.0).saccade; };
  for (uint64_t i = 0; i < 10; ++i) EXPECT_EQ(saccade(i), 0) << i;
  for (uint64_t i = 10; i < 18; ++i) EXPECT_EQ(saccade(i), 1 - float(i - 10) / 8) << i;
  for (uint64_t i = 18; i < 25; ++i) EXPECT_EQ(saccade(i), 0) << i;
  EXPECT_EQ(saccade(25), 1);
  EXPECT_EQ(saccade(27), 0.75f);
  EXPECT_EQ(saccade(28), 1);
  s.gaze = {{0, {0.5f, 0.5f}, true, glm::vec2(0.5f), glm::vec2(0.5f)},
            {0.375f, {0.5f, 0.5f}, true, glm::vec2(0.5f), glm::vec2(0.3f, 0.5f)}};
  EXPECT_EQ(saccade(3), 0);
  EXPECT_EQ(saccade(4), 1) << "one eye is enough";
}

TEST(Frame, EyesAreHalfTheirDistanceFromTheCamera) {
  Scene s = sceneWithPath();
  s.ipd = 0.1f;
  s.gaze = {{0, {0.25f, 0.5f}, true, glm::vec2(0.3f, 0.5f), std::nullopt}};
  const Geometry g = bounds(glm::vec3(-1), glm::vec3(1));
  const Frame before = makeFrame(s, g, {64, 64}, 14, 0, 10.0), f = makeFrame(s, g, {64, 64}, 15, 0, 10.0);
  ASSERT_EQ(f.views.size(), 5u);
  EXPECT_EQ(f.views[0].name, "main");
  const glm::mat3 axes = glm::transpose(glm::mat3(f.views[0].worldToView));
  EXPECT_LT(glm::distance(f.findView("left")->eye, f.views[0].eye - 0.05f * axes[0]), 1e-6f);
  EXPECT_LT(glm::distance(f.findView("right")->eye, f.views[0].eye + 0.05f * axes[0]), 1e-6f);
  for (const View& v : f.views) {  // parallel axes
    for (int i = 0; i < 3; ++i) EXPECT_LT(glm::distance(v.worldToView[i], f.views[0].worldToView[i]), 1e-6f);
    EXPECT_EQ(v.previousWorldToClip, before.findView(v.name)->worldToClip) << v.name;
  }
  EXPECT_EQ(f.views[0].gaze, glm::vec2(0.25f, 0.5f));
  EXPECT_EQ(f.findView("left")->gaze, glm::vec2(0.3f, 0.5f));
  EXPECT_EQ(f.findView("right")->gaze, glm::vec2(0.25f, 0.5f));
}

TEST(Frame, OnlyTheEyesLookThroughTheLens) {
  Scene s = sceneWithPath();
  const Geometry g = bounds(glm::vec3(-1), glm::vec3(1));
  const Frame without = makeFrame(s, g, {64, 64}, 15, 0, 10.0);
  s.lens = Lens{1.0f, 0.8f, 0.9f, 0.9f};
  const Frame last = makeFrame(s, g, {64, 64}, 14, 0, 10.0), f = makeFrame(s, g, {64, 64}, 15, 0, 10.0);
  EXPECT_EQ(f.views[0].worldToClip, without.views[0].worldToClip);
  EXPECT_EQ(f.findView("left")->worldToView, without.findView("left")->worldToView);
  EXPECT_NEAR(f.findView("left")->viewToClip[2][0], -f.findView("right")->viewToClip[2][0], 1e-6f);
  EXPECT_NE(f.findView("left")->viewToClip[2][0], 0);
  for (const View& v : f.views)
    EXPECT_EQ(v.previousWorldToClip, last.findView(v.name)->worldToClip) << v.name;
}

// A moment in which a camera looks along -Z through eyes with the field of view of a headset.
struct Wearing {
  Scene scene;
  Geometry geometry = bounds(glm::vec3(-5), glm::vec3(5));
  Moment moment;
  Wearing() {
    scene.lens = Lens{0.9f, 0.7f, 0.8f, 0.6f};
    scene.cameras.emplace_back();
    moment = momentAt(scene, 3, 90);
  }
  View view(const char* name, const std::optional<glm::uvec2>& inset = {}) const {
    return *makeFrame(scene, geometry, {60, 40}, moment, 1, inset).findView(name);
  }
};

TEST(Frame, EyesOfADisplayTakeThePlaceOfTheCameras) {
  Wearing w;
  const View left = w.view("left"), right = w.view("right");
  const size_t index = viewIndex("left");
  const Eye same{left.eye, glm::quat(1, 0, 0, 0), frustumOf(*w.scene.lens, true)};
  w.moment.eyes[index] = w.moment.previousEyes[index] = same;
  EXPECT_EQ(w.view("left").worldToClip, left.worldToClip);
  EXPECT_EQ(w.view("left").previousWorldToClip, left.previousWorldToClip);
  Eye moved = same;
  moved.position.y += 0.3f;
  moved.orientation = glm::angleAxis(0.2f, glm::vec3(0, 1, 0));
  w.moment.eyes[index] = moved;
  const View now = w.view("left");
  EXPECT_EQ(now.eye, moved.position);
  EXPECT_EQ(now.previousWorldToClip, left.worldToClip);  // where the eye was
  EXPECT_NE(now.worldToClip, left.worldToClip);
  EXPECT_EQ(w.view("right").worldToClip, right.worldToClip);
  EXPECT_EQ(w.view("main").eye, glm::vec3(0));
  EXPECT_THROW(viewIndex("middle"), Error);
}

TEST(Frame, InsetsShowHalfOfTheFieldAroundTheGaze) {
  Wearing w;
  for (const glm::vec2 gaze : {glm::vec2(0.5f), glm::vec2(0.6f, 0.35f), glm::vec2(0.02f, 0.97f)}) {
    w.moment.gazes.fill(gaze);
    for (const char* name : {"left", "right"}) {
      const View eye = w.view(name),
                 inset = w.view((std::string(name) + "_inset").c_str(), glm::uvec2(50, 30));
      EXPECT_EQ(inset.size, glm::uvec2(50, 30));
      EXPECT_EQ(inset.eye, eye.eye);
      EXPECT_NEAR(inset.viewToClip[0][0], 2 * eye.viewToClip[0][0], 1e-5f);
      EXPECT_NEAR(inset.viewToClip[1][1], 2 * eye.viewToClip[1][1], 1e-5f);
      // The same line of sight, and nothing that the eye does not show.
      const auto along = [](const View& v, glm::vec2 place) {
        return glm::normalize(v.rayDirection(place * glm::vec2(v.size)));
      };
      EXPECT_LT(glm::distance(along(inset, inset.gaze), along(eye, eye.gaze)), 1e-5f) << name << gaze.x;
      for (const glm::vec2 corner : {glm::vec2(0), glm::vec2(1)}) {
        const glm::vec3 seen = project(eye, eye.eye + along(inset, corner));
        EXPECT_LE(std::max(std::abs(seen.x), std::abs(seen.y)), 1 + 1e-4f);
      }
    }
  }
  EXPECT_EQ(w.view("left_inset").size, glm::uvec2(60, 40));
}

TEST(Frame, InsetsFollowTheGazeFromTheLastFrame) {
  Wearing w;
  w.moment.gazes.fill(glm::vec2(0.6f));
  w.moment.previousGazes.fill(glm::vec2(0.4f));
  const View now = w.view("left_inset");
  w.moment.gazes.fill(glm::vec2(0.4f));
  EXPECT_EQ(now.previousWorldToClip, w.view("left_inset").worldToClip);
  EXPECT_NE(now.previousWorldToClip, now.worldToClip);
  const size_t index = viewIndex("left_inset");
  w.moment.eyes[index] = Eye{glm::vec3(1), glm::quat(1, 0, 0, 0), {0.3f, 0.3f, 0.2f, 0.2f}};
  w.moment.gazes[index] = {0.1f, 0.2f};
  EXPECT_EQ(w.view("left_inset").eye, glm::vec3(1));
  EXPECT_EQ(w.view("left_inset").gaze, glm::vec2(0.1f, 0.2f));  // of a given one, in its own picture
}

TEST(Frame, FindsViewsByName) {
  Scene s;
  const Geometry g = bounds(glm::vec3(-1), glm::vec3(1));
  const Frame f = makeFrame(s, g, {8, 8}, 0, 7);
  ASSERT_NE(f.findView("main"), nullptr);
  ASSERT_NE(f.findView("left"), nullptr);
  ASSERT_NE(f.findView("right"), nullptr);
  EXPECT_EQ(f.findView("centre"), nullptr);
  EXPECT_EQ(f.seed, 7u);
  EXPECT_EQ(f.scene, &s);
}

}  // namespace
}  // namespace fovea::scene
