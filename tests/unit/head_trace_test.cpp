// Tests tables of heads: what is written is read back to the bit, and mistakes are told where they are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/scene/scene.h"
#include "framework/session/head_trace.h"
#include "tests/unit/scene_support.h"

namespace fovea::session {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kHeader = "t,head.x,head.y,head.z,head.qx,head.qy,head.qz,head.qw";

scene::Camera framed() {
  scene::Camera camera;
  camera.verticalFov = 0.7f;
  camera.zNear = 0.02f;
  return camera;
}

// Steering of three frames with numbers that have no short spelling.
std::vector<Steering> walk() {
  std::vector<Steering> rows;
  for (int i = 0; i < 3; ++i) {
    Steering row;
    row.time = i / 90.0;
    scene::Camera head = framed();
    head.position = {0.1f * float(i), 1.0f / 3, -2.0f / 7};
    head.orientation = glm::normalize(glm::quat(1, 0.1f * float(i), 0.3f, -0.2f));
    row.camera = head;
    for (const char* name : {"left", "right"}) {
      const size_t view = scene::viewIndex(name);
      row.eyes[view] = scene::Eye{head.position + glm::vec3(0.0317f, 0, 0),
                                  glm::normalize(glm::quat(1, 0, 0.02f * float(i), 0)),
                                  {1.0f / 3, 0.9f, -0.1f, 0.7f}};
      row.gazes[view] = glm::vec2(1.0f / 7, 0.1f * float(i));
    }
    rows.push_back(row);
  }
  return rows;
}

TEST(HeadTrace, IsReadBackToTheBit) {
  const scene::Scene scene = scene::builtin("cornellbox");
  const std::vector<scene::Moment> moments = replay(scene, walk());
  ASSERT_EQ(moments.size(), 3u);
  EXPECT_TRUE(moments[0].cameraCut);
  EXPECT_FALSE(moments[1].cameraCut);
  EXPECT_EQ(moments[2].previousCamera.position, moments[1].camera.position);
  const std::string table = headTraceTable(moments);
  const std::vector<scene::Moment> again = replay(scene, parseHeadTrace(table, "h.csv", framed()));
  EXPECT_EQ(headTraceTable(again), table);
  const scene::Geometry geometry = scene::flatten(scene);
  for (size_t i = 0; i < moments.size(); ++i) {
    const scene::Frame a = scene::makeFrame(scene, geometry, {40, 30}, moments[i], 1),
                       b = scene::makeFrame(scene, geometry, {40, 30}, again[i], 1);
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.saccade, b.saccade);
    for (size_t v = 0; v < a.views.size(); ++v) {
      EXPECT_EQ(a.views[v].worldToClip, b.views[v].worldToClip) << i << a.views[v].name;
      EXPECT_EQ(a.views[v].previousWorldToClip, b.views[v].previousWorldToClip) << i << a.views[v].name;
      EXPECT_EQ(a.views[v].gaze, b.views[v].gaze) << i << a.views[v].name;
    }
  }
}

TEST(HeadTrace, ViewsWithoutColumnsFollowFromTheHead) {
  const std::vector<Steering> rows =
      parseHeadTrace(std::string(kHeader) + "\n0.5,1,2,3,0,0,0,1\n", "h.csv", framed());
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].time, 0.5);
  EXPECT_EQ(rows[0].camera->position, glm::vec3(1, 2, 3));
  EXPECT_EQ(rows[0].camera->verticalFov, framed().verticalFov);
  for (const auto& eye : rows[0].eyes) EXPECT_FALSE(eye);
  for (const auto& gaze : rows[0].gazes) EXPECT_FALSE(gaze);
}

TEST(HeadTrace, SaysWhatIsWrongAndWhere) {
  const auto error = [](const std::string& text) {
    return test::errorOf([&] { parseHeadTrace(text, "h.csv", framed()); });
  };
  const std::string header = std::string(kHeader) + "\n", row = "0,1,2,3,0,0,0,1\n";
  EXPECT_THAT(error(""), HasSubstr("no header line"));
  EXPECT_THAT(error(header), HasSubstr("no rows"));
  EXPECT_THAT(error("t,x,y,valid\n"), AllOf(HasSubstr("h.csv:1"), HasSubstr("`head.x` is missing")));
  EXPECT_THAT(error(header + row + row), AllOf(HasSubstr("h.csv:3"), HasSubstr("increase")));
  EXPECT_THAT(error(header + "0,1,2,3,0,0,0,2\n"),
              AllOf(HasSubstr("h.csv:2"), HasSubstr("`head.qw` is `2`")));
  EXPECT_THAT(error(header + "0,1,2,3,0,0,0,0.5\n"), HasSubstr("no unit quaternion"));
  EXPECT_THAT(error(header + "0,1,2,3,0,0,0,\n"), HasSubstr("a number in each of its columns"));
  EXPECT_THAT(error(header + "0,nan,2,3,0,0,0,1\n"), HasSubstr("`head.x` is `nan`"));
  EXPECT_THAT(error("t,head.y,head.z,head.qx,head.qy,head.qz,head.qw,hed.x\n"),
              HasSubstr("did you mean `head.x`?"));
  const std::string left =
      std::string(kHeader) +
      ",left.x,left.y,left.z,left.qx,left.qy,left.qz,left.qw,left.left,left.right,left.up,left.down\n";
  EXPECT_THAT(error(left + "0,1,2,3,0,0,0,1,1,2,3,0,0,0,1,1,-1,1,1\n"),
              HasSubstr("field of view of `left` is empty"));
  EXPECT_THAT(error("t,head.x,head.y,head.z,head.qx,head.qy,head.qz,head.qw,left.x\n0,1,2,3,0,0,0,1,1\n"),
              HasSubstr("a number in each of its columns"));
}

}  // namespace
}  // namespace fovea::session
