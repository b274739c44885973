// What the headset of a test does: read from a JSON file, whose members README.md describes.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace fovea::test {

struct Place {
  glm::vec3 position{0};
  glm::quat orientation{1, 0, 0, 0};
};

struct ScriptedView {
  uint32_t width = 64, height = 64;
  Place inHead;
  float left = -0.8f, right = 0.8f, up = 0.8f, down = -0.8f;  // radians
};

struct ScriptedEvent {
  uint64_t frame = 0;  // the number of the xrWaitFrame at whose beginning it happens
  std::string what, function;
  int result = 0;  // XrResult of `function`
  int count = 1;   // of calls that fail
};

class Script {
 public:
  static Script load(const char* file);  // ends the process with a message if it cannot be read

  Place head(double seconds) const;
  // Direction relative to the head, as an orientation whose -Z looks there; nothing while it is lost.
  std::optional<glm::quat> gaze(double seconds) const;
  glm::vec2 stick(double seconds, bool turn) const;

  std::vector<ScriptedView> views;
  int64_t period = 11'111'111, gazeLatency = 8'000'000;  // nanoseconds
  uint64_t frames = 0;  // submitted before the runtime ends the session; 0 for no such number
  uint64_t picturesEvery = 1;
  std::vector<ScriptedEvent> events;
  std::set<std::string> without;  // extensions
  std::vector<int64_t> formats;
  bool headset = true;

 private:
  struct HeadKey {
    double time;
    Place place;
  };
  struct GazeKey {
    double time;
    std::optional<glm::quat> direction;
  };
  struct StickKey {
    double time;
    glm::vec2 walk, turn;
  };
  std::vector<HeadKey> head_;
  std::vector<GazeKey> gaze_;
  std::vector<StickKey> sticks_;
};

}  // namespace fovea::test
