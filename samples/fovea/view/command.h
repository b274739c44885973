// What a page asks the run to do, as a JSON object: {"playing": true}, {"set": {"vpl_count": "500"}}, ...
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fovea::view {

// Where the camera is and looks. Angles in radians: yaw turns left around the world's up, pitch then looks up.
struct Pose {
  glm::vec3 position{0};
  float yaw = 0, pitch = 0;
};

// Members that were not sent are empty. They are followed in this order.
struct Command {
  std::optional<std::string> graph, scene;  // names out of the lists that the page was given
  std::optional<std::string> second;        // a second graph to compare with; "" for none
  std::optional<std::string> tev;           // the source that tev shows; "" for none
  std::optional<bool> accumulate;           // adds up frames of the second graph while nothing moves
  std::optional<glm::uvec2> size;
  std::optional<uint32_t> seed;
  // A parameter's new value as text, or nothing for its value in the file.
  std::vector<std::pair<std::string, std::optional<std::string>>> set;
  bool resetAll = false;            // {"reset": true}: every parameter as in the file
  std::optional<std::string> save;  // name of the graph file to write beside the graph
  std::optional<Pose> pose;
  bool sceneCamera = false;  // {"camera": null}
  std::optional<glm::vec2> gaze;
  bool sceneGaze = false;  // {"gaze": null}
  std::optional<bool> playing, frozen, recording;
  std::optional<double> speed;
  std::optional<double> time;  // seconds, at which the next frame is
  uint32_t step = 0;
  bool restart = false;
};

inline constexpr double kMaxSpeed = 16;
inline constexpr double kMaxTime = 1e6;         // seconds
inline constexpr uint32_t kMaxViewSize = 4096;  // pixels a side

// Throws Error(BadInput) with every mistake; a command from a page or any other client is refused as a whole if any
// part of it is wrong.
Command parseCommand(std::string_view text);

// Letters, digits, '_' and '-', at most 64, for the name of a file to write.
bool isFileStem(std::string_view name);

}  // namespace fovea::view
