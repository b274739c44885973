// Reads gaze samples from a scene file, or from a table as written by eye trackers.
#include <algorithm>

#include "framework/scene/file/csv_table.h"
#include "framework/scene/file/reader.h"
#include "framework/scene/motion/motion.h"

namespace fovea::scene {
namespace {

using json::ObjectReader;

std::optional<glm::vec2> readEye(ObjectReader& r, std::string_view key) {
  const auto v = r.numbers(key, 2);
  if (!v) return std::nullopt;
  const glm::vec2 p((*v)[0], (*v)[1]);
  if (!(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1)) mistake(r, key, "a gaze lies within 0 to 1");
  return p;
}

}  // namespace

std::vector<GazeSample> readGaze(const json::Value& list, Diagnostics& errors) {
  std::vector<GazeSample> samples;
  for (size_t i = 0; i < list.items.size(); ++i) {
    ObjectReader r(list.items[i], itemPath("gaze", i), errors);
    r.require("t");
    GazeSample g;
    g.time = float(r.number("t", 0, 0, 1e6));
    g.valid = r.boolean("valid", true);
    g.position = {float(r.number("x", 0.5, 0, 1)), float(r.number("y", 0.5, 0, 1))};
    g.left = readEye(r, "left");
    g.right = readEye(r, "right");
    if (!samples.empty() && r.has("t") && g.time <= samples.back().time)
      mistake(r, "t", "the times of the gaze must increase");
    r.finish();
    samples.push_back(g);
  }
  const auto valid = [](const GazeSample& g) { return g.valid; };
  if (!samples.empty() && std::none_of(samples.begin(), samples.end(), valid))
    errors.error(list.where.location(), "gaze", "no sample of the gaze is valid",
                 "give at least one sample where the eye is open, or leave `gaze` out");
  return samples;
}

std::vector<GazeSample> parseGazeCsv(std::string_view text, const std::string& file) {
  CsvTable table(file, {"a table of gazes",
                        {"t", "x", "y", "valid", "left_x", "left_y", "right_x", "right_y"},
                        {"t", "x", "y"},
                        "t,x,y,valid"});
  std::vector<GazeSample> samples;
  const auto eye = [&](const char* x, const char* y) -> std::optional<glm::vec2> {
    const auto a = table.number(x, 0, 1), b = table.number(y, 0, 1);
    if (!a || !b) return std::nullopt;
    return glm::vec2(*a, *b);
  };
  table.read(text, [&] {
    const size_t before = table.mistakes();
    GazeSample g;
    const auto t = table.number("t", 0, 1e6);
    g.valid = table.number("valid", 0, 1).value_or(1) != 0;
    // Trackers leave the position of an invalid sample empty, or write something outside the image.
    const auto position = g.valid ? eye("x", "y") : glm::vec2(0.5f);
    if (g.valid) g.left = eye("left_x", "left_y"), g.right = eye("right_x", "right_y");
    if (table.mistakes() > before) return;
    if (!t || !position) return table.mistake("a sample needs t, and a valid one x and y");
    g.time = float(*t);
    g.position = *position;
    if (!samples.empty() && g.time <= samples.back().time)
      return table.mistake("the times of the gaze must increase");
    samples.push_back(g);
  });
  if (std::ranges::none_of(samples, &GazeSample::valid))
    table.mistake(samples.empty() ? "the table has no samples" : "the table has no valid sample",
                  "give at least one sample where the eye is open, or leave the table out");
  table.throwIfWrong();
  return samples;
}

std::vector<GazeSample> readGazeCsv(const std::filesystem::path& file) {
  return parseGazeCsv(readTableText(file), file.string());
}

}  // namespace fovea::scene
