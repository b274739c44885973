// Tests the facade's Session: what a program steers, fills and reads back, frame after frame.
#include "fovea/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "framework/session/test_device.h"
#include "tests/support/graph_run.h"

namespace fovea::graph {
namespace {

using testing::HasSubstr;

constexpr const char* kFew = "vpl_count=64";

// Nobody owns it.
std::shared_ptr<gpu::Device> device() { return {std::shared_ptr<void>(), &test::testDevice()}; }

SessionOptions options(std::vector<std::string> set = {}, std::vector<std::string> read = {"radiance"}) {
  return {.device = device(), .size = {48, 48}, .set = std::move(set), .read = std::move(read)};
}

std::string messageOf(ExitCode code, const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

const std::vector<std::byte>& radiance(const FrameResult& frame) {
  return frame.outputs.at("radiance").bytes;
}

scene::Scene moving() {
  Diagnostics messages;
  return scene::load("cornellbox_moving", messages);
}

// Looks from a little to the right.
scene::Camera beside(const scene::Scene& scene, float metres = 0.2f) {
  scene::Camera camera = scene.cameras[0];
  camera.position += camera.orientation * glm::vec3(metres, 0, 0);
  return camera;
}

class GraphFile {
 public:
  explicit GraphFile(const char* text)
      : path_(std::filesystem::temp_directory_path() / ("session-" + std::to_string(getpid()) + ".json")) {
    std::ofstream(path_) << text;
  }
  ~GraphFile() { std::filesystem::remove(path_); }
  GraphFile(const GraphFile&) = delete;
  GraphFile& operator=(const GraphFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST(Session, UntouchedFramesAreThoseOfTheProgram) {
  const scene::Scene scene = moving();
  const test::GraphRun run = test::runGraph(
      "ours", scene,
      {.size = {48, 48}, .frames = 4, .set = {kFew}, .outputs = {"radiance"}, .everyFrame = true});
  Session session("ours", scene, options({kFew}));
  for (uint64_t i = 0; i < 4; ++i) EXPECT_EQ(radiance(session.render(i)), radiance(run.frames[i])) << i;
}

TEST(Session, CameraAndGazeAreThoseOfTheFrame) {
  scene::Scene scene = scene::builtin("cornellbox"), other = scene;
  other.cameras[0] = beside(scene);
  other.gaze = {{0, {0.1f, 0.9f}, true, {}, {}}};
  Session steered("ours", scene, options({kFew})), plain("ours", other, options({kFew}));
  const FrameOptions frame{.camera = other.cameras[0], .gaze = glm::vec2(0.1f, 0.9f)};
  const FrameResult seen = steered.render(frame);
  EXPECT_EQ(radiance(seen), radiance(plain.render(0)));
  Session unsteered("ours", scene, options({kFew}));
  EXPECT_NE(radiance(seen), radiance(unsteered.render(0)));
}

// Each of them alone changes the picture: neither stands in for the other.
TEST(Session, TheGazeAloneDecidesWhereVplsLie) {
  const scene::Scene scene = scene::builtin("cornellbox");
  Session here("ours", scene, options({kFew})), there("ours", scene, options({kFew}));
  EXPECT_NE(radiance(here.render({.gaze = glm::vec2(0.1f, 0.1f)})),
            radiance(there.render({.gaze = glm::vec2(0.9f, 0.9f)})));
}

TEST(Session, TimeIsTheScenesAndNotTheFramesNumber) {
  const scene::Scene scene = moving();
  Session direct("direct", scene, options()), later("direct", scene, options());
  const FrameResult start = direct.render({.index = 0, .time = 0.0}),
                    then = direct.render({.index = 1, .time = 1.0});
  EXPECT_NE(radiance(start), radiance(then));
  EXPECT_EQ(radiance(then), radiance(later.render(42)));  // 42 frames a second
}

// Motion vectors lead to where things were in the frame that was rendered before, whatever its number.
TEST(Session, MotionIsRelativeToTheLastFrame) {
  const GraphFile file(R"({
    "passes": { "gbuffer": { "type": "gbuffer" },
                "motion": { "type": "motion-vectors",
                            "inputs": { "gbuffer": "gbuffer", "previous": "gbuffer@previous" } } },
    "outputs": { "origin": "motion" } })");
  const scene::Scene scene = scene::builtin("cornellbox");
  struct Pixels {
    int still = 0, moved = 0;
  };
  const auto after = [&](const FrameOptions& next) {
    Session session(file.path(), scene, options({}, {"origin"}));
    session.render({.index = 0, .camera = beside(scene)});
    const FrameResult frame = session.render(next);
    Pixels pixels;
    const auto* origin = reinterpret_cast<const uint32_t*>(frame.outputs.at("origin").bytes.data());
    for (uint32_t i = 0; i < 48 * 48; ++i)
      if (origin[i] != 0xffffffffu) ++(origin[i] == (i % 48 | i / 48 << 16) ? pixels.still : pixels.moved);
    return pixels;
  };
  const Pixels rests = after({.index = 7, .camera = beside(scene)}), goes = after({.index = 1}),
               cut = after({.index = 1, .cut = true});
  EXPECT_GT(rests.still, 1000);
  EXPECT_EQ(rests.moved, 0);
  EXPECT_GT(goes.moved, 500);
  EXPECT_EQ(cut.still + cut.moved, 0);
}

TEST(Session, ImpossibleFramesAreRefused) {
  const scene::Scene scene = scene::builtin("cornellbox");
  Session session("direct", scene, options());
  const auto refused = [&](const FrameOptions& frame) {
    return messageOf(ExitCode::Usage, [&] { session.render(frame); });
  };
  EXPECT_THAT(refused({.time = -1.0}), HasSubstr("-1 seconds"));
  EXPECT_THAT(refused({.time = NAN}), HasSubstr("nan seconds"));
  EXPECT_THAT(refused({.gaze = glm::vec2(0.5f, 1.5f)}), HasSubstr("0.5, 1.5"));
  scene::Camera flat = scene.cameras[0];
  flat.verticalFov = 0;
  EXPECT_THAT(refused({.camera = flat}), HasSubstr("0 radians"));
  EXPECT_THAT(messageOf(ExitCode::Usage,
                        [&] {
                          SessionOptions none = options();
                          none.size = {0, 48};
                          Session("direct", scene, none);
                        }),
              HasSubstr("0x48"));
}

// The tone curve has no part in the radiance, whose history must not notice.
TEST(Session, HistoryGoesOnWhenAParameterChanges) {
  for (const scene::Scene& scene : {scene::builtin("cornellbox"), moving()}) {
    Session changed("ours", scene, options({kFew}, {"radiance", "image"})),
        plain("ours", scene, options({kFew}, {"radiance", "image"}));
    for (uint64_t i = 0; i < 6; ++i) {
      if (i == 3) changed.set({"tonemap.exposure=3"});
      const FrameResult a = changed.render(i), b = plain.render(i);
      EXPECT_EQ(radiance(a), radiance(b)) << i;
      EXPECT_EQ(a.outputs.at("image").bytes == b.outputs.at("image").bytes, i < 3) << i;
    }
  }
}

// What a pass does once for a scene is not done again for a parameter of another one.
TEST(Session, OnlyWhatDependsOnAParameterIsDoneAgain) {
  for (const char* name : {"cornellbox", "cornellbox_moving"}) {
    Diagnostics messages;
    const scene::Scene scene = scene::load(name, messages);
    Session session("ours", scene, options({kFew}));
    const auto work = [&](uint64_t index) {
      std::map<std::string, std::pair<CommandCounts, std::vector<std::string>>> passes;
      for (const PassTiming& pass : session.render(index).passes) {
        auto& [commands, steps] = passes[session.passName(pass.pass)];
        commands = pass.commands;
        for (const StepTiming& step : pass.steps) steps.push_back(step.name);
      }
      return passes;
    };
    const auto first = work(0);
    work(1);
    const auto usual = work(2);
    EXPECT_NE(first.at("voxelize").second, usual.at("voxelize").second);
    session.set({"deferred.clamp_distance=0.4"});
    const auto after = work(3);
    ASSERT_EQ(after.size(), usual.size());
    for (const auto& [pass, done] : usual) {
      EXPECT_EQ(after.at(pass).first, done.first) << name << ", " << pass;
      EXPECT_THAT(after.at(pass).second, testing::ElementsAreArray(done.second)) << name << ", " << pass;
    }
    session.set({"voxelize.resolution=64"});
    EXPECT_EQ(work(4).at("voxelize").second, first.at("voxelize").second);
  }
}

TEST(Session, AWrongParameterChangesNothing) {
  const scene::Scene scene = scene::builtin("cornellbox");
  Session changed("ours", scene, options({kFew})), plain("ours", scene, options({kFew}));
  changed.render(0), plain.render(0);
  EXPECT_THAT(messageOf(ExitCode::BadInput, [&] { changed.set({"vpl_cout=10"}); }), HasSubstr("`vpl_count`"));
  EXPECT_THAT(messageOf(ExitCode::Usage, [&] { changed.set({"vpl_count"}); }), HasSubstr("name=value"));
  EXPECT_EQ(radiance(changed.render(1)), radiance(plain.render(1)));
}

// The context adds the name in the graph and the type, once.
TEST(Session, ErrorsOfAPassBeginWithThePass) {
  const std::string text = messageOf(ExitCode::BadInput, [&] {
    scene::Scene scene = scene::builtin("cornellbox");
    SessionOptions both = options({kFew, "right.source_view=nowhere"});
    Session("stereo", scene, both).render(0);
  });
  EXPECT_THAT(text, testing::StartsWith(
                        "error: pass `right/reproject` (reproject): source_view `nowhere` is no view"));
  EXPECT_EQ(text.find("pass `", 8), std::string::npos) << text;
}

TEST(Session, AnyPortIsReadBack) {
  const scene::Scene scene = scene::builtin("cornellbox");
  Session session("direct", scene, options({}, {"image", "direct:direct", "radiance"}));
  FrameResult frame = session.render(0);
  EXPECT_EQ(frame.outputs.size(), 3u);
  EXPECT_EQ(frame.outputs.at("direct:direct").bytes, radiance(frame));
  session.read({"gbuffer:gbuffer.normal", "shadow-map:maps.depth@0.0"});
  frame = session.render(1);
  EXPECT_EQ(frame.outputs.size(), 2u);
  const image::Image normal = session.picture(frame, "gbuffer:gbuffer.normal");
  EXPECT_EQ(normal.width, 48u);
  EXPECT_NE(std::count(normal.data.begin(), normal.data.end(), 0.0f), std::ptrdiff_t(normal.data.size()));
  session.read({});
  EXPECT_EQ(session.render(2).outputs.size(), 3u);  // all outputs
  EXPECT_THAT(messageOf(ExitCode::BadInput, [&] { session.read({"gbufer:gbuffer.normal"}); }),
              HasSubstr("did you mean `gbuffer`?"));
  EXPECT_THAT(messageOf(ExitCode::BadInput, [&] { session.read({"radianc"}); }),
              HasSubstr("did you mean `radiance`?"));
  EXPECT_THAT(
      messageOf(ExitCode::Usage, [&] { session.picture(session.render(3), "gbuffer:gbuffer.normal"); }),
      HasSubstr("was not read back"));
}

TEST(Session, InputsOfTheGraphAreFilled) {
  const GraphFile file(R"({
    "inputs": { "light": { "format": "rgba16f", "width": 2, "height": 2 } },
    "parameters": { "exposure": 1.0 },
    "passes": { "tonemap": { "type": "tonemap", "inputs": { "radiance": "inputs.light" },
                             "params": { "exposure": "$exposure" } } },
    "outputs": { "image": "tonemap" } })");
  const scene::Scene scene = scene::builtin("cornellbox");
  Session session(file.path(), scene, options({}, {}));
  EXPECT_THAT(messageOf(ExitCode::Usage, [&] { session.render(0); }), HasSubstr("input `light`"));
  const auto filled = [](uint16_t half) { return std::vector<uint16_t>(2 * 2 * 4, half); };
  const std::vector<uint16_t> black = filled(0), white = filled(0x3c00);  // 0 and 1
  const auto shown = [&](uint64_t index) { return session.picture(session.render(index), "image").data[0]; };
  session.setInput("light", std::as_bytes(std::span(white)));
  EXPECT_NEAR(shown(0), 1, 0.01);
  session.set({"exposure=0.5"});       // the input stays
  EXPECT_NEAR(shown(1), 0.735, 0.01);  // sRGB of 0.5
  session.setInput("light", std::as_bytes(std::span(black)));
  EXPECT_NEAR(shown(2), 0, 0.01);
  EXPECT_THAT(messageOf(ExitCode::BadInput,
                        [&] { session.setInput("light", std::as_bytes(std::span(black)).first(8)); }),
              HasSubstr("wants 32 bytes, got 8"));
  EXPECT_THAT(
      messageOf(ExitCode::BadInput, [&] { session.setInput("dark", std::as_bytes(std::span(black))); }),
      HasSubstr("no input `dark`"));
}

// Light is given to a graph and read back in the units of the scene, even where 16-bit floats could not hold it.
TEST(Session, LightGoesThroughAGraphInTheUnitsOfTheScene) {
  const GraphFile file(R"({
    "inputs": { "light": { "format": "rgba16f", "light": true, "width": 2, "height": 2 } },
    "passes": { "mean": { "type": "accumulate", "inputs": { "value": "inputs.light" } } },
    "outputs": { "image": "mean" } })");
  for (const float unit : {1e-7f, 1.0f, 1e7f}) {
    SCOPED_TRACE(unit);
    scene::Scene scene = scene::builtin("cornellbox");
    scene.exposure /= unit;
    Session session(file.path(), scene, options({}, {}));
    std::vector<float> given(2 * 2 * 4);
    for (size_t i = 0; i < given.size(); ++i) given[i] = unit * (float(i) + 0.5f);
    session.setInput("light", std::as_bytes(std::span(given)));
    const image::Image out = session.picture(session.render(0), "image");
    for (size_t i = 0; i < given.size(); ++i) {
      if (i % 4 == 3) continue;
      EXPECT_NEAR(out.data[i] / unit, given[i] / unit, 1e-3 * double(i + 1));
    }
    EXPECT_THAT(messageOf(ExitCode::BadInput,
                          [&] { session.setInput("light", std::as_bytes(std::span(given)).first(32)); }),
                AllOf(HasSubstr("wants 64 bytes, got 32"), HasSubstr("32-bit floats")));
  }
}

// Without the answer, the frame would take an hour.
TEST(Session, LongPassesTellHowFarTheyAreAndStop) {
  const scene::Scene scene = scene::builtin("cornellbox");
  SessionOptions chosen = options({"spp=1000000"});
  std::vector<double> shares;
  chosen.progress = [&](const std::string& pass, double share) {
    EXPECT_FALSE(pass.empty());
    shares.push_back(share);
    return shares.size() < 2;
  };
  const FrameResult frame = Session("reference", scene, chosen).render(0);
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_LT(shares[0], shares[1]);
  EXPECT_LT(shares[1], 0.5);
  EXPECT_FALSE(radiance(frame).empty());
}

TEST(Session, SeveralShareADevice) {
  const scene::Scene box = scene::builtin("cornellbox"), other = moving();
  Session alone("ours", box, options({kFew}));
  std::vector<FrameResult> expected;
  for (uint64_t i = 0; i < 3; ++i) expected.push_back(alone.render(i));
  Session first("ours", box, options({kFew}));
  auto second = std::make_unique<Session>("direct", other, options());
  EXPECT_EQ(first.device(), second->device());
  for (uint64_t i = 0; i < 3; ++i) {
    if (i == 2) second.reset();  // the device stays with the others
    EXPECT_EQ(radiance(first.render(i)), radiance(expected[i])) << i;
    if (second) second->render(i);
  }
}

}  // namespace
}  // namespace fovea::graph
