// The files of the page (samples/fovea/view/page), which are built into the program.
#pragma once

#include <span>
#include <string_view>

namespace fovea::view {

struct PageFile {
  std::string_view name, text;
};
std::span<const PageFile> pageFiles();

}  // namespace fovea::view
