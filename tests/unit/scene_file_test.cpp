// Tests scene files: everything they can say, and that all mistakes are reported at their positions, all at once.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "fovea/image.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/scene.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::errorOf;
using test::TemporaryFolder;
using test::TriangleDocument;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Sets FOVEA_SCENES for the duration of a test.
class ScenesVariable {
 public:
  explicit ScenesVariable(const std::string& value) {
    if (const char* old = std::getenv("FOVEA_SCENES")) old_ = old;
    setenv("FOVEA_SCENES", value.c_str(), 1);
  }
  ~ScenesVariable() { old_.empty() ? unsetenv("FOVEA_SCENES") : setenv("FOVEA_SCENES", old_.c_str(), 1); }

 private:
  std::string old_;
};

Scene loadJson(const TemporaryFolder& folder, const std::string& text, Diagnostics& warnings) {
  return load(folder.write("scene.json", text).string(), warnings);
}

std::string errorOfJson(const std::string& text) {
  TemporaryFolder folder;
  Diagnostics warnings;
  return errorOf([&] { loadJson(folder, text, warnings); });
}

TEST(SceneFile, EverythingItCanSay) {
  TemporaryFolder folder;
  TriangleDocument triangle;
  triangle.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  triangle.extra = R"(,"materials":[{"pbrMetallicRoughness":{"metallicFactor":0}}])";
  folder.write("models/tri.gltf", triangle.json());
  Diagnostics warnings;
  const Scene s = loadJson(folder, R"({
    "name": "all", "description": "x",
    "models": [
      { "file": "models/tri.gltf", "translate": [1, 2, 3], "rotate": [0, 90, 0], "scale": 2 },
      { "builtin": "cornellbox", "name": "box", "lights": false }
    ],
    "lights": [
      { "type": "directional", "intensity": 20, "color": [1, 0.5, 0.25], "direction": [0, -2, 0] },
      { "type": "point", "intensity": 5, "position": [1, 1, 1], "range": 4 },
      { "type": "spot", "name": "s", "position": [0, 3, 0], "direction": [0, -1, 0], "inner_cone_deg": 10, "outer_cone_deg": 30 }
    ],
    "camera": { "eye": [0, 1, 5], "target": [0, 1, 0], "fov_deg": 60, "near": 0.1, "far": 100 },
    "exposure": 2.5, "environment": [0.1, 0.2, 0.3],
    "gaze": [{ "t": 0, "x": 0.25, "y": 0.75 }, { "t": 1, "valid": false }]
  })",
                           warnings);
  EXPECT_TRUE(warnings.list().empty()) << warnings.format();
  EXPECT_EQ(s.name, "all");
  ASSERT_EQ(s.lights.size(), 3u);  // the box's own is left out
  EXPECT_EQ(s.lights[0].direction, glm::vec3(0, -1, 0));
  EXPECT_EQ(s.lights[0].color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_FLOAT_EQ(s.lights[1].range, 4);
  EXPECT_FLOAT_EQ(s.lights[2].outerConeAngle, glm::radians(30.0f));
  EXPECT_EQ(s.cameras[0].position, glm::vec3(0, 1, 5));
  EXPECT_LT(glm::distance(s.cameras[0].orientation * glm::vec3(0, 0, -1), glm::vec3(0, 0, -1)), 1e-6f);
  EXPECT_FLOAT_EQ(s.cameras[0].verticalFov, glm::radians(60.0f));
  EXPECT_EQ(s.cameras.size(), 2u);  // then the box's
  EXPECT_FLOAT_EQ(s.exposure, 2.5f);
  EXPECT_EQ(s.environment, glm::vec3(0.1f, 0.2f, 0.3f));
  ASSERT_EQ(s.gaze.size(), 2u);
  EXPECT_FALSE(s.gaze[1].valid);
  EXPECT_NE(s.hash, 0u);
  const Geometry g = flatten(s);
  EXPECT_EQ(g.triangles.size(), 1 + flatten(builtin("cornellbox")).triangles.size());
  // Scaled by 2, turned by 90 degrees about Y (x to -z), moved.
  EXPECT_LT(glm::distance(g.positions[0], glm::vec3(1, 2, 3)), 1e-5f);
  EXPECT_LT(glm::distance(g.positions[1], glm::vec3(1, 2, 1)), 1e-5f);
  EXPECT_LT(glm::distance(g.positions[2], glm::vec3(1, 4, 3)), 1e-5f);
  // The materials of both models are there, and each model refers to its own.
  EXPECT_EQ(s.materials.size(), 1 + builtin("cornellbox").materials.size());
  EXPECT_EQ(s.materials[g.triangles.back().material()].name, "white");
}

TEST(SceneFile, AnEnvironmentMayBeAnImage) {
  TemporaryFolder folder;
  fovea::image::write(folder.path() / "sky.pfm", {{"", {2, 1, 3, {1, 2, 3, 4, 5, 6}}}});
  Diagnostics warnings;
  const Scene s = loadJson(folder, R"({
    "models": [{ "builtin": "cornellbox" }],
    "environment": { "file": "sky.pfm", "intensity": 2, "turn_deg": 90 }
  })",
                           warnings);
  ASSERT_TRUE(s.environmentMap);
  EXPECT_EQ(s.environmentMap->texels().at(1), glm::vec3(8, 10, 12));
  EXPECT_FLOAT_EQ(s.environmentMap->turn(), glm::half_pi<float>());
  // The program's option replaces it, and the hash knows them apart.
  const std::string file = (folder.path() / "scene.json").string(),
                    sky = (folder.path() / "sky.pfm").string();
  const Scene other = load(file, warnings, {sky});
  EXPECT_EQ(other.environmentMap->texels().at(1), glm::vec3(4, 5, 6));
  EXPECT_NE(other.hash, s.hash);
  EXPECT_THAT(errorOfJson(R"({"models": [{"builtin": "cornellbox"}], "environment": {"file": "none.exr"}})"),
              HasSubstr("none.exr"));
  EXPECT_THAT(errorOfJson(R"({"models": [{"builtin": "cornellbox"}], "environment": {"fill": "a.exr"}})"),
              HasSubstr("did you mean `file`"));
}

TEST(SceneFile, AFloorLiesUnderTheModels) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadJson(folder, R"({
    "models": [{ "builtin": "cornellbox" }],
    "floor": { "position": [1, -2, 3], "radius": 4, "color": [0.1, 0.2, 0.3] }
  })",
                           warnings);
  const Geometry g = flatten(s);
  const size_t first = flatten(builtin("cornellbox")).triangles.size();
  EXPECT_EQ(s.materials[g.triangles.back().material()].baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 1));
  double area = 0;
  for (size_t i = first; i < g.triangles.size(); ++i) {
    const Triangle& t = g.triangles[i];
    const glm::vec3 a = g.positions[t.v[0]];
    const glm::vec3 across = glm::cross(g.positions[t.v[1]] - a, g.positions[t.v[2]] - a);
    EXPECT_FLOAT_EQ(a.y, -2);
    EXPECT_GT(across.y, 0);  // it faces upwards
    EXPECT_LE(glm::distance(a, {1, -2, 3}), 4.0001f);
    area += 0.5 * glm::length(across);
  }
  EXPECT_NEAR(area, 16 * 3.14159, 0.002 * area);
}

TEST(SceneFile, AModelsLightsAndCamerasMoveWithIt) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene box = builtin("cornellbox");
  const Scene s = loadJson(
      folder, R"({"models": [{"builtin": "cornellbox", "translate": [10, 0, 0], "rotate": [0, 180, 0]}]})",
      warnings);
  ASSERT_EQ(s.lights.size(), 1u);
  const glm::vec3 p = box.lights[0].position;
  EXPECT_LT(glm::distance(s.lights[0].position, glm::vec3(10 - p.x, p.y, -p.z)), 1e-5f);
  ASSERT_EQ(s.cameras.size(), 1u);
  EXPECT_LT(glm::distance(s.cameras[0].orientation * glm::vec3(0, 0, -1), glm::vec3(0, 0, 1)), 1e-5f);
  EXPECT_FLOAT_EQ(s.exposure, box.exposure);
  EXPECT_EQ(s.gaze.size(), box.gaze.size());
}

TEST(SceneFile, MoversAndMovingLights) {
  TemporaryFolder folder;
  folder.write("tri.gltf", TriangleDocument{}.json());
  Diagnostics warnings;
  const Scene box = builtin("cornellbox");
  const Scene s = loadJson(folder, R"({"models": [{"builtin": "cornellbox"}], "ipd": 0.07,
    "lens": { "outward_deg": 55, "inward_deg": 45, "up_deg": 50, "down_deg": 52 },
    "movers": [
      {"node": "yellow cube", "repeat": "loop", "keys": [{"t": 0}, {"t": 2, "translation": [1, 0, 0], "visible": false}]},
      {"name": "plane", "shape": "paper_plane", "size": 0.4, "color": [0.9, 0.9, 0.8], "interpolation": "linear",
       "keys": [{"t": 0, "translation": [0, 2, 0], "quaternion": [0, 2, 0, 0]}, {"t": 1, "rotation_deg": [0, 90, 0]}]},
      {"shape": "box", "size": [1, 2, 3], "emission": [1, 2, 3], "keys": [{"t": 0}]},
      {"file": "tri.gltf", "scale": 2, "repeat": "back_and_forth", "keys": [{"t": 1, "translation": [3, 0, 0]}]}
    ],
    "moving_lights": [{"light": "ceiling spot", "keys": [{"t": 0, "intensity": 10}, {"t": 1, "position": [0, 5, 1]}]}],
    "gaze": [{"t": 0, "x": 0.5, "y": 0.5, "left": [0.4, 0.5]}]})",
                           warnings);
  EXPECT_FLOAT_EQ(s.ipd, 0.07f);
  ASSERT_TRUE(s.lens.has_value());
  EXPECT_FLOAT_EQ(s.lens->outward, glm::radians(55.0f));
  EXPECT_FLOAT_EQ(s.lens->inward, glm::radians(45.0f));
  EXPECT_FLOAT_EQ(s.lens->up, glm::radians(50.0f));
  EXPECT_FLOAT_EQ(s.lens->down, glm::radians(52.0f));
  ASSERT_EQ(s.movers.size(), 4u);
  const Mover& cube = s.movers[0];
  EXPECT_EQ(s.nodes[cube.node].name, "yellow cube");
  EXPECT_TRUE(s.nodes[cube.node].dynamic);
  EXPECT_TRUE(cube.smooth);
  EXPECT_EQ(cube.repeat, Repeat::Loop);
  ASSERT_EQ(cube.keys.size(), 2u);
  EXPECT_EQ(cube.keys[0].translation, box.nodes[1].translation);  // where the node is when nothing is said
  EXPECT_EQ(cube.keys[1].rotation, box.nodes[1].rotation);
  EXPECT_FALSE(cube.keys[1].visible);
  const Mover& plane = s.movers[1];
  EXPECT_FALSE(plane.smooth);
  EXPECT_EQ(plane.keys[0].rotation, glm::quat(0, 0, 1, 0));
  EXPECT_LT(glm::distance(plane.keys[1].rotation * glm::vec3(1, 0, 0), glm::vec3(0, 0, -1)), 1e-6f);
  EXPECT_EQ(s.movers[3].repeat, Repeat::PingPong);
  const Geometry g = flatten(s);
  ASSERT_EQ(g.objects.size(), 5u);
  EXPECT_EQ(g.objects[1].name, "yellow cube");
  EXPECT_EQ(g.triangles.size(), flatten(box).triangles.size() + 4 + 12 + 1);
  EXPECT_EQ(s.materials[g.triangles[g.objects[3].firstTriangle].material()].emission, glm::vec3(1, 2, 3));
  EXPECT_EQ(g.positions[g.objects[4].firstVertex], glm::vec3(3, 0, 0));
  ASSERT_EQ(s.lightMotions.size(), 1u);
  EXPECT_EQ(s.lightMotions[0].keys[0].position, box.lights[0].position);
  EXPECT_EQ(s.lightMotions[0].keys[0].intensity, 10);
  EXPECT_EQ(s.lightMotions[0].keys[1].intensity, box.lights[0].intensity);
  ASSERT_TRUE(s.gaze[0].left.has_value());
  EXPECT_EQ(*s.gaze[0].left, glm::vec2(0.4f, 0.5f));
  EXPECT_FALSE(s.gaze[0].right.has_value());
  // At t = 0 the picture is that of the still scene.
  const Geometry still = flatten(box);
  EXPECT_EQ(g.positions[g.objects[1].firstVertex],
            still.positions[box.meshes[0].primitives[0].positions.size() +
                            box.meshes[0].primitives[1].positions.size() +
                            box.meshes[0].primitives[2].positions.size() +
                            box.meshes[0].primitives[3].positions.size()]);
}

TEST(SceneFile, MistakesOfMovers) {
  const std::string message = errorOfJson(R"({"models": [{"builtin": "cornellbox"}],
    "movers": [
      {"node": "x", "shape": "box", "keys": [{"t": 0}]},
      {"node": "x", "keys": []},
      {"node": "x"},
      {"shape": "boks", "size": 0, "keys": [{"t": 1, "quaternion": [0, 0, 0, 0]}, {"t": 1}, {"translation": [1, 2]}]},
      {"shape": "box", "color": [2, 0, 0], "repeat": "always", "keys": [{"t": 0, "visibel": true}]}
    ],
    "moving_lights": [{"keys": [{"t": 0, "intensity": -1, "direction": [0, 0, 0]}]}]})");
  for (const char* expected :
       {"scene.json:3:", "one of `node`, `file` and `shape`", "movers[1].keys", "at least one key",
        "scene.json:5:", "`keys` is missing", "expected one of box, paper_plane", "movers[3].size",
        "movers[3].keys[0].quaternion", "times of a path", "`t` is missing", "movers[3].keys[2].translation",
        "movers[4].color", "movers[4].repeat", "did you mean `visible`", "`light` is missing",
        "moving_lights[0].keys[0].intensity", "direction cannot be zero"})
    EXPECT_THAT(message, HasSubstr(expected));
  const auto mover = [](const std::string& movers, const std::string& more = "") {
    return errorOfJson(R"({"models": [{"builtin": "cornellbox"}], "movers": [)" + movers + "]" + more + "}");
  };
  EXPECT_THAT(
      mover(R"({"node": "yelow cube", "keys": [{"t": 0}]})"),
      AllOf(HasSubstr("movers[0].node"), HasSubstr("no node `yelow cube`"), HasSubstr("`yellow cube`")));
  EXPECT_THAT(mover(R"({"node": "vase", "keys": [{"t": 0}]}, {"node": "vase", "keys": [{"t": 0}]})"),
              AllOf(HasSubstr("movers[1]"), HasSubstr("moves twice")));
  EXPECT_THAT(mover(R"({"node": "vase", "keys": [{"t": 0}]}, {"node": "cornellbox", "keys": [{"t": 0}]})"),
              AllOf(HasSubstr("`vase` hangs on `cornellbox`")));
  EXPECT_THAT(mover(R"({"file": "none.gltf", "get": "from the attic", "keys": [{"t": 0}]})"),
              AllOf(HasSubstr("none.gltf"), HasSubstr("from the attic")));
  EXPECT_THAT(mover("", R"(, "moving_lights": [{"light": "ceiling spott", "keys": [{"t": 0}]}])"),
              AllOf(HasSubstr("no light `ceiling spott`"), HasSubstr("`ceiling spot`")));
}

TEST(SceneFile, GazeFromATable) {
  TemporaryFolder folder;
  folder.write(
      "gaze.csv",
      "# a trace\r\nt, x, y, valid, left_x, left_y\r\n0,0.25,0.5,1,0.2,0.5\n0.5,,,0,,\n\n1,0.75,0.5,1,,\n");
  Diagnostics warnings;
  const Scene s =
      loadJson(folder, R"({"models": [{"builtin": "cornellbox"}], "gaze": "gaze.csv"})", warnings);
  ASSERT_EQ(s.gaze.size(), 3u);
  EXPECT_EQ(s.gaze[0].position, glm::vec2(0.25f, 0.5f));
  ASSERT_TRUE(s.gaze[0].left.has_value());
  EXPECT_EQ(*s.gaze[0].left, glm::vec2(0.2f, 0.5f));
  EXPECT_FALSE(s.gaze[1].valid);
  EXPECT_TRUE(s.gaze[2].valid);
  EXPECT_FALSE(s.gaze[2].left.has_value());
  const auto error = [&](const std::string& table) {
    folder.write("gaze.csv", table);
    return errorOf([&] {
      loadJson(folder, R"({"models": [{"builtin": "cornellbox"}], "gaze": "gaze.csv"})", warnings);
    });
  };
  EXPECT_THAT(error("t,x,y\n0,0.5,2\n1,a,0.5\n2,0.5\n3,,0.5\n2.5,0.5,0.5\n4,0.1,0.1\n3.9,0.1,0.1\n"),
              AllOf(HasSubstr("gaze.csv:2:"), HasSubstr("`y` is `2`"), HasSubstr("gaze.csv:3:"),
                    HasSubstr("`x` is `a`"), HasSubstr("gaze.csv:4:"), HasSubstr("2 values in 3 columns"),
                    HasSubstr("gaze.csv:5:"), HasSubstr("gaze.csv:8:"), HasSubstr("must increase")));
  EXPECT_THAT(error("t,x,y,vlid\n"), AllOf(HasSubstr("gaze.csv:1:"), HasSubstr("did you mean `valid`")));
  EXPECT_THAT(error("t,x,x\n"), AllOf(HasSubstr("`y` is missing"), HasSubstr("twice")));
  EXPECT_THAT(error(""), HasSubstr("no header"));
  EXPECT_THAT(errorOfJson(R"({"models": [{"builtin": "cornellbox"}], "gaze": "none.csv"})"),
              AllOf(HasSubstr("scene.json:1:"), HasSubstr("`none.csv` is missing")));
  EXPECT_THAT(errorOfJson(R"({"models": [{"builtin": "cornellbox"}], "gaze": 4})"), HasSubstr("gaze"));
}

TEST(SceneFile, CameraPath) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadJson(folder, R"({"models": [{"builtin": "cornellbox"}],
    "camera": {"fov_deg": 40, "path": [{"t": 0, "eye": [0, 1, 5], "target": [0, 1, 0]},
                                       {"t": 2, "eye": [1, 1, 5], "target": [0, 1, 0], "fov_deg": 50}]}})",
                           warnings);
  ASSERT_EQ(s.cameraPath.size(), 2u);
  EXPECT_FLOAT_EQ(s.cameraPath[1].time, 2);
  EXPECT_FLOAT_EQ(s.cameraPath[0].camera.verticalFov, glm::radians(40.0f));
  EXPECT_FLOAT_EQ(s.cameraPath[1].camera.verticalFov, glm::radians(50.0f));
  EXPECT_EQ(s.cameras[0].position, glm::vec3(0, 1, 5));
}

TEST(SceneFile, AllMistakesAtOnceEachWithItsLine) {
  const std::string message = errorOfJson(R"({
    "models": [{ "file": "a.gltf", "builtin": "b" }, { "fill": "x.gltf" }, { "builtin": "cornelbox" }],
    "lights": [
      { "type": "sun", "intensity": 1 },
      { "type": "spot", "position": [0, 0, 0], "direction": [0, 0, 0], "inner_cone_deg": 50, "outer_cone_deg": 40 },
      { "type": "point", "color": [1, -1, 0] }
    ],
    "camera": { "eye": [0, 0, 0], "target": [0, 0, 0], "fov_dg": 60 },
    "exposure": 0,
    "exposre": 1,
    "floor": { "radius": 0, "color": [2, 0, 0] },
    "gaze": [{ "t": 1, "x": 2, "y": 0.5 }, { "t": 1 }, 5]
  })");
  for (const char* expected : {"scene.json:2:",
                               "either by `file` or by `builtin`",
                               "models[1].fill",
                               "did you mean `file`",
                               "did you mean `cornellbox`",
                               "scene.json:4:",
                               "lights[0].type",
                               "lights[1].direction",
                               "lights[1].outer_cone_deg",
                               "lights[2]",
                               "`position` is missing",
                               "no negative parts",
                               "camera.target",
                               "the same point",
                               "camera.fov_dg",
                               "did you mean `fov_deg`",
                               "scene.json:9:",
                               "exposure",
                               "did you mean `exposure`",
                               "floor.radius",
                               "no surface reflects more than 1",
                               "gaze[0].x",
                               "gaze[1].t",
                               "gaze[2]"})
    EXPECT_THAT(message, HasSubstr(expected));
}

TEST(SceneFile, NoModelsNoTrianglesNoJson) {
  EXPECT_THAT(errorOfJson("{}"), HasSubstr("no `models`"));
  EXPECT_THAT(errorOfJson(R"({"models": []})"), HasSubstr("no triangles"));
  EXPECT_THAT(errorOfJson("[1]"), HasSubstr("an object"));
  EXPECT_THAT(errorOfJson(R"({"models": [)"), HasSubstr("scene.json:1:"));
  EXPECT_THAT(errorOfJson(R"({"models": 5})"), HasSubstr("`models`: expected an array"));
  EXPECT_THAT(errorOfJson(R"({"models": [{"builtin": "cornellbox", "scale": 0}]})"), HasSubstr("scale of 0"));
  EXPECT_THAT(errorOfJson(R"({"models": [{"builtin": "cornellbox"}], "camera": {"path": []}})"),
              HasSubstr("at least one key"));
  EXPECT_THAT(errorOfJson(R"({"models": [{"builtin": "cornellbox"}], "camera": {"path": 3}})"),
              HasSubstr("camera.path"));
  EXPECT_THAT(errorOfJson(R"({"models": [{"builtin": "cornellbox"}], "camera": 3})"), HasSubstr("camera"));
}

TEST(SceneFile, MissingModelSaysWhereItLookedAndWhereToGetIt) {
  TemporaryFolder folder;
  const ScenesVariable variable((folder.path() / "elsewhere").string());
  folder.write("elsewhere/readme", "");
  const auto file = folder.write(
      "scene.json", R"({"models": [{"file": "hall/none.gltf", "get": "get it from the archive"}]})");
  Diagnostics warnings;
  EXPECT_THAT(errorOf([&] { load(file.string(), warnings); }),
              AllOf(HasSubstr("scene.json:1:"), HasSubstr("`hall/none.gltf` is missing"),
                    HasSubstr("elsewhere/hall/none.gltf"), HasSubstr("get it from the archive"),
                    HasSubstr("FOVEA_SCENES")));
}

TEST(SceneFile, ModelsAreFoundThroughTheVariable) {
  TemporaryFolder folder;
  folder.write("a/readme", "");
  folder.write("b/m/tri.gltf", TriangleDocument{}.json());
  const ScenesVariable variable((folder.path() / "a").string() + ":" + (folder.path() / "b").string());
  const auto file = folder.write("scene.json", R"({"models": [{"file": "m/tri.gltf"}]})");
  Diagnostics warnings;
  EXPECT_EQ(flatten(load(file.string(), warnings)).triangles.size(), 1u);
  EXPECT_THAT(warnings.format(), AllOf(HasSubstr("no camera"), HasSubstr("this scene has no light")));
  // The same model, loaded by its own name, has a floor as well.
  const Scene bare = load("m/tri.gltf", warnings);
  EXPECT_TRUE(bare.assumedFloor);
  EXPECT_EQ(flatten(bare).triangles.size(), 1 + bare.meshes.back().primitives[0].indices.size() / 3);
}

TEST(Load, BareModelsGetAViewAndASun) {
  TemporaryFolder folder;
  const auto file = folder.write("tri.gltf", TriangleDocument{}.json());
  Diagnostics warnings;
  const Scene s = load(file.string(), warnings);
  ASSERT_EQ(s.cameras.size(), 1u);
  ASSERT_EQ(s.lights.size(), 1u);
  EXPECT_FALSE(s.assumedLamp);
  EXPECT_TRUE(s.environmentMap);  // the sky around that sun
  EXPECT_EQ(s.lights[0].type, LightType::Directional);
  EXPECT_THAT(warnings.format(),
              AllOf(HasSubstr("is assumed: a camera"), HasSubstr("a floor, a sun and a sky"),
                    HasSubstr("the exposure"), HasSubstr("scene info")));
  // The view contains the whole model, and the sun shines on what it sees.
  const glm::vec3 forward = s.cameras[0].orientation * glm::vec3(0, 0, -1);
  for (const glm::vec3 p : {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)})
    EXPECT_GT(glm::dot(glm::normalize(p - s.cameras[0].position), forward),
              std::cos(0.75f * s.cameras[0].verticalFov));
  EXPECT_LT(s.lights[0].direction.y, 0);
}

// Alone, a model is shown as its author meant it; in a scene file, as that says.
TEST(Load, BareModelsHaveFullMaterials) {
  TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  d.extra =
      R"(,"materials":[{"name":"gold","alphaMode":"BLEND","pbrMetallicRoughness":{"metallicFactor":1}}])";
  TemporaryFolder folder;
  const auto file = folder.write("tri.gltf", d.json());
  Diagnostics warnings;
  EXPECT_TRUE(load(file.string(), warnings).fullMaterials);
  EXPECT_THAT(warnings.format(), AllOf(Not(HasSubstr("gold")), Not(HasSubstr("diffuse"))));
  for (const auto& [key, full] : {std::pair("", false), std::pair(R"(, "materials": "diffuse")", false),
                                  std::pair(R"(, "materials": "full")", true)}) {
    Diagnostics own;
    const Scene s = loadJson(folder, fmt::format(R"({{"models": [{{"file": "tri.gltf"}}]{}}})", key), own);
    EXPECT_EQ(s.fullMaterials, full) << key;
    EXPECT_EQ(own.format().find("gold") == std::string::npos, full) << own.format();
  }
  EXPECT_THAT(errorOfJson(R"({"models": [{"builtin": "cornellbox"}], "materials": "shiny"})"),
              HasSubstr("shiny"));
}

TEST(Load, NamesAndFiles) {
  Diagnostics warnings;
  EXPECT_EQ(load("cornellbox", warnings).name, "cornellbox");
  EXPECT_THAT(errorOf([&] { load("cornelbox", warnings); }),
              AllOf(HasSubstr("`cornelbox`"), HasSubstr("`cornellbox`")));
  EXPECT_THAT(errorOf([&] { load("zzzzzz", warnings); }),
              AllOf(HasSubstr("known scenes"), HasSubstr("sponza")));
  EXPECT_THAT(errorOf([&] { load("/nowhere/a.json", warnings); }), HasSubstr("/nowhere/a.json"));
  EXPECT_THAT(errorOf([&] { load("/dev/null", warnings); }), HasSubstr("neither a scene file"));
}

TEST(Load, MovingScenesKeepTheBoundsOfTheirStillOnes) {
  const bool sponza = !test::sharedScenes().empty();
  for (const auto& [name, still] :
       {std::pair("cornellbox_moving", "cornellbox"), {"sponza_plane", "sponza"}}) {
    if (std::string(still) == "sponza" && !sponza) continue;
    Diagnostics warnings;
    const Scene s = load(name, warnings);
    EXPECT_TRUE(warnings.list().empty()) << warnings.format();
    EXPECT_TRUE(!s.movers.empty() || s.cameraPath.size() > 1) << name;
    EXPECT_GT(s.gaze.size(), 10u) << name;
    const Geometry g = flatten(s), stillGeometry = flatten(load(still, warnings));
    EXPECT_EQ(g.boundsMin, stillGeometry.boundsMin) << name;
    EXPECT_EQ(g.boundsMax, stillGeometry.boundsMax) << name;
  }
}

TEST(Load, SponzaIsLitAndSeen) {
  FOVEA_NEED_SCENES(root);
  (void)root;
  Diagnostics warnings;
  const Scene s = load("sponza", warnings);
  EXPECT_TRUE(warnings.list().empty()) << warnings.format();
  EXPECT_EQ(flatten(s).triangles.size(), 262266u);
  ASSERT_EQ(s.lights.size(), 1u);
  EXPECT_EQ(s.lights[0].type, LightType::Directional);
  EXPECT_LT(s.lights[0].direction.y, -0.8f);
  EXPECT_EQ(s.cameras.size(), 1u);
}

}  // namespace
}  // namespace fovea::scene
