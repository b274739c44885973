#include "samples/fovea/view/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "framework/base/json.h"

namespace fovea::view {
namespace {

constexpr double kFar = 1e6;  // metres
constexpr uint32_t kMaxSteps = 1000;
constexpr size_t kMaxValues = 256, kMaxText = 4096;

// A member that is a text of sensible length.
std::optional<std::string> textOf(json::ObjectReader& reader, std::string_view key) {
  if (!reader.has(key)) return std::nullopt;
  std::string text = reader.text(key);
  if (text.size() > kMaxText) {
    reader.diagnostics().error({}, reader.pathOf(key), "the text is too long");
    return std::nullopt;
  }
  return text;
}

std::optional<bool> flagOf(json::ObjectReader& reader, std::string_view key) {
  if (!reader.has(key)) return std::nullopt;
  return reader.boolean(key, false);
}

// The text that `--set` would take.
std::optional<std::string> valueText(const json::Value& value) {
  switch (value.type) {
    case json::Value::Type::Bool:
      return value.boolean ? "true" : "false";
    case json::Value::Type::Int:
      return std::to_string(value.integer);
    case json::Value::Type::Real:
      return fmt::format("{}", value.real);
    case json::Value::Type::String:
      return value.string;
    default:
      return std::nullopt;
  }
}

void readValues(json::ObjectReader& reader, Command& command) {
  const json::Value* set = reader.object("set");
  if (!set) return;
  if (set->members.size() > kMaxValues)
    reader.diagnostics().error({}, "set", fmt::format("at most {} values at once", kMaxValues));
  for (const json::Member& member : set->members) {
    std::optional<std::string> text = valueText(member.value);
    const bool good = (text || member.value.isNull()) && (!text || text->size() <= kMaxText) &&
                      member.key.find('=') == std::string::npos;
    if (!good)
      reader.diagnostics().error({}, json::joinPath("set", member.key),
                                 "expected true, false, a number, a text or null");
    command.set.emplace_back(member.key, std::move(text));
  }
}

void readCamera(json::ObjectReader& reader, Command& command) {
  const json::Value* value = reader.find("camera");
  if (!value) return;
  command.sceneCamera = value->isNull();
  if (command.sceneCamera) return;
  json::ObjectReader camera(*value, "camera", reader.diagnostics());
  Pose pose;
  const auto position = camera.numbers("position", 3);
  if (!position)
    reader.diagnostics().error({}, "camera.position", "three numbers are missing");
  else if (std::any_of(position->begin(), position->end(), [](double v) { return v < -kFar || v > kFar; }))
    reader.diagnostics().error({}, "camera.position", "the camera would be too far away");
  else
    pose.position = {float((*position)[0]), float((*position)[1]), float((*position)[2])};
  pose.yaw = float(camera.number("yaw", 0, -1e4, 1e4));
  pose.pitch = float(camera.number("pitch", 0, -1.6, 1.6));
  camera.finish();
  command.pose = pose;
}

void readGaze(json::ObjectReader& reader, Command& command) {
  const json::Value* value = reader.find("gaze");
  if (!value) return;
  command.sceneGaze = value->isNull();
  if (command.sceneGaze) return;
  const auto gaze = reader.numbers("gaze", 2);
  if (!gaze) return;
  if (std::any_of(gaze->begin(), gaze->end(), [](double v) { return v < 0 || v > 1; }))
    reader.diagnostics().error({}, "gaze", "both coordinates go from 0 to 1");
  else
    command.gaze = {float((*gaze)[0]), float((*gaze)[1])};
}

void readSize(json::ObjectReader& reader, Command& command) {
  const auto size = reader.numbers("size", 2);
  if (!size) return;
  const auto whole = [](double v) { return v >= 1 && v <= kMaxViewSize && v == double(uint32_t(v)); };
  if (!whole((*size)[0]) || !whole((*size)[1]))
    reader.diagnostics().error({}, "size", fmt::format("both sides go from 1 to {} pixels", kMaxViewSize));
  else
    command.size = {uint32_t((*size)[0]), uint32_t((*size)[1])};
}

}  // namespace

Command parseCommand(std::string_view text) {
  const json::Value document = json::parse(text, "the request");
  Diagnostics mistakes;
  json::ObjectReader reader(document, "", mistakes);
  Command command;
  command.graph = textOf(reader, "graph");
  command.scene = textOf(reader, "scene");
  command.second = textOf(reader, "second");
  command.tev = textOf(reader, "tev");
  command.accumulate = flagOf(reader, "accumulate");
  readSize(reader, command);
  if (reader.has("seed")) command.seed = uint32_t(reader.integer("seed", 1, 0, 0xffffffffll));
  readValues(reader, command);
  command.resetAll = reader.boolean("reset", false);
  command.save = textOf(reader, "save");
  if (command.save && !isFileStem(*command.save))
    mistakes.error({}, "save", fmt::format("`{}` is no name for a graph", *command.save),
                   "use letters, digits, _ and -, at most 64");
  readCamera(reader, command);
  readGaze(reader, command);
  command.playing = flagOf(reader, "playing");
  command.frozen = flagOf(reader, "frozen");
  command.recording = flagOf(reader, "recording");
  if (reader.has("speed")) command.speed = reader.number("speed", 1, -kMaxSpeed, kMaxSpeed);
  if (reader.has("time")) command.time = reader.number("time", 0, 0, kMaxTime);
  command.step = uint32_t(reader.integer("step", 0, 0, kMaxSteps));
  command.restart = reader.boolean("restart", false);
  reader.finish();
  mistakes.throwIfErrors();
  return command;
}

bool isFileStem(std::string_view name) {
  return !name.empty() && name.size() <= 64 && name[0] != '-' &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

}  // namespace fovea::view
