// Tests the gaze over time (samples joined within fixations and held over blinks, pauses and saccades), tables with
// mistakes, and the fovea as an angle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "framework/scene/file/reader.h"
#include "framework/scene/frame.h"
#include "framework/scene/motion/motion.h"
#include "scene_support.h"
#include "tests/references/fovea.h"

namespace fovea::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

GazeSample at(float t, float x, float y, bool valid = true) { return {t, {x, y}, valid, {}, {}}; }

void expectGaze(const std::vector<GazeSample>& gaze, double time, glm::vec2 expected, double gap = kGazeGap) {
  EXPECT_LT(glm::distance(gazeAt(gaze, time, gap).position, expected), 1e-5f) << time;
}

// Samples at 100 Hz: a fixation that drifts, a saccade from one sample to the next, another fixation.
TEST(Gaze, FixationsAreJoinedAndSaccadesAreNot) {
  const std::vector<GazeSample> gaze = {at(0, 0.30f, 0.5f), at(0.01f, 0.32f, 0.5f), at(0.02f, 0.70f, 0.6f),
                                        at(0.03f, 0.70f, 0.62f)};
  expectGaze(gaze, -1, {0.30f, 0.5f});
  expectGaze(gaze, 0.005, {0.31f, 0.5f});
  expectGaze(gaze, 0.0125, {0.32f, 0.5f});
  expectGaze(gaze, 0.0199, {0.32f, 0.5f});
  expectGaze(gaze, 0.02, {0.70f, 0.6f});
  expectGaze(gaze, 0.025, {0.70f, 0.61f});
  expectGaze(gaze, 9, {0.70f, 0.62f});
}

TEST(Gaze, BlinksAndPausesHold) {
  const std::vector<GazeSample> gaze = {at(0, 0.5f, 0.5f), at(0.02f, 0, 0, false), at(0.04f, 0.52f, 0.5f),
                                        at(0.5f, 0.54f, 0.5f)};
  expectGaze(gaze, 0.01, {0.5f, 0.5f});
  expectGaze(gaze, 0.03, {0.5f, 0.5f});
  expectGaze(gaze, 0.04, {0.52f, 0.5f});
  expectGaze(gaze, 0.27, {0.52f, 0.5f});
  expectGaze(gaze, 0.27, {0.53f, 0.5f}, 1.0);
  expectGaze({at(0, 0.1f, 0.1f, false), at(1, 0.2f, 0.3f)}, 0.5, {0.2f, 0.3f});
  expectGaze({at(0, 0.1f, 0.1f, false)}, 0.5, {0.5f, 0.5f});
  expectGaze({}, 0.5, {0.5f, 0.5f});
}

TEST(Gaze, EachEyeOnItsOwn) {
  std::vector<GazeSample> gaze = {at(0, 0.5f, 0.5f), at(0.02f, 0.52f, 0.5f)};
  gaze[0].left = {0.48f, 0.5f};
  gaze[1].left = {0.50f, 0.5f};
  gaze[0].right = {0.52f, 0.5f};
  const GazeSample g = gazeAt(gaze, 0.01);
  EXPECT_LT(glm::distance(*g.left, glm::vec2(0.49f, 0.5f)), 1e-6f);
  EXPECT_EQ(*g.right, glm::vec2(0.52f, 0.5f));
}

TEST(Gaze, ATableSaysWhichLineIsWrong) {
  test::TemporaryFolder folder;
  const auto read = [&](const std::string& text) { return readGazeCsv(folder.write("g.csv", text)); };
  const auto samples = read("t,x,y,valid\n# eye tracker\n0,0.25,0.5,1\n0.1,,,0\n0.2,0.75,0.5,1\n");
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_FALSE(samples[1].valid);
  EXPECT_EQ(samples[2].position, glm::vec2(0.75f, 0.5f));
  const auto error = [&](const std::string& text) { return test::errorOf([&] { read(text); }); };
  EXPECT_THAT(error("t,x,y,valid\n0,0.5,0.5,1\nrubbish\n"), HasSubstr("g.csv:3"));
  EXPECT_THAT(error("t,x,y,valid\n0,0.5,0.5,1\n0.1,a,0.5,1\n0.2,0.5,7,1\n"),
              AllOf(HasSubstr("g.csv:3"), HasSubstr("`x` is `a`"), HasSubstr("g.csv:4")));
  EXPECT_THAT(error("t,x,y,valid\n0,nan,0.5,1\n"), HasSubstr("g.csv:2"));
  EXPECT_THAT(error("t,x,y,valid\n0.2,0.5,0.5,1\n0.1,0.5,0.5,1\n"),
              AllOf(HasSubstr("g.csv:3"), HasSubstr("increase")));
  EXPECT_THAT(error("time,x,y\n"), HasSubstr("g.csv:1"));
  EXPECT_THAT(error(std::string("\x00\xff\x13 garbage", 11)), HasSubstr("g.csv:1"));
  EXPECT_THAT(error("t,x,y,vald\n"), HasSubstr("did you mean `valid`?"));
  EXPECT_THAT(error("t,x,y," + std::string(400, 'v') + "\n"), HasSubstr("the columns are t, x, y"));
  EXPECT_THAT(error(""), HasSubstr("no header line"));
  EXPECT_THAT(error("root:secret:20228:0:99999:7:::\n"),
              AllOf(HasSubstr("t,x,y,valid"), Not(HasSubstr("secret"))));
}

TEST(Gaze, TablesAsOtherProgramsWriteThem) {
  for (const std::string table :
       {"\xEF\xBB\xBFt,x,y,valid\r\n0,0.25,0.5,1\r\n0.1,,,0\r\n", "t;x;y;valid\r0;0.25;0.5;1\r0.1;;;0\r",
        "sep=;\r\nT;X;Y;Valid\r\n0,0;0,25;0,5;1\r\n0,1;;;0\r\n",
        "t\tx\ty\tvalid\n0\t0.25\t.5\t1\n0.1\t\t\t0\n",
        "\"t\",\"x\",\"y\",\"valid\"\n\"0\",\"0,25\",\"0,5\",\"1\"\n\"0,1\",\"\",\"\",\"0\"\n",
        "\xEF\xBB\xBF\"VALID\" ; \"Y\" ; \"X\" ; \"T\";;\n1;0.5;0.25;0;;\n;;;;;\n0;;;0.1;;"}) {
    const std::vector<GazeSample> samples = parseGazeCsv(table, "g.csv");
    ASSERT_EQ(samples.size(), 2u) << table;
    EXPECT_EQ(samples[0].position, glm::vec2(0.25f, 0.5f)) << table;
    EXPECT_EQ(samples[0].time, 0) << table;
    EXPECT_EQ(samples[1].time, 0.1f) << table;
    EXPECT_FALSE(samples[1].valid) << table;
  }
}

TEST(Gaze, WhatIsAmbiguousInTablesIsNamed) {
  const auto error = [](const std::string& text) {
    return test::errorOf([&] { parseGazeCsv(text, "g.csv"); });
  };
  EXPECT_THAT(error("t,x,y\n0,0,0,25,0,5\n"), AllOf(HasSubstr("g.csv:2"), HasSubstr("semicolons")));
  EXPECT_THAT(error("t;x;y\n0,5;0,25;0,5\n1.5;0,25;0,5\n"),
              AllOf(HasSubstr("g.csv:3"), HasSubstr("decimal commas and decimal points")));
  EXPECT_THAT(error("t;x;y\n1,000.5;0.25;0.5\n"), AllOf(HasSubstr("g.csv:2"), HasSubstr("`t` is `1,000.5`")));
  EXPECT_THAT(error("t x y\n0 0.5 0.5\n"), HasSubstr("g.csv:1"));
  EXPECT_THAT(error(std::string("\xFF\xFEt\0,\0x\0", 8)), HasSubstr("UTF-16"));
  EXPECT_THAT(error("t,T,x,y\n"), HasSubstr("`t` is there twice"));
  for (const char* number : {"0x1", "1e", "nan", "inf", "+0.5", "0.5s", "00.5"})
    EXPECT_THAT(error(std::string("t,x,y\n0,0.5,") + number + "\n"), HasSubstr("from 0 to 1")) << number;
}

TEST(Gaze, TablesWithoutAValidSampleAreRefused) {
  const auto error = [](const std::string& text) {
    return test::errorOf([&] { parseGazeCsv(text, "g.csv"); });
  };
  EXPECT_THAT(error("t,x,y\n"), HasSubstr("no samples"));
  EXPECT_THAT(error("t,x,y,valid\n0,0.5,0.5,0\n1,,,0\n"), HasSubstr("no valid sample"));
  Diagnostics messages;
  readGaze(json::parse(R"([{ "t": 0, "valid": false }])", "s.json"), messages);
  EXPECT_THAT(messages.list().at(0).message, HasSubstr("no sample of the gaze is valid"));
}

// The pixel at the rim of the disc is seen at the given angle.
TEST(Gaze, FoveaAsAnAngle) {
  for (const glm::uvec2 size : {glm::uvec2(640, 480), glm::uvec2(100, 300)}) {
    Camera camera;
    camera.verticalFov = 0.9f;
    const View view = makeView(camera, size, {});
    const float angle = glm::radians(12.0f);
    const float radius = foveaRadiusOfAngle(angle, view.viewToClip) * float(size.x);
    const glm::vec2 middle = 0.5f * glm::vec2(size);
    for (const glm::vec2 rim :
         {glm::vec2(radius, 0), glm::vec2(0, radius), -glm::vec2(0.6f, 0.8f) * radius}) {
      const glm::vec3 d = glm::normalize(view.rayDirection(middle + rim));
      EXPECT_NEAR(std::acos(-d.z), angle, 1e-4f);
    }
  }
}

}  // namespace
}  // namespace fovea::scene
