// Scene files: everything they can say, and that every mistake is reported where it stands, all at once.
#include <gmock/gmock.h>

#include <cmath>

#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::errorOf;
using test::TemporaryFolder;
using test::TriangleDocument;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// FOVEA_SCENES for the length of a test.
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
  folder.write("models/tri.gltf", TriangleDocument{}.json());
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
  // Materials of both models, each pointing at its own.
  EXPECT_EQ(s.materials.size(), 1 + builtin("cornellbox").materials.size());
  EXPECT_EQ(s.materials[g.triangles.back().material()].name, "white");
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
  EXPECT_THAT(warnings.format(), AllOf(HasSubstr("no camera"), HasSubstr("nothing in this scene shines")));
  // The same model by its own name.
  EXPECT_EQ(flatten(load("m/tri.gltf", warnings)).triangles.size(), 1u);
}

TEST(Load, BareModelsGetAViewAndASun) {
  TemporaryFolder folder;
  const auto file = folder.write("tri.gltf", TriangleDocument{}.json());
  Diagnostics warnings;
  const Scene s = load(file.string(), warnings);
  ASSERT_EQ(s.cameras.size(), 1u);
  ASSERT_EQ(s.lights.size(), 1u);
  EXPECT_EQ(s.lights[0].type, LightType::Directional);
  EXPECT_THAT(warnings.format(), AllOf(HasSubstr("no camera"), HasSubstr("no light")));
  // The view holds the whole model, and the sun shines on what it sees.
  const glm::vec3 forward = s.cameras[0].orientation * glm::vec3(0, 0, -1);
  for (const glm::vec3 p : {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)})
    EXPECT_GT(glm::dot(glm::normalize(p - s.cameras[0].position), forward),
              std::cos(0.5f * s.cameras[0].verticalFov));
  EXPECT_LT(glm::dot(s.lights[0].direction, glm::vec3(0, 0, 1)), -0.2f);
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
