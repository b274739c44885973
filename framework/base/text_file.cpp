#include "framework/base/text_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "fovea/error.h"
#include "framework/base/files.h"

namespace fovea {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw Error(ExitCode::CannotWrite, "cannot write `" + file.string() + "`: " + reason,
              "choose another place, or make room and permission there");
}

struct CloseFile {
  void operator()(std::FILE* f) const { std::fclose(f); }
};

void writeTo(const fs::path& file, const std::string& text) {
  const auto check = [](bool good) {
    if (!good) throw std::runtime_error(std::strerror(errno));
  };
  std::unique_ptr<std::FILE, CloseFile> out(std::fopen(file.c_str(), "wb"));
  check(out != nullptr);
  check(std::fwrite(text.data(), 1, text.size(), out.get()) == text.size());
  check(std::fclose(out.release()) == 0);  // a full disk may only be noticed here
}

}  // namespace

void writeText(const fs::path& file, const std::string& text) try {
  OutputFile output(file);
  writeTo(output.temporary(), text);
  output.finish();
} catch (const std::exception& e) {
  fail(file, e.what());
}

void checkTextWritable(const fs::path& file) {
  if (const std::string reason = whyUnwritable(file); !reason.empty()) fail(file, reason);
}

}  // namespace fovea
