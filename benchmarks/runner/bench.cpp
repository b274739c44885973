#include "benchmarks/runner/bench.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>

#include "benchmarks/runner/estimate.h"
#include "benchmarks/runner/folder.h"
#include "benchmarks/runner/job.h"
#include "benchmarks/runner/passes.h"
#include "benchmarks/runner/suite.h"
#include "benchmarks/runner/tables.h"
#include "framework/base/number.h"
#include "framework/base/paths.h"
#include "framework/session/inputs.h"
#include "framework/session/interrupt.h"
#include "framework/session/progress.h"

namespace fovea::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Shard {
  uint32_t index = 0, count = 1;
};

Shard parseShard(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  const size_t slash = std::min(text.find('/'), text.size());
  const auto number = [](std::string_view digits) {  // 0 if it is no whole number of at most 100,000
    const double value = parseDecimal(digits).value_or(0);
    return value >= 1 && value <= 100'000 && std::trunc(value) == value ? uint32_t(value) : 0;
  };
  shard.index = number(text.substr(0, slash));
  shard.count = number(text.substr(std::min(slash + 1, text.size())));
  if (shard.index < 1 || shard.index > shard.count)
    throw Error(ExitCode::Usage, "--shard `" + text + "` is not I/N with I from 1 to N", "e.g. --shard 2/8");
  --shard.index;
  return shard;
}

// Upper bound of the space that the suite's files take.
struct Room {
  uint64_t results = 0, references = 0;
};

Room roomFor(const std::vector<const Job*>& jobs) {
  Room room;
  std::set<std::string> references;
  for (const Job* each : jobs) {
    const Job& job = *each;
    const uint64_t pixels = uint64_t(job.size.x) * job.size.y;
    room.results += 32 << 10;
    if (job.pictures) room.results += 4 * 3 * pixels;
    if (!job.needsReference()) continue;
    for (uint32_t f = job.temporal ? 0 : job.frames - 1; f < job.frames; ++f)
      if (references
              .insert(fmt::format("{} {} {} {} {} {} {}", job.scene, job.first + f, job.size.x, job.size.y,
                                  job.frameRate, job.spp, job.eyes))
              .second)
        room.references += (job.eyes ? 11 : 5) * 3 * sizeof(float) * pixels;
  }
  return room;
}

// Folder of the references if --cache is not given.
std::string cacheOf(const SuiteOptions& options) {
  const char* environment = std::getenv("FOVEA_BENCH_CACHE");
  return options.cache.empty() && environment ? environment : options.cache;
}

class Bench {
 public:
  explicit Bench(const SuiteOptions& options)
      : options_(options),
        shard_(parseShard(options.shard)),
        folder_(options.folder, cacheOf(options)),
        progress_(options.quiet, options.frameLimit) {}
  ExitCode run();

 private:
  void chooseJobs();
  void identify();
  std::vector<std::string> referencesToMake(const Job& job);
  bool isDone(const ResultFiles& files, const Job& job, const std::string& key, const Fingerprint& now) const;
  void openDevice();
  std::optional<nlohmann::ordered_json> tryTwice(const Job& job, const Fingerprint& fingerprint);
  void measure();
  void serve();
  std::string serve(const std::string& name);
  void makeReferences();
  void finish();
  std::string command() const;
  std::map<std::string, std::string> missingScenes(const std::vector<StoredResult>& results) const;
  std::string left() const;
  void makePage(const std::string& script, const std::string& page) const;
  template <class... Args>
  void say(fmt::format_string<Args...> format, Args&&... args) const {
    if (options_.quiet) return;
    fmt::print(format, std::forward<Args>(args)...);
    std::fflush(stdout);
  }

  const SuiteOptions& options_;
  Shard shard_;
  BenchFolder folder_;
  session::Progress progress_;
  Suite suite_;
  std::vector<bool> chosen_;        // for each job, whether --only names it; all without --only
  std::vector<const Job*> wanted_;  // the chosen jobs
  std::unique_ptr<BenchRunner> runner_;
  struct Task {
    const Job* job = nullptr;
    Fingerprint fingerprint;
    std::vector<std::string> references;  // names of those that do not exist yet
  };
  std::vector<Task> tasks_;                     // of this shard, not yet done
  std::map<std::string, std::string> missing_;  // scene -> why
  Estimate estimate_;
  size_t done_ = 0;
  size_t lost_ = 0;  // jobs without a result, as the device was lost twice
};

void Bench::openDevice() {
  runner_.reset();
  runner_ = std::make_unique<BenchRunner>(
      folder_, gpu::openDevice({.device = options_.device, .without = options_.without}), progress_);
}

void Bench::chooseJobs() {
  SuiteOverrides overrides;
  if (!options_.size.empty()) overrides.size = session::parseSize(options_.size);
  overrides.seeds = options_.seeds;
  overrides.scenes = session::sceneNames(options_.scenes);
  overrides.scale = options_.scale;
  suite_ = loadSuite(options_.suite, dataFolders("benchmarks/suites"), overrides);
  for (const Job& job : suite_.jobs) {
    chosen_.push_back(options_.only.empty() || matchesGlob(options_.only, job.name()));
    if (chosen_.back()) wanted_.push_back(&job);
  }
  if (wanted_.empty())
    throw Error(ExitCode::Usage,
                fmt::format("no job of suite `{}` is named like --only `{}`", suite_.name, options_.only),
                "see its jobs with --list");
}

// Whether the job has a result. One that was measured with other code or inputs must not be in a table with new ones.
bool Bench::isDone(const ResultFiles& files, const Job& job, const std::string& key,
                   const Fingerprint& now) const {
  bool done = false;
  for (const StoredResult& old : resultsOf(job, files)) {
    if (old.json["key"] == key) {
      done = true;
      continue;
    }
    if (options_.replace) {
      std::error_code ignored;
      fs::remove(old.file, ignored);
      continue;
    }
    std::string difference = firstDifference(old.json["job"], job.json());
    if (difference.empty()) difference = firstDifference(old.json["made_with"], now.parts);
    throw Error(ExitCode::BadInput,
                fmt::format("`{}` cannot be compared with what would be measured now: {}", old.file.string(),
                            difference),
                "choose another folder with -o, or measure it anew with --replace");
  }
  return done;
}

// The names of those that do not exist yet, of which the estimate is told.
std::vector<std::string> Bench::referencesToMake(const Job& job) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const BenchRunner::Reference& r : runner_->references(job)) {
    if (fs::exists(folder_.reference(r.name), ignored)) continue;
    estimate_.addReference(
        r.name, (job.eyes ? 2.0 : 1.0) * double(job.size.x) * double(job.size.y) * double(job.spp));
    names.push_back(r.name);
  }
  return names;
}

// Finds every mistake in the jobs, and the jobs that are already done, before anything is rendered.
void Bench::identify() {
  const ResultFiles files = folder_.resultFiles();
  for (size_t i = 0; i < wanted_.size(); ++i) {
    const Job& job = *wanted_[i];
    std::string why;
    const auto fingerprint = runner_->fingerprint(job, why);
    if (!fingerprint) {
      if (missing_.try_emplace(job.scene, why).second)
        std::fprintf(stderr, "fovea: warning: the scene `%s` is left out: %s\n", job.scene.c_str(),
                     why.c_str());
      continue;
    }
    if (isDone(files, job, fingerprint->key(job), *fingerprint)) {
      ++done_;
    } else if (i % shard_.count == shard_.index) {
      tasks_.push_back({&job, *fingerprint, referencesToMake(job)});
      estimate_.addJob(job);
    }
    if (session::interrupted()) throw Error(ExitCode::Interrupted, "interrupted before the first job");
  }
}

// A device that is lost costs a job its first try, and if that is repeated on a new device, the job, but not the suite.
std::optional<nlohmann::ordered_json> Bench::tryTwice(const Job& job, const Fingerprint& fingerprint) {
  for (const char* next : {"it is measured again on a new device", "the suite goes on without it"}) {
    try {
      return runner_->measure(job, fingerprint);
    } catch (const Error& e) {
      if (e.code() != ExitCode::DeviceLost) throw;
      progress_.clear();
      std::fprintf(stderr, "fovea: warning: job `%s`: %s; %s\n", job.name().c_str(),
                   e.diagnostics().front().message.c_str(), next);
      openDevice();
    }
  }
  return std::nullopt;
}

std::string Bench::left() const {
  const auto seconds = estimate_.secondsLeft();
  return seconds && *seconds > 0 ? ", " + session::formatDuration(*seconds) + " left" : "";
}

void Bench::measure() {
  const auto since = [](Clock::time_point t) {
    return std::chrono::duration<double>(Clock::now() - t).count();
  };
  for (size_t i = 0; i < tasks_.size(); ++i) {
    const Task& task = tasks_[i];
    progress_.setPrefix(fmt::format("job {}/{}{}: ", i + 1, tasks_.size(), left()));
    const Clock::time_point jobStart = Clock::now();
    try {
      if (auto result = tryTwice(*task.job, task.fingerprint)) {
        (*result)["seconds"] = since(jobStart);
        folder_.write(*task.job, task.fingerprint.key(*task.job), *result);
      } else {
        ++lost_;
        estimate_.finish(*task.job, since(jobStart), runner_->takeMadeReferences(), task.references);
        continue;
      }
    } catch (const Error& e) {
      if (e.code() != ExitCode::Interrupted) throw;
      throw Error(ExitCode::Interrupted, fmt::format("interrupted; {} of {} jobs are done", i, tasks_.size()),
                  "the same command goes on from there");
    }
    progress_.clear();
    estimate_.finish(*task.job, since(jobStart), runner_->takeMadeReferences(), task.references);
    say("[{}/{}] {}: {}{}\n", i + 1, tasks_.size(), task.job->name(),
        session::formatDuration(since(jobStart)), left());
  }
  progress_.setPrefix("");
}

// The answer to the name of a job; the device and the scene stay for the next one.
std::string Bench::serve(const std::string& name) {
  const auto found =
      std::find_if(wanted_.begin(), wanted_.end(), [&](const Job* j) { return j->name() == name; });
  if (found == wanted_.end())
    throw Error(ExitCode::Usage, fmt::format("suite `{}` has no job `{}`", suite_.name, name),
                "see its jobs with --list");
  const Job& job = **found;
  std::string why;
  const auto fingerprint = runner_->fingerprint(job, why);
  if (!fingerprint) return "missing " + name;
  const std::string key = fingerprint->key(job);
  if (!isDone(folder_.resultFiles(), job, key, *fingerprint)) {
    const Clock::time_point start = Clock::now();
    auto result = tryTwice(job, *fingerprint);
    if (!result) throw Error(ExitCode::DeviceLost, fmt::format("job `{}` lost the device twice", name));
    (*result)["seconds"] = std::chrono::duration<double>(Clock::now() - start).count();
    folder_.write(job, key, *result);
  }
  progress_.clear();
  return "done " + name;
}

void Bench::serve() {
  for (std::string name; std::getline(std::cin, name);) {
    fmt::print("{}\n", serve(name));
    std::fflush(stdout);
  }
}

// Makes the references of the chosen jobs and nothing else; a shard makes every N-th of them.
void Bench::makeReferences() {
  struct Entry {
    const Job* job;
    BenchRunner::Reference reference;
  };
  std::vector<Entry> list;
  std::set<std::string> known;
  for (const Job* job : wanted_)
    for (const BenchRunner::Reference& r : runner_->references(*job))
      if (known.insert(r.name).second) list.push_back({job, r});
  if (list.empty())
    throw Error(ExitCode::Usage, fmt::format("no job of suite `{}` needs a reference", suite_.name),
                "leave out --references-only");
  size_t made = 0, there = 0;
  for (size_t i = shard_.index; i < list.size(); i += shard_.count) {
    const Clock::time_point start = Clock::now();
    progress_.setPrefix(fmt::format("{}/{}: ", i + 1, list.size()));
    const bool isNew = runner_->makeReference(*list[i].job, list[i].reference);
    progress_.clear();
    ++(isNew ? made : there);
    if (isNew)
      say("[{}/{}] {}: {}\n", i + 1, list.size(), list[i].reference.name,
          session::formatDuration(std::chrono::duration<double>(Clock::now() - start).count()));
    if (session::interrupted())
      throw Error(ExitCode::Interrupted, "interrupted", "the same command goes on from there");
  }
  progress_.setPrefix("");
  say("{} references: {} made, {} were there\n", made + there, made, there);
}

// Runs a script of benchmarks/, which needs Python and matplotlib; without them, only the tables are written.
void Bench::makePage(const std::string& name, const std::string& page) const {
  fs::path script;
  for (const fs::path& folder : dataFolders("benchmarks"))
    if (script.empty() && fs::exists(folder / name)) script = folder / name;
  if (script.empty()) {
    std::fprintf(stderr, "fovea: warning: benchmarks/%s is not installed: there are tables, but no %s\n",
                 name.c_str(), page.c_str());
    return;
  }
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    execlp("python3", "python3", script.c_str(), folder_.path().c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0)
    return;
  std::fprintf(stderr,
               "fovea: warning: no %s: it needs python3 with matplotlib (apt-get install "
               "python3-matplotlib); the tables are there\n",
               page.c_str());
}

// Includes scenes that an earlier process found missing and this one did not look for.
std::map<std::string, std::string> Bench::missingScenes(const std::vector<StoredResult>& results) const {
  std::map<std::string, std::string> missing = missing_;
  std::ifstream in(folder_.path() / "report.json", std::ios::binary);
  const auto before = nlohmann::json::parse(in, nullptr, false);
  if (!before.is_object() || before.value("suite", std::string()) != suite_.name) return missing;
  for (const auto& [scene, why] : before.value("missing_scenes", nlohmann::json::object()).items())
    if (why.is_string()) missing.try_emplace(scene, why.get<std::string>());
  for (const StoredResult& result : results) missing.erase(result.json["job"].value("scene", std::string()));
  return missing;
}

// The command that produces all of the tables.
std::string Bench::command() const {
  std::string text = "fovea bench " + options_.suite + " -o DIR";
  if (!options_.scale.empty()) text += " --scale " + options_.scale;
  if (!options_.size.empty()) text += " --size " + options_.size;
  if (options_.seeds) text += fmt::format(" --seeds {}", *options_.seeds);
  for (const std::string& scene : options_.scenes) text += " --scene " + scene;
  return text;
}

// Tables and page contain everything in the folder that can be compared, not only what --only names.
void Bench::finish() {
  const std::vector<StoredResult> results =
      mergedResults(folder_, suite_.jobs, chosen_, [](const std::string& why) {
        std::fprintf(stderr, "fovea: warning: left out of the tables: %s\n", why.c_str());
      });
  if (results.empty())
    throw Error(ExitCode::BadInput,
                fmt::format("`{}` has no results of suite `{}`", folder_.path().string(), suite_.name),
                "run it without --report");
  say("{}", writeTables(folder_, suite_, results, missingScenes(results), command()));
  say("{} of {} jobs have results\nwrote {}/tables\n", results.size(), suite_.jobs.size(),
      folder_.path().string());
  const auto make = [&](const std::string& script, const std::string& page) {
    makePage(script, page);
    std::error_code ignored;
    if (fs::exists(folder_.path() / page, ignored)) say("wrote {}/{}\n", folder_.path().string(), page);
  };
  make("report.py", "report.html");
  if (!suite_.page.empty()) make(suite_.page + ".py", suite_.page + "/README.md");
}

ExitCode Bench::run() {
  chooseJobs();
  if (options_.list) {
    for (const Job* job : wanted_) fmt::print("{}\n", job->name());
    return ExitCode::Ok;
  }
  if (options_.folder.empty()) throw Error(ExitCode::Usage, "where to? -o is missing", "e.g. -o results");
  std::error_code ignored;
  if (options_.report) {
    if (!fs::is_directory(folder_.path() / "results", ignored))
      throw Error(ExitCode::BadInput, "`" + options_.folder + "` has no results",
                  "run the suite without --report first");
    folder_.prepare(0, 0);
    finish();
    return ExitCode::Ok;
  }
  if (options_.resume && !fs::is_directory(folder_.path() / "results", ignored))
    throw Error(ExitCode::BadInput, "there is nothing to resume in `" + options_.folder + "`",
                "leave out --resume");
  const Room room = roomFor(wanted_);
  folder_.prepare(options_.referencesOnly ? 0 : room.results, room.references);
  session::catchInterrupts();
  session::loadPlugins(options_.plugins);
  openDevice();
  if (options_.referencesOnly) {
    makeReferences();
    return ExitCode::Ok;
  }
  if (options_.serve) {
    serve();
    return ExitCode::Ok;
  }
  identify();
  if (done_ > 0) say("{} of {} jobs are done already\n", done_, wanted_.size());
  if (!tasks_.empty())
    say("{} jobs to measure, {} references of {:.3g} million paths to render for them\n", tasks_.size(),
        estimate_.references(), estimate_.paths() / 1e6);
  measure();
  if (done_ + tasks_.size() > lost_) finish();
  if (lost_ > 0)
    throw Error(ExitCode::DeviceLost,
                fmt::format("{} of {} jobs have no result: they lost the device twice", lost_, tasks_.size()),
                "the same command tries them again; see the warnings above");
  return ExitCode::Ok;
}

}  // namespace

ExitCode runSuite(const SuiteOptions& options) { return Bench(options).run(); }

}  // namespace fovea::bench
