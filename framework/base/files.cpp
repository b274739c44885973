#include "framework/base/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <stdexcept>

#include "fovea/error.h"

namespace fovea {

namespace fs = std::filesystem;

namespace {

struct ReadFiles {
  std::mutex mutex;
  std::vector<fs::path> list;
};

ReadFiles& readFiles() {
  static ReadFiles files;
  return files;
}

[[noreturn]] void fail(int reason) { throw std::runtime_error(std::strerror(reason)); }

// An open file of the system.
class Handle {
 public:
  Handle(const fs::path& file, int flags) : handle_(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {
    if (handle_ < 0) fail(errno);
  }
  ~Handle() { ::close(handle_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator int() const { return handle_; }

 private:
  int handle_;
};

// The file to which a chain of symbolic links leads, which need not exist.
fs::path followed(fs::path file) {
  constexpr int kMostLinks = 40;  // as in Linux
  std::error_code failed;
  for (int links = 0; links < kMostLinks && fs::is_symlink(file, failed); ++links) {
    const fs::path next = fs::read_symlink(file, failed);
    if (failed) break;
    file = file.parent_path() / next;  // an absolute one replaces the whole
  }
  return file;
}

bool isStream(const fs::path& file) {
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

// In the folder of the file, so that the final rename is atomic; what a pipe gets waits among the temporary files.
fs::path temporaryName(const fs::path& target, bool stream) {
  const fs::path folder = stream ? fs::temp_directory_path() : target.parent_path();
  return folder / ("." + target.stem().string() + ".partial" + std::to_string(::getpid()) +
                   target.extension().string());
}

void copyInto(const fs::path& from, const fs::path& to) {
  const Handle in(from, O_RDONLY), out(to, O_WRONLY);
  std::vector<char> block(1 << 16);
  while (const ssize_t count = ::read(in, block.data(), block.size())) {
    if (count < 0) fail(errno);
    for (ssize_t done = 0; done < count;) {
      const ssize_t step = ::write(out, block.data() + done, size_t(count - done));
      if (step < 0 && errno != EINTR) fail(errno);
      done += std::max<ssize_t>(step, 0);
    }
  }
}

fs::file_type typeOf(const fs::path& file) {
  std::error_code failed;
  const fs::file_status status = fs::status(file, failed);
  if (fs::status_known(status)) return status.type();
  throw Error(ExitCode::BadInput, "cannot look for `" + file.string() + "`: " + failed.message(),
              "make the folders on the way to it searchable");
}

[[noreturn]] void refuse(const std::string& what, const std::string& remedy) {
  throw Error(ExitCode::Usage, what, remedy);
}

std::string spelling(const fs::path& a, const fs::path& b) {
  return a == b ? "" : ", which is also named `" + b.string() + "`,";
}

}  // namespace

std::string whyUnreadable(const fs::path& file) {
  std::error_code failed;
  const fs::file_status status = fs::status(file, failed);
  if (!fs::exists(status)) return std::strerror(failed ? failed.value() : ENOENT);
  if (fs::is_directory(status)) return "it is a folder";
  if (!fs::is_regular_file(status)) return "it is a pipe or a device, not a regular file";
  return ::access(file.c_str(), R_OK) == 0 ? "" : std::strerror(errno);
}

bool isFolder(const fs::path& folder) { return typeOf(folder) == fs::file_type::directory; }
bool isFile(const fs::path& file) { return typeOf(file) == fs::file_type::regular; }

void noteRead(const fs::path& file) {
  ReadFiles& files = readFiles();
  const std::scoped_lock lock(files.mutex);
  if (std::find(files.list.begin(), files.list.end(), file) == files.list.end()) files.list.push_back(file);
}

std::vector<fs::path> filesRead() {
  ReadFiles& files = readFiles();
  const std::scoped_lock lock(files.mutex);
  return files.list;
}

bool sameFile(const fs::path& a, const fs::path& b) {
  std::error_code failed, ignored;
  if (const bool same = fs::equivalent(a, b, failed); !failed) return same;
  const auto place = [&](const fs::path& file) {
    return fs::weakly_canonical(fs::absolute(followed(file)), ignored);
  };
  return place(a) == place(b);
}

void checkOutputs(const std::vector<fs::path>& outputs) {
  const std::vector<fs::path> inputs = filesRead();
  for (size_t i = 0; i < outputs.size(); ++i) {
    const fs::path& output = outputs[i];
    for (size_t other = 0; other < i; ++other)
      if (sameFile(output, outputs[other]) && !isStream(output))
        refuse("two outputs would go into the file `" + outputs[other].string() + "`" +
                   spelling(outputs[other], output) + " and one would be lost",
               "give each its own name");
    for (const fs::path& input : inputs)
      if (sameFile(output, input))
        refuse("the output `" + output.string() + "` would replace the file `" + input.string() +
                   "`, which is an input of this command",
               "choose another name for the output");
  }
}

OutputFile::OutputFile(const fs::path& file)
    : target_(isStream(file) ? file : followed(file)), stream_(isStream(file)) {
  std::error_code ignored;
  if (!stream_ && fs::is_symlink(target_, ignored)) fail(ELOOP);
  temporary_ = temporaryName(target_, stream_);
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

// Brings everything to the disk before the rename: a crash must not leave an empty file under the final name.
void OutputFile::finish() {
  if (stream_) return copyInto(temporary_, target_);
  {
    const Handle handle(temporary_, O_RDONLY);
    if (::fsync(handle) != 0 && errno != EINVAL) fail(errno);
  }
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
}

std::string whyUnwritable(const fs::path& file) try {
  std::error_code failed;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::exists(folder, failed)) return "the folder `" + folder.string() + "` does not exist";
  if (!fs::is_directory(folder, failed)) return "`" + folder.string() + "` is not a folder";
  if (fs::is_directory(file, failed)) return "it is a folder";
  if (isStream(file)) return ::access(file.c_str(), W_OK) == 0 ? "" : std::strerror(errno);
  // Trying is the only reliable test for every file system and user.
  const OutputFile trial(file);
  const Handle handle(trial.temporary(), O_WRONLY | O_CREAT);
  return "";
} catch (const std::exception& e) {
  return e.what();
}

}  // namespace fovea
