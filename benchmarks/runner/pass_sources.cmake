# Writes pass_code.h's constants: cmake -DSOURCE=.. -DOUTPUT=.. -P pass_sources.cmake
# Code counts without comments and spaces, so that results outlive what says the same in other words.
cmake_minimum_required(VERSION 3.25)

# What makes scenes is left out: results depend on the scene made, which has a hash of its own; likewise the phases
# of the graph compiler, since the plan has one, too.
set(ignored "framework/scene/(builtin|gltf/|file/|load|export/|subdivision/cage_builder)|framework/base/(diagnostic|json|paths|text_file)|include/fovea/error")
set(execution "framework/graph/run/")

file(GLOB_RECURSE files RELATIVE ${SOURCE} ${SOURCE}/framework/*.cpp ${SOURCE}/framework/*.h ${SOURCE}/passes/*.cpp
  ${SOURCE}/passes/*.h ${SOURCE}/benchmarks/runner/*.cpp ${SOURCE}/benchmarks/runner/*.h ${SOURCE}/shaders/*.h)
list(FILTER files EXCLUDE REGEX "${ignored}")
list(SORT files)

# uses_FILE: what it includes. A header uses its source file, too: the one of its name, and those of its folder that
# include it and have no header of their own. The records that C++ and GLSL share include each other as GLSL does.
foreach(file ${files})
  file(STRINGS ${SOURCE}/${file} lines REGEX "^#include \"")
  list(TRANSFORM lines REPLACE "^#include \"([^\"]+)\".*" "\\1")
  list(TRANSFORM lines REPLACE "^fovea/" "framework/include/fovea/")
  if(file MATCHES "^shaders/|/records[.]h$")
    list(TRANSFORM lines REPLACE "^([.][.]/)+shaders/" "shaders/")
    cmake_path(GET file PARENT_PATH folder)
    list(TRANSFORM lines REPLACE "^([a-z_]+[.]h)$" "${folder}/\\1")
  endif()
  list(APPEND uses_${file} ${lines})
  if(file MATCHES "\\.cpp$")
    string(REGEX REPLACE "\\.cpp$" ".h" own ${file})
    cmake_path(GET file PARENT_PATH folder)
    foreach(header ${lines})
      cmake_path(GET header PARENT_PATH place)
      if(header STREQUAL own OR (NOT EXISTS ${SOURCE}/${own} AND place STREQUAL folder))
        list(APPEND uses_${header} ${file})
      endif()
    endforeach()
  endif()
endforeach()

# What the facade declares is done in these.
list(APPEND uses_framework/include/fovea/scene.h framework/scene/scene.h framework/scene/frame.h)
list(APPEND uses_framework/include/fovea/image.h framework/image/image.cpp)

# Hash of the files that match `start` and of all that they use, directly or not, among those that match `scope`.
function(code result start scope)
  set(open ${files})
  list(FILTER open INCLUDE REGEX "^(${start})")
  set(used "")
  while(open)
    list(POP_FRONT open file)
    if(NOT file IN_LIST used AND file IN_LIST files AND file MATCHES "^(${start}|${scope})")
      list(APPEND used ${file})
      list(APPEND open ${uses_${file}})
    endif()
  endwhile()
  list(SORT used)
  set(all "")
  foreach(file ${used})
    file(READ ${SOURCE}/${file} text)
    string(REGEX REPLACE "//[^\n]*" "" text "${text}")
    string(REGEX REPLACE "[ \t\r\n]+" " " text "${text}")
    string(SHA256 hash "${text}")
    string(APPEND all "${file} ${hash}\n")
  endforeach()
  string(SHA256 hash "${all}")
  string(SUBSTRING ${hash} 0 16 hash)
  set(${result} ${hash} PARENT_SCOPE)
endfunction()

set(entries "")
file(GLOB folders LIST_DIRECTORIES true RELATIVE ${SOURCE}/passes ${SOURCE}/passes/*)
foreach(type ${folders})
  if(IS_DIRECTORY ${SOURCE}/passes/${type})
    code(hash "passes/${type}/" "framework/(base|host|scene|image|include)/|shaders/")
    string(APPEND entries "    {\"${type}\", \"${hash}\"},\n")
  endif()
endforeach()
code(framework "framework/gpu/|${execution}" "framework/(base|host|scene|include)/|shaders/")
code(measures "benchmarks/runner/(job|job_errors|compared|timings)[.]|framework/session/graph_run[.]" "framework/(image|include)/")
set(commit "")
execute_process(COMMAND git -C ${SOURCE} rev-parse --short HEAD OUTPUT_VARIABLE commit ERROR_QUIET
  OUTPUT_STRIP_TRAILING_WHITESPACE)
file(WRITE ${OUTPUT} "#include \"benchmarks/runner/pass_code.h\"

namespace fovea::bench {

const std::vector<std::pair<std::string_view, std::string_view>> kPassSources = {
${entries}};
const std::string_view kFrameworkSources = \"${framework}\";
const std::string_view kMeasureSources = \"${measures}\";
const std::string_view kBuildCommit = \"${commit}\";

}  // namespace fovea::bench
")
