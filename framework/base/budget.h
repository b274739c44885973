// Limits the memory that the content of files may take. The claimed sizes are taken from the headers of the files, so
// that a file is refused before anything is read or decoded.
#pragma once

#include <cstdint>
#include <string>

namespace fovea {

// Bytes: FOVEA_MEMORY_LIMIT (in MiB), else half of the memory that was available when this was first asked.
uint64_t contentLimit();

// Counts what one scene claims. While an object exists, all claims of its thread add up; nested objects do not start a
// new count.
class ContentBudget {
 public:
  ContentBudget();
  ~ContentBudget();
  ContentBudget(const ContentBudget&) = delete;
  ContentBudget& operator=(const ContentBudget&) = delete;

 private:
  bool outermost_;
};

// Throws Error(OutOfMemory) with the figures if `what` ("the images of model.gltf") would bring the claims above the
// limit.
void claimContent(uint64_t bytes, const std::string& what);

}  // namespace fovea
