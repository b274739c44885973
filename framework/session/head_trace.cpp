#include "framework/session/head_trace.h"

#include <fmt/format.h>

#include "framework/scene/file/csv_table.h"

namespace fovea::session {
namespace {

using scene::CsvTable;
using scene::kViewNames;

constexpr const char* kPose[] = {"x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr const char* kFrustum[] = {"left", "right", "up", "down"};
constexpr const char* kGaze[] = {"gaze_x", "gaze_y"};
constexpr double kFar = 1e9;  // metres
constexpr double kLeastTangent = -50,
                 kMostTangent = 50;    // a field of view may lie to one side of the line of sight
constexpr const char* kHead = "head";  // the columns of view 0

std::string column(const std::string& group, const char* name) { return group + "." + name; }

std::string groupOf(size_t view) { return view == 0 ? kHead : kViewNames[view]; }

std::vector<std::string> knownColumns() {
  std::vector<std::string> names = {"t"};
  for (size_t view = 0; view < std::size(kViewNames); ++view) {
    for (const char* name : kPose) names.push_back(column(groupOf(view), name));
    if (view > 0)
      for (const char* name : kFrustum) names.push_back(column(groupOf(view), name));
    for (const char* name : kGaze) names.push_back(column(groupOf(view), name));
  }
  return names;
}

void append(std::string& row, glm::vec3 position, glm::quat orientation) {
  row += fmt::format(",{},{},{},{},{},{},{}", position.x, position.y, position.z, orientation.x,
                     orientation.y, orientation.z, orientation.w);
}

// Reads the columns of one row.
class Row {
 public:
  explicit Row(CsvTable& table) : table_(table) {}
  bool complete() const { return complete_; }
  double number(const std::string& column, double min, double max) {
    const std::optional<double> value = table_.number(column, min, max);
    complete_ &= value.has_value();
    return value.value_or(0);
  }
  float real(const std::string& group, const char* name, double min, double max) {
    return float(number(column(group, name), min, max));
  }
  glm::vec3 position(const std::string& group) {
    return {real(group, "x", -kFar, kFar), real(group, "y", -kFar, kFar), real(group, "z", -kFar, kFar)};
  }
  glm::quat orientation(const std::string& group) {
    const float x = real(group, "qx", -1, 1), y = real(group, "qy", -1, 1), z = real(group, "qz", -1, 1),
                w = real(group, "qw", -1, 1);
    const glm::quat q(w, x, y, z);
    if (complete_ && std::abs(glm::length(q) - 1) > 1e-3f) {
      table_.mistake("the orientation of `" + group + "` is no unit quaternion");
      complete_ = false;
    }
    return q;
  }
  scene::Frustum frustum(const std::string& group) {
    const auto tangent = [&](const char* name) { return real(group, name, kLeastTangent, kMostTangent); };
    const scene::Frustum f{tangent("left"), tangent("right"), tangent("up"), tangent("down")};
    if (complete_ && !(f.left + f.right > 1e-4f && f.up + f.down > 1e-4f)) {
      table_.mistake("the field of view of `" + group + "` is empty", "give tangents, which grow outwards");
      complete_ = false;
    }
    return f;
  }
  glm::vec2 gaze(const std::string& group) {
    return {real(group, "gaze_x", 0, 1), real(group, "gaze_y", 0, 1)};
  }

 private:
  CsvTable& table_;
  bool complete_ = true;
};

}  // namespace

std::string headTraceTable(const std::vector<scene::Moment>& moments) {
  std::string text = "# fovea render GRAPH --scene SCENE --head-trace THIS\n";
  const scene::Eyes present = moments.empty() ? scene::Eyes() : moments[0].eyes;
  std::string header = "t";
  for (size_t view = 0; view < present.size(); ++view) {
    if (view > 0 && !present[view]) continue;
    for (const char* name : kPose) header += "," + column(groupOf(view), name);
    if (view > 0)
      for (const char* name : kFrustum) header += "," + column(groupOf(view), name);
    for (const char* name : kGaze) header += "," + column(groupOf(view), name);
  }
  text += header + "\n";
  for (const scene::Moment& moment : moments) {
    text += fmt::format("{}", moment.time);
    for (size_t view = 0; view < present.size(); ++view) {
      if (view == 0) {
        append(text, moment.camera.position, moment.camera.orientation);
      } else if (const std::optional<scene::Eye>& eye = moment.eyes[view]; present[view] && eye) {
        append(text, eye->position, eye->orientation);
        const scene::Frustum& f = eye->frustum;
        text += fmt::format(",{},{},{},{}", f.left, f.right, f.up, f.down);
      } else {
        continue;
      }
      text += fmt::format(",{},{}", moment.gazes[view].x, moment.gazes[view].y);
    }
    text += "\n";
  }
  return text;
}

std::vector<Steering> parseHeadTrace(std::string_view text, const std::string& file,
                                     const scene::Camera& camera) {
  CsvTable table(file, {"a table of heads",
                        knownColumns(),
                        {"t", "head.x", "head.y", "head.z", "head.qx", "head.qy", "head.qz", "head.qw"},
                        "t,head.x,head.y,head.z,head.qx,head.qy,head.qz,head.qw"});
  std::vector<Steering> rows;
  table.read(text, [&] {
    const size_t before = table.mistakes();
    Row row(table);
    Steering steering;
    steering.time = row.number("t", 0, 1e6);
    scene::Camera head = camera;
    head.position = row.position(kHead);
    head.orientation = row.orientation(kHead);
    steering.camera = head;
    for (size_t view = 0; view < std::size(kViewNames); ++view) {
      const std::string group = groupOf(view);
      if (view > 0 && table.has(column(group, "x")))
        steering.eyes[view] = scene::Eye{row.position(group), row.orientation(group), row.frustum(group)};
      if (table.has(column(group, "gaze_x"))) steering.gazes[view] = row.gaze(group);
    }
    if (table.mistakes() > before) return;
    if (!row.complete()) return table.mistake("a row needs a number in each of its columns");
    if (!rows.empty() && steering.time <= rows.back().time)
      return table.mistake("the times of the frames must increase");
    rows.push_back(steering);
  });
  if (rows.empty()) table.mistake("the table has no rows", "record at least one frame");
  table.throwIfWrong();
  return rows;
}

std::vector<Steering> readHeadTrace(const std::filesystem::path& file, const scene::Camera& camera) {
  return parseHeadTrace(scene::readTableText(file), file.string(), camera);
}

std::vector<scene::Moment> replay(const scene::Scene& scene, const std::vector<Steering>& rows) {
  Course course;
  std::vector<scene::Moment> moments;
  for (const Steering& row : rows) moments.push_back(course.next(scene, moments.size(), row));
  return moments;
}

}  // namespace fovea::session
