# cmake -DOUT=page.cpp -DFILES=a.html,b.js -P page.cmake: a C++ file with the contents of the files, for pageFiles().
string(REPLACE "," ";" FILES "${FILES}")
set(arrays "")
set(entries "")
set(number 0)
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(APPEND arrays "constexpr unsigned char kFile${number}[] = {\n${bytes}0};\n")
  string(APPEND entries
    "      {\"${name}\", {reinterpret_cast<const char*>(kFile${number}), sizeof kFile${number} - 1}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUT} "// Generated from samples/fovea/view/page.
#include \"samples/fovea/view/http/page.h\"

namespace fovea::view {
namespace {
${arrays}}  // namespace

std::span<const PageFile> pageFiles() {
  static const PageFile files[] = {
${entries}  };
  return files;
}

}  // namespace fovea::view
")
