#include "tests/openxr/script.h"

#include <vulkan/vulkan_core.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

namespace fovea::test {
namespace {

using Json = nlohmann::json;

glm::vec3 vec3(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }
glm::vec2 vec2(const Json& json) { return {json.at(0), json.at(1)}; }

Place place(const Json& json) {
  Place place;
  if (json.contains("position")) place.position = vec3(json["position"]);
  if (json.contains("orientation")) {  // x, y, z, w
    const Json& q = json["orientation"];
    place.orientation = glm::normalize(glm::quat(q.at(3), q.at(0), q.at(1), q.at(2)));
  }
  return place;
}

// The last key at or before the time; the first one if there is none.
template <class Key>
size_t keyAt(const std::vector<Key>& keys, double seconds) {
  size_t i = 0;
  while (i + 1 < keys.size() && keys[i + 1].time <= seconds) ++i;
  return i;
}

}  // namespace

Script Script::load(const char* file) {
  Script script;
  try {
    Json json = Json::object();
    if (file) json = Json::parse(std::ifstream(file), nullptr, true, true);
    for (const Json& view :
         json.value("views", Json::parse(R"([{"position": [-0.032, 0, 0]}, {"position": [0.032, 0, 0]}])"))) {
      ScriptedView& v = script.views.emplace_back();
      if (view.contains("size")) v.width = view["size"].at(0), v.height = view["size"].at(1);
      v.inHead = place(view);
      if (view.contains("fov")) {
        const Json& fov = view["fov"];
        v.left = fov.at(0), v.right = fov.at(1), v.up = fov.at(2), v.down = fov.at(3);
      }
    }
    script.period = json.value("period", script.period);
    script.gazeLatency = json.value("gaze_latency", script.gazeLatency);
    script.frames = json.value("frames", uint64_t(0));
    script.picturesEvery = json.value("pictures_every", uint64_t(1));
    script.headset = json.value("headset", true);
    script.formats =
        json.value("formats", std::vector<int64_t>{VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM});
    script.without = json.value("without", std::set<std::string>());
    for (const Json& key : json.value("head", Json::array()))
      script.head_.push_back({key.at("time"), place(key)});
    for (const Json& key : json.value("gaze", Json::array())) {
      GazeKey& made = script.gaze_.emplace_back(GazeKey{key.at("time"), {}});
      if (!key.contains("angles")) continue;  // lost
      const glm::vec2 angles = vec2(key["angles"]);
      made.direction =
          glm::angleAxis(angles.x, glm::vec3(0, 1, 0)) * glm::angleAxis(angles.y, glm::vec3(1, 0, 0));
    }
    for (const Json& key : json.value("sticks", Json::array()))
      script.sticks_.push_back(
          {key.at("time"), vec2(key.value("walk", Json{0, 0})), vec2(key.value("turn", Json{0, 0}))});
    for (const Json& event : json.value("events", Json::array()))
      script.events.push_back({event.value("frame", uint64_t(0)), event.at("what"),
                               event.value("function", ""), event.value("result", 0),
                               event.value("count", 1)});
  } catch (const Json::exception& error) {
    std::fprintf(stderr, "test runtime: %s: %s\n", file, error.what());
    std::exit(1);
  }
  return script;
}

Place Script::head(double seconds) const {
  if (head_.empty()) return {};
  const size_t i = keyAt(head_, seconds);
  if (i + 1 >= head_.size() || seconds <= head_[i].time) return head_[i].place;
  const HeadKey &a = head_[i], &b = head_[i + 1];
  const float t = float((seconds - a.time) / (b.time - a.time));
  return {glm::mix(a.place.position, b.place.position, t),
          glm::normalize(glm::slerp(a.place.orientation, b.place.orientation, t))};
}

std::optional<glm::quat> Script::gaze(double seconds) const {
  if (gaze_.empty()) return std::nullopt;
  return gaze_[keyAt(gaze_, seconds)].direction;
}

glm::vec2 Script::stick(double seconds, bool turn) const {
  if (sticks_.empty()) return glm::vec2(0);
  const StickKey& key = sticks_[keyAt(sticks_, seconds)];
  return turn ? key.turn : key.walk;
}

}  // namespace fovea::test
