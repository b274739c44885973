#include "benchmarks/runner/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "framework/base/paths.h"
#include "framework/base/text_file.h"

namespace fovea::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMatch = "match.value";

// 97.5% points of Student's t distribution for 1, 2, .. degrees of freedom.
constexpr double kStudent[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                               2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131};

// The paper's numbers: {"scenes": {"atrium": "Sponza"}, "tables": {"table1": {"Sponza": {"ours": {NAME: x}}}}}.
Json readPaper() {
  for (const auto& folder : dataFolders("benchmarks")) {
    std::ifstream in(folder / "paper.json", std::ios::binary);
    if (!in) continue;
    Json paper = Json::parse(in, nullptr, false);
    if (paper.is_object() && paper.contains("tables") && paper.contains("scenes")) return paper;
    throw Error(ExitCode::BadInput, "`" + (folder / "paper.json").string() + "` is not the paper's numbers",
                "restore it");
  }
  return Json::object();
}

std::optional<double> paperNumber(const Json& paper, const std::string& table, const std::string& scene,
                                  const std::string& graph, const std::string& measure) {
  if (table.empty() || !paper.contains("scenes") || !paper["scenes"].contains(scene)) return {};
  const std::string path[] = {table, paper["scenes"][scene].get<std::string>(), graph, measure};
  const Json* at = &paper["tables"];
  for (const std::string& key : path) {
    if (!at->is_object() || !at->contains(key)) return {};
    at = &(*at)[key];
  }
  return at->is_number() ? std::optional(at->get<double>()) : std::nullopt;
}

// RFC 4180.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == text.npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

struct Row {
  std::string scene, graph;
  std::vector<std::string> axes;
  std::vector<std::string> order;  // order of the numbers
  std::map<std::string, std::vector<double>> values;
  std::map<std::string, char>
      bounds;  // those only known to be '>' or '<' their value; '~': now one, now the other

  char bound(const std::string& name) const {
    const auto found = bounds.find(name);
    return found == bounds.end() ? ' ' : found->second;
  }
  void limit(const std::string& name, char sign) {
    if (sign == ' ') return;
    char& known = bounds.try_emplace(name, sign).first->second;
    if (known != sign) known = '~';
  }
};

// If a search ended at an end of its range, the number that it sought lies beyond.
char matchBound(const Json& match) {
  if (!match.value("reached", true)) return '>';
  return match.contains("steps") && match["steps"].size() == 1 ? '<' : ' ';
}

struct Table {
  std::vector<std::string> axes;
  std::vector<Row> rows;
};

Table tableOf(const std::string& sweep, const std::vector<StoredResult>& results) {
  Table table;
  for (const StoredResult& result : results) {
    const Json& job = result.json["job"];
    if (job["sweep"] != sweep) continue;
    for (const auto& [name, value] : job["varied"].items())
      if (std::find(table.axes.begin(), table.axes.end(), name) == table.axes.end())
        table.axes.push_back(name);
  }
  for (const StoredResult& result : results) {
    const Json& job = result.json["job"];
    if (job["sweep"] != sweep) continue;
    std::vector<std::string> axes;
    for (const std::string& name : table.axes) axes.push_back(job["varied"].value(name, std::string()));
    const std::string scene = job["scene"], graph = job["label"];
    auto row = std::find_if(table.rows.begin(), table.rows.end(), [&](const Row& r) {
      return r.scene == scene && r.graph == graph && r.axes == axes;
    });
    if (row == table.rows.end()) row = table.rows.insert(row, Row{scene, graph, axes, {}, {}});
    for (const auto& [name, value] : numbersOf(result.json)) {
      if (!row->values.contains(name)) row->order.push_back(name);
      row->values[name].push_back(value);
    }
    if (result.json.contains("match")) row->limit(kMatch, matchBound(result.json["match"]));
  }
  return table;
}

// Ratios of frame times, seed by seed; they are bounds if the number of VPLs of the other graph is a bound.
void addSpeedUps(const SpeedUp& wanted, Table& table) {
  const std::string time = "time.wall_ms";
  for (Row& row : table.rows) {
    if (row.graph != wanted.of) continue;
    for (const std::string& over : wanted.over) {
      const auto other = std::find_if(table.rows.begin(), table.rows.end(), [&](const Row& r) {
        return r.graph == over && r.scene == row.scene && r.axes == row.axes;
      });
      if (other == table.rows.end() || other->values[time].size() != row.values[time].size()) continue;
      const std::string name = "speed_up." + over;
      row.order.push_back(name);
      for (size_t i = 0; i < row.values[time].size(); ++i)
        row.values[name].push_back(other->values[time][i] / row.values[time][i]);
      row.limit(name, other->bound(kMatch));
    }
  }
}

// How much larger the errors of the others are than those of `ours`, seed by seed. What their scenes and references
// have in common cancels out, and an interval without 0 decides which is better.
void addDifferences(const std::string& measure, Table& table) {
  for (const Row& ours : table.rows) {
    if (ours.graph != "ours" || !ours.values.contains(measure)) continue;
    const std::vector<double>& own = ours.values.at(measure);
    for (Row& row : table.rows) {
      if (row.graph == ours.graph || row.scene != ours.scene || row.axes != ours.axes) continue;
      if (!row.values.contains(measure) || row.values[measure].size() != own.size()) continue;
      const std::string name = measure + "_over_ours";
      row.order.push_back(name);
      for (size_t i = 0; i < own.size(); ++i) row.values[name].push_back(row.values[measure][i] - own[i]);
    }
  }
}

// The paper's numbers apply to its parameters, at 42 frames a second; a bound cannot be compared with them.
bool likeThePaper(const Table& table, const Row& row, const std::string& name) {
  if (row.bound(name) != ' ') return false;
  for (size_t i = 0; i < table.axes.size(); ++i)
    if (table.axes[i] != "frame_rate" || row.axes[i] != "42") return false;
  return true;
}

std::string csvOf(const Table& table, const Json& paper, const std::string& paperTable) {
  std::string text = "scene,graph";
  for (const std::string& axis : table.axes) text += "," + cell(axis);
  text += ",measure,mean,half_width,seeds,paper,ratio,bound\n";
  for (const Row& row : table.rows)
    for (const std::string& name : row.order) {
      const Mean mean = meanOf(row.values.at(name));
      text += cell(row.scene) + "," + cell(row.graph);
      for (const std::string& axis : row.axes) text += "," + cell(axis);
      const auto known = likeThePaper(table, row, name)
                             ? paperNumber(paper, paperTable, row.scene, row.graph, name)
                             : std::nullopt;
      const char bound = row.bound(name);
      text += fmt::format(",{},{},{},{},{},{},{}\n", cell(name), cell(mean.mean), cell(mean.halfWidth),
                          mean.count, known ? cell(*known) : "", known ? cell(mean.mean / *known) : "",
                          bound == ' ' ? "" : std::string(1, bound));
    }
  return text;
}

// The part of a table that a terminal shows: errors, frame time and ratios, one row per graph of a scene.
std::string shownOf(const std::string& sweep, const Table& table, const Json& paper,
                    const std::string& paperTable) {
  std::vector<std::string> measures;
  for (const char* wanted :
       {"error.fovea.mse", "error.periphery.mse", "temporal.fovea.mse_prime", "temporal.periphery.mse_prime",
        "temporal.fovea.excess", "temporal.periphery.excess", "eyes.fovea.excess", "eyes.periphery.excess",
        "eyes.fovea.flicker", "eyes.periphery.flicker", "time.wall_ms", kMatch, "speed_up.", "second_eye."})
    for (const Row& row : table.rows)
      for (const std::string& name : row.order)
        if (name.starts_with(wanted) && !name.ends_with("_over_ours") &&
            std::find(measures.begin(), measures.end(), name) == measures.end())
          measures.push_back(name);
  std::vector<std::vector<std::string>> lines = {{"scene", "graph"}};
  lines[0].insert(lines[0].end(), measures.begin(), measures.end());
  for (const Row& row : table.rows) {
    std::string graph = row.graph;
    for (size_t i = 0; i < table.axes.size(); ++i) graph += " " + table.axes[i] + "=" + row.axes[i];
    std::vector<std::string>& line = lines.emplace_back(std::vector{row.scene, graph});
    for (const std::string& name : measures) {
      std::string& text = line.emplace_back();
      if (!row.values.contains(name)) continue;
      const Mean mean = meanOf(row.values.at(name));
      const auto shown = [](double value) {
        return std::abs(value) < 100 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
      };
      if (row.bound(name) != ' ') text = fmt::format("{} ", row.bound(name));
      text += shown(mean.mean);
      if (std::isfinite(mean.halfWidth)) text += " +- " + shown(mean.halfWidth);
      if (!likeThePaper(table, row, name)) continue;
      if (const auto known = paperNumber(paper, paperTable, row.scene, row.graph, name))
        text += fmt::format(" [{:.3g}]", *known);
    }
  }
  std::vector<size_t> widths(lines[0].size(), 0);
  for (const auto& line : lines)
    for (size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text = sweep + ": means +- half the 95% interval over seeds";
  text += paperTable.empty() ? "\n" : " [the paper's]\n";
  for (const auto& line : lines) {
    std::string padded;
    for (size_t i = 0; i < line.size(); ++i) padded += fmt::format("{:<{}}  ", line[i], widths[i]);
    text += padded.substr(0, padded.find_last_not_of(' ') + 1) + "\n";
  }
  return text + "\n";
}

}  // namespace

std::vector<std::pair<std::string, double>> numbersOf(const Json& result) {
  std::vector<std::pair<std::string, double>> list;
  const auto add = [&](const std::string& name, const Json& value) {
    if (value.is_number()) list.emplace_back(name, value.get<double>());
  };
  for (const char* part : {"error", "temporal", "eyes"})
    if (result.contains(part))
      for (const auto& [region, measures] : result[part].items()) {
        add(fmt::format("{}.{}", part, region), measures);  // of the whole picture
        if (measures.is_object())
          for (const auto& [name, value] : measures.items())
            add(fmt::format("{}.{}.{}", part, region, name), value);
      }
  if (result.contains("match")) add(kMatch, result["match"].value("value", Json()));
  if (!result.contains("time")) return list;
  const Json& time = result["time"];
  for (const auto& [name, spread] : time["frame"].items())
    add("time." + name, spread.value("median", Json()));
  for (const Json& pass : time["passes"])
    for (const char* clock : {"gpu_ms", "cpu_ms"})
      add(fmt::format("pass.{}.{}", pass["name"].get<std::string>(), clock),
          pass[clock].value("median", Json()));
  for (const auto& [name, value] : time["counters"].items()) add("counter." + name, value);
  if (time.contains("second_eye"))
    for (const auto& [name, value] : time["second_eye"].items()) add("second_eye." + name, value);
  return list;
}

Mean meanOf(const std::vector<double>& values) {
  Mean result{0, std::numeric_limits<double>::quiet_NaN(), values.size()};
  for (double v : values) result.mean += v / double(values.size());
  if (values.size() < 2) return result;
  double squares = 0;
  for (double v : values) squares += (v - result.mean) * (v - result.mean);
  const size_t freedom = values.size() - 1;
  const double t = freedom <= std::size(kStudent) ? kStudent[freedom - 1] : 1.96 + 2.5 / double(freedom);
  result.halfWidth = t * std::sqrt(squares / double(freedom) / double(values.size()));
  return result;
}

std::string writeTables(const BenchFolder& folder, const Suite& suite,
                        const std::vector<StoredResult>& results,
                        const std::map<std::string, std::string>& missingScenes, const std::string& command) {
  const Json paper = readPaper();
  std::vector<std::string> sweeps;
  for (const Job& job : suite.jobs)
    if (std::find(sweeps.begin(), sweeps.end(), job.sweep) == sweeps.end()) sweeps.push_back(job.sweep);
  Json written = Json::array();
  std::string shown;
  for (const std::string& sweep : sweeps) {
    Table table = tableOf(sweep, results);
    for (const SpeedUp& wanted : suite.speedUps)
      if (wanted.sweep == sweep) addSpeedUps(wanted, table);
    for (const char* measure : {"error.fovea.mse", "temporal.fovea.excess"}) addDifferences(measure, table);
    const auto found = suite.papers.find(sweep);
    const std::string paperTable = found == suite.papers.end() ? "" : found->second;
    writeText(folder.table(sweep), csvOf(table, paper, paperTable));
    written.push_back({{"sweep", sweep}, {"axes", table.axes}});
    if (!table.rows.empty()) shown += shownOf(sweep, table, paper, paperTable);
  }
  Json files = Json::array();
  for (const StoredResult& result : results) files.push_back(result.file.filename().string());
  const Json report = {{"suite", suite.name},
                       {"description", suite.description},
                       {"scale", suite.scale},
                       {"command", command},
                       {"paper", !suite.papers.empty()},
                       {"paper_scenes", paper.value("scenes", Json::object())},
                       {"jobs", suite.jobs.size()},
                       {"missing_scenes", missingScenes},
                       {"sweeps", written},
                       {"results", files}};
  writeText(folder.path() / "report.json", report.dump(1) + "\n");
  return shown;
}

}  // namespace fovea::bench
