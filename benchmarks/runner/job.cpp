#include "benchmarks/runner/job.h"
#include "framework/scene/scene.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <set>

#include "benchmarks/runner/pass_code.h"
#include "benchmarks/runner/settled.h"
#include "fovea/scene.h"
#include "framework/base/hash.h"
#include "framework/base/paths.h"
#include "framework/gpu/format.h"
#include "framework/graph/report/report.h"
#include "framework/image/metrics.h"
#include "framework/scene/load.h"
#include "framework/session/inputs.h"
#include "framework/session/interrupt.h"

namespace fovea::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kReferenceSeed = 4711;  // no method is run with this seed
constexpr const char* kLayers[] = {"radiance", "direct", "indirect", "half_a", "half_b"};

// eyes: whether layers of the right eye count, and the places that it has in common with the left one.
bool isLayer(std::string_view output, bool eyes) {
  if (eyes && output == "correspondence") return true;
  if (eyes && output.ends_with("_right")) output.remove_suffix(std::string_view("_right").size());
  return std::find(std::begin(kLayers), std::end(kLayers), output) != std::end(kLayers);
}
constexpr uint64_t kMostFurtherFrames = 8;
constexpr int kMaxSearchSteps = 12;
constexpr double kSearchTolerance = 0.04;  // relative, of the number searched for

void throwIfInterrupted() {
  if (session::interrupted()) throw Error(ExitCode::Interrupted, "interrupted");
}

graph::Description describe(const std::string& graph,
                            const std::vector<std::pair<std::string, std::string>>& set,
                            Diagnostics& messages) {
  session::GraphOptions options;
  options.graph = graph;
  for (const auto& [name, value] : set) options.set.push_back(name + "=" + value);
  return session::loadGraph(options, messages);
}

// The mistake, preceded by the place in the suite that leads to it.
[[noreturn]] void rethrowAt(const Error& error, const SourceLocation& where, const std::string& message) {
  std::vector<Diagnostic> all = {{Severity::Error, where, "", message, ""}};
  all.insert(all.end(), error.diagnostics().begin(), error.diagnostics().end());
  throw Error(error.code(), std::move(all));
}

Json codesOf(const graph::BoundGraph& graph) {
  std::set<std::string> types;
  for (const graph::BoundPass& pass : graph.passes) types.insert(pass.declaration->type);
  Json codes = Json::object();
  for (const std::string& type : types) codes[type] = passCode(type);
  return codes;
}

std::string hashOf(std::string_view text) {
  Hasher hash;
  hash.add(text);
  return session::formatHash(hash.value());
}

// The name of this computer.
std::string machine() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : std::string();
}

// null if it is not known.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

// Time of the second eye of stereo graphs in milliseconds and as a share of the first eye's whole frame, and the
// second eye's share of new pixels.
void addSecondEye(Json& time) {
  double first = 0, second = 0, pixels = 0, fresh = 0;
  for (const Json& pass : time["passes"])
    (pass["name"].get<std::string>().starts_with("right/") ? second : first) +=
        std::max(pass["gpu_ms"]["median"].get<double>(), pass["cpu_ms"]["median"].get<double>());
  if (second <= 0) return;
  pixels = time["counters"].value("right/reproject.pixels", 0.0);
  fresh = time["counters"].value("right/reproject.new_pixels", 0.0);
  time["second_eye"] = {{"ms", second},
                        {"of_first", number(second / first)},
                        {"new_pixels", pixels > 0 ? Json(fresh / pixels) : Json()}};
}

// The first eye of the one for two is the left one, which is what graphs for two eyes call `radiance`.
const char* referenceGraph(const Job& job) {
  return job.eyes ? "alternatives/reference_stereo" : "reference";
}

// All frames use the same random numbers: remaining noise stands still as far as the picture does, and less of it is
// in the changes between frames.
std::vector<std::pair<std::string, std::string>> referenceParameters(const Job& job) {
  std::vector<std::pair<std::string, std::string>> set = {
      {"spp", std::to_string(job.spp)}, {"depth", std::to_string(job.depth)}, {"per_frame", "false"}};
  for (const auto& [name, value] : job.set)
    if (name == "view.materials") set.emplace_back(name, value);
  return set;
}

}  // namespace

BenchRunner::BenchRunner(const BenchFolder& folder, std::shared_ptr<gpu::Device> device,
                         session::Progress& progress)
    : folder_(folder), device_(std::move(device)), progress_(progress) {}

bool BenchRunner::useScene(const Job& job, std::string& why) {
  if (sceneName_ == job.scene) return true;
  if (const auto known = missing_.find(job.scene); known != missing_.end()) {
    why = known->second;
    return false;
  }
  progress_.stage("loading scene " + job.scene);
  Diagnostics messages;
  try {
    sceneName_.clear();
    scene_ = scene::load(job.scene, messages);
    geometry_ = scene::flatten(scene_);
  } catch (const Error& e) {
    if (e.code() != ExitCode::BadInput) throw;
    if (!job.sceneOptional) rethrowAt(e, job.sceneWhere, "the scene `" + job.scene + "` cannot be used");
    missing_[job.scene] = why = e.diagnostics().empty() ? e.what() : e.diagnostics().front().message;
    return false;
  }
  progress_.clear();
  session::printWarnings(messages);
  sceneName_ = job.scene;
  return true;
}

std::unique_ptr<session::GraphRun> BenchRunner::makeRun(const Job& job, bool pictures) {
  Diagnostics messages;
  try {
    const graph::Description description = describe(job.graph, job.set, messages);
    session::GraphRun::Options options;
    options.size = job.size, options.seed = job.seed, options.frameRate = job.frameRate;
    options.readback = [&](const graph::BoundGraph& graph) {
      std::vector<std::string> names;
      for (const graph::BoundOutput& output : graph.outputs)
        if (pictures && isLayer(output.name, job.eyes)) names.push_back(output.name);
      return names;
    };
    options.hostProgress = [this](const std::string& pass, double share) {
      progress_.pass(pass, share);
      return !session::interrupted();
    };
    auto run = std::make_unique<session::GraphRun>(*device_, description, scene_, geometry_,
                                                   std::move(options), messages);
    progress_.clear();
    session::printWarnings(messages);
    return run;
  } catch (const Error& e) {
    rethrowAt(e, job.graphWhere,
              fmt::format("the graph `{}` cannot be used in sweep `{}`", job.graph, job.sweep));
  }
}

std::optional<Fingerprint> BenchRunner::fingerprint(const Job& job, std::string& why) {
  if (!useScene(job, why)) return std::nullopt;
  Job probe = job;
  if (job.match) probe.set.emplace_back(job.match->parameter, std::to_string(job.match->to));
  const auto run = makeRun(probe, true);
  if (job.needsReference()) {
    const auto lacks = [&](const std::string& name) {
      return std::ranges::none_of(run->graph().outputs,
                                  [&](const graph::BoundOutput& o) { return o.name == name; });
    };
    if (lacks("radiance"))
      rethrowAt(Error(ExitCode::BadInput, "its outputs lack `radiance`",
                      "add it, or leave out the measures of errors"),
                job.graphWhere, "the errors of graph `" + job.graph + "` cannot be measured");
    for (const std::string& layer : {job.layer, job.layer + "_right"})
      if (job.eyes && lacks(layer))
        rethrowAt(Error(ExitCode::BadInput, "its outputs lack `" + layer + "`",
                        "take a graph for two eyes, as `stereo`, or leave out the measure `eyes`"),
                  job.graphWhere, "the eyes of graph `" + job.graph + "` cannot be compared");
  }
  Fingerprint made;
  made.parts = {{"format", kBenchFormat},
                {"device", device_->name()},
                {"scene", session::formatHash(scene_.hash)},
                {"graph", session::formatHash(run->graph().hash)},
                {"plan", hashOf(graph::planJson(*run->plan()))},
                {"passes", codesOf(run->graph())},
                {"framework", frameworkCode()},
                {"measures", std::string(kMeasureSources)}};
  if (job.needsReference()) made.parts["reference"] = referenceParts(job);
  return made;
}

// What is stored is the light and, for two eyes, the places that they have in common, so passes that display it do not
// count.
Json BenchRunner::referenceParts(const Job& job) {
  Diagnostics messages;
  const auto description = describe(referenceGraph(job), referenceParameters(job), messages);
  const auto bound =
      graph::bind(description, session::sceneEnvironment(nullptr, scene_, geometry_, job.size), messages);
  Json parts = Json::object();
  for (const graph::BoundPass& pass : bound.passes) {
    if (pass.declaration->type == "tonemap" || pass.declaration->type == "side-by-side") continue;
    Hasher parameters;
    for (const graph::Value& value : pass.parameters.values()) parameters.add(value);
    parameters.add(bound.view.text("materials"));
    parts[pass.declaration->type] = passCode(pass.declaration->type);
    parts["parameters of " + pass.name] = session::formatHash(parameters.value());
  }
  return parts;
}

image::File BenchRunner::toFile(const session::GraphRun& run, graph::FrameResult& result, bool eyes) const {
  image::File file;
  for (auto& [name, output] : result.outputs) {
    if (!isLayer(name, eyes)) continue;
    file.layers.push_back({name, image::toRgb(session::toImage(output))});
    output.bytes = {};
  }
  const scene::Frame shown = run.frame(result.frame);
  const double exposure = session::parameterOr(run.graph(), "exposure", 0);  // of tonemap; 0: the scene's
  file.metadata = {{"gaze", fmt::format("{},{}", shown.views[0].gaze.x, shown.views[0].gaze.y)},
                   {"fovea_radius", fmt::format("{}", shown.views[0].foveaRadius)},
                   {"exposure", fmt::format("{}", float(exposure > 0 ? exposure : shown.exposure))},
                   {"scene", sceneName_},
                   {"scene_hash", session::formatHash(scene_.hash)}};
  return file;
}

BenchRunner::Sequence BenchRunner::render(const Job& job) {
  const bool pictures = job.needsReference() || job.pictures;
  progress_.stage("preparing " + job.graph);
  const auto run = makeRun(job, pictures);
  run->prepare();
  session::Timings own(run->plan()), timings(run->plan());  // of the job's frames, and with further ones
  Sequence sequence;
  std::vector<graph::FrameResult> kept;  // converted afterwards, so that the wall time excludes it
  std::vector<double> walls;             // of all frames that have finished
  const uint64_t total = uint64_t(job.warmup) + job.frames;
  const auto take = [&](graph::FrameResult result) {
    walls.push_back(result.wallMs);
    progress_.frames(std::min<uint64_t>(walls.size(), total), total);
    if (walls.size() <= job.warmup) return;
    timings.add(result);
    if (walls.size() <= total) own.add(result);
    if (!result.outputs.empty()) kept.push_back(std::move(result));
  };
  progress_.frames(0, total);
  for (uint64_t i = 0; i < total; ++i) {
    throwIfInterrupted();
    const bool wanted = i >= job.warmup && (job.temporal || i + 1 == total);
    run->submit(run->frame(job.first - job.warmup + i), pictures && wanted);
    if (run->inFlight() == 1) {
      while (auto result = run->executor().next()) take(std::move(*result));
    } else {
      while (auto result = run->executor().poll()) take(std::move(*result));
    }
  }
  while (auto result = run->executor().next()) take(std::move(*result));
  // Frames after those of the job are rendered for their times alone.
  for (uint64_t i = total; i < total + kMostFurtherFrames && !settled(walls, walls.size() - job.warmup);
       ++i) {
    throwIfInterrupted();
    run->submit(run->frame(job.first - job.warmup + i), false);
    while (auto result = run->executor().next()) take(std::move(*result));
  }
  throwIfInterrupted();
  for (graph::FrameResult& result : kept) {
    sequence.frames.push_back(toFile(*run, result, job.eyes));
    if (&result != &kept.back() && !job.eyes)  // only the last frame needs its other layers
      std::erase_if(sequence.frames.back().layers,
                    [&](const image::Layer& l) { return l.name != job.layer && l.name != "indirect"; });
  }
  session::RunInfo info;
  info.device = device_->name();
  const Json times = Json::parse(timings.json(info));
  sequence.time = {{"frame", times["frame"]},
                   {"passes", times["passes"]},
                   {"counters", Json::parse(own.json(info))["counters"]}};
  addSecondEye(sequence.time);
  progress_.clear();
  return sequence;
}

BenchRunner::Reference BenchRunner::referenceOf(const Job& job, uint64_t frame, const std::string& parts) {
  Hasher hash;
  for (const uint64_t n : {scene_.hash, frame, uint64_t(job.size.x), uint64_t(job.size.y),
                           std::bit_cast<uint64_t>(job.frameRate), uint64_t(kReferenceSeed)})
    hash.add(n);
  hash.add(std::string_view(parts));
  return {fmt::format("{}-{}x{}-f{}-{}", std::filesystem::path(job.scene).stem().string(), job.size.x,
                      job.size.y, frame, session::formatHash(hash.value())),
          frame};
}

std::vector<BenchRunner::Reference> BenchRunner::references(const Job& job) {
  std::vector<Reference> list;
  std::string why;
  if (!job.needsReference() || !useScene(job, why)) return list;
  const std::string parts = referenceParts(job).dump();
  for (uint32_t f = job.temporal ? 0 : job.frames - 1; f < job.frames; ++f)
    list.push_back(referenceOf(job, uint64_t(job.first) + f, parts));
  return list;
}

bool BenchRunner::makeReference(const Job& job, const Reference& wanted) {
  std::error_code ignored;
  if (std::filesystem::exists(folder_.reference(wanted.name), ignored)) return false;
  std::string why;
  if (!useScene(job, why)) throw Error(ExitCode::BadInput, why);
  reference(job, wanted.frame);
  return true;
}

image::File BenchRunner::reference(const Job& job, uint64_t frame) {
  Job own = job;
  own.graph = referenceGraph(job), own.match.reset();
  own.set = referenceParameters(job);
  own.seed = kReferenceSeed, own.first = uint32_t(frame), own.frames = 1, own.warmup = 0;
  own.temporal = own.error = false, own.pictures = true;
  const std::string name = referenceOf(job, frame, referenceParts(job).dump()).name;
  return folder_.findOrMakeReference(
      name,
      [&](const std::function<void()>& alive) {
        const auto start = std::chrono::steady_clock::now();
        progress_.stage(fmt::format("reference of frame {}", frame));
        const auto run = makeRun(own, true);
        run->prepare();
        alive();
        run->submit(run->frame(frame), true);
        throwIfInterrupted();
        auto result = run->executor().next();
        throwIfInterrupted();
        progress_.clear();
        image::File file = toFile(*run, *result, job.eyes);
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
        made_.emplace_back(name, spent.count());
        return file;
      },
      [&] {
        progress_.stage(
            fmt::format("waiting for the reference of frame {}, which another process makes", frame));
        return !session::interrupted();
      });
}

void BenchRunner::writePicture(const std::string& name, const image::Image& picture) const {
  image::write(folder_.picture(name), {{"", picture}});
}

// ---- The number of a parameter that reaches another graph's error

double BenchRunner::errorWith(const Job& job, uint32_t count) {
  Job one = job;
  one.match.reset();
  one.temporal = one.pictures = false;
  if (count > 0) one.set.emplace_back(job.match->parameter, std::to_string(count));
  const Sequence sequence = render(one);
  const Json found = errors(one, sequence.frames.back());
  const Json& value = found.at(Json::json_pointer("/" + [&] {
    std::string path = job.match->measure.substr(job.match->measure.find('.') + 1);
    std::replace(path.begin(), path.end(), '.', '/');
    return path;
  }()));
  return value.is_number() ? value.get<double>() : image::kUnknown;
}

// Stores the number found in the parameters of `job`.
Json BenchRunner::search(Job& job) {
  const Match match = *job.match;
  Job like = job;
  like.graph = match.likeGraph, like.set = match.likeSet, like.warmup = match.likeWarmup;
  std::erase_if(job.set, [&](const auto& entry) { return entry.first == match.parameter; });
  const double target = errorWith(like, 0);
  Json steps = Json::array();
  Job last = job;  // the job whose error is reported
  last.first += job.frames - 1, last.frames = 1;
  const auto reaches = [&](uint32_t count) {
    const double error = errorWith(last, count);
    steps.push_back({{"value", count}, {"error", number(error)}});
    return error <= target;
  };
  uint32_t low = match.from, high = match.to;  // low does not reach the error, high does
  bool reached = true;
  if (reaches(low)) {
    high = low;
  } else if (!reaches(high)) {
    reached = false;
  } else {
    for (int step = 0; step < kMaxSearchSteps && high > low + 1 && high > (1 + kSearchTolerance) * low;
         ++step) {
      const auto middle = uint32_t(std::lround(std::sqrt(double(low) * high)));
      const uint32_t next = std::clamp(middle, low + 1, high - 1);
      (reaches(next) ? high : low) = next;
    }
  }
  job.set.emplace_back(match.parameter, std::to_string(high));
  return {{"parameter", match.parameter}, {"value", high}, {"reached", reached}, {"like", match.like},
          {"target", number(target)},     {"steps", steps}};
}

Json BenchRunner::measure(const Job& wanted, const Fingerprint& fingerprint) {
  std::string why;
  if (!useScene(wanted, why)) throw Error(ExitCode::BadInput, why);
  Job job = wanted;
  Json result = {{"format", kBenchFormat},   {"key", fingerprint.key(wanted)},
                 {"job", wanted.json()},     {"made_with", fingerprint.parts},
                 {"version", FOVEA_VERSION}, {"commit", kBuildCommit},
                 {"machine", machine()}};
  if (job.match) result["match"] = search(job);
  const Sequence sequence = render(job);
  result["time"] = sequence.time;
  if (job.error) result["error"] = errors(job, sequence.frames.back());
  if (job.temporal) result["temporal"] = temporal(job, sequence);
  if (job.eyes) result["eyes"] = eyes(job, sequence);
  if (job.pictures && !job.error && !sequence.frames.empty()) {
    const image::File& last = sequence.frames.back();
    if (const image::Image* radiance = last.find("radiance"))
      writePicture(job.name(), image::displayed(*radiance, std::stof(last.metadata.at("exposure"))));
  }
  const std::vector<std::string> validation = device_->validationMessages();
  if (!validation.empty())
    throw Error(ExitCode::Internal, fmt::format("the validation layers object {} times, first: {}",
                                                validation.size(), validation.front()));
  return result;
}

}  // namespace fovea::bench
