#include "benchmarks/runner/suite.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "benchmarks/runner/scale.h"
#include "framework/base/files.h"
#include "framework/base/json.h"
#include "framework/session/inputs.h"

namespace fovea::bench {
namespace {

namespace fs = std::filesystem;
using json::ObjectReader;
using json::Value;

constexpr int64_t kMaxFrames = 1'000'000;
constexpr size_t kMaxJobs = 100'000;

template <class T>
struct Placed {
  T value;
  SourceLocation where;
};
using Texts = std::vector<Placed<std::string>>;

struct GraphEntry {
  std::string graph, label;
  std::vector<std::pair<std::string, std::vector<std::string>>> set;
  std::optional<Match> match;
  std::optional<uint32_t> warmup;  // overrides the sweep's
  SourceLocation where;
};

// Settings allowed at the head of the suite and in each sweep; those of a sweep replace those of the head.
struct Settings {
  Texts scenes;
  std::vector<GraphEntry> graphs;
  std::vector<std::pair<std::string, std::vector<std::string>>> set;
  std::vector<std::string> sizes = {"256x256"};
  std::vector<double> frameRates = {42};
  uint32_t first = 40, frames = 1, warmup = 0, seeds = 1, spp = 512, depth = 4;
  std::vector<std::string> measures = {"error"};
  std::string layer = "radiance", paper;
  std::vector<SpeedUp> speedUps;
};

std::string textOf(const Value& value) {
  if (value.isString()) return value.string;
  if (value.isBool()) return value.boolean ? "true" : "false";
  if (value.isInt()) return std::to_string(value.integer);
  std::ostringstream text;
  text << value.real;
  return text.str();
}

bool isPlain(const Value& value) { return value.isString() || value.isBool() || value.isNumber(); }

void expected(Diagnostics& messages, const Value& value, const std::string& path, const std::string& what) {
  messages.error(value.where.location(), path, "expected " + what + ", found " + value.describe());
}

std::optional<glm::uvec2> sizeOf(const std::string& text) {
  try {
    return session::parseSize(text);
  } catch (const Error&) {
    return std::nullopt;  // the caller reports what was expected, and where
  }
}

class SuiteReader {
 public:
  SuiteReader(Diagnostics& messages, const SuiteOverrides& overrides)
      : messages_(messages), overrides_(overrides) {}

  void read(const Value& root, Suite& suite) {
    ObjectReader r(root, "", messages_);
    suite.description = r.text("description");
    readPage(r, suite);
    for (auto& [name, scale] : readScales(r, messages_)) {
      if (name == overrides_.scale) scale_ = std::move(scale);
      suite.scales.push_back(name);
    }
    for (const auto& name : texts(r, "optional_scenes")) optional_.insert(name.value);
    Settings head;
    readSettings(r, head);
    const Value* sweeps = r.array("sweeps");
    if (!sweeps)
      messages_.error(root.where.location(), "sweeps", "a suite needs `sweeps`", "a list of what to measure");
    std::set<std::string> names;
    for (size_t i = 0; sweeps && i < sweeps->items.size(); ++i)
      readSweep(sweeps->items[i], "sweeps[" + std::to_string(i) + "]", head, names, suite);
    r.finish();
  }

 private:
  // The script that it names is run, so it has to be one of those that come with the program.
  void readPage(ObjectReader& r, Suite& suite) {
    suite.page = r.text("page");
    const auto bad = [](unsigned char c) { return !std::isalnum(c) && c != '_'; };
    if (const Value* page = r.find("page"); page && std::any_of(suite.page.begin(), suite.page.end(), bad))
      expected(messages_, *page, "page", "the name of a script in benchmarks/, without .py");
  }

  Texts texts(ObjectReader& r, const char* key) {
    Texts list;
    const Value* array = r.array(key);
    for (size_t i = 0; array && i < array->items.size(); ++i) {
      const Value& item = array->items[i];
      if (item.isString() && !item.string.empty()) {
        list.push_back({item.string, item.where.location()});
      } else {
        expected(messages_, item, r.pathOf(key) + "[" + std::to_string(i) + "]", "a name");
      }
    }
    return list;
  }

  // Either one value, as in "vpl_count": 500, or a list of values.
  void readSet(ObjectReader& r, std::vector<std::pair<std::string, std::vector<std::string>>>& set) {
    const Value* object = r.object("set");
    if (!object) return;
    for (const json::Member& member : object->members) {
      const std::string path = r.pathOf("set") + "." + member.key;
      std::vector<std::string> values;
      if (isPlain(member.value)) {
        values.push_back(textOf(member.value));
      } else if (member.value.isArray() && !member.value.items.empty()) {
        for (const Value& item : member.value.items) {
          if (isPlain(item)) {
            values.push_back(textOf(item));
          } else {
            expected(messages_, item, path, "a number, text, true or false");
          }
        }
      } else {
        expected(messages_, member.value, path, "a value, or a list of values to go through");
      }
      std::erase_if(set, [&](const auto& old) { return old.first == member.key; });
      set.emplace_back(member.key, std::move(values));
    }
  }

  void readGraph(const Value& value, const std::string& path, std::vector<GraphEntry>& graphs) {
    GraphEntry entry;
    entry.where = value.where.location();
    if (value.isString() && !value.string.empty()) {
      entry.graph = entry.label = value.string;
    } else if (value.isObject()) {
      ObjectReader r(value, path, messages_);
      entry.graph = r.text("graph");
      if (entry.graph.empty()) messages_.error(entry.where, path, "which graph?", "add \"graph\": \"ours\"");
      entry.label = r.text("label", fs::path(entry.graph).stem().string());
      readSet(r, entry.set);
      if (r.has("warmup")) entry.warmup = uint32_t(r.integer("warmup", 0, 0, kMaxFrames));
      if (const Value* match = r.object("match")) entry.match = readMatch(*match, r.pathOf("match"));
      r.finish();
    } else {
      return expected(messages_, value, path, "a graph's name, or an object with \"graph\"");
    }
    entry.label = fs::path(entry.label).stem().string();
    for (const GraphEntry& other : graphs)
      if (other.label == entry.label)
        messages_.error(entry.where, path, "the label `" + entry.label + "` occurs twice in this list",
                        "give one of them another \"label\"");
    graphs.push_back(std::move(entry));
  }

  Match readMatch(const Value& value, const std::string& path) {
    ObjectReader r(value, path, messages_);
    Match match;
    match.parameter = r.text("parameter", match.parameter);
    match.like = r.text("like");
    if (match.like.empty())
      messages_.error(value.where.location(), path,
                      "match needs `like`: the graph whose error is to be reached");
    match.measure =
        r.choice("measure", match.measure,
                 {"error.fovea.mse", "error.periphery.mse", "error.whole.mse", "error.fovea.relmse"});
    match.from = uint32_t(r.integer("from", match.from, 1, 1'000'000));
    match.to = uint32_t(r.integer("to", match.to, match.from, 1'000'000));
    r.finish();
    return match;
  }

  void readSizes(ObjectReader& r, Settings& s) {
    const Value* value = r.find("size");
    if (!value) return;
    s.sizes.clear();
    const std::vector<Value> one = {*value};
    for (const Value& item : value->isArray() ? value->items : one) {
      if (item.isString() && sizeOf(item.string)) {
        s.sizes.push_back(item.string);
      } else {
        expected(messages_, item, r.pathOf("size"), "a size like \"256x256\", 1 to 16384 pixels a side");
      }
    }
  }

  void readFrameRates(ObjectReader& r, Settings& s) {
    const Value* value = r.find("frame_rate");
    if (!value) return;
    s.frameRates.clear();
    const std::vector<Value> one = {*value};
    for (const Value& item : value->isArray() ? value->items : one) {
      if (item.isNumber() && item.real >= 0.1 && item.real <= 1e5) {
        s.frameRates.push_back(item.real);
      } else {
        expected(messages_, item, r.pathOf("frame_rate"), "frames a second from 0.1 to 100000");
      }
    }
  }

  void readSettings(ObjectReader& r, Settings& s) {
    Texts scenes = texts(r, "scenes");
    if (r.has("scenes")) s.scenes = std::move(scenes);
    if (!overrides_.scenes.empty()) s.scenes.clear();
    for (const std::string& scene : overrides_.scenes) s.scenes.push_back({scene, {}});
    if (const Value* graphs = r.array("graphs")) {
      s.graphs.clear();
      for (size_t i = 0; i < graphs->items.size(); ++i)
        readGraph(graphs->items[i], r.pathOf("graphs") + "[" + std::to_string(i) + "]", s.graphs);
    }
    readSet(r, s.set);
    readSizes(r, s);
    readFrameRates(r, s);
    const auto count = [&](const char* key, uint32_t& value, int64_t min, int64_t max) {
      value = uint32_t(r.integer(key, value, min, max));
    };
    count("first", s.first, 0, 10'000'000);
    count("frames", s.frames, 1, kMaxFrames);
    count("warmup", s.warmup, 0, kMaxFrames);
    count("seeds", s.seeds, 1, 1000);
    if (const Value* reference = r.object("reference")) {
      ObjectReader rr(*reference, r.pathOf("reference"), messages_);
      s.spp = uint32_t(rr.integer("spp", s.spp, 2, 1'000'000));
      s.depth = uint32_t(rr.integer("depth", s.depth, 1, 64));
      rr.finish();
    }
    readMeasures(r, s);
    s.layer = r.choice("layer", s.layer, {"radiance", "indirect"});
    s.paper = r.text("paper", s.paper);
    if (const Value* speed = r.object("speed_up")) {
      ObjectReader rr(*speed, r.pathOf("speed_up"), messages_);
      SpeedUp wanted;
      wanted.of = rr.text("of");
      for (const auto& name : texts(rr, "over")) wanted.over.push_back(name.value);
      rr.finish();
      s.speedUps = {wanted};
    }
  }

  void readMeasures(ObjectReader& r, Settings& s) {
    static const std::vector<std::string> kKnown = {"error", "temporal", "eyes", "pictures", "time"};
    const Texts names = texts(r, "measures");
    if (r.has("measures")) s.measures.clear();
    for (const auto& name : names) {
      if (std::find(kKnown.begin(), kKnown.end(), name.value) == kKnown.end()) {
        const std::string nearest = nearestName(name.value, kKnown);
        messages_.error(name.where, r.pathOf("measures"), "there is no measure `" + name.value + "`",
                        nearest.empty() ? "known: error, temporal, eyes, pictures, time"
                                        : "did you mean `" + nearest + "`?");
      }
      s.measures.push_back(name.value);
    }
  }

  void readSweep(const Value& value, const std::string& path, const Settings& head,
                 std::set<std::string>& names, Suite& suite) {
    ObjectReader r(value, path, messages_);
    Settings s = head;
    const std::string name = r.text("name");
    const auto bad = [](unsigned char c) { return !std::isalnum(c) && c != '_'; };
    if (name.empty() || std::any_of(name.begin(), name.end(), bad))
      messages_.error(value.where.location(), path, "a sweep needs a `name` of letters, digits and _");
    if (!names.insert(name).second)
      messages_.error(value.where.location(), path, "the sweep `" + name + "` occurs twice");
    readSettings(r, s);
    r.finish();
    if (scale_) applyScale(*scale_, s);
    if (!s.paper.empty()) suite.papers[name] = s.paper;
    const auto complain = [&](const std::string& message) {
      messages_.error(value.where.location(), path, message);
    };
    if (s.scenes.empty()) complain("no `scenes`, neither here nor in the suite's head");
    if (s.graphs.empty()) complain("no `graphs`, neither here nor in the suite's head");
    const auto has = [&](const char* m) { return std::count(s.measures.begin(), s.measures.end(), m) > 0; };
    if (has("temporal") && s.frames < 2)
      complain("`temporal` compares consecutive frames: `frames` must be at least 2");
    const auto warmsTooLong = [&](const GraphEntry& g) { return g.warmup.value_or(s.warmup) > s.first; };
    if (std::any_of(s.graphs.begin(), s.graphs.end(), warmsTooLong))
      complain("`warmup` frames come before frame `first`, which has not as many before it");
    for (const GraphEntry& graph : s.graphs)
      if (graph.match) checkMatch(graph, s, has("error"));
    for (SpeedUp& wanted : s.speedUps) {
      wanted.sweep = name;
      std::vector<std::string> labels = wanted.over;
      labels.push_back(wanted.of);
      for (const std::string& label : labels)
        if (!hasLabel(s, label))
          complain("`speed_up` names the graph `" + label + "`, which this sweep does not have");
      suite.speedUps.push_back(wanted);
    }
    if (!messages_.hasErrors() && !expand(name, s, suite)) complain("a suite has at most 100000 jobs");
  }

  void applyScale(const Scale& scale, Settings& s) const {
    if (scale.size && s.sizes.size() == 1) s.sizes = {*scale.size};
    s.seeds = scale.seeds.value_or(s.seeds);
    s.spp = scale.spp.value_or(s.spp);
    s.frames = std::min(s.frames, scale.maxFrames);
    s.warmup = std::min(s.warmup, scale.maxWarmup);
    const auto thin = [&](auto& list) { list = thinned(list, scale.maxValues); };
    const auto thinAll = [&](auto& set) {
      std::for_each(set.begin(), set.end(), [&](auto& e) { thin(e.second); });
    };
    thin(s.sizes), thin(s.frameRates), thinAll(s.set);
    for (GraphEntry& graph : s.graphs) {
      thinAll(graph.set);
      if (graph.warmup) graph.warmup = std::min(*graph.warmup, scale.maxWarmup);
    }
    if (scale.scenes.empty() || !overrides_.scenes.empty()) return;
    const auto isIn = [&](const auto& scene) {
      return std::find(scale.scenes.begin(), scale.scenes.end(), scene.value) != scale.scenes.end();
    };
    Texts kept;
    std::copy_if(s.scenes.begin(), s.scenes.end(), std::back_inserter(kept), isIn);
    if (kept.empty() && !s.scenes.empty()) kept = {s.scenes.front()};
    s.scenes = std::move(kept);
  }

  static bool hasLabel(const Settings& s, const std::string& label) {
    return std::any_of(s.graphs.begin(), s.graphs.end(),
                       [&](const GraphEntry& g) { return g.label == label && !g.graph.empty(); });
  }

  void checkMatch(const GraphEntry& graph, const Settings& s, bool error) {
    const auto like = std::find_if(s.graphs.begin(), s.graphs.end(),
                                   [&](const GraphEntry& g) { return g.label == graph.match->like; });
    if (like == s.graphs.end() || like->match)
      messages_.error(
          graph.where, graph.label,
          "match: `like` names `" + graph.match->like + "`, which is not another graph of this sweep");
    if (!error) messages_.error(graph.where, graph.label, "match needs the measure `error`");
  }

  // All combinations, with the first parameter slowest. Those of a scene go seed by seed, so that what is compared is
  // measured in turns, in case the speed of the machine varies. Returns false if there are too many.
  bool expand(const std::string& sweep, const Settings& s, Suite& suite) {
    for (const auto& scene : s.scenes) {
      const auto first = std::ptrdiff_t(suite.jobs.size());
      for (const GraphEntry& graph : s.graphs) {
        auto axes = s.set;
        for (const auto& own : graph.set) {
          std::erase_if(axes, [&](const auto& old) { return old.first == own.first; });
          axes.push_back(own);
        }
        std::vector<std::string> sizes = s.sizes;
        if (overrides_.size && sizes.size() == 1)
          sizes = {std::to_string(overrides_.size->x) + "x" + std::to_string(overrides_.size->y)};
        axes.emplace_back("size", sizes);
        axes.emplace_back("frame_rate", std::vector<std::string>());
        for (double rate : s.frameRates)
          axes.back().second.push_back(textOf(Value{.type = Value::Type::Real, .real = rate}));
        std::vector<Job> jobs = {jobOf(sweep, s, scene, graph)};
        const uint32_t seeds = overrides_.seeds.value_or(s.seeds);
        for (const auto& [key, values] : axes) {
          if (suite.jobs.size() + jobs.size() * values.size() * seeds > kMaxJobs) return false;
          jobs = multiplied(jobs, key, values);
        }
        if (graph.match)
          for (Job& job : jobs) completeMatch(s, graph, job);
        for (const Job& job : jobs)
          for (uint32_t seed = 1; seed <= seeds; ++seed) {
            suite.jobs.push_back(job);
            suite.jobs.back().seed = seed;
          }
      }
      std::stable_sort(suite.jobs.begin() + first, suite.jobs.end(),
                       [](const Job& a, const Job& b) { return a.seed < b.seed; });
    }
    return true;
  }

  // Parameters of the other graph: those of the sweep, as in this job, and its own.
  static void completeMatch(const Settings& s, const GraphEntry& graph, Job& job) {
    for (const GraphEntry& like : s.graphs) {
      if (like.label != job.match->like) continue;
      job.match->likeGraph = like.graph;
      job.match->likeWarmup = like.warmup.value_or(s.warmup);
      const auto own = [](const GraphEntry& g, const std::string& key) {
        return std::any_of(g.set.begin(), g.set.end(), [&](const auto& e) { return e.first == key; });
      };
      for (const auto& [key, value] : job.set)
        if (!own(graph, key) && !own(like, key)) job.match->likeSet.emplace_back(key, value);
      for (const auto& [key, values] : like.set) job.match->likeSet.emplace_back(key, values.front());
    }
  }

  Job jobOf(const std::string& sweep, const Settings& s, const Placed<std::string>& scene,
            const GraphEntry& graph) const {
    const auto has = [&](const char* m) { return std::count(s.measures.begin(), s.measures.end(), m) > 0; };
    Job job;
    job.sweep = sweep, job.scene = scene.value, job.graph = graph.graph, job.label = graph.label;
    job.first = s.first, job.frames = s.frames, job.warmup = graph.warmup.value_or(s.warmup);
    job.spp = s.spp, job.depth = s.depth, job.layer = s.layer;
    job.error = has("error"), job.temporal = has("temporal"), job.eyes = has("eyes");
    job.pictures = has("pictures");
    job.match = graph.match;
    job.sceneWhere = scene.where, job.graphWhere = graph.where;
    job.sceneOptional = overrides_.scenes.empty() && optional_.count(scene.value) > 0;
    return job;
  }

  static std::vector<Job> multiplied(const std::vector<Job>& jobs, const std::string& key,
                                     const std::vector<std::string>& values) {
    std::vector<Job> result;
    for (const Job& job : jobs)
      for (const std::string& value : values) {
        Job& made = result.emplace_back(job);
        if (key == "size") {
          made.size = *sizeOf(value);
        } else if (key == "frame_rate") {
          made.frameRate = std::stod(value);
        } else {
          made.set.emplace_back(key, value);
        }
        if (values.size() > 1) made.varied.emplace_back(key, value);
      }
    return result;
  }

  Diagnostics& messages_;
  const SuiteOverrides& overrides_;
  std::optional<Scale> scale_;  // the one that was asked for
  std::set<std::string> optional_;
};

}  // namespace

Suite parseSuite(std::string_view text, const fs::path& file, const SuiteOverrides& overrides) {
  Diagnostics messages;
  Suite suite;
  suite.name = file.stem().string();
  suite.file = file;
  const Value root = json::parse(text, file.string());
  SuiteReader(messages, overrides).read(root, suite);
  messages.throwIfErrors();
  if (!overrides.scale.empty()) checkScale(overrides.scale, suite.scales, suite.name);
  suite.scale = overrides.scale;
  std::vector<std::string> scenes;  // in order of first appearance
  for (const Job& job : suite.jobs)
    if (std::find(scenes.begin(), scenes.end(), job.scene) == scenes.end()) scenes.push_back(job.scene);
  std::stable_sort(suite.jobs.begin(), suite.jobs.end(), [&](const Job& a, const Job& b) {
    return std::find(scenes.begin(), scenes.end(), a.scene) <
           std::find(scenes.begin(), scenes.end(), b.scene);
  });
  return suite;
}

Suite loadSuite(const std::string& nameOrFile, const std::vector<fs::path>& folders,
                const SuiteOverrides& overrides) {
  std::error_code ignored;
  fs::path found;
  std::vector<std::string> known;
  if (nameOrFile.ends_with(".json")) {
    found = nameOrFile;
  } else {
    for (const fs::path& folder : folders) {
      if (found.empty() && fs::is_regular_file(folder / (nameOrFile + ".json"), ignored))
        found = folder / (nameOrFile + ".json");
      for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored))
        if (entry->path().extension() == ".json") known.push_back(entry->path().stem().string());
    }
  }
  if (found.empty()) {
    std::sort(known.begin(), known.end());
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    const std::string nearest = nearestName(nameOrFile, known);
    throw Error(
        ExitCode::BadInput, "there is no suite `" + nameOrFile + "`",
        nearest.empty() ? "name a .json file, or one of: " + list : "did you mean `" + nearest + "`?");
  }
  if (const std::string reason = whyUnreadable(found); !reason.empty())
    throw Error(ExitCode::BadInput, "cannot read the suite `" + found.string() + "`: " + reason,
                "check its name and permissions");
  noteRead(found);
  std::ifstream stream(found, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parseSuite(text, found, overrides);
}

}  // namespace fovea::bench
