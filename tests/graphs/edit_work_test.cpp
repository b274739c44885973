// Tests what passes do right after a number of their graph is edited: what does not depend on it is not done again.
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

using Work = std::map<std::string, uint32_t>;  // dispatches, draws and transfers that each pass records

void keepGreater(Work& work, const Work& others) {
  for (const auto& [pass, commands] : others) work[pass] = std::max(work[pass], commands);
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
  void edit(const std::vector<std::string>& values) {
    session::GraphRun::Options options;
    options.size = kSize;
    options.readback = [](const BoundGraph&) { return std::vector<std::string>(); };
    Diagnostics messages;
    auto next = std::make_unique<session::GraphRun>(test::testDevice(), description(values), scene_,
                                                    geometry_, std::move(options), messages);
    next->prepare(run_.get());
    run_ = std::move(next);
  }
  // The most that each pass does in one of so many frames.
  Work most(int frames) {
    Work most;
    for (int i = 0; i < frames; ++i) keepGreater(most, frame());
    return most;
  }

 private:
  static constexpr glm::uvec2 kSize{64, 64};
  Work frame() {
    scene::Moment moment = moment_;
    moment.index = index_++;
    run_->submit(run_->frame(moment), false);
    const FrameResult result = *run_->executor().next();
    Work work;
    for (const PassTiming& pass : result.passes) {
      const CommandCounts& c = pass.commands;
      work[run_->graph().passes[pass.pass].name] =
          c.dispatches + c.indirectDispatches + c.draws + c.transfers;
    }
    return work;
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

// In a scene that stands still these passes keep what they have made and record next to nothing. Edits on which all of it
// depends have it made again. So do those of light-inject, whose commands are always the same.
const std::map<std::string, std::set<std::string>> kMadeAgain = {
    {"voxelize", {"voxels", "voxelize.capacity"}},
    {"shadow-map", {"shadow_map_size"}},
};

bool isMadeAgain(const std::string& pass, const std::string& edit) {
  const auto found = kMadeAgain.find(pass);
  return found != kMadeAgain.end() && found->second.contains(edit.substr(0, edit.find('=')));
}

TEST(LongEdits, RepeatNothingThatDoesNotDependOnThem) {
  Frozen frozen("foveal_view", "cornellbox");
  frozen.most(40);
  const Work usual = frozen.most(20);
  size_t edited = 0;
  for (const std::string& edit : edits(frozen)) {
    try {
      frozen.edit({edit});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::BadInput)
          << edit << ": " << error.what();  // contradicts another number
      continue;
    }
    ++edited;
    const Work first = frozen.most(2);
    Work later = frozen.most(4);
    keepGreater(later, usual);
    for (const auto& [pass, commands] : first) {
      if (!isMadeAgain(pass, edit)) {
        EXPECT_LE(commands, later.at(pass)) << edit << ": " << pass;
      }
    }
    frozen.edit({});
    frozen.most(2);
  }
  EXPECT_GT(edited, 80u);
}

}  // namespace
}  // namespace fovea::graph
