// Tests that a scene which lies far from the origin of its coordinates is the same as one that does not.
#include "framework/scene/origin.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/scene/export/bare_model.h"
#include "framework/scene/export/gltf.h"
#include "framework/scene/export/mitsuba.h"
#include "framework/scene/frame.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::TemporaryFolder;
using test::TriangleDocument;
using testing::HasSubstr;
using testing::Not;

const glm::dvec3 kMap(448262.125, 0, -5411932.25);  // in UTM coordinates

std::string text(glm::dvec3 v) { return fmt::format("[{},{},{}]", v.x, v.y, v.z); }

// Everything that has a place in a frame, in the author's coordinates.
std::vector<glm::dvec3> placesAt(const Scene& scene, double time) {
  Geometry geometry = flatten(scene);
  Moment moment;
  moment.time = moment.before = time;
  moment.camera = moment.previousCamera = momentAt(scene, uint64_t(time * 42 + 0.5), 42).camera;
  const Frame frame = makeFrame(scene, geometry, {8, 8}, moment, 1);
  moveObjects(frame, geometry);
  std::vector<glm::dvec3> places;
  if (!scene.cameras.empty()) places.push_back(toAuthor(scene, frame.views[0].eye));
  for (const Light& l : frame.lights) places.push_back(toAuthor(scene, l.position));
  for (const glm::vec3& p : geometry.positions) places.push_back(toAuthor(scene, p));
  return places;
}

void expectMoved(const Scene& scene, const Scene& moved, glm::dvec3 by, double tolerance = 1e-6) {
  for (const double time : {0.0, 1.0}) {
    const std::vector<glm::dvec3> here = placesAt(scene, time), there = placesAt(moved, time);
    ASSERT_EQ(here.size(), there.size());
    for (size_t i = 0; i < here.size(); ++i)
      EXPECT_LT(glm::distance(here[i] + by, there[i]), tolerance) << "place " << i << " at " << time << " s";
  }
}

Scene loaded(const TemporaryFolder& folder, const TriangleDocument& document) {
  Diagnostics warnings;
  return test::loadText(folder, document.json(), warnings);
}

constexpr const char* kCameraAndLamp =
    R"(,"cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}}],
    "extensionsUsed":["KHR_lights_punctual"],
    "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":10}]}})";

// A root of this kind with a triangle, a camera and a lamp below it.
TriangleDocument below(const std::string& root) {
  TriangleDocument d;
  d.nodes =
      "[{" + root +
      R"("children":[1,2,3]},{"mesh":0,"translation":[0.25,0.5,0]},{"camera":0,"translation":[0.5,0.25,3]},
            {"translation":[0,2,1],"extensions":{"KHR_lights_punctual":{"light":0}}}])";
  d.extra = kCameraAndLamp;
  return d;
}

TEST(Origin, StaysWhereItIsInOrdinaryScenes) {
  TemporaryFolder folder;
  for (const glm::dvec3 at : {glm::dvec3(0), glm::dvec3(3, 0, -5), glm::dvec3(0, 9, 0)}) {
    const Scene s = loaded(folder, below("\"translation\":" + text(at) + ","));
    EXPECT_EQ(s.origin, glm::dvec3(0));
    EXPECT_EQ(s.nodes[0].translation, glm::vec3(at));
  }
}

TEST(Origin, FollowsARootThatIsFarAway) {
  TemporaryFolder folder;
  const Scene here = loaded(folder, below(""));
  for (const glm::dvec3 by : {glm::dvec3(1e4, 0, 0), glm::dvec3(0, -54321.5, 0), kMap, glm::dvec3(1e7)}) {
    const Scene there = loaded(folder, below("\"translation\":" + text(by) + ","));
    EXPECT_LT(glm::distance(there.origin, by), 2);
    expectMoved(here, there, by);
    const Scene matrix = loaded(
        folder, below(fmt::format(R"("matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, {},{},{},1],)", by.x, by.y, by.z)));
    expectMoved(here, matrix, by);
  }
}

TEST(Origin, TranslationsThatCancelLeaveNoError) {
  TemporaryFolder folder;
  const Scene here = loaded(folder, below(""));
  TriangleDocument d = below("\"translation\":" + text(kMap) + ",");
  // The root gets a child that goes back again, and carries its children in its place.
  d.nodes =
      d.nodes.substr(0, d.nodes.size() - 1) + R"(,{"children":[1,2,3],"translation":)" + text(-kMap) + "}]";
  d.nodes.replace(d.nodes.find("[1,2,3]"), 7, "[4]");
  const Scene there = loaded(folder, d);
  EXPECT_EQ(there.origin, glm::dvec3(0));
  expectMoved(here, there, glm::dvec3(0));
}

TEST(Origin, DoesNotFollowAForgottenObject) {
  TemporaryFolder folder;
  TriangleDocument d = below("\"translation\":" + text(kMap) + ",");
  d.nodes.insert(d.nodes.find("{\"mesh\""), R"({"mesh":0,"translation":[1,0,0]},)");
  d.nodes.replace(d.nodes.find("[1,2,3]"), 7, "[1,2,3,4]");
  d.nodes = d.nodes.substr(0, d.nodes.size() - 1) + R"(,{"mesh":0}])";
  d.scenes = R"([{"nodes":[0,5]}])";
  const Scene s = loaded(folder, d);
  EXPECT_LT(glm::distance(s.origin, kMap), 2);
  EXPECT_LT(glm::distance(toAuthor(s, s.cameras.at(0).position), kMap + glm::dvec3(0.5, 0.25, 3)), 1e-6);
}

TEST(Origin, FollowsVerticesThatAreFarAway) {
  const auto document = [](float x, float y, glm::dvec3 node) {
    TriangleDocument d;
    d.bytes.clear();
    test::appendBytes<float>(d.bytes, {x, y, 0, x + 1, y, 0, x, y + 1, 0});
    test::appendBytes<uint16_t>(d.bytes, {0, 1, 2});
    d.nodes = R"([{"mesh":0,"translation":)" + text(node) + "}]";
    return d;
  };
  TemporaryFolder folder;
  const Scene here = loaded(folder, document(0, 0, {}));
  const Scene there = loaded(folder, document(4e6f, -1e4f, {}));
  EXPECT_LT(glm::distance(there.origin, {4e6, -1e4, 0}), 2);
  expectMoved(here, there, {4e6, -1e4, 0});
  EXPECT_LT(std::abs(there.meshes[0].primitives[0].positions[1].x), 2);
  // The node takes the mesh to the origin, or from there to somewhere else.
  expectMoved(here, loaded(folder, document(4e6f, -1e4f, {-4e6 + 0.1, 1e4, 0})), {0.1, 0, 0});
  expectMoved(here, loaded(folder, document(4e6f, -1e4f, {4e6 + 0.1, 1e4, 0})), {8e6 + 0.1, 0, 0});
}

// A triangle that follows an animation of its translation from `from` to a metre beside it, below a root.
TriangleDocument animated(glm::vec3 from, glm::dvec3 root) {
  TriangleDocument d;
  d.bytes.resize(44);
  test::appendBytes<float>(d.bytes, {0, 2, from.x, from.y, from.z, from.x + 1, from.y, from.z});
  d.views =
      R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},
      {"buffer":0,"byteOffset":44,"byteLength":8},{"buffer":0,"byteOffset":52,"byteLength":24}])";
  d.accessors.pop_back();
  d.accessors +=
      R"(,{"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR"},
      {"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}])";
  d.nodes = R"([{"mesh":0},{"children":[0],"translation":)" + text(root) + "}]";
  d.scenes = R"([{"nodes":[1]}])";
  d.extra =
      R"(,"animations":[{"samplers":[{"input":2,"output":3}],
      "channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}])";
  return d;
}

TEST(Origin, FollowsAnimationsThatAreFarAway) {
  TemporaryFolder folder;
  const Scene here = loaded(folder, animated({}, {}));
  const glm::vec3 far(4e6f, 0, -1e4f);
  expectMoved(here, loaded(folder, animated(far, {})), far);
  expectMoved(here, loaded(folder, animated({}, kMap)), kMap);
  expectMoved(here, loaded(folder, animated(far, -glm::dvec3(far))), {});
}

// A triangle that hangs on one joint, below a root.
TriangleDocument skinned(glm::dvec3 root, glm::dvec3 joint, float bindX) {
  TriangleDocument d;
  d.bytes.resize(44);
  test::appendBytes<uint8_t>(d.bytes, std::vector<uint8_t>(12, 0));
  test::appendBytes<float>(d.bytes, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  test::appendBytes<float>(d.bytes, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, bindX, 0, 0, 1});
  d.primitive = R"({"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},"indices":1})";
  d.views =
      R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},
      {"buffer":0,"byteOffset":44,"byteLength":12},{"buffer":0,"byteOffset":56,"byteLength":48},
      {"buffer":0,"byteOffset":104,"byteLength":64}])";
  d.accessors.pop_back();
  d.accessors +=
      R"(,{"bufferView":2,"componentType":5121,"count":3,"type":"VEC4"},
      {"bufferView":3,"componentType":5126,"count":3,"type":"VEC4"},
      {"bufferView":4,"componentType":5126,"count":1,"type":"MAT4"}])";
  d.nodes = R"([{"mesh":0,"skin":0},{"translation":)" + text(joint) +
            R"(},{"children":[0,1],"translation":)" + text(root) + "}]";
  d.scenes = R"([{"nodes":[2]}])";
  d.extra = R"(,"skins":[{"joints":[1],"inverseBindMatrices":4}])";
  return d;
}

TEST(Origin, FollowsJointsThatAreFarAway) {
  TemporaryFolder folder;
  const Scene here = loaded(folder, skinned({}, {0.5, 0, 0}, 0));
  expectMoved(here, loaded(folder, skinned(kMap, {0.5, 0, 0}, 0)), kMap);
  expectMoved(here, loaded(folder, skinned({}, kMap + glm::dvec3(0.5, 0, 0), 0)), kMap);
  expectMoved(here, loaded(folder, skinned(kMap, 0.5 - kMap, 0)), {0, 0.5, 0.5});
  expectMoved(here, loaded(folder, skinned({}, {4e6 + 0.5, 0, 0}, -4e6f)), {});
}

// A scene file with everything that has a place.
std::string sceneFile(glm::dvec3 by, glm::dvec3 model) {
  const auto at = [&](double x, double y, double z) { return text(by + glm::dvec3(x, y, z)); };
  return R"({"models":[{"file":"model.gltf","translate":)" + text(model) +
         R"(},{"file":"model.gltf","name":"second","translate":)" + text(model + glm::dvec3(2, 0, 0)) +
         R"(}],"camera":{"path":[{"t":0,"eye":)" + at(0, 1, 5) + R"(,"target":)" + at(0, 1, 0) +
         R"(},{"t":2,"eye":)" + at(1, 1, 5) + R"(,"target":)" + at(0, 1, 0) +
         R"(}]},"lights":[{"type":"point","position":)" + at(0, 3, 0) +
         R"(},{"type":"spot","name":"lamp","direction":[0,-1,0],"position":)" + at(1, 3, 0) +
         R"(}],"floor":{"radius":3,"position":)" + at(0, -1, 0) +
         R"(},"moving_lights":[{"light":"lamp","keys":[{"t":0},{"t":2,"position":)" + at(2, 3, 0) +
         R"(}]}],"movers":[{"shape":"box","keys":[{"t":0,"translation":)" + at(0, 0, 1) +
         R"(},{"t":2,"translation":)" + at(0, 0, 2) +
         R"(}]},{"node":"second","keys":[{"t":0},{"t":2,"translation":)" + text(model + glm::dvec3(3, 0, 0)) +
         R"(,"rotation_deg":[0,90,0]}]}]})";
}

TEST(Origin, IsThatOfTheModelsOfASceneFile) {
  TemporaryFolder folder;
  const auto scene = [&](glm::dvec3 root, glm::dvec3 by, glm::dvec3 model) {
    folder.write("model.gltf", below("\"translation\":" + text(root) + ",").json());
    Diagnostics warnings;
    return load(folder.write("scene.json", sceneFile(by, model)).string(), warnings);
  };
  const Scene here = scene({}, {}, {});
  EXPECT_EQ(here.origin, glm::dvec3(0));
  for (const glm::dvec3 by : {glm::dvec3(0, 0, 1e4), kMap, glm::dvec3(-1e7)})
    expectMoved(here, scene({}, by, by), by);  // placed there by the scene file
  // The model lies there, and is brought back by the scene file. A turn about its root then moves it far away.
  const Scene back = scene(kMap, {}, -kMap);
  const std::vector<glm::dvec3> places = placesAt(here, 0), again = placesAt(back, 0);
  ASSERT_EQ(places.size(), again.size());
  for (size_t i = 0; i < places.size(); ++i) EXPECT_LT(glm::distance(places[i], again[i]), 1e-6) << i;
}

TEST(Origin, IsThatOfEveryExport) {
  TemporaryFolder folder;
  folder.write("model.gltf", below("").json());
  Diagnostics warnings;
  const Scene here = load(folder.write("here.json", sceneFile({}, {})).string(), warnings);
  const Scene there = load(folder.write("there.json", sceneFile(kMap, kMap)).string(), warnings);
  const std::filesystem::path file = exportGltf(there, folder.path() / "out", warnings);
  const Scene again = load(file.string(), warnings);
  EXPECT_LT(glm::distance(again.origin, there.origin), 9);
  const std::vector<glm::dvec3> a = placesAt(here, 1), b = placesAt(again, 1);
  ASSERT_EQ(a.size(), b.size());
  for (const glm::dvec3& p : a)
    EXPECT_TRUE(
        std::ranges::any_of(b, [&](const glm::dvec3& q) { return glm::distance(p + kMap, q) < 1e-5; }))
        << p.x << " " << p.y << " " << p.z;

  Diagnostics said;
  std::ifstream xml(exportMitsuba(there, folder.path() / "mitsuba", {}, said));
  const std::string content{std::istreambuf_iterator<char>(xml), {}};
  EXPECT_THAT(content, HasSubstr(fmt::format(R"(<default name="z" value="{}"/>)", there.origin.z)));
  EXPECT_THAT(said.format(), HasSubstr("double precision"));
  std::ifstream near(exportMitsuba(here, folder.path() / "mitsuba", {}, said));
  EXPECT_THAT((std::string{std::istreambuf_iterator<char>(near), {}}), Not(HasSubstr("$x")));
}

TEST(Origin, TheSceneFileOfABareModelShowsTheSame) {
  TemporaryFolder folder;
  for (const glm::dvec3 by : {glm::dvec3(0.1, 0.3, 0.7), glm::dvec3(54000.1, 0, 0), kMap}) {
    const std::string file =
        folder.write("model.gltf", below("\"translation\":" + text(by) + ",").json()).string();
    Diagnostics warnings;
    const Scene bare = load(file, warnings);
    const Scene again = load(folder.write("again.json", bareModelFile(bare, "")).string(), warnings);
    EXPECT_EQ(again.origin, bare.origin);
    expectMoved(bare, again, {}, 1e-5);
    const glm::quat a = bare.cameras[0].orientation, b = again.cameras[0].orientation;
    EXPECT_GT(std::abs(glm::dot(a, b)), 1 - 1e-6f);
    EXPECT_EQ(again.cameras[0].verticalFov, bare.cameras[0].verticalFov);
  }
}

}  // namespace
}  // namespace fovea::scene
