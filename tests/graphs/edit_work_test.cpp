// Tests how long the passes take right after a number of their graph is edited: what does not depend on it is not done
// again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "framework/graph/report/settings.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "framework/session/graph_run.h"
#include "framework/session/test_device.h"
#include "places.h"

namespace fovea::graph {
namespace {

using Times = std::map<std::string, double>;  // of each pass, ms

void keepGreater(Times& times, const Times& others) {
  for (const auto& [pass, ms] : others) times[pass] = std::max(times[pass], ms);
}

// A graph that is edited while it shows one moment of a scene, as in a viewer that is frozen.
class Frozen {
 public:
  Frozen(std::string graph, const std::string& scene) : graph_(std::move(graph)) {
    Diagnostics messages;
    scene_ = scene::load(scene, messages);
    geometry_ = scene::flatten(scene_);
    moment_ = scene::momentAt(scene_, 0, 42);
    edit({});
  }
  const BoundGraph& graph() const { return run_->graph(); }
  Description description(const std::vector<std::string>& values) const {
    LoadOptions options;
    options.searchPaths = {std::filesystem::path(FOVEA_SOURCE_DIR) / "graphs"};
    for (const char* few : {"vpl_count=256", "map_size=32"}) options.overrides.push_back(parseOverride(few));
    for (const std::string& text : values) options.overrides.push_back(parseOverride(text));
    Diagnostics messages;
    return load(graph_, options, messages);
  }
  std::vector<Setting> settings() const {
    return graph::settings(description({}),
                           session::sceneEnvironment(&test::testDevice(), scene_, geometry_, kSize));
  }
  // Returns whether shaders had to be compiled.
  bool edit(const std::vector<std::string>& values) {
    const uint32_t before = compiled();
    session::GraphRun::Options options;
    options.size = kSize;
    options.readback = [](const BoundGraph&) { return std::vector<std::string>(); };
    Diagnostics messages;
    auto next = std::make_unique<session::GraphRun>(test::testDevice(), description(values), scene_,
                                                    geometry_, std::move(options), messages);
    next->prepare(run_.get());
    run_ = std::move(next);
    return compiled() > before;
  }
  Times frame() {
    scene::Moment moment = moment_;
    moment.index = index_++;
    run_->submit(run_->frame(moment), false);
    const FrameResult result = *run_->executor().next();
    Times times;
    for (const PassTiming& pass : result.passes)
      times[run_->graph().passes[pass.pass].name] = std::max(pass.gpuMs, pass.cpuMs);
    return times;
  }
  Times median(int frames) {
    std::map<std::string, std::vector<double>> all;
    for (int i = 0; i < frames; ++i)
      for (const auto& [pass, ms] : frame()) all[pass].push_back(ms);
    Times middle;
    for (auto& [pass, list] : all) {
      std::nth_element(list.begin(), list.begin() + ptrdiff_t(list.size() / 2), list.end());
      middle[pass] = list[list.size() / 2];
    }
    return middle;
  }

 private:
  static constexpr glm::uvec2 kSize{64, 64};
  static uint32_t compiled() {
    const gpu::ShaderCompiler::Statistics all = test::testDevice().shaders().statistics();
    return all.compiled + all.fromDisk;
  }
  std::string graph_;
  scene::Scene scene_;
  scene::Geometry geometry_;
  scene::Moment moment_;
  std::unique_ptr<session::GraphRun> run_;
  uint64_t index_ = 0;
};

bool isNumber(const ParameterSpec& spec) {
  return spec.type == ParameterSpec::Type::Int || spec.type == ParameterSpec::Type::Real;
}

// Another value near this one.
std::string another(const ParameterSpec& spec, const std::string& text) {
  if (!spec.choices.empty()) return spec.choices[spec.choices.front() == text ? spec.choices.size() - 1 : 0];
  const double value = std::stod(text);
  const bool whole = spec.type == ParameterSpec::Type::Int;
  double next = value != 0 ? 1.25 * value : std::isfinite(spec.max) ? 0.25 * spec.max : 1;
  if (whole) next = std::max(std::ceil(next), value + 1);
  if (next > spec.max) next = 0.75 * value;
  return whole ? fmt::format("{}", int64_t(next)) : fmt::format("{}", next);
}

// One for each number of the graph and, where the graph does not give it, of its passes.
std::vector<std::string> edits(const Frozen& frozen) {
  std::vector<std::string> list;
  std::set<std::string> given;
  for (const Setting& setting : frozen.settings()) {
    given.insert(setting.reaches.begin(), setting.reaches.end());
    if (isNumber(setting.spec) && !setting.value.starts_with('$'))
      list.push_back(setting.name + "=" + another(setting.spec, setting.value));
  }
  for (const BoundPass& pass : frozen.graph().passes)
    for (size_t i = 0; i < pass.declaration->parameters.size(); ++i) {
      const ParameterSpec& spec = pass.declaration->parameters[i];
      const std::string name = pass.name + "." + spec.name;
      if (isNumber(spec) && !given.contains(name))
        list.push_back(name + "=" + another(spec, valueText(pass.parameters.values()[i])));
    }
  return list;
}

// In a scene that stands still these passes keep what they have made, and do nothing. Edits on which all of it depends
// have it made again, with everything that depends on it:
const std::map<std::string, std::set<std::string>> kMadeAgain = {
    {"voxelize", {"voxels", "voxelize.capacity"}},
    {"shadow-map", {"shadow_map_size"}},
    {"light-inject",
     {"voxels", "voxelize.capacity", "shadow_map_size", "light-inject.taps", "light-inject.offset"}},
};

bool isMadeAgain(const std::string& pass, const std::string& edit) {
  const auto found = kMadeAgain.find(pass);
  return found != kMadeAgain.end() && found->second.contains(edit.substr(0, edit.find('=')));
}

// The pass that takes longest in the two frames after an edit, in ms beyond twice the median of its other frames.
struct Longest {
  std::string pass;
  double beyond = -1e9;
  bool compiled = false;  // the edit has had shaders compiled
};
Longest longestAfter(Frozen& frozen, const std::string& edit, const Times& usual) {
  Longest longest;
  longest.compiled = frozen.edit({edit});
  Times first = frozen.frame();
  keepGreater(first, frozen.frame());
  Times typical = frozen.median(3);
  keepGreater(typical, usual);
  for (const auto& [pass, ms] : first)
    if (const double beyond = ms - 2 * typical.at(pass); beyond > longest.beyond && !isMadeAgain(pass, edit))
      longest.pass = pass, longest.beyond = beyond;
  frozen.edit({});
  frozen.median(2);
  return longest;
}

TEST(LongEdits, TakeNoPassMuchLongerThanItsOtherFrames) {
  constexpr double kNoise = 4;  // ms
  constexpr int kTurns = 4;     // as other programs may slow one
  Frozen frozen("foveal_view", "cornellbox");
  frozen.median(40);
  const Times usual = frozen.median(15);
  size_t measured = 0;
  for (const std::string& edit : edits(frozen)) {
    try {
      Longest longest = longestAfter(frozen, edit, usual);
      if (longest.compiled) continue;
      for (int turn = 1; turn < kTurns && longest.beyond > kNoise; ++turn)
        longest = longestAfter(frozen, edit, usual);
      EXPECT_LT(longest.beyond, kNoise) << edit << ": " << longest.pass;
      ++measured;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::BadInput)
          << edit << ": " << error.what();  // contradicts another number
    }
  }
  EXPECT_GT(measured, 80u);
}

}  // namespace
}  // namespace fovea::graph
