#include "framework/base/budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>

#include "fovea/error.h"

namespace fovea {
namespace {

constexpr uint64_t kMiB = uint64_t(1) << 20;
constexpr uint64_t kUnknown = std::numeric_limits<uint64_t>::max();

thread_local bool counting = false;
thread_local uint64_t claimed = 0;

// What the system could still give, in bytes.
uint64_t availableMemory() {
  uint64_t available = kUnknown;
  std::ifstream list("/proc/meminfo");
  for (std::string name, unit; list >> name;) {
    uint64_t kibibytes = 0;
    if (name == "MemAvailable:" && list >> kibibytes) available = kibibytes * 1024;
    std::getline(list, unit);
  }
  uint64_t limit = 0, used = 0;  // of a container
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> limit &&
      std::ifstream("/sys/fs/cgroup/memory.current") >> used)
    available = std::min(available, limit - std::min(used, limit));
  return available;
}

uint64_t limitFromEnvironment(std::string_view text) {
  uint64_t mebibytes = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), mebibytes);
  if (error != std::errc() || end != text.data() + text.size() || mebibytes < 1 ||
      mebibytes > kUnknown / kMiB)
    throw Error(ExitCode::BadInput,
                fmt::format("FOVEA_MEMORY_LIMIT is `{}`, not a whole number of MiB", text),
                "unset it, or set for instance 8192");
  return mebibytes * kMiB;
}

}  // namespace

uint64_t contentLimit() {
  static const uint64_t limit = [] {
    const char* variable = std::getenv("FOVEA_MEMORY_LIMIT");
    return variable && *variable ? limitFromEnvironment(variable) : availableMemory() / 2;
  }();
  return limit;
}

ContentBudget::ContentBudget() : outermost_(!counting) {
  if (outermost_) claimed = 0;
  counting = true;
}

ContentBudget::~ContentBudget() {
  if (outermost_) counting = false;
}

void claimContent(uint64_t bytes, const std::string& what) {
  if (!counting) claimed = 0;
  if (bytes > contentLimit() - std::min(claimed, contentLimit()))
    throw Error(
        ExitCode::OutOfMemory,
        fmt::format("{} would need {} MiB{}, and the content of files may take {} MiB", what,
                    (bytes + kMiB - 1) / kMiB,
                    claimed > 0 ? fmt::format(" besides {} MiB of the scene so far", claimed / kMiB) : "",
                    contentLimit() / kMiB),
        "use less or smaller content, or raise the limit: FOVEA_MEMORY_LIMIT, in MiB");
  claimed += bytes;
}

}  // namespace fovea
