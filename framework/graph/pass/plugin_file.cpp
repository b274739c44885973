#include "framework/graph/pass/plugin_file.h"

#include <elf.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <link.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

#include "fovea/error.h"
#include "fovea/pass.h"

namespace fovea::graph {
namespace {

constexpr std::string_view kSection = "fovea_abi";
constexpr std::string_view kBuild = "build it as a shared library with fovea_add_pass_plugin()";
constexpr unsigned char kClass = sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32;
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
constexpr unsigned char kByteOrder = ELFDATA2MSB;
#else
constexpr unsigned char kByteOrder = ELFDATA2LSB;
#endif
#if defined(__x86_64__)
constexpr unsigned kMachine = EM_X86_64;
#elif defined(__aarch64__)
constexpr unsigned kMachine = EM_AARCH64;
#else
constexpr unsigned kMachine = EM_NONE;  // not checked
#endif

[[noreturn]] void refuse(const std::filesystem::path& file, std::string message, std::string_view remedy) {
  throw Error(ExitCode::BadInput,
              {{Severity::Error, {file.string()}, {}, std::move(message), std::string(remedy)}});
}

class LibraryFile {
 public:
  explicit LibraryFile(const std::filesystem::path& path);
  ~LibraryFile() { close(descriptor_); }
  LibraryFile(const LibraryFile&) = delete;
  LibraryFile& operator=(const LibraryFile&) = delete;

  void check();  // before anything else
  std::vector<Abi> marks() const;

 private:
  bool contains(uint64_t offset, uint64_t bytes) const { return offset <= size_ && bytes <= size_ - offset; }
  template <class T>
  std::vector<T> table(uint64_t offset, uint64_t count) const;
  void checkSegments() const;
  std::vector<ElfW(Shdr)> sections() const;
  [[noreturn]] void refuse(const std::string& reason) const {
    graph::refuse(path_, "cannot load plug-in: " + reason, kBuild);
  }

  const std::filesystem::path& path_;
  int descriptor_;
  uint64_t size_ = 0;
  ElfW(Ehdr) header_{};
};

LibraryFile::LibraryFile(const std::filesystem::path& path) : path_(path) {
  // Without O_NONBLOCK, opening a pipe waits for somebody to write to it.
  descriptor_ = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor_ < 0) {
    const int error = errno;
    if (error == ENOENT) graph::refuse(path, "plug-in does not exist", "check its path");
    graph::refuse(path, fmt::format("cannot read plug-in: {}", std::strerror(error)), "check its path");
  }
  struct stat info {};
  const bool known = fstat(descriptor_, &info) == 0;
  if (!known || !S_ISREG(info.st_mode)) {
    close(descriptor_);
    graph::refuse(path,
                  known && S_ISDIR(info.st_mode) ? "cannot load plug-in: it is a directory"
                                                 : "cannot load plug-in: it is no regular file",
                  "name the file that fovea_add_pass_plugin() built, which ends in .so");
  }
  size_ = static_cast<uint64_t>(info.st_size);
}

template <class T>
std::vector<T> LibraryFile::table(uint64_t offset, uint64_t count) const {
  const uint64_t bytes = count * sizeof(T);
  if (count > size_ || !contains(offset, bytes))
    refuse(fmt::format("it is cut short: a part of {} bytes at {} lies outside its {} bytes", bytes, offset,
                       size_));
  std::vector<T> values(count);
  auto* to = reinterpret_cast<char*>(values.data());
  for (uint64_t done = 0; done < bytes;) {
    const ssize_t n = pread(descriptor_, to + done, bytes - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) refuse(n < 0 ? std::strerror(errno) : "it became shorter while it was read");
    done += static_cast<uint64_t>(n);
  }
  return values;
}

void LibraryFile::check() {
  const std::vector<char> magic = table<char>(0, std::min<uint64_t>(size_, SELFMAG));
  if (magic.size() < SELFMAG || std::memcmp(magic.data(), ELFMAG, SELFMAG) != 0) refuse("it is no ELF file");
  header_ = table<ElfW(Ehdr)>(0, 1).front();
  if (header_.e_ident[EI_CLASS] != kClass || header_.e_ident[EI_DATA] != kByteOrder ||
      (kMachine != EM_NONE && header_.e_machine != kMachine))
    refuse("it was built for another processor");
  if (header_.e_type != ET_DYN) refuse("it is no shared library");
  if (header_.e_phentsize != sizeof(ElfW(Phdr)) || header_.e_phnum == 0 ||
      (header_.e_shnum != 0 && header_.e_shentsize != sizeof(ElfW(Shdr))))
    refuse("its ELF header is damaged");
  checkSegments();
}

void LibraryFile::checkSegments() const {
  bool code = false, dynamic = false;
  for (const ElfW(Phdr) & segment : table<ElfW(Phdr)>(header_.e_phoff, header_.e_phnum)) {
    code |= segment.p_type == PT_LOAD;
    dynamic |= segment.p_type == PT_DYNAMIC;
    if (segment.p_type != PT_LOAD && segment.p_type != PT_DYNAMIC) continue;
    if (!contains(segment.p_offset, segment.p_filesz))
      refuse(fmt::format("it is cut short: a segment of {} bytes at {} lies outside its {} bytes",
                         segment.p_filesz, segment.p_offset, size_));
    if (segment.p_filesz > segment.p_memsz) refuse("its ELF header is damaged");
  }
  if (!code || !dynamic) refuse("it is no shared library");
}

std::vector<ElfW(Shdr)> LibraryFile::sections() const {
  std::vector<ElfW(Shdr)> sections = table<ElfW(Shdr)>(header_.e_shoff, header_.e_shnum);
  for (const ElfW(Shdr) & section : sections)
    if (section.sh_type != SHT_NULL && section.sh_type != SHT_NOBITS &&
        !contains(section.sh_offset, section.sh_size))
      refuse(fmt::format("it is cut short: a section of {} bytes at {} lies outside its {} bytes",
                         section.sh_size, section.sh_offset, size_));
  return sections;
}

std::vector<Abi> LibraryFile::marks() const {
  const std::vector<ElfW(Shdr)> all = sections();
  std::vector<Abi> marks;
  if (header_.e_shstrndx >= all.size()) return marks;
  const std::vector<char> names =
      table<char>(all[header_.e_shstrndx].sh_offset, all[header_.e_shstrndx].sh_size);
  for (const ElfW(Shdr) & section : all) {
    if (section.sh_name >= names.size() || section.sh_type != SHT_PROGBITS) continue;
    const char* name = names.data() + section.sh_name;
    if (std::string_view(name, strnlen(name, names.size() - section.sh_name)) != kSection) continue;
    if (section.sh_size % sizeof(Abi) != 0) refuse("its section `fovea_abi` is damaged");
    const std::vector<Abi> some = table<Abi>(section.sh_offset, section.sh_size / sizeof(Abi));
    marks.insert(marks.end(), some.begin(), some.end());
  }
  return marks;
}

}  // namespace

std::vector<Abi> readPluginFile(const std::filesystem::path& file) {
  LibraryFile library(file);
  library.check();
  return library.marks();
}

std::string describeOtherAbi(const Abi& mark) {
  constexpr Abi kOwn = passAbi();
  if (mark == kOwn) return {};
  // "fovea VERSION TYPES"
  const auto word = [](const Abi& abi, int index) {
    std::string_view text(abi.text, strnlen(abi.text, sizeof(abi.text)));
    for (; index > 0; --index) {
      const size_t space = text.find(' ');
      text.remove_prefix(space == std::string_view::npos ? text.size() : space + 1);
    }
    return std::string(text.substr(0, text.find(' ')));
  };
  if (word(mark, 0) != "fovea") return "the plug-in has a damaged mark of its version";
  if (word(mark, 1) != kVersion)
    return fmt::format("the plug-in was compiled for fovea {}, but this is fovea {}", word(mark, 1),
                       kVersion);
  return fmt::format(
      "the plug-in was compiled with other headers or other compiler settings than this fovea {} "
      "(types {}, here {})",
      kVersion, word(mark, 2), word(kOwn, 2));
}

void checkPluginMarks(const std::filesystem::path& file, const std::vector<Abi>& marks) {
  if (marks.empty())
    refuse(
        file, "the plug-in does not say for which version of fovea it was compiled",
        fmt::format("put FOVEA_PASS(YourPass) at namespace scope in one of its sources, and compile it for "
                    "fovea {}",
                    kVersion));
  for (const Abi& mark : marks)
    if (const std::string message = describeOtherAbi(mark); !message.empty())
      refuse(file, message,
             fmt::format("compile it again with the CMake package of fovea {}, or use the fovea for which it "
                         "was compiled",
                         kVersion));
}

}  // namespace fovea::graph
