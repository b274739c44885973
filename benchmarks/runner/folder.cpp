#include "benchmarks/runner/folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <thread>

#include "framework/base/files.h"
#include "framework/base/hash.h"
#include "framework/base/text_file.h"
#include "framework/graph/report/report.h"
#include "framework/session/inputs.h"

namespace fovea::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

// A claim that its owner has not touched for this long is void: the owner or its machine is gone.
constexpr auto kStale = 180s;
constexpr auto kTouch = 10s;
// Likewise a claim that names no owner for this long: the owner was killed before it wrote its name.
constexpr auto kNameless = 5s;

constexpr size_t kKeyDigits = 16;                   // Fingerprint::key()
constexpr size_t kEnding = 1 + kKeyDigits + 1 + 4;  // of the name of a result, ".KEY.json"

[[noreturn]] void cannotWrite(const fs::path& where, const std::string& reason) {
  throw Error(ExitCode::CannotWrite, "cannot write to `" + where.string() + "`: " + reason,
              "choose another folder with -o, or make room and permission there");
}

void makeFolder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) cannotWrite(folder, failed.message());
}

// Writes and removes a file that is as large as a result.
void tryWriting(const fs::path& folder) {
  const fs::path file = folder / fmt::format(".try.{}", getpid());
  const int descriptor = open(file.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) cannotWrite(folder, std::strerror(errno));
  const std::string block(size_t(64) << 10, 'x');
  int error =
      write(descriptor, block.data(), block.size()) == ssize_t(block.size()) ? 0 : (errno ? errno : ENOSPC);
  if (fsync(descriptor) != 0 && error == 0) error = errno;
  if (close(descriptor) != 0 && error == 0) error = errno;
  unlink(file.c_str());
  if (error != 0) cannotWrite(folder, std::strerror(error));
}

std::string hostName() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// The exclusive right to make a file, held as FILE.claim with "host pid".
class Claim {
 public:
  explicit Claim(const fs::path& file) : file_(file.string() + ".claim") {
    const int descriptor = open(file_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0) {
      if (errno != EEXIST) cannotWrite(file_, std::strerror(errno));
      return;
    }
    const std::string owner = fmt::format("{} {}\n", hostName(), getpid());
    held_ = write(descriptor, owner.data(), owner.size()) == ssize_t(owner.size());
    close(descriptor);
    if (!held_) {
      unlink(file_.c_str());
      cannotWrite(file_, "the disk is full");
    }
  }
  ~Claim() {
    if (held_) unlink(file_.c_str());
  }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

  bool held() const { return held_; }
  void touch() {
    const auto now = std::chrono::steady_clock::now();
    if (now - touched_ < kTouch) return;
    touched_ = now;
    std::error_code ignored;
    fs::last_write_time(file_, fs::file_time_type::clock::now(), ignored);
  }
  // Removes a claim whose owner is gone. If two processes do so at once, the file is made twice, which does no harm.
  void dropIfStale() const {
    std::error_code failed;
    const auto age = fs::file_time_type::clock::now() - fs::last_write_time(file_, failed);
    if (failed) return;  // abandoned meanwhile
    std::istringstream owner(contentOf(file_));
    std::string host;
    pid_t pid = 0;
    owner >> host >> pid;
    const bool dead = pid > 0 && host == hostName() && kill(pid, 0) != 0 && errno == ESRCH;
    if (dead || age > kStale || (pid <= 0 && age > kNameless)) fs::remove(file_, failed);
  }

 private:
  fs::path file_;
  bool held_ = false;
  std::chrono::steady_clock::time_point touched_ = std::chrono::steady_clock::now();
};

std::optional<image::File> readIfWhole(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  try {
    return image::read(file);
  } catch (const Error&) {  // left by a machine that went down; it is made again
    fs::remove(file, ignored);
    return {};
  }
}

}  // namespace

std::string Fingerprint::key(const Job& job) const {
  Hasher hash;
  hash.add(std::string_view(parts.dump()));
  hash.add(std::string_view(job.json().dump()));
  return session::formatHash(hash.value());
}

void BenchFolder::prepare(uint64_t bytes, uint64_t referenceBytes) const {
  checkOutputs({folder_ / "report.json"});
  for (const fs::path& folder : {folder_ / "results", folder_ / "pictures", folder_ / "tables", cache_}) {
    makeFolder(folder);
    tryWriting(folder);
  }
  struct statvfs room {
  }, cacheRoom{};
  if (statvfs(folder_.c_str(), &room) != 0 || statvfs(cache_.c_str(), &cacheRoom) != 0) return;
  const auto demand = [](const fs::path& folder, const struct statvfs& there, uint64_t needed) {
    const uint64_t available = uint64_t(there.f_bavail) * there.f_frsize;
    if (available < needed)
      cannotWrite(folder, fmt::format("the suite needs about {} there, and {} are free",
                                      graph::printBytes(needed), graph::printBytes(available)));
  };
  const bool oneDisk = room.f_fsid == cacheRoom.f_fsid;
  demand(folder_, room, bytes + (oneDisk ? referenceBytes : 0));
  if (!oneDisk) demand(cache_, cacheRoom, referenceBytes);
}

ResultFiles BenchFolder::resultFiles() const {
  ResultFiles files;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder_ / "results", ignored), end; entry != end;
       entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    if (name.size() > kEnding && name.ends_with(".json") && name[name.size() - kEnding] == '.')
      files[name.substr(0, name.size() - kEnding)].push_back(entry->path());
  }
  return files;
}

std::vector<StoredResult> resultsOf(const Job& job, const ResultFiles& files) {
  std::vector<StoredResult> found;
  const auto entry = files.find(job.name());
  if (entry == files.end()) return found;
  for (const fs::path& file : entry->second) {
    StoredResult result{file, Json::parse(contentOf(file), nullptr, false)};
    const auto key = result.json.is_object() ? result.json.find("key") : result.json.end();
    if (!result.json.is_object() || key == result.json.end() || !key->is_string() ||
        *key != file.filename().string().substr(job.name().size() + 1, kKeyDigits) ||
        !result.json.contains("job") || !result.json.contains("made_with"))
      throw Error(ExitCode::BadInput, "`" + file.string() + "` is no result of a benchmark",
                  "remove it; its job will be run again");
    found.push_back(std::move(result));
  }
  return found;
}

void BenchFolder::write(const Job& job, const std::string& key, const Json& result) const {
  writeText(folder_ / "results" / (job.name() + "." + key + ".json"),
            result.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

image::File BenchFolder::findOrMakeReference(
    const std::string& name, const std::function<image::File(const std::function<void()>&)>& make,
    const std::function<bool()>& waiting) const {
  const fs::path file = reference(name);
  while (true) {
    if (auto found = readIfWhole(file)) return std::move(*found);
    Claim claim(file);
    if (claim.held()) {
      if (auto found = readIfWhole(file)) return std::move(*found);  // finished just before
      image::File made = make([&] { claim.touch(); });
      image::write(file, made.layers, made.metadata);
      return made;
    }
    if (!waiting()) throw Error(ExitCode::Interrupted, "interrupted while another process makes a reference");
    claim.dropIfStale();
    std::this_thread::sleep_for(300ms);
  }
}

std::string firstDifference(const Json& there, const Json& here, const std::string& path) {
  if (there == here) return {};
  if (there.is_object() && here.is_object()) {
    for (const auto& [key, value] : there.items()) {
      const Json other = here.contains(key) ? here[key] : Json();
      const std::string found = firstDifference(value, other, path.empty() ? key : path + "." + key);
      if (!found.empty()) return found;
    }
    for (const auto& [key, value] : here.items())
      if (!there.contains(key)) return firstDifference(Json(), value, path.empty() ? key : path + "." + key);
    return {};
  }
  const auto text = [](const Json& value) {
    return value.is_null() ? "nothing" : value.is_string() ? value.get<std::string>() : value.dump();
  };
  return fmt::format("{} is {} there and {} here", path, text(there), text(here));
}

namespace {

// What all results of one report must share: the device, the framework, and each scene and pass wherever
// they are used.
class Common {
 public:
  // "" if the result belongs to those added before.
  std::string difference(const StoredResult& result) const {
    for (const auto& [what, value] : facts(result))
      if (const auto seen = known_.find(what); seen != known_.end() && seen->second.first != value)
        return fmt::format("{} is {} in `{}` and {} in `{}`", what, seen->second.first.dump(),
                           seen->second.second.string(), value.dump(), result.file.string());
    return {};
  }
  void add(const StoredResult& result) {
    for (const auto& [what, value] : facts(result)) known_.try_emplace(what, value, result.file);
  }

 private:
  static std::vector<std::pair<std::string, Json>> facts(const StoredResult& result) {
    const Json &made = result.json["made_with"], &job = result.json["job"];
    std::vector<std::pair<std::string, Json>> list;
    for (const char* part : {"device", "framework", "measures"})
      list.emplace_back(part, made.value(part, Json()));
    list.emplace_back("scene " + job.value("scene", std::string()), made.value("scene", Json()));
    for (const char* part : {"passes", "reference"})
      if (made.contains(part) && made[part].is_object())
        for (const auto& [name, code] : made[part].items())
          if (!name.starts_with("parameters"))  // belongs to the suite: samples may differ between sweeps
            list.emplace_back((std::string(part) == "passes" ? "pass " : "reference's ") + name, code);
    return list;
  }
  std::map<std::string, std::pair<Json, fs::path>> known_;
};

// The result of the job that belongs to `common`, if there is one; otherwise `why` gives the reason.
std::optional<StoredResult> resultOf(const ResultFiles& files, const Job& job, const Common& common,
                                     std::string& why) {
  std::optional<StoredResult> found;
  for (StoredResult& result : resultsOf(job, files)) {
    std::string other = firstDifference(result.json["job"], job.json());
    if (!other.empty()) other = fmt::format("`{}` was measured otherwise: {}", result.file.string(), other);
    if (other.empty()) other = common.difference(result);
    if (other.empty() && found)
      other = fmt::format("`{}` and `{}` are of one job: {}", found->file.string(), result.file.string(),
                          firstDifference(found->json["made_with"], result.json["made_with"]));
    if (other.empty()) {
      found = std::move(result);
    } else {
      why = other;
    }
  }
  return found;
}

}  // namespace

std::vector<StoredResult> mergedResults(const BenchFolder& folder, const std::vector<Job>& jobs,
                                        const std::vector<bool>& chosen,
                                        const std::function<void(const std::string&)>& leaveOut) {
  std::vector<std::optional<StoredResult>> found(jobs.size());
  Common common;
  const ResultFiles files = folder.resultFiles();
  for (const bool choice : {true, false})
    for (size_t i = 0; i < jobs.size(); ++i) {
      if (chosen[i] != choice) continue;
      std::string why;
      found[i] = resultOf(files, jobs[i], common, why);
      if (!why.empty() && choice)
        throw Error(
            ExitCode::BadInput, "results that cannot be compared: " + why,
            "give the same --scale, --size, --seeds and --scene, keep them in different folders, or run the "
            "suite with --replace");
      if (!why.empty() && !found[i]) leaveOut(why);
      if (found[i]) common.add(*found[i]);
    }
  std::vector<StoredResult> merged;
  for (auto& result : found)
    if (result) merged.push_back(std::move(*result));
  return merged;
}

}  // namespace fovea::bench
