#include "framework/base/text_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "fovea/error.h"

namespace fovea {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw Error(ExitCode::CannotWrite, "cannot write `" + file.string() + "`: " + reason,
              "choose another place, or make room and permission there");
}

fs::path temporaryName(const fs::path& file) { return file.string() + ".partial" + std::to_string(getpid()); }

struct CloseFile {
  void operator()(std::FILE* f) const { std::fclose(f); }
};

}  // namespace

void writeText(const fs::path& file, const std::string& text) {
  const fs::path temporary = temporaryName(file);
  std::unique_ptr<std::FILE, CloseFile> out(std::fopen(temporary.c_str(), "wb"));
  if (!out) fail(file, std::strerror(errno));
  const auto giveUp = [&](int error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    fail(file, std::strerror(error));
  };
  if (std::fwrite(text.data(), 1, text.size(), out.get()) != text.size() || std::fflush(out.get()) != 0)
    giveUp(errno);
  if (std::fclose(out.release()) != 0) giveUp(errno);  // a full disk may only be noticed here
  if (std::rename(temporary.c_str(), file.c_str()) != 0) giveUp(errno);
}

void checkTextWritable(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) fail(file, "it is a folder");
  const fs::path temporary = temporaryName(file);
  std::unique_ptr<std::FILE, CloseFile> out(std::fopen(temporary.c_str(), "wb"));
  if (!out) fail(file, std::strerror(errno));
  fs::remove(temporary, ignored);
}

}  // namespace fovea
