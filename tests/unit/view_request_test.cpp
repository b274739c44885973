// Tests what the viewer answers: token, Host, Origin, paths, sizes, and commands.
#include "samples/fovea/view/http/request.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "fovea/error.h"
#include "samples/fovea/view/command.h"

namespace fovea::view {
namespace {

const Access kAccess{"0123456789abcdef0123456789abcdef", "render.example"};

Request request(const std::string& name = "") {
  return {"GET", "/" + kAccess.token + "/" + name, {}, "127.0.0.1:8042", {}, {}, 0};
}

int statusOf(const Request& r) { return check(r, kAccess).status; }

TEST(ViewRequest, NothingIsServedWithoutTheToken) {
  EXPECT_EQ(statusOf(request()), 200);
  EXPECT_EQ(check(request("picture"), kAccess).name, "picture");
  for (const std::string& target :
       {std::string(), std::string("/"), std::string("//"), std::string("/picture"), "/" + kAccess.token,
        "/" + kAccess.token.substr(1) + "/", "/" + kAccess.token + "0/", "x" + kAccess.token + "/",
        std::string("/0123456789abcdef0123456789abcdeF/")}) {
    Request r = request();
    r.target = target;
    const Verdict verdict = check(r, kAccess);
    EXPECT_EQ(verdict.status, 404) << target;
    EXPECT_EQ(verdict.name, "") << target;
  }
}

TEST(ViewRequest, AnswersOnlyToNamesThatNobodyElseCanPointHere) {
  for (const char* host : {"127.0.0.1:8042", "localhost:9000", "LOCALHOST", "[::1]:8042", "10.1.2.3:80",
                           "render.example:8042", "render.example"}) {
    Request r = request();
    r.host = host;
    EXPECT_EQ(statusOf(r), 200) << host;
  }
  for (const char* host : {"", "evil.example", "127.0.0.1.evil.example", "localhost.evil.example:8042",
                           "localhost:8042:1", "localhost:", "localhost:80a", "[::1", "[x]:1", "1.2.3.4.5"}) {
    Request r = request();
    r.host = host;
    EXPECT_EQ(statusOf(r), 403) << host;
  }
}

TEST(ViewRequest, RefusesOtherSites) {
  Request r = request();
  r.origin = "http://127.0.0.1:8042";
  EXPECT_EQ(statusOf(r), 200);
  for (const char* origin :
       {"null", "http://127.0.0.1:8043", "https://127.0.0.1:8042", "http://evil.example"}) {
    r.origin = origin;
    EXPECT_EQ(statusOf(r), 403) << origin;
  }
  r.origin.clear();
  r.fetchSite = "cross-site";
  EXPECT_EQ(statusOf(r), 403);
  r.fetchSite = "same-origin";
  EXPECT_EQ(statusOf(r), 200);
}

TEST(ViewRequest, LeavesNoWayOutOfThePage) {
  for (const char* name : {"../../etc/passwd", "..", ".", ".hidden", "a/b", "a//", "a%2fb", "%2e%2e/", "a\\b",
                           "a..b", "a b", "a\nb", "\xff", "picture?x"})
    EXPECT_EQ(statusOf(request(name)), 404) << name;
  EXPECT_EQ(statusOf(request(std::string(1000, 'a'))), 404);
}

TEST(ViewRequest, BoundsMethodsAndBodies) {
  Request r = request("control");
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "HEAD", "TRACE", "", "get"}) {
    r.method = method;
    EXPECT_EQ(statusOf(r), 405) << method;
  }
  r.method = "POST";
  r.bodyBytes = kMaxBody;
  EXPECT_EQ(statusOf(r), 200);
  r.bodyBytes = kMaxBody + 1;
  EXPECT_EQ(statusOf(r), 413);
  r.bodyBytes = -1;
  EXPECT_EQ(statusOf(r), 411);
}

TEST(ViewRequest, TokensAreLongAndNew) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(makeToken());
  EXPECT_EQ(tokens.size(), 100u);
  for (const std::string& token : tokens) {
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  }
}

TEST(ViewRequest, ReadsQueries) {
  constexpr std::string_view kQuery = "source=gbuffer%3Anormal&x=1.5&y=-3&bad=%zz&nul=%00&plus=a+b&n=nan";
  EXPECT_EQ(queryValue(kQuery, "source"), "gbuffer:normal");
  EXPECT_EQ(queryValue(kQuery, "plus"), "a b");
  EXPECT_EQ(queryValue(kQuery, "bad"), std::nullopt);
  EXPECT_EQ(queryValue(kQuery, "nul"), std::nullopt);
  EXPECT_EQ(queryValue(kQuery, "ourc"), std::nullopt);
  EXPECT_EQ(queryNumber(kQuery, "x", 0, 2, 7), 1.5);
  EXPECT_EQ(queryNumber(kQuery, "x", 0, 1, 7), 7);
  EXPECT_EQ(queryNumber(kQuery, "y", 0, 1, 7), 7);
  EXPECT_EQ(queryNumber(kQuery, "n", 0, 1, 7), 7);
  EXPECT_EQ(queryNumber(kQuery, "missing", 0, 1, 7), 7);
}

// A million of requests, most of them nearly right. None may pass but those that are.
TEST(ViewRequest, RefusesWhateverIsNotRight) {
  std::mt19937 random(1);
  const auto pick = [&](size_t n) { return size_t(random() % n); };
  const std::vector<std::string> pieces = {
      "/",    kAccess.token, "picture", "..", "%2e", std::string(1, '\0'), ":", "80", "localhost",
      "evil", "http",        "//",      "?",  "é"};
  const auto text = [&] {
    std::string made;
    for (size_t i = pick(5); i > 0; --i) made += pieces[pick(pieces.size())];
    if (!made.empty() && pick(3) == 0) made[pick(made.size())] = char(random());
    return made;
  };
  for (int i = 0; i < 1'000'000; ++i) {
    Request r = request("state");
    if (pick(2)) r.target = text();
    if (pick(2)) r.host = text();
    if (pick(3) == 0) r.origin = text();
    if (pick(8) == 0) r.method = text();
    if (pick(8) == 0) r.bodyBytes = int64_t(random()) - int64_t(random());
    const Verdict verdict = check(r, kAccess);
    if (verdict.status != 200) continue;
    ASSERT_TRUE(r.target.starts_with("/" + kAccess.token + "/")) << r.target;
    ASSERT_EQ(verdict.name.find_first_of("/\\%"), std::string::npos) << r.target;
    ASSERT_EQ(verdict.name.find(".."), std::string::npos) << r.target;
    ASSERT_TRUE(r.origin.empty() || r.origin == "http://" + r.host) << r.origin;
  }
}

// ---- Commands --------------------------------------------------------------------------------------------------

void expectRefused(std::string_view text, std::string_view says) {
  try {
    parseCommand(text);
    ADD_FAILURE() << text << " was accepted";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string_view(e.what()).find(says), std::string_view::npos) << e.what();
  }
}

TEST(ViewCommand, ReadsWhatAPageAsks) {
  const Command c =
      parseCommand(R"({"playing": false, "speed": -2, "step": 3, "gaze": [0.25, 1], "size": [64, 48],
      "camera": {"position": [1, 2, 3], "yaw": 0.5, "pitch": -0.25}, "set": {"vpl_count": 500, "a.b": null,
      "x": true, "y": "text", "z": 0.1}, "save": "my-graph_2"})");
  EXPECT_EQ(c.playing, false);
  EXPECT_EQ(c.frozen, std::nullopt);
  EXPECT_EQ(c.speed, -2);
  EXPECT_EQ(c.step, 3u);
  EXPECT_EQ(c.gaze, glm::vec2(0.25f, 1));
  EXPECT_EQ(c.size, glm::uvec2(64, 48));
  ASSERT_TRUE(c.pose);
  EXPECT_EQ(c.pose->position, glm::vec3(1, 2, 3));
  EXPECT_EQ(c.pose->yaw, 0.5f);
  using Set = std::vector<std::pair<std::string, std::optional<std::string>>>;
  EXPECT_EQ(c.set,
            (Set{{"vpl_count", "500"}, {"a.b", std::nullopt}, {"x", "true"}, {"y", "text"}, {"z", "0.1"}}));
  EXPECT_EQ(c.save, "my-graph_2");
  EXPECT_TRUE(parseCommand(R"({"camera": null, "gaze": null})").sceneCamera);
}

TEST(ViewCommand, RefusesWhatIsWrongWhole) {
  expectRefused("", "JSON");
  expectRefused("[]", "object");
  expectRefused(R"({"playing": 1})", "playing");
  expectRefused(R"({"plying": true})", "plying");
  expectRefused(R"({"speed": 1e9})", "speed");
  expectRefused(R"({"gaze": [0.5, 2]})", "gaze");
  expectRefused(R"({"gaze": [0.5]})", "gaze");
  expectRefused(R"({"size": [0, 64]})", "size");
  expectRefused(R"({"size": [64.5, 64]})", "size");
  expectRefused(R"({"size": [1e9, 64]})", "size");
  expectRefused(R"({"camera": {"position": [1, 2]}})", "camera.position");
  expectRefused(R"({"camera": {"position": [1, 2, 1e30]}})", "camera.position");
  expectRefused(R"({"set": {"a": [1]}})", "set.a");
  expectRefused(R"({"set": {"a=b": 1}})", "set.a=b");
  for (const char* name : {"../x", "a/b", "", "a.json", "-o", "a b"})
    expectRefused(std::string(R"({"save": ")") + name + "\"}", "save");
  expectRefused(std::string(100, '['), "nested");
}

}  // namespace
}  // namespace fovea::view
