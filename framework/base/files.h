// Files that are read and written: a command does not overwrite what it reads, and outputs appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fovea {

// Why `file` cannot be read as a file ("it is a folder", "Permission denied"); "" if it can. Pipes and devices, which
// may never end or block for ever, cannot. Call it before anything opens the file.
std::string whyUnreadable(const std::filesystem::path& file);

// Whether there is such a folder or regular file. Throws Error(BadInput) if the system cannot tell, because a folder on
// the path cannot be searched.
bool isFolder(const std::filesystem::path& folder);
bool isFile(const std::filesystem::path& file);

// Remembers a file from which this process has taken content. Any thread may call it.
void noteRead(const std::filesystem::path& file);
// The files remembered, in order, each once.
std::vector<std::filesystem::path> filesRead();

// Whether both names lead to one file, through links or different spellings. The files need not exist.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b);

// Throws Error(Usage) naming both if two of these are one file, or if one of them is a file that was read.
void checkOutputs(const std::vector<std::filesystem::path>& outputs);

// A file in the making. The content is written under the name `temporary()`, which has the extension of the file.
// finish() then puts it into place at once, so that an existing file survives every failure; an object that is
// destroyed without it leaves nothing behind. A symbolic link is followed, and stays. Pipes and devices are opened and
// get the content when it is finished. Throws std::runtime_error with the reason.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  const std::filesystem::path& temporary() const { return temporary_; }
  void finish();

 private:
  std::filesystem::path target_, temporary_;
  bool stream_ = false;  // a pipe or a device
};

// Why `file` cannot be written, found by trying; "" if it can. Leaves nothing behind.
std::string whyUnwritable(const std::filesystem::path& file);

}  // namespace fovea
