// Tests the control of a viewed run: time, camera and gaze, the exchange between its threads, and saved changes.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "framework/scene/motion/motion.h"
#include "framework/session/sources.h"
#include "samples/fovea/view/exchange.h"
#include "samples/fovea/view/graph/changes.h"
#include "samples/fovea/view/motion.h"
#include "samples/fovea/view/watcher.h"

namespace fovea::view {
namespace {

using std::chrono::milliseconds;

// ---- Motion ----------------------------------------------------------------------------------------------------

// A gaze that jumps and rests, and a camera that moves.
scene::Scene restlessScene() {
  scene::Scene s;
  s.cameras.emplace_back();
  for (int i = 0; i < 3; ++i) {
    scene::CameraKey key;
    key.time = float(i);
    key.camera.position = {float(i), 1, float(i * i)};
    s.cameraPath.push_back(key);
  }
  for (int i = 0; i < 20; ++i)
    s.gaze.push_back({0.1f * float(i), {0.1f + 0.8f * float(i * 7 % 5) / 5, 0.3f}, i % 4 != 3, {}, {}});
  return s;
}

void expectSame(const scene::Moment& a, const scene::Moment& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.before, b.before);
  EXPECT_EQ(a.camera.position, b.camera.position);
  EXPECT_EQ(a.previousCamera.position, b.previousCamera.position);
  EXPECT_EQ(a.gazes, b.gazes);
  EXPECT_EQ(a.saccade, b.saccade);
  EXPECT_EQ(a.cameraCut, b.cameraCut);
}

TEST(ViewMotion, UntouchedFramesAreThoseOfRender) {
  const scene::Scene s = restlessScene();
  Motion motion;
  for (uint64_t i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    expectSame(motion.next(s), scene::momentAt(s, i, kFrameRate));
  }
  motion.restart();
  expectSame(motion.next(s), scene::momentAt(s, 0, kFrameRate));
}

TEST(ViewMotion, TimeStandsStillStepsAndChangesItsSpeed) {
  const scene::Scene s = restlessScene();
  Motion motion;
  for (int i = 0; i < 5; ++i) motion.next(s);
  Command c;
  c.playing = false;
  motion.apply(c);
  const double still = motion.next(s).time;
  EXPECT_EQ(still, 4 / kFrameRate);
  EXPECT_EQ(motion.next(s).time, still);
  EXPECT_EQ(motion.shown().before, still);
  EXPECT_FALSE(motion.due());
  c = {};
  c.step = 2;
  motion.apply(c);
  EXPECT_TRUE(motion.frozen());
  EXPECT_TRUE(motion.due());
  motion.next(s);
  EXPECT_EQ(motion.next(s).time, 6 / kFrameRate);
  EXPECT_FALSE(motion.due());
  c = {};
  c.playing = true;
  c.frozen = false;
  c.speed = -100;
  motion.apply(c);
  EXPECT_EQ(motion.next(s).time, 0);  // no time before the first
}

TEST(ViewMotion, AnOwnCameraMovesWithItsHistory) {
  const scene::Scene s = restlessScene();
  Motion motion;
  motion.next(s);
  Command c;
  c.pose = Pose{{1, 2, 3}, 0.5f, -0.25f};
  motion.apply(c);
  EXPECT_TRUE(motion.due());
  scene::Moment m = motion.next(s);
  EXPECT_EQ(m.camera.position, glm::vec3(1, 2, 3));
  EXPECT_EQ(m.previousCamera.position, glm::vec3(0, 1, 0));
  const Pose back = poseOf(m.camera);
  EXPECT_NEAR(back.yaw, 0.5f, 1e-5f);
  EXPECT_NEAR(back.pitch, -0.25f, 1e-5f);
  m = motion.next(s);
  EXPECT_EQ(m.previousCamera.position, glm::vec3(1, 2, 3));
  c = {};
  c.sceneCamera = true;
  motion.apply(c);
  EXPECT_EQ(motion.next(s).camera.position, scene::cameraAt(s, 3 / kFrameRate).position);
}

// What was recorded, read as `fovea render --gaze-trace FILE --gaze-gap 0` reads it, yields the same frames.
TEST(ViewMotion, ARecordedGazeReplays) {
  scene::Scene s = restlessScene();
  Motion motion;
  Command c;
  c.recording = true;
  motion.apply(c);
  std::vector<scene::Moment> seen;
  for (int i = 0; i < 200; ++i) {
    if (i % 3 == 0) {
      c = {};
      c.gaze = glm::vec2(float(i * 37 % 100) / 99, float(i * i % 50) / 77);
      motion.apply(c);
    }
    seen.push_back(motion.next(s));
  }
  EXPECT_EQ(motion.recorded(), 200u);
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "view_gaze.csv";
  std::ofstream(file) << motion.gazeTable();
  s.gaze = scene::readGazeCsv(file);
  s.gazeGap = 0;
  for (uint64_t i = 0; i < seen.size(); ++i) {
    SCOPED_TRACE(i);
    const scene::Moment again = scene::momentAt(s, i, kFrameRate);
    EXPECT_EQ(again.gazes, seen[i].gazes);
    EXPECT_EQ(again.saccade, seen[i].saccade);
  }
}

TEST(ViewMotion, ARecordedCameraIsAMemberOfASceneFile) {
  const scene::Scene s = restlessScene();
  Motion motion;
  Command c;
  c.recording = true;
  c.pose = Pose{{1, 2, 3}, 0, 0};
  motion.apply(c);
  for (int i = 0; i < 3; ++i) motion.next(s);
  const json::Value file = json::parse(motion.cameraKeys(s.origin), "camera.json");
  const json::Value* path = file.find("camera")->find("path");
  ASSERT_EQ(path->items.size(), 3u);
  EXPECT_EQ(path->items[2].find("eye")->items[1].real, 2);
  EXPECT_NEAR(path->items[2].find("t")->real, 2 / kFrameRate, 1e-6);
  EXPECT_NEAR(path->items[2].find("target")->items[2].real, 2, 1e-6);
}

// ---- Exchange --------------------------------------------------------------------------------------------------

Shot shotOf(uint64_t frame) {
  Shot shot;
  shot.frame = frame;
  return shot;
}

TEST(ViewExchange, HandsOverTheNewestPictureOnce) {
  Exchange exchange;
  EXPECT_FALSE(exchange.watched());
  EXPECT_EQ(exchange.shot("image", 0, milliseconds(1)), nullptr);
  EXPECT_TRUE(exchange.watched());
  EXPECT_TRUE(exchange.hungry());
  EXPECT_TRUE(exchange.lacking());
  EXPECT_EQ(exchange.wanted(), std::vector<std::string>{"image"});
  exchange.publish("image", shotOf(7));
  exchange.publish("nobody wants this", shotOf(7));
  EXPECT_FALSE(exchange.hungry());
  const ShotPointer first = exchange.shot("image", 0, milliseconds(1));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->frame, 7u);
  EXPECT_FALSE(exchange.hungry());
  EXPECT_EQ(exchange.shot("image", first->number, milliseconds(1)), nullptr);
  EXPECT_TRUE(exchange.hungry());
  std::thread render([&] { exchange.publish("image", shotOf(8)); });
  const ShotPointer second = exchange.shot("image", first->number, milliseconds(5000));
  render.join();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->frame, 8u);
  EXPECT_EQ(first->frame, 7u);  // whoever still sends it keeps it
}

TEST(ViewExchange, BoundsWhatClientsCanAskFor) {
  Exchange exchange;
  for (size_t i = 0; i < 3 * Exchange::kMaxSources; ++i)
    exchange.shot("source " + std::to_string(i), 0, milliseconds(0));
  EXPECT_EQ(exchange.wanted().size(), Exchange::kMaxSources);
  for (size_t i = 0; i < Exchange::kMaxCommands; ++i) EXPECT_TRUE(exchange.send({}));
  EXPECT_FALSE(exchange.send({}));
  EXPECT_EQ(exchange.takeCommands().size(), Exchange::kMaxCommands);
  EXPECT_TRUE(exchange.send({}));
}

TEST(ViewExchange, StopLetsAllGo) {
  Exchange exchange;
  std::thread picture([&] { exchange.shot("image", 0, milliseconds(60000)); });
  std::thread tick([&] { exchange.tick(0, milliseconds(60000)); });
  std::this_thread::sleep_for(milliseconds(20));
  exchange.stop();
  picture.join();
  tick.join();
  EXPECT_TRUE(exchange.stopped());
}

// ---- Changes ---------------------------------------------------------------------------------------------------

constexpr const char* kGraph = R"({
  "parameters": { "radius": 0.5, "count": 3, "soft": true },
  "passes": {
    "tonemap": { "type": "tonemap", "inputs": { "radiance": "inputs.radiance" }, "params": { "exposure": "$radius" } }
  },
  "outputs": { "image": "tonemap" }
})";

// A graph without passes is enough: parameters of the graph are known from the document alone.
TEST(ViewChanges, BecomeAGraphOfTheDifferences) {
  const Documents documents{json::parse(kGraph, "base.json"), {{"right", json::parse(kGraph, "part.json")}}};
  const graph::BoundGraph bound;
  const std::string text =
      extendingGraph("base.json", {{"radius", "0.25"}, {"count", "7"}, {"soft", "false"}}, documents, bound);
  const json::Value saved = json::parse(text, "saved.json");
  EXPECT_EQ(saved.find("extends")->string, "base.json");
  const json::Value* parameters = saved.find("parameters");
  ASSERT_TRUE(parameters);
  EXPECT_EQ(parameters->members.size(), 3u);
  EXPECT_EQ(parameters->find("radius")->real, 0.25);
  EXPECT_TRUE(parameters->find("count")->isInt());
  EXPECT_FALSE(parameters->find("soft")->boolean);
  EXPECT_EQ(saved.find("passes"), nullptr);
  // A parameter of a sub-graph is given by its instance.
  const json::Value inner =
      json::parse(extendingGraph("base.json", {{"right.count", "5"}}, documents, bound), "inner.json");
  EXPECT_EQ(inner.find("passes")->find("right")->find("parameters")->find("count")->integer, 5);
  EXPECT_THROW(extendingGraph("base.json", {{"right.missing", "1"}}, documents, bound), Error);
  EXPECT_THROW(extendingGraph("base.json", {{"left/blur.radius", "1"}}, documents, bound), Error);
  EXPECT_THROW(extendingGraph("base.json", {{"blur.radius", "1"}}, documents, bound), Error);
  EXPECT_THROW(extendingGraph("base.json", {{"soft", "perhaps"}}, documents, bound), Error);
}

TEST(ViewChanges, AreTheOptionsOfRender) {
  EXPECT_EQ(overridesOf(changesOf({"b=1", "a.b=x=y", "b=2"})), (std::vector<std::string>{"a.b=x=y", "b=2"}));
  EXPECT_THROW(changesOf({"b"}), Error);
}

TEST(ViewSources, AreReadFromTheirNames) {
  const session::SourceName port = session::parseSource("left/gbuffer:gbuffer.normal@2.15");
  EXPECT_EQ(port.pass, "left/gbuffer");
  EXPECT_EQ(port.path, "gbuffer.normal");
  EXPECT_EQ(port.mip, 2u);
  EXPECT_EQ(port.layer, 15u);
  EXPECT_EQ(session::parseSource("image").path, "image");
  EXPECT_EQ(session::parseSource("image").pass, "");
  for (const char* text : {"", ":", "@", "a:@", "@.", "a@9999999999999.1", ":@1.2"})
    session::parseSource(text);
}

// ---- Watcher ---------------------------------------------------------------------------------------------------

TEST(ViewWatcher, TellsWhatWasSaved) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "view_watcher";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "inner");
  Watcher watcher;
  watcher.watch(withSubfolders(folder));
  EXPECT_TRUE(watcher.changed().empty());
  std::ofstream(folder / "graph.json") << "{}";
  std::ofstream(folder / "inner" / "blur.comp") << "void main() {}";
  std::ofstream(folder / "notes.txt") << "not watched";
  std::ofstream(folder / ".graph.json.swp") << "not watched";
  std::ofstream(folder / "new.part") << "{}";
  std::filesystem::rename(folder / "new.part", folder / "moved.json");
  EXPECT_EQ(watcher.changed(),
            (std::set<std::filesystem::path>{folder / "graph.json", folder / "inner" / "blur.comp",
                                             folder / "moved.json"}));
  watcher.watch({folder / "inner"});
  std::ofstream(folder / "graph.json") << "{ }";
  EXPECT_TRUE(watcher.changed().empty());
  std::filesystem::remove(folder / "inner" / "blur.comp");
  EXPECT_EQ(watcher.changed().size(), 1u);
}

}  // namespace
}  // namespace fovea::view
