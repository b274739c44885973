// Tests what the viewer answers, as a whole: what a page gets, and that no request does harm.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <random>

#include "tests/fuzz/view_request_fuzz.h"

namespace fovea::view {
namespace {

using fuzz::kViewAccess;

Request requestFor(const std::string& name, const std::string& query = {}) {
  return {"GET", "/" + kViewAccess.token + "/" + name, query, "127.0.0.1:8042", {}, {}, 0};
}

TEST(ViewAnswers, ServesEachNameOnce) {
  fuzz::ViewServer server;
  for (const char* name : {"", "index.html", "main.js", "style.css", "state", "gaze.csv", "camera.json"})
    EXPECT_EQ(server.ask(requestFor(name), ""), 200) << name;
  for (const char* name : {"picture", "picture.png", "picture.exr", "pixels", "statistics"})
    EXPECT_EQ(server.ask(requestFor(name, "source=radiance"), ""), 200) << name;
  EXPECT_EQ(server.ask(requestFor("measures", "source=radiance&reference=image"), ""), 200);
  EXPECT_EQ(server.ask(requestFor("picture", "source=nothing"), ""), 204);
  EXPECT_EQ(server.ask(requestFor("picture"), ""), 400);
  EXPECT_EQ(server.ask(requestFor("picture.exr", "source=list"), ""), 404);
  EXPECT_EQ(server.ask(requestFor("pixels", "source=image&x=5"), ""), 404);
  EXPECT_EQ(server.ask(requestFor("passwd"), ""), 404);
  Request post = requestFor("control");
  post.method = "POST";
  post.bodyBytes = 15;
  EXPECT_EQ(server.ask(post, R"({"frozen":true})"), 204);
  EXPECT_EQ(server.ask(post, R"({"frozen":true)"), 400);
  EXPECT_EQ(server.ask(post, R"({"frozen":maybe})"), 400);
}

// Requests that are right or nearly so. FOVEA_VIEW_REQUESTS sets their number.
class Requests {
 public:
  std::pair<Request, std::string> next() {
    Request r = requestFor(one(kNames), query());
    std::string body;
    if (rarely(4)) {
      r.method = "POST";
      r.target = "/" + kViewAccess.token + "/control";
      body = "{" + one(kMembers) + (rarely(2) ? "" : ", " + one(kMembers)) + "}";
      r.bodyBytes = int64_t(body.size());
    }
    for (std::string* text : {&r.method, &r.target, &r.query, &r.host, &body})
      if (rarely(12)) spoil(*text);
    if (rarely(12)) r.origin = one({"null", "http://127.0.0.1:8042", "http://evil.example", "\r\nX: y"});
    if (rarely(20)) r.fetchSite = one({"cross-site", "same-origin", "none"});
    if (rarely(20)) r.bodyBytes = int64_t(random_()) - int64_t(random_());
    return {r, body};
  }

 private:
  using Texts = std::vector<std::string>;
  bool rarely(size_t n) { return random_() % n == 0; }
  const std::string& one(const Texts& list) { return list[random_() % list.size()]; }

  std::string query() {
    std::string text = "source=" + one(kSources);
    for (size_t i = random_() % 5; i > 0; --i) text += "&" + one(kKeys) + "=" + one(kValues);
    return text;
  }
  void spoil(std::string& text) {
    if (text.empty() || rarely(3))
      text.insert(random_() % (text.size() + 1),
                  one({"..", "/", "%00", "%2e%2e", "&", "\r\n", "\xff", "[[[["}));
    else if (rarely(2))
      text[random_() % text.size()] = char(random_());
    else
      text.resize(random_() % text.size());
  }

  const Texts kNames = {"",       "picture",    "picture.png", "picture.exr", "pixels",   "statistics",
                        "state",  "measures",   "gaze.csv",    "camera.json", "events",   "main.js",
                        "hidden", "../private", "picture.jpg", "index.html",  "style.css"};
  const Texts kSources = {"image",   "radiance",     "ids",         "list", "none",
                          "a:b@1.2", "second!image", "%22%0d%0aX:", ""};
  const Texts kKeys = {"x",       "y",   "width", "height", "exposure", "low",   "high", "channel",
                       "quality", "fit", "marks", "curve",  "after",    "minus", "map",  "reference"};
  const Texts kValues = {"0",         "1",    "2",   "4",     "7",   "-1",   "1e9",
                         "1e-30",     "nan",  "inf", "alpha", "red", "100",  "image",
                         "luminance", "srgb", "ids", "",      "%31", "9e15", "list"};
  const Texts kMembers = {R"("playing": true)",
                          R"("speed": 2)",
                          R"("set": {"a": 1, "b": null})",
                          R"("gaze": [0.5, 0.5])",
                          R"("camera": null)",
                          R"("size": [64, 64])",
                          R"("graph": "../secret")",
                          R"("save": "mine")",
                          R"("step": 1e99)",
                          R"("camera": {"position": [0, 1, 2], "yaw": 1})",
                          R"("set": {"x": [[]]})",
                          R"("tev": "image")",
                          R"("second": "direct")",
                          R"("no": 1)"};
  std::mt19937 random_{1};
};

TEST(ViewAnswers, NoRequestDoesHarm) {
  const char* asked = std::getenv("FOVEA_VIEW_REQUESTS");
  const long count = asked ? std::atol(asked) : 20'000;
  fuzz::ViewServer server;
  Requests requests;
  std::map<int, long> statuses;
  for (long i = 0; i < count; ++i) {
    const auto [request, body] = requests.next();
    ++statuses[server.ask(request, body)];
  }
  for (const int status : {200, 204, 400, 403, 404, 405}) EXPECT_GT(statuses[status], count / 500) << status;
  if (asked)
    for (const auto& [status, number] : statuses) std::printf("%d: %ld requests\n", status, number);
}

}  // namespace
}  // namespace fovea::view
