// Tests the cameras of glTF models: what is read, and what replaces values that no camera can have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/scene/frame.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::TemporaryFolder;
using test::TriangleDocument;
using testing::HasSubstr;
using testing::Not;

struct Loaded {
  Scene scene;
  std::string warnings;
};

// The document with these cameras, each of which has a node.
TriangleDocument document(const std::vector<std::string>& cameras) {
  TriangleDocument d;
  std::string nodes = R"([{"mesh":0})", indices = "0", list;
  for (size_t i = 0; i < cameras.size(); ++i) {
    nodes += R"(,{"translation":[0,0,3],"camera":)" + std::to_string(i) + "}";
    indices += "," + std::to_string(i + 1);
    list += (i > 0 ? "," : "") + cameras[i];
  }
  d.nodes = nodes + "]";
  d.scenes = R"([{"nodes":[)" + indices + "]}]";
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  d.extra = R"(,"materials":[{}],"cameras":[)" + list + "]";
  return d;
}

Loaded loadedWith(const std::vector<std::string>& cameras, bool binary = false) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const TriangleDocument d = document(cameras);
  Scene scene = binary ? test::loadText(folder, d.glb(), warnings, "model.glb")
                       : test::loadText(folder, d.json(), warnings);
  return {std::move(scene), warnings.format()};
}

std::string perspective(const std::string& members) {
  return R"({"name":"eye","type":"perspective","perspective":{)" + members + "}}";
}

TEST(GltfCamera, SoundValuesAreTaken) {
  const Loaded l = loadedWith({perspective(R"("yfov":0.7,"znear":0.1,"zfar":50,"aspectRatio":1.5)")});
  EXPECT_EQ(l.warnings, "");
  const Camera& c = l.scene.cameras.at(0);
  EXPECT_EQ(c.verticalFov, 0.7f);
  EXPECT_EQ(c.zNear, 0.1f);
  EXPECT_EQ(c.zFar, 50);
  EXPECT_EQ(c.aspectRatio, 1.5f);
}

TEST(GltfCamera, ValuesThatNoCameraCanHaveAreNamedAndReplaced) {
  struct Case {
    const char* members;
    const char* place;
    Camera expected;
  };
  const auto camera = [](float fov, float near, float far) {
    Camera c;
    c.verticalFov = fov, c.zNear = near, c.zFar = far;
    return c;
  };
  const Case cases[] = {
      {R"("znear":0.1)", ".yfov", camera(0.8f, 0.1f, 0)},
      {R"("yfov":0,"znear":0.1)", ".yfov", camera(0.8f, 0.1f, 0)},
      {R"("yfov":-1,"znear":0.1)", ".yfov", camera(0.8f, 0.1f, 0)},
      {R"("yfov":45,"znear":0.1)", ".yfov", camera(0.8f, 0.1f, 0)},
      {R"("yfov":0.7)", ".znear", camera(0.7f, 0.05f, 0)},
      {R"("yfov":0.7,"znear":0,"zfar":20)", ".znear", camera(0.7f, 2e-3f, 20)},
      {R"("yfov":0.7,"znear":100,"zfar":0.5)", ".zfar", camera(0.7f, 0.5f, 100)},
      {R"("yfov":0.7,"znear":2,"zfar":2)", ".zfar", camera(0.7f, 2, 0)},
      {R"("yfov":0.7,"znear":2,"zfar":0)", ".zfar", camera(0.7f, 2, 0)},
      {R"("yfov":0.7,"znear":2,"zfar":-5)", ".zfar", camera(0.7f, 2, 0)},
      {R"("yfov":0.7,"znear":2,"aspectRatio":0)", ".aspectRatio", camera(0.7f, 2, 0)},
      {R"("yfov":0.7,"znear":2,"aspectRatio":-2)", ".aspectRatio", camera(0.7f, 2, 0)},
  };
  for (const Case& test : cases)
    for (const bool binary : {false, true}) {
      SCOPED_TRACE(test.members);
      const Loaded l = loadedWith({perspective(test.members)}, binary);
      EXPECT_THAT(l.warnings, HasSubstr("cameras[0] `eye`.perspective"));
      EXPECT_THAT(l.warnings, HasSubstr(test.place));
      EXPECT_THAT(l.warnings, Not(HasSubstr("rthographic")));
      const Camera& c = l.scene.cameras.at(0);
      EXPECT_FLOAT_EQ(c.verticalFov, test.expected.verticalFov);
      EXPECT_FLOAT_EQ(c.zNear, test.expected.zNear);
      EXPECT_FLOAT_EQ(c.zFar, test.expected.zFar);
      EXPECT_EQ(c.aspectRatio, 0);
      EXPECT_EQ(c.position, glm::vec3(0, 0, 3));
    }
  EXPECT_THAT(loadedWith({R"({"type":"perspective"})"}).warnings, HasSubstr("cameras[0].perspective.yfov"));
}

TEST(GltfCamera, OrthographicOnesAreNamedWithWhatIsShownInstead) {
  for (const char* members : {R"("xmag":1,"ymag":1,"znear":0.1,"zfar":9)", R"("xmag":0,"ymag":0)", ""}) {
    const std::string flat =
        R"({"name":"plan","type":"orthographic","orthographic":{)" + std::string(members) + "}}";
    const Loaded alone = loadedWith({flat});
    EXPECT_TRUE(alone.scene.cameras.empty());
    EXPECT_THAT(alone.warnings, HasSubstr("cameras[0] `plan`"));
    EXPECT_THAT(alone.warnings, HasSubstr("a camera is chosen instead"));
    const Loaded two = loadedWith({flat, perspective(R"("yfov":0.7,"znear":0.1)")});
    EXPECT_EQ(two.scene.cameras.at(0).verticalFov, 0.7f);
    EXPECT_EQ(two.scene.nodes.at(2).camera, 0u);
    EXPECT_THAT(two.warnings, HasSubstr("the model's camera `eye` is used instead"));
  }
}

TEST(GltfCamera, IsLeftOutIfAMemberHasAWrongType) {
  const Loaded wide = loadedWith({perspective(R"("yfov":"wide","znear":0.1)")});
  EXPECT_TRUE(wide.scene.cameras.empty());
  EXPECT_THAT(wide.warnings, HasSubstr("cameras[0].perspective.yfov"));
  const Loaded fisheye = loadedWith({R"({"type":"fisheye"})"});
  EXPECT_TRUE(fisheye.scene.cameras.empty());
  EXPECT_THAT(fisheye.warnings, HasSubstr("cameras[0].type"));
}

}  // namespace
}  // namespace fovea::scene
