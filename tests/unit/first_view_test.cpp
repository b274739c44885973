// Tests what is assumed for models without camera, light and exposure.
#include "framework/scene/first_view/first_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "fovea/image.h"
#include "framework/scene/environment/sky.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "passes/path-trace/path_tracer.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

using testing::HasSubstr;

// Rooms around the origin, 4 m wide and high unless scaled, with furniture of another material on the floor.
scene::Scene room(float scale = 1) {
  scene::Scene s;
  const uint32_t wall = addMaterial(s, glm::vec3(0.6f)), wood = addMaterial(s, {0.5f, 0.3f, 0.2f});
  const uint32_t walls[6] = {wall, wall, wall, wall, wall, wall};
  addRoom(s, walls, 2 * scale);
  addQuad(s, wood, glm::vec3(-1.5f, -1.2f, -1.5f) * scale, glm::vec3(0, 0, 1) * scale,
          glm::vec3(1, 0, 0) * scale);
  return s;
}

// A box that faces outwards, on the origin.
scene::Scene box(glm::vec3 half) {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f));
  const glm::vec3 x(2 * half.x, 0, 0), y(0, 2 * half.y, 0), z(0, 0, 2 * half.z), low = -half, high = half;
  for (const auto& [corner, u, v] :
       {std::tuple(low, z, y), {high, -y, -z}, {low, x, z}, {high, -z, -x}, {low, y, x}, {high, -x, -y}})
    addQuad(s, grey, corner, u, v);
  return s;
}

// The first camera's picture by the path tracer, as displayed: 32 x 32 pixels.
struct Displayed {
  double mean = 0, clipped = 0, surfaces = 0;
};

Displayed display(const scene::Scene& s) {
  constexpr uint32_t kSize = 32;
  const scene::Geometry g = scene::flatten(s);
  const scene::Frame frame = scene::makeFrame(s, g, {kSize, kSize}, 0, 7);
  const auto rays = scene::RayScene::cached(s, g);
  std::vector<glm::vec4> radiance(size_t(kSize) * kSize);
  path_trace::tracePaths(frame, frame.views[0], *rays, {.samples = 16}, {.radiance = radiance});
  Displayed d;
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x) {
      const glm::vec3 direction = glm::normalize(frame.views[0].rayDirection(glm::vec2(x, y) + 0.5f)),
                      light(radiance[y * kSize + x]);
      d.surfaces += bool(rays->intersect({frame.views[0].eye, direction})) / double(kSize * kSize);
      d.clipped += std::max({light.r, light.g, light.b}) * s.exposure > 1 ? 1 / double(kSize * kSize) : 0;
      for (int c = 0; c < 3; ++c)
        d.mean += image::srgbEncode(std::min(light[c] * s.exposure, 1.0f)) / double(3 * kSize * kSize);
    }
  return d;
}

// Radiance that leaves a point in a direction (unit), W/(sr m^2), as a narrow camera 0.2 m away sees it.
glm::vec3 lightFrom(const scene::Scene& s, glm::vec3 point, glm::vec3 direction,
                    const path_trace::PathTraceSettings& settings) {
  const scene::Geometry g = scene::flatten(s);
  const scene::Frame frame = scene::makeFrame(s, g, {1, 1}, 0, 1);
  scene::Camera camera;
  camera.position = point + 0.2f * direction;
  camera.orientation =
      glm::quatLookAt(-direction, std::abs(direction.y) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0));
  camera.verticalFov = 0.01f;
  camera.zNear = 0.01f;
  std::vector<glm::vec4> radiance(1);
  path_trace::tracePaths(frame, scene::makeView(camera, {1, 1}, g), *scene::RayScene::cached(s, g), settings,
                         {.radiance = radiance});
  return glm::vec3(radiance[0]);
}

void expectGoodPicture(const scene::Scene& s) {
  const Displayed d = display(s);
  EXPECT_GT(d.surfaces, 0.5);
  EXPECT_GT(d.mean, 0.2);
  EXPECT_LT(d.mean, 0.7);
  EXPECT_LT(d.clipped, 0.05);
}

TEST(FirstView, RoomsAreSeenFromInside) {
  for (const float scale : {0.02f, 1.0f, 50.0f}) {
    scene::Scene s = room(scale);
    const scene::FirstView added = scene::addFirstView(s);
    EXPECT_THAT(added.camera, HasSubstr("inside")) << scale;
    const glm::vec3 eye = s.cameras.at(0).position;
    EXPECT_LT(std::max({std::abs(eye.x), std::abs(eye.y), std::abs(eye.z)}), 2 * scale);
    EXPECT_GT(eye.y, -1.9f * scale);
    EXPECT_LT(s.cameras[0].zNear, 0.1f * scale);
    EXPECT_EQ(added.light, "a lamp");  // no sun shines into it
    expectGoodPicture(s);
  }
}

TEST(FirstView, RoomsOfMetresAreSeenFromTheHeightOfAnEye) {
  scene::Scene s = room();
  scene::addFirstCamera(s, scene::flatten(s));
  EXPECT_NEAR(s.cameras.at(0).position.y, -2 + 1.6f, 0.85f);  // on the floor, or on the table
}

TEST(FirstView, ThingsAreSeenAsAWhole) {
  for (const glm::vec3 half : {glm::vec3(1), glm::vec3(0.01f), glm::vec3(300, 100, 200),
                               glm::vec3(0.2f, 1, 0.2f), glm::vec3(1, 0.02f, 1)}) {
    scene::Scene s = box(half);
    const scene::Geometry g = scene::flatten(s);
    const scene::FirstView added = scene::addFirstView(s);
    EXPECT_THAT(added.camera, HasSubstr("whole"));
    EXPECT_EQ(added.light, "a sun and a sky");
    const scene::View view = scene::makeView(s.cameras.at(0), {64, 64}, g);
    float widest = 0;
    for (const glm::vec3& p : g.positions) {
      const glm::vec4 clip = view.worldToClip * glm::vec4(p, 1);
      ASSERT_GT(clip.w, s.cameras[0].zNear);
      widest = std::max({widest, std::abs(clip.x / clip.w), std::abs(clip.y / clip.w)});
    }
    EXPECT_GT(widest, 0.85f);
    EXPECT_LE(widest, 1.0f);
    EXPECT_GT(display(s).mean, 0.2);
    EXPECT_LT(display(s).clipped, 0.05);
  }
}

// Their walls are shown from both sides, so that it is no matter on which one stands; unless there is something inside.
TEST(FirstView, ClosedBoxesAreSeenFromOutside) {
  scene::Scene crate = box(glm::vec3(1)), slab = box({20, 0.5f, 20}), furnished = box(glm::vec3(2));
  addQuad(furnished, addMaterial(furnished, {0.5f, 0.3f, 0.2f}), {-1.5f, -2, -1}, {3, 0, 0}, {0, 2.5f, 0});
  furnished.materials[1].doubleSided = true;
  for (scene::Scene* s : {&crate, &slab, &furnished}) {
    s->materials[0].doubleSided = true;
    EXPECT_THAT(scene::addFirstView(*s).camera, HasSubstr(s == &furnished ? "inside" : "whole"));
    expectGoodPicture(*s);
  }
}

// What moves stays in the picture in the course of its animation.
TEST(FirstView, ThingsAreSeenWhereverTheyMove) {
  scene::Scene s = box(glm::vec3(0.5f));
  for (scene::Node& node : s.nodes) node.dynamic = true;
  scene::Animation swing;
  swing.plays = true;
  for (uint32_t node = 0; node < s.nodes.size(); ++node)
    swing.channels.push_back({node,
                              scene::AnimationChannel::Path::Translation,
                              scene::AnimationChannel::Interpolation::Linear,
                              {0, 1, 2},
                              {0, 0, 0, 2, 3, 0, 0, 0, 0}});
  s.animations.push_back(swing);
  scene::addFirstView(s);
  scene::Geometry g = scene::flatten(s);
  for (const double time : {0.0, 0.5, 1.0, 1.5}) {
    scene::Moment moment;
    moment.time = moment.before = time;
    moment.camera = moment.previousCamera = s.cameras[0];
    const scene::Frame frame = scene::makeFrame(s, g, glm::uvec2(64), moment, 1);
    scene::moveObjects(frame, g);
    for (const scene::Triangle& triangle : g.triangles)
      for (const uint32_t v : triangle.v) {
        if (triangle.material() != 0) continue;  // of the floor
        const glm::vec4 clip = frame.views[0].worldToClip * glm::vec4(g.positions[v], 1);
        EXPECT_LE(std::max(std::abs(clip.x), std::abs(clip.y)), clip.w) << time;
      }
  }
}

// A pole, a needle of two millimetres and a wall as long as a town.
TEST(FirstView, AFloorFillsThePictureOfThinThings) {
  for (const glm::vec3 half :
       {glm::vec3(0.02f, 1, 0.02f), glm::vec3(2e-5f, 1e-3f, 2e-5f), glm::vec3(900, 2, 30)}) {
    scene::Scene s = box(half);
    EXPECT_EQ(scene::addFirstView(s).floor, "a floor");
    EXPECT_TRUE(s.assumedFloor);
    const scene::Node& floor = s.nodes.back();
    EXPECT_LT(floor.translation.y, -half.y);
    EXPECT_NEAR(floor.translation.y, -half.y, 1e-3f * glm::length(half));
    EXPECT_GE(floor.scale.x, glm::length(glm::vec2(half.x, half.z)));
    EXPECT_EQ(s.materials[s.meshes[floor.mesh].primitives[0].material].name, "floor");
    expectGoodPicture(s);
  }
}

TEST(FirstView, NoFloorWhereThereIsEnoughToSee) {
  scene::Scene inside = room(), ground = box({1, 0.01f, 1});
  scene::Camera down;
  down.position = {0, 2, 0};
  down.orientation = glm::angleAxis(-1.5f, glm::vec3(1, 0, 0));
  ground.cameras.push_back(down);
  for (scene::Scene* s : {&inside, &ground}) {
    EXPECT_EQ(scene::addFirstView(*s).floor, "");
    EXPECT_FALSE(s->assumedFloor);
  }
}

TEST(FirstView, ACameraOfTheModelStays) {
  scene::Scene s = box(glm::vec3(1));
  scene::Camera camera;
  camera.position = {0, 0, 9};
  s.cameras.push_back(camera);
  const scene::FirstView added = scene::addFirstView(s);
  EXPECT_EQ(added.camera, "");
  EXPECT_EQ(added.floor, "");
  EXPECT_EQ(s.cameras.size(), 1u);
  EXPECT_EQ(s.cameras[0].position, camera.position);
}

TEST(FirstView, LightOfTheModelStaysAloneIfItIsEnough) {
  for (const float lux : {1e-3f, 1.0f, 2049.0f, 1e5f}) {
    scene::Scene s = box(glm::vec3(1));
    scene::Light sun;
    sun.intensity = lux;
    sun.direction = glm::normalize(glm::vec3(-0.3f, -1, -0.8f));
    s.lights.push_back(sun);
    EXPECT_EQ(scene::addFirstView(s).light, "") << lux;
    EXPECT_EQ(s.lights.size(), 1u);
    expectGoodPicture(s);
  }
}

// A spot light of the model is enough if it lights a tenth of what the camera sees, as on a stage. If it lights less, a
// sun and a sky are added.
TEST(FirstView, ASpotLightOfTheModelMayLeaveMostInTheDark) {
  for (const float radius : {0.3f, 1.2f}) {
    scene::Scene s;
    addQuad(s, addMaterial(s, glm::vec3(0.6f)), {-2, -2, 0}, {4, 0, 0}, {0, 4, 0});
    scene::Light spot;
    spot.type = scene::LightType::Spot;
    spot.position = {0, 0, 4};
    spot.direction = {0, 0, -1};
    spot.innerConeAngle = spot.outerConeAngle = std::atan(radius / 4);
    spot.intensity = 30;
    s.lights.push_back(spot);
    scene::Camera camera;
    camera.position = {0, 0, 5};
    camera.verticalFov = 2 * std::atan(0.4f);  // the wall, and nothing beside it
    s.cameras.push_back(camera);
    EXPECT_EQ(scene::addFirstView(s).light, radius < 1 ? "a sun and a sky" : "") << radius;
  }
}

// The sky stands where its sun does, and its ground looks like the floor that is added: of what the eye sees of both,
// in the sun and far from the thing, one is as bright as the other.
TEST(FirstView, TheGroundContinuesTheFloor) {
  scene::Scene s = box({0.02f, 1, 0.02f});
  EXPECT_EQ(scene::addFirstView(s).light, "a sun and a sky");
  ASSERT_TRUE(s.assumedSky && s.environmentMap && s.lights.size() == 1);
  EXPECT_LT(glm::distance(s.lights[0].direction, -scene::towardsSun(*s.assumedSky)), 1e-6f);
  EXPECT_LE(std::abs(s.assumedSky->sunAzimuth), glm::pi<float>() + 1e-6f);
  const scene::Node& floor = s.nodes.back();
  const glm::vec3 sunwards(-s.lights[0].direction.x, 0, -s.lights[0].direction.z), up(0, 1, 0);
  const glm::vec3 point = floor.translation + 0.9f * floor.scale.x * sunwards,
                  light = lightFrom(s, point, up, {.depth = 3, .samples = 4096}),
                  ground = s.environmentMap->radiance(-up);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c], ground[c], 0.02f * ground[c]);
  // With full materials the floor has no highlight, not even where the sun would be mirrored.
  const glm::vec3 mirrored = glm::reflect(s.lights[0].direction, up);
  const glm::vec3 matt = lightFrom(s, point, mirrored, {.depth = 3, .samples = 4096}),
                  full = lightFrom(s, point, mirrored, {.depth = 3, .samples = 4096, .full = true});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(full[c], matt[c], 0.02f * matt[c]);
}

// A given environment is never replaced. If it does not suffice, as this black one, there is a lamp.
TEST(FirstView, AGivenEnvironmentStays) {
  scene::Scene s = box(glm::vec3(1));
  s.environmentMap = std::make_shared<scene::EnvironmentMap>(4, 2, std::vector<glm::vec3>(8, glm::vec3(0)));
  const auto given = s.environmentMap;
  EXPECT_EQ(scene::addFirstView(s).light, "a lamp");
  EXPECT_EQ(s.environmentMap, given);
  EXPECT_FALSE(s.assumedSky);
}

// Metals reflect the sky, and unlit materials show their colour as it is: neither is black.
TEST(FirstView, MetalsAndUnlitMaterialsAreExposedForWhatTheyShow) {
  scene::Scene matt = box(glm::vec3(1)), metal = box(glm::vec3(1)), unlit = box(glm::vec3(1));
  for (scene::Material& m : metal.materials) m.metallic = 1;
  for (scene::Material& m : unlit.materials) m.unlit = true;
  scene::addFirstView(matt);
  scene::addFirstView(metal);
  EXPECT_NEAR(metal.exposure / matt.exposure, 1, 0.3);
  EXPECT_EQ(scene::addFirstView(unlit).light, "a sun and a sky");  // for the floor, which would be black
  EXPECT_LT(unlit.exposure, 1);                                    // a radiance of 0.5 needs no more
  EXPECT_GT(unlit.exposure, 0.2f);
}

// Things that fill the picture stand on a floor as well, on which their shadow falls.
TEST(FirstView, AFloorCatchesTheShadowOfBulkyThings) {
  for (const glm::vec3 half : {glm::vec3(1), glm::vec3(0.01f), glm::vec3(1, 3, 1)}) {
    scene::Scene s = box(half);
    scene::addFirstView(s);
    ASSERT_TRUE(s.assumedFloor && s.assumedSky);
    const scene::Node& floor = s.nodes.back();
    const glm::vec3 sun = scene::towardsSun(*s.assumedSky), top(0, half.y, 0);
    const glm::vec3 shadow = top - sun * ((half.y - floor.translation.y) / sun.y);
    EXPECT_LT(glm::length(glm::vec2(shadow.x, shadow.z)), floor.scale.x);
  }
}

// Surfaces that light themselves would stand on a black floor. Lamps of the model may leave it in the dark.
TEST(FirstView, EmissiveThingsStandOnAFloorThatIsLit) {
  scene::Scene s = box(glm::vec3(1)), lamp = box(glm::vec3(1));
  for (scene::Scene* scene : {&s, &lamp})
    for (scene::Material& m : scene->materials) m.emission = glm::vec3(0.5f);
  scene::Light spot;
  spot.type = scene::LightType::Spot;
  spot.position = {0, 2, 0};
  spot.direction = {0, 1, 0};
  lamp.lights.push_back(spot);
  EXPECT_EQ(scene::addFirstView(s).light, "a sun and a sky");
  EXPECT_EQ(scene::addFirstView(lamp).light, "");
}

// The light of an emissive lamp in a box is the author's; the floor outside, which it does not reach, is left out.
TEST(FirstView, AnEmissiveLampThatLightsTheModelStaysAlone) {
  scene::Scene s = box({1, 0.01f, 1});
  const uint32_t emissive = addMaterial(s, glm::vec3(0)), black = addMaterial(s, glm::vec3(0));
  s.materials[emissive].emission = glm::vec3(5);
  s.materials[black].doubleSided = true;
  addQuad(s, emissive, {-0.3f, 1.2f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f});  // faces the plate
  addQuad(s, black, {-0.4f, 1.21f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f});
  EXPECT_EQ(scene::addFirstView(s).light, "");
}

// A plate under a spot light that does not reach past its edges: the floor would only be a black disc.
TEST(FirstView, NoFloorWhereTheLampsOfTheModelDoNotReach) {
  scene::Scene s = box({1, 0.01f, 1});
  scene::Light spot;
  spot.type = scene::LightType::Spot;
  spot.position = {0, 2, 0};
  spot.direction = {0, -1, 0};
  spot.innerConeAngle = 0.43f;
  spot.outerConeAngle = 0.44f;
  s.lights.push_back(spot);
  const size_t nodes = s.nodes.size(), materials = s.materials.size();
  const scene::FirstView added = scene::addFirstView(s);
  EXPECT_EQ(added.light, "");
  EXPECT_EQ(added.floor, "");
  EXPECT_FALSE(s.assumedFloor);
  EXPECT_EQ(s.nodes.size(), nodes);
  EXPECT_EQ(s.materials.size(), materials);
}

// A sun reaches what stands under glass.
TEST(FirstView, GlassDoesNotHideTheSun) {
  scene::Scene s = room();
  scene::Material glass;
  glass.transmission = 1;
  s.materials.push_back(glass);
  for (const scene::Node& node : s.nodes)
    for (scene::Primitive& p : s.meshes[node.mesh].primitives)
      if (std::ranges::all_of(p.positions, [](glm::vec3 v) { return v.y > 1.9f; })) p.material = 2;
  EXPECT_EQ(scene::addFirstView(s).light, "a sun and a sky");
}

// A garden at night, with a lantern that lights next to nothing of it.
TEST(FirstView, ASunHelpsWhereALanternDoesNot) {
  scene::Scene s = box({10, 0.5f, 10});
  const uint32_t emissive = addMaterial(s, glm::vec3(0));
  s.materials[emissive].emission = glm::vec3(20);
  addQuad(s, emissive, {3, 1, 0}, {0.1f, 0, 0}, {0, 0.1f, 0});
  EXPECT_EQ(scene::addFirstView(s).light, "a sun and a sky");
  expectGoodPicture(s);
}

// A closed room of 4 m, whose camera at one wall looks at the opposite one, with a square of this radiance.
struct Glowing {
  glm::vec3 centre, halfU, halfV;  // the square faces cross(halfU, halfV)
  float radiance;
};
scene::Scene roomLitBy(const Glowing& g) {
  scene::Scene s = room();
  const uint32_t emissive = addMaterial(s, glm::vec3(0));
  s.materials[emissive].emission = glm::vec3(g.radiance);
  addQuad(s, emissive, g.centre - g.halfU - g.halfV, 2.0f * g.halfU, 2.0f * g.halfV);
  scene::Camera camera;
  camera.position = {0, 0, 1.9f};
  camera.verticalFov = 1.2f;
  s.cameras.push_back(camera);
  return s;
}

constexpr glm::vec3 kAlongX(1, 0, 0), kAlongY(0, 1, 0), kAlongZ(0, 0, 1);

// Below the ceiling, in view and far brighter than the walls; as dim as a screen; behind the camera.
TEST(FirstView, EmissiveSurfacesThatLightARoomAreItsLamps) {
  for (const Glowing& g : {Glowing{{0, 1.95f, 0}, 0.5f * kAlongX, 0.5f * kAlongZ, 10},
                           {{0, 1.95f, 0}, 0.5f * kAlongX, 0.5f * kAlongZ, 1},
                           {{0, 1.95f, 0}, 0.5f * kAlongX, 0.5f * kAlongZ, 0.01f},
                           {{0, 1.95f, 0}, 0.05f * kAlongX, 0.05f * kAlongZ, 2000},
                           {{0, 0, 1.95f}, 0.5f * kAlongY, 0.5f * kAlongX, 10},
                           {{-1.95f, 0, 0}, 1.5f * kAlongY, 0.2f * kAlongZ, 3},
                           {{0, 0, -1.95f}, kAlongX, kAlongY, 1}}) {
    scene::Scene s = roomLitBy(g);
    EXPECT_EQ(scene::addFirstView(s).light, "") << g.radiance << " at " << g.centre.x << " " << g.centre.y;
    EXPECT_TRUE(s.lights.empty());
    EXPECT_GT(s.exposure, 0);
  }
}

// The frame of a picture that glows, a screen in standby, and a panel that faces the wall behind it.
TEST(FirstView, EmissiveSurfacesThatLightNothingAreNoLamps) {
  for (const Glowing& g : {Glowing{{0, 0, -1.95f}, 0.15f * kAlongX, 0.2f * kAlongY, 1},
                           {{0, 0, -1.95f}, 0.15f * kAlongX, 0.2f * kAlongY, 0.02f},
                           {{1, -1, -1.95f}, 0.02f * kAlongX, 0.02f * kAlongY, 1},
                           {{0, 0, -1.998f}, 0.5f * kAlongY, 0.5f * kAlongX, 10}}) {
    scene::Scene s = roomLitBy(g);
    EXPECT_EQ(scene::addFirstView(s).light, "a lamp")
        << g.radiance << " at " << g.centre.x << " " << g.centre.y;
  }
}

// Lamps beyond a wall light nothing in view; those of a room do, however much brighter an emissive panel looks.
TEST(FirstView, LampsCountWhereTheirLightArrives) {
  scene::Light bulb;
  bulb.type = scene::LightType::Point;
  bulb.intensity = 50;
  scene::Scene other = roomLitBy({{0, 0, -1.95f}, 0.1f * kAlongX, 0.1f * kAlongY, 0});
  bulb.position = {0, 0, -3};
  other.lights.push_back(bulb);
  EXPECT_EQ(scene::addFirstView(other).light, "a lamp");
  scene::Scene lit = roomLitBy({{0, 0, -1.95f}, 0.3f * kAlongX, 0.3f * kAlongY, 1000});
  bulb.position = {0, 1.5f, 0};
  bulb.intensity = 1;
  lit.lights.push_back(bulb);
  EXPECT_EQ(scene::addFirstView(lit).light, "");
}

// A room with a window, before which there is a sky; and one whose window is as small as a keyhole.
TEST(FirstView, AnEnvironmentLightsRoomsThroughWindows) {
  for (const bool wide : {true, false}) {
    scene::Scene s;
    const uint32_t wall = addMaterial(s, glm::vec3(0.6f));
    const uint32_t walls[6] = {wall, wall, wall, wall, wall, wall};
    addRoom(s, walls, 2);
    for (const scene::Node& node : s.nodes)
      for (scene::Primitive& p : s.meshes[node.mesh].primitives)
        if (std::ranges::all_of(p.positions, [](glm::vec3 v) { return v.x < -1.9f; }))
          for (glm::vec3& v : p.positions) v.y = wide ? v.y < 0 ? v.y : 0.4f : v.y < 1.9f ? v.y : 1.998f;
    s.environmentMap = std::make_shared<scene::EnvironmentMap>(4, 2, std::vector<glm::vec3>(8, glm::vec3(1)));
    scene::Camera camera;
    camera.position = {0, 0, 1.9f};
    camera.verticalFov = 1.2f;
    s.cameras.push_back(camera);
    EXPECT_EQ(scene::addFirstView(s).light, wide ? "" : "a lamp");
  }
}

// A dim wall with a lamp on it, which fills 3% of the picture and is fifty times as bright.
TEST(FirstView, DarkRoomsAreExposedForWhatIsDark) {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), emissive = addMaterial(s, glm::vec3(0));
  s.materials[emissive].emission = glm::vec3(25 * glm::one_over_pi<float>());
  addQuad(s, grey, {-3, -3, 0}, {6, 0, 0}, {0, 6, 0});
  addQuad(s, emissive, {-0.17f, -0.17f, 0.001f}, {0.346f, 0, 0}, {0, 0.346f, 0});
  scene::Camera camera;
  camera.position = {0, 0, 1};
  camera.verticalFov = glm::half_pi<float>();
  s.cameras.push_back(camera);
  scene::Light dim;
  dim.direction = {0, 0, -1};
  s.lights.push_back(dim);
  s.exposure = scene::firstExposure(s, scene::flatten(s));
  expectGoodPicture(s);
}

TEST(FirstView, NothingToLookAt) {
  scene::Scene s;
  s.materials.emplace_back();
  scene::addFirstView(s);
  EXPECT_EQ(s.cameras.size(), 1u);
  EXPECT_EQ(s.exposure, 1);
}

}  // namespace
}  // namespace fovea::test
