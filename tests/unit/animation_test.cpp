// Tests animations: channels against closed forms, skins and morph targets against a plain reference.
#include "framework/scene/motion/animation.h"
#include "framework/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "framework/scene/frame.h"
#include "framework/scene/motion/deform.h"
#include "framework/scene/motion/motion.h"
#include "framework/scene/subdivision/subdivision.h"
#include "scene_support.h"
#include "tests/support/deform_reference.h"
#include "tests/support/shapes.h"

namespace fovea::scene {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;
using testing::AllOf;
using testing::HasSubstr;

AnimationChannel channel(Path path, Interpolation interpolation, std::vector<float> times,
                         std::vector<float> values) {
  return {0, path, interpolation, std::move(times), std::move(values)};
}

std::vector<float> sample(const AnimationChannel& c, float time) {
  std::vector<float> value(componentsOf(c));
  sampleChannel(c, time, value);
  return value;
}

TEST(Animation, StepHoldsAndLinearRunsStraight) {
  const std::vector<float> times = {1, 2, 4}, values = {0, 0, 0, 2, 4, 6, 2, 0, 2};
  const AnimationChannel step = channel(Path::Translation, Interpolation::Step, times, values);
  const AnimationChannel linear = channel(Path::Translation, Interpolation::Linear, times, values);
  EXPECT_EQ(sample(step, 0), (std::vector<float>{0, 0, 0}));
  EXPECT_EQ(sample(step, 1.99f), (std::vector<float>{0, 0, 0}));
  EXPECT_EQ(sample(step, 2), (std::vector<float>{2, 4, 6}));
  EXPECT_EQ(sample(step, 9), (std::vector<float>{2, 0, 2}));
  EXPECT_EQ(sample(linear, 0), (std::vector<float>{0, 0, 0}));
  EXPECT_EQ(sample(linear, 1.5f), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(sample(linear, 3.5f), (std::vector<float>{2, 1, 3}));
  EXPECT_EQ(sample(linear, 4), (std::vector<float>{2, 0, 2}));
}

// A cubic is its own Hermite spline.
TEST(Animation, CubicSplinesReproduceACubic) {
  const auto f = [](float t) { return 2 - 3 * t + t * t - 0.5f * t * t * t; };
  const auto slope = [](float t) { return -3 + 2 * t - 1.5f * t * t; };
  AnimationChannel c = channel(Path::Weights, Interpolation::CubicSpline, {0.5f, 1, 3}, {});
  for (float t : c.times) c.values.insert(c.values.end(), {slope(t), f(t), slope(t)});
  ASSERT_EQ(componentsOf(c), 1u);
  for (float t = 0.5f; t <= 3; t += 0.0625f) EXPECT_NEAR(sample(c, t)[0], f(t), 2e-6f) << t;
}

TEST(Animation, RotationsTurnEvenlyTheShorterWay) {
  const auto turned = [](float deg) {
    return std::array{0.0f, std::sin(glm::radians(deg) / 2), 0.0f, std::cos(glm::radians(deg) / 2)};
  };
  const auto a = turned(10), b = turned(130);
  // The second key is the same rotation with all signs changed.
  const AnimationChannel c = channel(Path::Rotation, Interpolation::Linear, {0, 2},
                                     {a[0], a[1], a[2], a[3], -b[0], -b[1], -b[2], -b[3]});
  for (float t = 0; t <= 2; t += 0.25f) {
    const std::vector<float> q = sample(c, t);
    const auto expected = turned(10 + 60 * t);
    const float sign = q[3] < 0 ? -1.0f : 1.0f;
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(sign * q[i], expected[i], 1e-6f) << t;
  }
}

TEST(Animation, RepeatsAsToldAndAtItsSpeed) {
  Animation a;
  a.channels = {channel(Path::Scale, Interpolation::Linear, {0.5f, 2}, {1, 1, 1, 2, 2, 2})};
  a.speed = 2;
  EXPECT_EQ(duration(a), 2);
  EXPECT_FLOAT_EQ(animationTime(a, 0.75), 1.5f);
  EXPECT_FLOAT_EQ(animationTime(a, 1.25), 0.5f);
  EXPECT_FLOAT_EQ(animationTime(a, 1000.25), 0.5f);
  a.repeat = Repeat::PingPong;
  EXPECT_FLOAT_EQ(animationTime(a, 1.25), 1.5f);
  a.repeat = Repeat::Once;
  EXPECT_FLOAT_EQ(animationTime(a, 1.25), 2.5f);
}

// ---- Files ------------------------------------------------------------------------------------------------

double sizeOf(const Geometry& g) { return glm::length(g.boundsMax - g.boundsMin); }

// Compares the frame's vertices with the reference at several times and checks that they are inside the bounds.
void compareWithReference(const std::filesystem::path& file, std::initializer_list<double> times,
                          size_t leastDynamic) {
  Diagnostics warnings;
  const Scene s = loadGltf(file, warnings);
  Geometry g = flatten(s);
  ASSERT_GT(g.triangles.size() - g.staticTriangles, leastDynamic) << warnings.format();
  const float slack = 1e-4f * float(sizeOf(g));
  for (double time : times) {
    moveObjects(makeFrame(s, g, {8, 8}, 1, 1, 1.0 / time), g);
    EXPECT_LT(test::deformError(s, g, time, sizeOf(g)), 1e-5) << file << " at " << time;
    for (const glm::vec3& p : g.positions)
      for (int c = 0; c < 3; ++c)
        ASSERT_TRUE(p[c] >= g.boundsMin[c] - slack && p[c] <= g.boundsMax[c] + slack) << file << time;
  }
}

TEST(Animation, NodesOfAllInterpolations) {
  FOVEA_NEED_SCENES(root);
  compareWithReference(root / "conformance/valid/own/interpolation.gltf",
                       {0.1, 0.25, 0.6, 0.99, 1.3, 1.8, 2.2, 2.45}, 100);
}

TEST(Animation, SkinsFollowTheirJoints) {
  FOVEA_NEED_SCENES(root);
  compareWithReference(root / "conformance/valid/own/skin_two_arms.glb", {0.3, 1.0, 1.7}, 100);
  compareWithReference(root / "conformance/valid/bevy/SimpleSkin.gltf", {0.4, 2.6}, 5);
  compareWithReference(root / "conformance/valid/CesiumMan/glTF-Binary/CesiumMan.glb", {0.2, 0.9, 1.71},
                       4000);
}

TEST(Animation, MorphTargetsAddUp) {
  FOVEA_NEED_SCENES(root);
  compareWithReference(root / "conformance/valid/own/sparse_morph.gltf", {0.4, 1.0, 1.6}, 10);
  compareWithReference(root / "conformance/valid/bevy/MorphStressTest.gltf", {0.8, 3.1, 7.7}, 1000);
}

TEST(Animation, LargeModels) {
  FOVEA_NEED_SCENES(root);
  if (!std::filesystem::exists(root / "pigman/pigman.glb")) GTEST_SKIP() << "pigman is not here";
  compareWithReference(root / "pigman/pigman.glb", {0.33, 1.1}, 20000);
  compareWithReference(root / "neko_diorama/neko_diorama.gltf", {0.7, 5.3}, 4);
}

// A cage in a file, whose morph target an animation moves.
TEST(Animation, ACageOfAFileDeforms) {
  test::TriangleDocument d;
  test::appendBytes<float>(d.bytes, {0, 1, 0, 1});  // 44: times, then weights
  d.accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
      {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
      {"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR"},
      {"bufferView":3,"componentType":5126,"count":2,"type":"SCALAR"}])";
  d.views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},
      {"buffer":0,"byteOffset":44,"byteLength":8},{"buffer":0,"byteOffset":52,"byteLength":8}])";
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"targets":[{"POSITION":0}],
      "extras":{"fovea_subdivision":{"scheme":"loop","level":1}}})";
  d.extra = R"(,"animations":[{"samplers":[{"input":2,"output":3}],
      "channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}]}])";
  test::TemporaryFolder folder;
  Diagnostics warnings;
  Scene s;
  try {
    s = test::loadText(folder, d.json(), warnings);
  } catch (const Error& e) {
    if (std::string(e.what()).find("OpenSubdiv") == std::string::npos) throw;
    GTEST_SKIP() << e.what();
  }
  Geometry g = flatten(s);
  const Geometry rest = g;
  ASSERT_EQ(g.objects.size(), 2u) << warnings.format();
  EXPECT_TRUE(g.objects[1].stencils);
  // The target displaces by the position itself, so at weight 0.5 everything is half as large again.
  moveObjects(makeFrame(s, g, {8, 8}, 1, 1, 2.0), g);
  for (size_t v = 0; v < g.positions.size(); ++v)
    EXPECT_LT(glm::distance(g.positions[v], 1.5f * rest.positions[v]), 1e-6f);
}

// The effect of the file's first target is known: its twelve displaced vertices rise by the weight.
TEST(Animation, SparseMorphInClosedForm) {
  FOVEA_NEED_SCENES(root);
  Diagnostics warnings;
  const Scene s = loadGltf(root / "conformance/valid/own/sparse_morph.gltf", warnings);
  ASSERT_EQ(s.meshes[0].primitives[0].targets.size(), 2u);
  EXPECT_EQ(s.meshes[0].weights, (std::vector<float>{0.5f, 0}));
  size_t raised = 0;
  for (const glm::vec3& d : s.meshes[0].primitives[0].targets[0].positions) {
    EXPECT_TRUE(d == glm::vec3(0) || d == glm::vec3(0, 1, 0));
    raised += d.y > 0;
  }
  EXPECT_EQ(raised, 12u);
}

// A morph target on a cage moves the control points; the surface is that of the moved cage.
TEST(Animation, CagesAreBentBeforeTheyAreRefined) {
  Scene s;
  test::addMaterial(s, glm::vec3(0.5f));
  auto cage = std::make_shared<SubdivisionCage>();
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) cage->positions.emplace_back(x, y, 0);
  for (uint32_t y = 0; y < 3; ++y)
    for (uint32_t x = 0; x < 3; ++x) {
      const uint32_t v = 4 * y + x;
      cage->faceSizes.push_back(4);
      cage->faceVertices.insert(cage->faceVertices.end(), {v, v + 1, v + 5, v + 4});
    }
  MorphTarget wave;
  for (int i = 0; i < 16; ++i) wave.positions.emplace_back(0, 0.1f * float(i % 3), std::sin(float(i)));
  cage->targets = {wave};
  SubdivisionCage bent = *cage;
  for (size_t i = 0; i < 16; ++i) bent.positions[i] += 0.75f * wave.positions[i];
  s.meshes.push_back({"cloth", {}, {}, cage});
  Node node;
  node.mesh = 0;
  node.translation = {1, 2, 3};
  node.scale = {2, 1, -1};  // mirrored
  s.nodes = {node};
  Animation a;
  a.plays = true;
  a.channels = {channel(Path::Weights, Interpolation::Linear, {0, 1}, {0, 1})};
  s.animations = {a};
  std::vector<Primitive> expected;
  try {
    refineCages(s);
    expected = refine(bent);
  } catch (const Error& e) {
    GTEST_SKIP() << e.what();  // built without OpenSubdiv
  }
  Geometry g = flatten(s);
  ASSERT_EQ(g.objects.size(), 2u);
  EXPECT_TRUE(g.objects[1].deforms);
  moveObjects(makeFrame(s, g, {8, 8}, 3, 1, 4.0), g);
  ASSERT_EQ(g.objects[1].vertexCount, expected[0].positions.size());
  for (size_t i = 0; i < expected[0].positions.size(); ++i) {
    const uint32_t v = g.objects[1].firstVertex + uint32_t(i);
    const glm::vec3 p = expected[0].positions[i] * node.scale + node.translation;
    EXPECT_LT(glm::distance(g.positions[v], p), 1e-5f) << i;
    EXPECT_LT(glm::distance(g.normals[v], glm::normalize(expected[0].normals[i] / node.scale)), 1e-4f) << i;
  }
}

TEST(Animation, ALightGoesWithItsNode) {
  FOVEA_NEED_SCENES(root);
  Diagnostics warnings;
  const Scene s = loadGltf(root / "conformance/valid/own/lights_punctual.gltf", warnings);
  ASSERT_EQ(s.animations.size(), 1u);
  ASSERT_EQ(s.animations[0].channels.size(), 1u);
  bool moved = false;
  test::DeformReference reference(s, 1.3);
  const std::vector<Light> lights = lightsAt(s, 1.3);
  for (uint32_t i = 0; i < s.nodes.size(); ++i) {
    if (s.nodes[i].light == kNoIndex) continue;
    const Light& l = lights[s.nodes[i].light];
    EXPECT_LT(glm::distance(glm::dvec3(l.position), glm::dvec3(reference.world(i)[3])), 1e-4) << l.name;
    moved = moved || glm::distance(l.position, s.lights[s.nodes[i].light].position) > 0.1f;
  }
  EXPECT_TRUE(moved);
}

// A camera on a turned child of a node that flies and turns; it is used if there is no path and only if it is
// the first one.
TEST(Animation, ACameraGoesWithItsNode) {
  Scene s;
  s.nodes.resize(2);
  s.nodes[1].parent = 0;
  s.nodes[1].translation = {0, 1, 0};
  s.nodes[1].camera = 0;
  s.cameras.resize(2);
  s.cameras[0].position = {0, 1, 0};
  s.cameras[0].verticalFov = 0.7f;
  const float half = std::sqrt(0.5f);
  Animation fly;
  fly.plays = true;
  fly.repeat = Repeat::Once;
  fly.channels = {{0,
                   AnimationChannel::Path::Translation,
                   AnimationChannel::Interpolation::Linear,
                   {0, 2},
                   {0, 0, 0, 4, 0, 0}},
                  {0,
                   AnimationChannel::Path::Rotation,
                   AnimationChannel::Interpolation::Linear,
                   {0, 2},
                   {0, 0, 0, 1, 0, half, 0, half}}};
  s.animations = {fly};
  const Camera c = cameraAt(s, 1);
  EXPECT_LT(glm::distance(c.position, glm::vec3(2, 1, 0)), 1e-5f);
  const glm::vec3 ahead =
      c.orientation * glm::vec3(0, 0, -1);  // a quarter turn to the left in all, half of it now
  EXPECT_LT(glm::distance(ahead, glm::vec3(-half, 0, -half)), 1e-5f);
  EXPECT_EQ(c.verticalFov, 0.7f);
  s.nodes[1].camera = 1;
  EXPECT_EQ(cameraAt(s, 1).position, s.cameras[0].position);
  s.nodes[1].camera = 0;
  s.cameraPath = {{0, s.cameras[1]}};
  EXPECT_EQ(cameraAt(s, 1).position, s.cameras[1].position);
}

// ---- Errors -----------------------------------------------------------------------------------------------

test::TriangleDocument animatedTriangle() {
  test::TriangleDocument d;
  test::appendBytes<float>(d.bytes, {0, 1});              // 44: times
  test::appendBytes<float>(d.bytes, {0, 0, 0, 1, 2, 3});  // 52: translations
  d.accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
      {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
      {"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR"},
      {"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}])";
  d.views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},
      {"buffer":0,"byteOffset":44,"byteLength":8},{"buffer":0,"byteOffset":52,"byteLength":24}])";
  d.extra = R"(,"animations":[{"name":"hop","samplers":[{"input":2,"output":3}],
      "channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}])";
  return d;
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

TEST(AnimationErrors, SayWhatIsWrong) {
  test::TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = test::loadText(folder, animatedTriangle().json(), warnings);
  ASSERT_EQ(s.animations.size(), 1u);
  EXPECT_TRUE(s.animations[0].plays);
  EXPECT_EQ(flatten(s).objects.size(), 2u);
  const auto broken = [](const std::string& from, const std::string& to) {
    std::string text = animatedTriangle().json();
    replace(text, from, to);
    return test::warningsOfText(text);
  };
  EXPECT_THAT(broken(R"("componentType":5126,"count":2,"type":"SCALAR")",
                     R"("componentType":5126,"count":0,"type":"SCALAR")"),
              AllOf(HasSubstr("model.gltf"), HasSubstr("accessors[2]")));
  EXPECT_THAT(
      broken(R"("samplers":[{"input":2,"output":3}])", R"("samplers":[])"),
      AllOf(HasSubstr("model.gltf:"), HasSubstr("animations[0].samplers"), HasSubstr("nothing moves")));
  EXPECT_THAT(
      broken(R"("channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}])", R"("channels":[])"),
      AllOf(HasSubstr("animations[0].channels"), HasSubstr("nothing moves")));
  EXPECT_THAT(broken(R"("count":2,"type":"VEC3")", R"("count":1,"type":"VEC3")"),
              AllOf(HasSubstr("accessors[3]"), HasSubstr("3 numbers; 2 keys need 6")));
  EXPECT_THAT(broken(R"("output":3})", R"("output":3,"interpolation":"CUBICSPLINE"})"),
              HasSubstr("2 keys need 18"));
  EXPECT_THAT(broken(R"("output":3})", R"("output":3,"interpolation":"CUBIC"})"), HasSubstr("CUBICSPLINE"));
  EXPECT_THAT(broken(R"("path":"translation")", R"("path":"rotation")"), HasSubstr("VEC4"));
  EXPECT_THAT(broken(R"("input":2)", R"("input":0)"), HasSubstr("SCALAR"));
  EXPECT_THAT(broken(R"("node":0,)", R"("node":7,)"), HasSubstr("index 7 into `nodes`"));
  EXPECT_THAT(broken(R"("sampler":0)", R"("sampler":3)"), HasSubstr("sampler"));
  test::TriangleDocument d = animatedTriangle();
  std::memset(d.bytes.data() + 48, 0, 4);  // both keys at 0 s
  EXPECT_THAT(test::warningsOfText(d.json()),
              AllOf(HasSubstr("not after that of the key before it"), HasSubstr("animations[0] `hop`"),
                    HasSubstr("the animation is left out")));
  const float early = -1;
  std::memcpy(d.bytes.data() + 44, &early, 4);
  EXPECT_THAT(test::warningsOfText(d.json()), HasSubstr("is negative or not finite"));
  // The next one plays instead, unless the scene file says otherwise.
  replace(d.extra, "}]}]", R"(}]},{"name":"leap","samplers":[{"input":4,"output":3}],
      "channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}]}])");
  replace(d.accessors, "}]",
          R"(},{"bufferView":0,"byteOffset":8,"componentType":5126,"count":2,"type":"SCALAR"}])");
  const Scene next = test::loadText(folder, d.json(), warnings);
  ASSERT_EQ(next.animations.size(), 2u);
  EXPECT_TRUE(next.animations[0].channels.empty());
  EXPECT_FALSE(next.animations[0].plays);
  EXPECT_TRUE(next.animations[1].plays);
  for (const char* choice : {"false", "0", "\"hop\""}) {
    const auto file = folder.write("s.json", std::string(R"({"models":[{"file":"model.gltf","animation":)") +
                                                 choice + R"(}],"camera":{"eye":[0,0,5],"target":[0,0,0]}})");
    EXPECT_EQ(flatten(load(file.string(), warnings)).triangles.size(), 1u) << choice;
  }
  d = animatedTriangle();
  const float nan = std::nanf("");
  std::memcpy(d.bytes.data() + 52, &nan, 4);
  EXPECT_THAT(test::warningsOfText(d.json()), HasSubstr("not finite"));
}

TEST(AnimationErrors, MorphTargetsThatDoNotFit) {
  test::TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"targets":[{"POSITION":0}]})";
  test::TemporaryFolder folder;
  Diagnostics warnings;
  EXPECT_EQ(test::loadText(folder, d.json(), warnings).meshes[0].primitives[0].targets.size(), 1u);
  std::string text = d.json();
  replace(text, R"("primitives":)", R"("weights":[1,0],"primitives":)");
  EXPECT_THAT(test::warningsOfText(text), HasSubstr("2 weights for 1 morph targets"));
  text = d.json();
  replace(text, R"([{"mesh":0}])", R"([{"mesh":0,"weights":[]}, {"mesh":0,"weights":[1,2,3]}])");
  replace(text, R"("nodes":[0])", R"("nodes":[0,1])");
  EXPECT_THAT(test::warningsOfText(text), AllOf(HasSubstr("nodes[1]"), HasSubstr("3 weights for 1")));
  d.accessors =
      R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},{"bufferView":0,"componentType":5126,"count":2,"type":"VEC3"}])";
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"targets":[{"POSITION":2}]})";
  EXPECT_THAT(test::warningsOfText(d.json()), AllOf(HasSubstr("targets[0]"), HasSubstr("has 2 elements")));
}

TEST(AnimationErrors, ASkinNeedsJoints) {
  test::TriangleDocument d;
  d.extra = R"(,"skins":[{"joints":[]}])";
  EXPECT_THAT(test::warningsOfText(d.json()), AllOf(HasSubstr("skins[0]"), HasSubstr("no `joints`")));
  d.extra = R"(,"skins":[{"joints":[4]}])";
  EXPECT_THAT(test::warningsOfText(d.json()), AllOf(HasSubstr("skins[0].joints[0]"), HasSubstr("index 4")));
}

// ---- Scene files ------------------------------------------------------------------------------------------

TEST(SceneFileAnimation, ChoosesByNameNumberOrNone) {
  test::TemporaryFolder folder;
  test::TriangleDocument d = animatedTriangle();
  replace(d.extra, "}]}]", R"(}]},{"name":"leap","samplers":[{"input":2,"output":3,"interpolation":"STEP"}],
      "channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}]}])");
  folder.write("m.gltf", d.json());
  const auto sceneWith = [&](const std::string& animation) {
    return folder.write("s.json", R"({"models":[{"file":"m.gltf")" + animation + R"(}],"environment":[1,1,1],
        "camera":{"eye":[0,0,5],"target":[0,0,0]}})");
  };
  const auto playing = [&](const std::string& animation) {
    Diagnostics warnings;
    const Scene s = load(sceneWith(animation).string(), warnings);
    std::string names;
    for (const Animation& a : s.animations)
      if (a.plays) names += a.name + (a.repeat == Repeat::Once ? " once" : "");
    return names;
  };
  EXPECT_EQ(playing(""), "hop");
  EXPECT_EQ(playing(R"(,"animation":"leap")"), "leap");
  EXPECT_EQ(playing(R"(,"animation":1)"), "leap");
  EXPECT_EQ(playing(R"(,"animation":false)"), "");
  EXPECT_EQ(playing(R"(,"animation":{"name":"leap","speed":2,"repeat":"once"})"), "leap once");
  EXPECT_THAT(test::errorOf([&] { playing(R"(,"animation":"lap")"); }), HasSubstr("did you mean `leap`?"));
  EXPECT_THAT(test::errorOf([&] { playing(R"(,"animation":2)"); }), HasSubstr("2 animations"));
  EXPECT_THAT(test::errorOf([&] { playing(R"(,"animation":{"speed":0})"); }), HasSubstr("speed"));
}

// A placed model brings its skin and animation along.
TEST(SceneFileAnimation, APlacedModelMovesWhereItStands) {
  FOVEA_NEED_SCENES(root);
  test::TemporaryFolder folder;
  const std::string file = (root / "conformance/valid/own/skin_two_arms.glb").string();
  const auto load = [&](const std::string& placement) {
    Diagnostics warnings;
    const auto path = folder.write(
        "s.json", R"({"models":[{"builtin":"cornellbox"},{"file":")" + file + "\"" + placement + "}]}");
    return fovea::scene::load(path.string(), warnings);
  };
  const Scene here = load(""), there = load(R"(,"translate":[1,2,3],"scale":2)");
  Geometry a = flatten(here), b = flatten(there);
  moveObjects(makeFrame(here, a, {8, 8}, 30, 1), a);
  moveObjects(makeFrame(there, b, {8, 8}, 30, 1), b);
  ASSERT_EQ(a.positions.size(), b.positions.size());
  ASSERT_GT(a.positions.size(), a.staticVertices());
  for (size_t v = a.staticVertices(); v < a.positions.size(); ++v)
    ASSERT_LT(glm::distance(b.positions[v], 2.0f * a.positions[v] + glm::vec3(1, 2, 3)), 1e-4f);
}

}  // namespace
}  // namespace fovea::scene
